#include <fmt/format.h>

#include <array>
#include <cmath>

#include "duty/duty.h"
#include "input/csv.h"

namespace heatsoak::shapes {
namespace {

constexpr std::size_t kMostRows = 2'000'000;  ///< a day at 20 rows a second; more would fill the memory

struct Row {
  double duration_s = 0.0;
  double demand = 0.0;  ///< N m or A
  double speed_rad_per_s = 0.0;
};

/// A row holds until the next one; the last row only ends the duty.
std::vector<Row> read_rows(const std::filesystem::path& file, DutyKind kind) {
  const std::array<std::string, 3> torque_columns{"time_s", "torque_Nm", "speed_rad_per_s"};
  const std::array<std::string, 3> current_columns{"time_s", "current_A", "speed_rad_per_s"};
  double before_s = std::nan("");
  std::vector<Row> rows;
  Diagnostics diagnostics;
  read_csv(file, kind == DutyKind::torque ? torque_columns : current_columns, {}, [&](const CsvRow& row) {
    const double now_s = row.values[0];
    if (rows.size() > kMostRows) {
      throw bad_input({file.string(), row.line, 1}, "", fmt::format("has more than {} rows; expected something like a match", kMostRows));
    }
    if (now_s <= before_s && diagnostics.list().size() < 20) {
      diagnostics.add({file.string(), row.line, 1}, "time_s", fmt::format("{} s does not come after {} s; time must increase", now_s, before_s));
    }
    if (!rows.empty()) {
      rows.back().duration_s = now_s - before_s;
    }
    before_s = now_s;
    rows.push_back({0.0, row.values[1], row.values[2]});
  });
  diagnostics.throw_if_any();
  rows.pop_back();
  if (rows.empty()) {
    throw bad_input({file.string()}, "", "has one row; expected at least two, the last one ends the duty");
  }
  return rows;
}

class Recorded final : public DutyShape {
 public:
  Recorded(const std::vector<Row>& rows, DutyKind kind, int repeats) : repeats_(repeats) {
    once_.wheel = "recorded wheel";
    for (const Row& row : rows) {
      const double torque_Nm = kind == DutyKind::torque ? row.demand : 0.0;
      const double current_A = kind == DutyKind::current ? row.demand : 0.0;
      once_.bins.push_back(constant_bin(row.duration_s, torque_Nm, row.speed_rad_per_s, current_A));
      const double sign = row.speed_rad_per_s < 0.0 ? -1.0 : 1.0;
      once_.points.push_back({sign * torque_Nm, std::abs(row.speed_rad_per_s), sign * current_A, row.duration_s * repeats});
    }
  }

  [[nodiscard]] std::vector<WheelDemand> demand(const Robot& /*robot*/, std::uint64_t /*seed*/) const override {
    WheelDemand wheel = once_;
    for (int i = 1; i < repeats_; ++i) {
      wheel.bins.insert(wheel.bins.end(), once_.bins.begin(), once_.bins.end());
    }
    return {wheel};
  }

 private:
  WheelDemand once_;
  int repeats_;
};

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
  std::vector<Row> rows;
  try {
    rows = read_rows(folder / *file, duty.kind);
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
  if (static_cast<double>(rows.size()) * repeats > static_cast<double>(kMostRows)) {
    table.problem("repeats", fmt::format("makes more than {} rows; expected something like a match", kMostRows));
    return;
  }
  duty.shape_data = std::make_shared<Recorded>(rows, duty.kind, static_cast<int>(repeats));
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
