#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "duty/duty.h"
#include "input/csv.h"

namespace heatsoak::duty::shapes {
namespace {

constexpr double kMostPieces = 2e6;  ///< limits the memory

/// Longest duration of merged rows. It is shorter than the bins of a match: voltage and current limits act on the mean of merged rows
/// instead of single rows, which overestimates the heat.
constexpr double kMerged_s = 0.1;

constexpr int kMostWheels = 4;
constexpr double kLongest_s = 1e6;
constexpr double kLargest = 1e5;  ///< N m, A or rad/s
constexpr std::size_t kMostProblems = 20;

/// Returns the name of a column: "torque_Nm" or "speed_rad_per_s" for a single wheel (`wheel` 0), "torque_1_Nm" etc. for several.
std::string column(DutyKind kind, int wheel, bool demand) {
  const std::string number = wheel > 0 ? fmt::format("_{}", wheel) : "";
  return demand ? fmt::format("{}{}_{}", kind == DutyKind::torque ? "torque" : "current", number, kind == DutyKind::torque ? "Nm" : "A")
                : fmt::format("speed{}_rad_per_s", number);
}

/// Grid of load points. As for a match, finer steps do not change a verdict.
constexpr DemandGatherer::Grid kGrid{.torque_step_Nm = 0.002, .speed_step_rad_per_s = 3.0, .current_step_A = 0.02};

/// Builds the demand of one or several wheels from rows. A row holds until the next one; the last row only marks the end. Rows shorter than
/// kMerged_s are merged.
class Recording {
 public:
  Recording(std::filesystem::path file, DutyKind kind) : file_(std::move(file)), kind_(kind) {}

  std::vector<WheelDemand> read() {
    base::Diagnostics all;
    try {
      input::read_csv(
          file_,
          [this](std::span<const std::string> header) {
            names_ = columns(header).required;
            refuse_both_kinds(header);
            return columns(header);
          },
          {}, [this](const input::CsvRow& row) { take(row); });
    } catch (const base::Failure& failure) {
      if (pieces_ > kMostPieces) {
        throw;  // too many rows; other problems are not reported
      }
      for (const base::Diagnostic& each : failure.diagnostics()) {
        all.add(each.at, each.key, each.message);
      }
    }
    for (const base::Diagnostic& each : input::with_characters(std::move(problems_))) {
      all.add(each.at, each.key, each.message);
    }
    all.throw_if_any();
    if (rows_ < 2) {
      throw base::bad_input({file_.string()}, "", "has one row; expected at least two, the last one ends the duty");
    }
    std::vector<WheelDemand> wheels;
    for (DemandGatherer& wheel : wheels_) {
      wheels.push_back(wheel.finish());
    }
    return wheels;
  }

 private:
  /// Returns the expected columns: numbered ones up to the last wheel in the header, otherwise those of a single wheel.
  [[nodiscard]] input::CsvColumns columns(std::span<const std::string> header) const {
    const auto has = [&](const std::string& name) { return std::ranges::find(header, name) != header.end(); };
    int wheels = kMostWheels;
    while (wheels > 0 && !has(column(kind_, wheels, true)) && !has(column(kind_, wheels, false))) {
      --wheels;
    }
    input::CsvColumns wanted{{"time_s"}, {}};
    for (int wheel = std::min(wheels, 1); wheel <= wheels; ++wheel) {
      wanted.required.push_back(column(kind_, wheel, true));
      wanted.required.push_back(column(kind_, wheel, false));
    }
    return wanted;
  }

  /// Rejects a header with numbered and unnumbered columns, because the unnumbered load would be ignored.
  void refuse_both_kinds(std::span<const std::string> header) const {
    const auto has = [&](int wheel) { return std::ranges::find(header, column(kind_, wheel, true)) != header.end(); };
    if (names_.size() > 1 && names_[1] != column(kind_, 0, true) && has(0)) {
      throw base::bad_input(
          {file_.string(), 1, 1}, "",
          fmt::format("has {} and {}; expected the columns of one wheel without a number in their names, or of several wheels with numbers",
                      column(kind_, 0, true), names_[1]));
    }
  }

  void take(const input::CsvRow& row) {
    const double now_s = row.values[0];
    const double duration_s = now_s - before_s_;
    pieces_ += rows_ > 0 ? std::min(1.0, std::abs(duration_s) / kMerged_s) : 0.0;
    if (pieces_ > kMostPieces) {
      throw base::bad_input(
          {file_.string(), row.line, 1}, "",
          fmt::format("has more than {:.0f} rows (a row shorter than {} s counts as a fraction); expected about the length of a match",
                      kMostPieces, kMerged_s));
    }
    if (duration_s <= 0.0) {
      problem(row, 0, fmt::format("{} s does not come after {} s; time must increase", now_s, before_s_));
    }
    if (++rows_ == 1) {
      first_s_ = now_s;
    }
    if (now_s - first_s_ > kLongest_s) {
      problem(row, 0,
              fmt::format("{} s is more than {:.0f} s after the first row; expected about the length of a match", now_s, kLongest_s));
    }
    for (std::size_t i = 1; i < row.values.size(); ++i) {
      if (std::abs(row.values[i]) > kLargest) {
        problem(row, i, fmt::format("{0} is beyond any motor; expected -{1:.0f} to {1:.0f}", row.values[i], kLargest));
      }
    }
    if (problems_.empty()) {
      hold(duration_s);
    }
    before_s_ = now_s;
    before_.assign(row.values.begin(), row.values.end());
  }

  /// Adds the previous row, which lasted `duration_s`.
  void hold(double duration_s) {
    for (std::size_t i = 1; i + 1 < before_.size(); i += 2) {
      const std::size_t wheel = (i - 1) / 2;
      if (wheel == wheels_.size()) {
        wheels_.emplace_back(before_.size() > 3 ? fmt::format("wheel {}", wheel + 1) : "recorded wheel", kMerged_s, kGrid);
      }
      const double torque_Nm = kind_ == DutyKind::torque ? before_[i] : 0.0;
      const double current_A = kind_ == DutyKind::current ? before_[i] : 0.0;
      if (duration_s < kMerged_s * (1.0 - 1e-9)) {
        wheels_[wheel].add(duration_s, torque_Nm, before_[i + 1], current_A);
      } else {
        wheels_[wheel].add_alone(duration_s, torque_Nm, before_[i + 1], current_A);
      }
    }
  }

  void problem(const input::CsvRow& row, std::size_t value, std::string message) {
    if (problems_.size() < kMostProblems) {
      problems_.push_back({{file_.string(), row.line, row.cells[value]}, names_[value], std::move(message)});
    }
  }

  std::filesystem::path file_;
  DutyKind kind_;
  std::vector<std::string> names_;  ///< names of the columns that are read
  std::vector<DemandGatherer> wheels_;
  std::vector<base::Diagnostic> problems_;
  std::vector<double> before_;  ///< values of the row that still holds
  std::size_t rows_ = 0;
  double pieces_ = 0.0;
  double before_s_ = std::nan("");
  double first_s_ = 0.0;
};

class Recorded final : public DutyShape {
 public:
  Recorded(std::vector<WheelDemand> once, int repeats) : once_(std::move(once)), repeats_(repeats) {
    for (WheelDemand& wheel : once_) {
      for (LoadPoint& point : wheel.points) {
        point.time_s *= repeats;
      }
    }
  }

  [[nodiscard]] std::vector<WheelDemand> demand(const robot::Robot& /*robot*/, std::uint64_t /*seed*/) const override {
    std::vector<WheelDemand> wheels = once_;
    for (WheelDemand& wheel : wheels) {
      const std::vector<LoadBin> once = wheel.bins;
      for (int i = 1; i < repeats_; ++i) {
        wheel.bins.insert(wheel.bins.end(), once.begin(), once.end());
      }
    }
    return wheels;
  }

 private:
  std::vector<WheelDemand> once_;
  int repeats_;
};

void read_recorded(input::Reader& table, const std::filesystem::path& folder, Duty& duty) {
  const std::optional<std::string> file = table.text("file", input::Need::required);
  constexpr std::array<std::string_view, 2> kQuantities{"torque", "current"};
  const std::optional<std::string> quantity = table.choice("quantity", kQuantities, input::Need::required);
  const double repeats =
      table.quantity({"repeats", "", base::Range::between(1.0, 1e4), "number of runs of the recording"}, input::Need::optional)
          .value_or(1.0);
  if (repeats != std::floor(repeats)) {
    table.problem("repeats", "is not a whole number");
  }
  if (!file || !quantity) {
    return;
  }
  duty.kind = *quantity == "torque" ? DutyKind::torque : DutyKind::current;
  std::vector<WheelDemand> wheels;
  try {
    wheels = Recording(folder / *file, duty.kind).read();
  } catch (const base::Failure& failure) {
    for (const base::Diagnostic& each : failure.diagnostics()) {
      if (each.at.line) {
        table.add(each);
      } else {
        table.problem("file", fmt::format("{} {}", each.at.file, each.message));
      }
    }
    return;
  }
  if (static_cast<double>(wheels.front().bins.size()) * repeats > kMostPieces) {
    table.problem("repeats", fmt::format("makes more than {:.0f} rows; expected about the length of a match", kMostPieces));
    return;
  }
  duty.recording = RecordedFile{folder / *file, static_cast<int>(repeats)};
  duty.shape_data = std::make_shared<Recorded>(std::move(wheels), static_cast<int>(repeats));
}

}  // namespace

ShapeType recorded() {
  return {.name = {},
          .summary =
              "a CSV file with time_s, speed_rad_per_s and torque_Nm or current_A (or torque_1_Nm, speed_1_rad_per_s, … of several "
              "wheels); a row holds until the next",
          .example = R"(shape = "recorded"
[recorded]
file = "my_game.csv"
quantity = "torque"   # or "current"
repeats = "1"
)",
          .read = read_recorded};
}

}  // namespace heatsoak::duty::shapes
