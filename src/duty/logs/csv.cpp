#include "input/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "base/diagnostic.h"
#include "base/quantity.h"
#include "duty/log_type.h"

namespace heatsoak::logs {
namespace {

const std::array<std::string, 6> kColumns{"t_s", "team", "robot_id", "x_m", "y_m", "yaw_rad"};
enum Column { time, team, robot_id, x, y, yaw };
constexpr double kLargestRobotId = 255.0;

/// A header row that names most of the columns; which one is missing is said when the file is read.
bool recognises(std::string_view head) {
  const std::string_view header = head.substr(0, head.find('\n'));
  std::size_t found = 0;
  for (const std::string& column : kColumns) {
    found += header.find(column) != std::string_view::npos ? 1 : 0;
  }
  return found >= 3;
}

/// Tells metres from millimetres and radians from degrees by what a robot can do.
class Scales {
 public:
  void take(double before_s, double before_yaw_rad, const Detection& sight) {
    const double step_s = sight.time_s - before_s;
    const double turn_rad = std::abs(sight.yaw_rad - before_yaw_rad);
    // A yaw that wraps says nothing of the turn.
    if (step_s > 0.0 && step_s < kLongestBridge_s && turn_rad < 0.5 * kWrap) {
      turned_rad_ += turn_rad;
      turned_s_ += step_s;
    }
    farthest_m_ = std::max({farthest_m_, std::abs(sight.x_m), std::abs(sight.y_m)});
    outside_ += std::abs(sight.x_m) > kField_m || std::abs(sight.y_m) > kField_m ? 1 : 0;
    ++sights_;
  }

  void say(const std::filesystem::path& file) const {
    Diagnostics problems;
    if (2 * outside_ > sights_) {
      problems.add({file.string(), 1, 1}, "x_m, y_m",
                   fmt::format("reach {} m, and most places lie outside any field: are they in millimetres?", significant(farthest_m_, 3)));
    }
    constexpr double kNobodyTurns_rad_per_s = 15.0;
    if (turned_s_ > 1.0 && turned_rad_ > kNobodyTurns_rad_per_s * turned_s_) {
      problems.add({file.string(), 1, 1}, "yaw_rad",
                   fmt::format("turns at {} rad/s on average over the game, which no robot does: is it in degrees?",
                               significant(turned_rad_ / turned_s_, 2)));
    }
    problems.throw_if_any();
  }

 private:
  static constexpr double kWrap = 360.0;
  static constexpr double kField_m = 30.0;

  double turned_rad_ = 0.0;
  double turned_s_ = 0.0;
  double farthest_m_ = 0.0;
  std::uint64_t outside_ = 0;
  std::uint64_t sights_ = 0;
};

void read(const std::filesystem::path& file, const ImportOptions& /*options*/, LogEvents& events) {
  const std::array<CsvWords, 1> words{CsvWords{"team", {"yellow", "blue"}}};
  std::map<RobotName, Detection> latest;
  Scales scales;
  ImportReport& report = events.report();
  report.source = "positions in a table";
  read_csv(file, kColumns, {}, words, [&](const CsvRow& row) {
    ++report.messages;
    ++report.frames;
    const double id = row.values[robot_id];
    if (!(id >= 0.0 && id <= kLargestRobotId) || id != static_cast<double>(static_cast<int>(id))) {
      throw Failure(ExitCode::bad_input, "",
                    with_characters({{{file.string(), row.line, row.cells[robot_id]},
                                      "robot_id",
                                      fmt::format("{} is no robot; expected a whole number from 0 to {}", id, kLargestRobotId)}}));
    }
    const RobotName name{row.values[team] == 0.0 ? Team::yellow : Team::blue, static_cast<int>(id)};
    const Detection sight{
        .robot = name, .time_s = row.values[time], .x_m = row.values[x], .y_m = row.values[y], .yaw_rad = row.values[yaw]};
    const auto [before, is_new] = latest.try_emplace(name, sight);
    if (!is_new && sight.time_s <= before->second.time_s) {
      events.problem(static_cast<std::uint64_t>(row.line),
                     fmt::format("{} at {} s, after {} s; time must increase for each robot; left out", to_string(name), sight.time_s,
                                 before->second.time_s));
      ++report.out_of_order;
      return;
    }
    scales.take(before->second.time_s, before->second.yaw_rad, sight);
    before->second = sight;
    events.see(sight);
  });
  scales.say(file);
  std::error_code error;
  report.bytes = std::filesystem::file_size(file, error);
}

}  // namespace

LogType csv() {
  return {.name = {}, .summary = "table with the columns t_s, team, robot_id, x_m, y_m, yaw_rad", .recognises = recognises, .read = read};
}

}  // namespace heatsoak::logs
