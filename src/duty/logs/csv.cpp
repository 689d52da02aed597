#include "input/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <vector>

#include "base/diagnostic.h"
#include "base/quantity.h"
#include "duty/capture_clock.h"
#include "duty/log_bytes.h"
#include "duty/log_type.h"

namespace heatsoak::duty::logs {
namespace {

const std::array<std::string, 6> kColumns{"t_s", "team", "robot_id", "x_m", "y_m", "yaw_rad"};
enum Column { time, team, robot_id, x, y, yaw };
constexpr double kLargestRobotId = 255.0;

/// Returns true for a header row with most of the columns. Reading the file reports missing ones.
bool recognises(std::string_view head) {
  const std::string_view header = head.substr(0, head.find('\n'));
  std::size_t found = 0;
  for (const std::string& column : kColumns) {
    found += header.find(column) != std::string_view::npos ? 1 : 0;
  }
  return found >= 3;
}

/// Last detection of a robot.
struct Before {
  Detection sight;
  Detection window;  ///< earlier detection; the turn over several frames is less sensitive to noise
};

/// Detects wrong units (mm, degrees, ms) by the limits of a robot's motion.
class Units {
 public:
  void take(Before& before, const Detection& sight, const input::CsvRow& row) {
    farthest_m_ = std::max({farthest_m_, std::abs(sight.x_m), std::abs(sight.y_m)});
    outside_ += std::abs(sight.x_m) > kField_m || std::abs(sight.y_m) > kField_m ? 1 : 0;
    lowest_yaw_ = std::min(lowest_yaw_, sight.yaw_rad);
    highest_yaw_ = std::max(highest_yaw_, sight.yaw_rad);
    beyond_a_turn_ += std::abs(sight.yaw_rad) > 2.0 * std::numbers::pi + 0.05 ? 1 : 0;
    ++sights_;
    if (const double step_s = sight.time_s - before.sight.time_s; step_s > 0.0) {
      log_steps_ += std::log(step_s);
      ++steps_;
      take_turn(before, sight, row);
    }
    before.sight = sight;
  }

  void say(const std::filesystem::path& file) const {
    base::Diagnostics problems;
    if (2 * outside_ > sights_) {
      const std::string far = farthest_m_ < 1e6 ? base::significant(farthest_m_, 3) : fmt::format("{:.3g}", farthest_m_);
      problems.add({file.string(), 1, 1}, "x_m, y_m",
                   fmt::format("reach {} m, and most positions are outside any field: are they in millimetres?", far));
    }
    // Radians seldom exceed one turn; degrees seldom stay within ±2π.
    if (10 * beyond_a_turn_ > sights_) {
      say_degrees(file, problems);
    }
    problems.throw_if_any();
  }

  void say_steps(ImportReport& report) const {
    const double step_s = steps_ > 0 ? std::exp(log_steps_ / static_cast<double>(steps_)) : 0.0;
    if (step_s > kLongestBridge_s) {
      const RowTimeUnit unit = step_s < 1e3   ? RowTimeUnit::milliseconds
                               : step_s < 1e6 ? RowTimeUnit::microseconds
                                              : RowTimeUnit::nanoseconds;
      report.notes.emplace_back(RowsFarApart{step_s, unit});
    }
  }

 private:
  static constexpr double kFullTurn = 360.0;
  static constexpr double kField_m = 30.0;
  static constexpr double kWindow_s = 0.1;

  void take_turn(Before& before, const Detection& sight, const input::CsvRow& row) {
    const double turn = std::abs(sight.yaw_rad - before.sight.yaw_rad);
    const bool is_lost = sight.time_s - before.sight.time_s > kLongestBridge_s;
    if (!is_lost && std::abs(turn - kFullTurn) < 30.0 && !wrap_) {
      wrap_ = base::Location{{}, row.line, row.cells[yaw]};
    }
    if (is_lost || turn > 0.5 * kFullTurn) {  // a wrapped turn is not usable
      before.window = sight;
    } else if (const double span_s = sight.time_s - before.window.time_s; span_s >= kWindow_s) {
      turned_ += std::abs(sight.yaw_rad - before.window.yaw_rad);
      turned_s_ += span_s;
      before.window = sight;
    }
  }

  void say_degrees(const std::filesystem::path& file, base::Diagnostics& problems) const {
    constexpr double kNobodyTurns_rad_per_s = 15.0;
    constexpr double kNobodyKeepsTurning_rad_per_s = 4.0;
    const double mean_rad_per_s = turned_s_ > 1.0 ? turned_ / turned_s_ : 0.0;
    if (wrap_ && highest_yaw_ - lowest_yaw_ < 1.01 * kFullTurn) {
      const base::Diagnostic there{{file.string(), wrap_->line, wrap_->column}, "yaw_rad", ""};
      problems.add(input::with_characters({there}).front().at, there.key,
                   "jumps by a full turn of 360: it is in degrees; expected radians");
    } else if (mean_rad_per_s > kNobodyTurns_rad_per_s) {
      problems.add({file.string(), 1, 1}, "yaw_rad",
                   fmt::format("turns at {:.3g} rad/s on average over the game, which no robot does: is it in degrees?", mean_rad_per_s));
    } else if (mean_rad_per_s > kNobodyKeepsTurning_rad_per_s && turned_s_ > 10.0) {
      problems.add({file.string(), 1, 1}, "yaw_rad",
                   fmt::format("turns at {:.3g} rad/s on average, with values from {:.4g} to {:.4g}: is it in degrees? If the robot does "
                               "turn so much, expected radians from -pi to pi",
                               mean_rad_per_s, lowest_yaw_, highest_yaw_));
    }
  }

  double log_steps_ = 0.0;
  std::uint64_t steps_ = 0;
  double turned_ = 0.0;  ///< sum of turns over windows of kWindow_s
  double turned_s_ = 0.0;
  double lowest_yaw_ = std::numeric_limits<double>::infinity();
  double highest_yaw_ = -std::numeric_limits<double>::infinity();
  std::uint64_t beyond_a_turn_ = 0;
  std::optional<base::Location> wrap_;  ///< location of the first step of about 360; its column counts cells
  double farthest_m_ = 0.0;
  std::uint64_t outside_ = 0;
  std::uint64_t sights_ = 0;
};

/// Handles the rows of one robot in the order of the file. Rows that go back in time are omitted. If several consecutive rows are in order
/// among themselves, the clock has restarted, and their times are shifted to after a pause.
class RobotClock {
 public:
  struct Row {
    Detection sight;
    int line = 0;
    double written_s = 0.0;  ///< time as in the file
  };
  /// Callbacks for rows. `after_s` is the latest earlier time, as in the file.
  struct Listener {
    std::function<void(const Detection& in_time)> see;
    std::function<void(const Row& row, double after_s)> left_out;
    std::function<void(const Row& row, double after_s)> restarted;
  };
  static constexpr double kPause_s = 1.0;
  static_assert(kPause_s > kLongestBridge_s, "tracks are cut there");

  void take(Row row, const Listener& listener) {
    row.sight.time_s += shift_s_;
    if (!latest_s_ || row.sight.time_s > *latest_s_) {
      leave_out(listener);
      see(row.sight, listener);
      return;
    }
    const double step_s = late_.empty() ? kPause_s : row.sight.time_s - late_.back().sight.time_s;
    if (!late_.empty() && (step_s <= 0.0 || step_s > kLongestBridge_s)) {
      leave_out(listener);
    }
    late_.push_back(row);
    const double back_s = *latest_s_ - late_.front().sight.time_s;
    if (late_.size() < static_cast<std::size_t>(CaptureClock::kConfirmed) || back_s < CaptureClock::kTolerance_s) {
      return;
    }
    listener.restarted(late_.front(), *latest_s_ - shift_s_);
    shift_s_ += back_s + kPause_s;
    for (Row& each : late_) {
      each.sight.time_s += back_s + kPause_s;
      see(each.sight, listener);
    }
    late_.clear();
  }

  void leave_out(const Listener& listener) {
    for (const Row& each : late_) {
      listener.left_out(each, *latest_s_ - shift_s_);
    }
    late_.clear();
  }

 private:
  void see(const Detection& sight, const Listener& listener) {
    latest_s_ = sight.time_s;
    listener.see(sight);
  }

  std::optional<double> latest_s_;
  double shift_s_ = 0.0;
  std::vector<Row> late_;
};

RobotName robot_of(const std::filesystem::path& file, const input::CsvRow& row) {
  const double id = row.values[robot_id];
  if (!(id >= 0.0 && id <= kLargestRobotId) || id != static_cast<double>(static_cast<int>(id))) {
    throw base::Failure(
        base::ExitCode::bad_input, "",
        input::with_characters({{{file.string(), row.line, row.cells[robot_id]},
                                 "robot_id",
                                 fmt::format("{} is not a robot id; expected a whole number from 0 to {}", id, kLargestRobotId)}}));
  }
  return {row.values[team] == 0.0 ? Team::yellow : Team::blue, static_cast<int>(id)};
}

/// Distributes the rows of a file to the clocks of their robots.
class Rows {
 public:
  Rows(const std::filesystem::path& file, LogEvents& events) : file_(file), events_(events) {}

  void take(const input::CsvRow& row) {
    ++events_.report().messages;
    ++events_.report().frames;
    const RobotName name = robot_of(file_, row);
    if (std::isnan(row.values[x]) || std::isnan(row.values[y]) || std::isnan(row.values[yaw])) {
      ++blank_;
      return;
    }
    const Detection sight{
        .robot = name, .time_s = row.values[time], .x_m = row.values[x], .y_m = row.values[y], .yaw_rad = row.values[yaw]};
    row_ = &row;
    robot_ = &robots_.try_emplace(sight.robot, Robot{{sight, sight}, {}}).first->second;
    robot_->clock.take({sight, row.line, sight.time_s}, listener_);
  }

  void finish() {
    for (auto& [name, robot] : robots_) {
      robot.clock.leave_out(listener_);
    }
    if (blank_ > 0) {
      events_.report().notes.emplace_back(RowsWithoutPosition{blank_});
    }
    units_.say(file_);
    say_times();
  }

 private:
  struct Robot {
    Before before;
    RobotClock clock;
  };

  void problem(const RobotClock::Row& row, const LogFault& fault) { events_.problem(static_cast<std::uint64_t>(row.line), fault); }

  /// Adds the probable reason why robots could not be tracked: the unit, rounding or order of the times.
  void say_times() const {
    ImportReport& report = events_.report();
    if (2 * report.out_of_order <= report.messages) {
      units_.say_steps(report);
    } else if (2 * repeated_ > report.out_of_order) {
      report.notes.emplace_back(TimesRepeat{});
    } else {
      report.notes.emplace_back(RowsNotSorted{});
    }
  }

  const std::filesystem::path& file_;
  LogEvents& events_;
  std::uint64_t blank_ = 0;
  std::uint64_t repeated_ = 0;  ///< omitted rows with the time of the previous row
  std::map<RobotName, Robot> robots_;
  Units units_;
  const input::CsvRow* row_ = nullptr;
  Robot* robot_ = nullptr;  ///< robot of the present row
  RobotClock::Listener listener_{.see =
                                     [this](const Detection& in_time) {
                                       units_.take(robot_->before, in_time, *row_);
                                       events_.see(in_time);
                                     },
                                 .left_out =
                                     [this](const RobotClock::Row& row, double after_s) {
                                       ++events_.report().out_of_order;
                                       repeated_ += row.written_s == after_s ? 1 : 0;
                                       problem(row, TimeNotIncreasing{row.sight.robot, row.written_s, after_s});
                                     },
                                 .restarted =
                                     [this](const RobotClock::Row& row, double after_s) {
                                       problem(row, ClockRestarts{row.sight.robot, row.written_s, after_s, RobotClock::kPause_s});
                                     }};
};

void read(const std::filesystem::path& file, const ImportOptions& /*options*/, LogEvents& events) {
  if (LogBytes(file).is_packed()) {
    throw base::bad_input({file.string()}, "", "is packed by gzip; unpack it first");
  }
  const std::array<input::CsvWords, 1> words{input::CsvWords{"team", {"yellow", "blue"}}};
  input::CsvColumns columns{{kColumns.begin(), kColumns.end()}, {}, {kColumns[x], kColumns[y], kColumns[yaw]}};
  ImportReport& report = events.report();
  report.source.kind = PositionSource::Kind::table;
  Rows rows(file, events);
  input::read_csv(
      file, [&columns](std::span<const std::string> /*header*/) { return columns; }, words,
      [&rows](const input::CsvRow& row) { rows.take(row); }, [&report](int line) { report.notes.emplace_back(LastRowOmitted{line}); });
  rows.finish();
  std::error_code error;
  report.bytes = std::filesystem::file_size(file, error);
}

}  // namespace

LogType csv() {
  return {.name = {}, .summary = "table with the columns t_s, team, robot_id, x_m, y_m, yaw_rad", .recognises = recognises, .read = read};
}

}  // namespace heatsoak::duty::logs
