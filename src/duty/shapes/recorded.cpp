#include <fmt/format.h>

#include <array>
#include <cmath>

#include "duty/duty.h"
#include "input/csv.h"

namespace heatsoak::shapes {
namespace {

constexpr std::size_t kMostPieces = 2'000'000;  ///< a day at 20 rows a second; more would fill the memory

/// A row holds until the next one; the last row only ends the duty.
void read_rows(const std::filesystem::path& file, DutyKind kind, Duty& duty) {
  const std::array<std::string, 3> torque_columns{"time_s", "torque_Nm", "speed_rad_per_s"};
  const std::array<std::string, 3> current_columns{"time_s", "current_A", "speed_rad_per_s"};
  double before_s = std::nan("");
  Diagnostics diagnostics;
  read_csv(file, kind == DutyKind::torque ? torque_columns : current_columns, {}, [&](const CsvRow& row) {
    const double now_s = row.values[0];
    if (duty.pieces.size() > kMostPieces) {
      throw bad_input({file.string(), row.line, 1}, "", fmt::format("has more than {} rows; expected something like a match", kMostPieces));
    }
    if (now_s <= before_s && diagnostics.list().size() < 20) {
      diagnostics.add({file.string(), row.line, 1}, "time_s", fmt::format("{} s does not come after {} s; time must increase", now_s, before_s));
    }
    if (!duty.pieces.empty()) {
      duty.pieces.back().duration_s = now_s - before_s;
    }
    before_s = now_s;
    const double demand = row.values[1];
    duty.pieces.push_back({0.0, kind == DutyKind::torque ? demand : 0.0, row.values[2], kind == DutyKind::current ? demand : 0.0});
  });
  diagnostics.throw_if_any();
  duty.pieces.pop_back();
  if (duty.pieces.empty()) {
    throw bad_input({file.string()}, "", "has one row; expected at least two, the last one ends the duty");
  }
}

void read(Reader& table, const std::filesystem::path& folder, Duty& duty) {
  const std::optional<std::string> file = table.text("file", Need::required);
  constexpr std::array<std::string_view, 2> kQuantities{"torque", "current"};
  const std::optional<std::string> quantity = table.choice("quantity", kQuantities, Need::required);
  const double repeats = table.quantity({"repeats", "", Range::between(1.0, 1e4), "how often the recording is run"}, Need::optional).value_or(1.0);
  if (repeats != std::floor(repeats)) {
    table.problem("repeats", "is not a whole number");
  }
  if (!file || !quantity) {
    return;
  }
  duty.kind = *quantity == "torque" ? DutyKind::torque : DutyKind::current;
  try {
    read_rows(folder / *file, duty.kind, duty);
  } catch (const Failure& failure) {
    for (const Diagnostic& each : failure.diagnostics()) {
      if (each.at.line > 0) {
        table.add(each);
      } else {
        table.problem("file", to_string(each));
      }
    }
    return;
  }
  if (static_cast<double>(duty.pieces.size()) * repeats > static_cast<double>(kMostPieces)) {
    table.problem("repeats", fmt::format("makes more than {} rows; expected something like a match", kMostPieces));
    return;
  }
  const std::vector<DutyPiece> once = duty.pieces;
  for (int i = 1; i < static_cast<int>(repeats); ++i) {
    duty.pieces.insert(duty.pieces.end(), once.begin(), once.end());
  }
}

}  // namespace

ShapeType recorded() {
  return {.name = {},
          .summary = "a CSV file with time_s, speed_rad_per_s and torque_Nm or current_A of one wheel; a row holds until the next",
          .example = R"(shape = "recorded"
[recorded]
file = "my_game.csv"
quantity = "torque"   # or "current"
repeats = "1"
)",
          .read = read};
}

}  // namespace heatsoak::shapes
