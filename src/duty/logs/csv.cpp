#include "input/csv.h"

#include <fmt/format.h>

#include <array>
#include <limits>
#include <map>

#include "base/diagnostic.h"
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

void read(const std::filesystem::path& file, const ImportOptions& /*options*/, LogEvents& events) {
  const std::array<CsvWords, 1> words{CsvWords{"team", {"yellow", "blue"}}};
  std::map<RobotName, double> latest_s;
  Diagnostics problems;
  ImportReport& report = events.report();
  report.source = "positions in a table";
  read_csv(file, kColumns, {}, words, [&](const CsvRow& row) {
    ++report.messages;
    ++report.frames;
    const double id = row.values[robot_id];
    if (!(id >= 0.0 && id <= kLargestRobotId) || id != static_cast<double>(static_cast<int>(id))) {
      problems.add({file.string(), row.line, row.columns[robot_id]}, "robot_id",
                   fmt::format("{} is no robot; expected a whole number from 0 to {}", id, kLargestRobotId));
      problems.throw_if_any();
    }
    const RobotName name{row.values[team] == 0.0 ? Team::yellow : Team::blue, static_cast<int>(id)};
    const auto [before, is_new] = latest_s.try_emplace(name, -std::numeric_limits<double>::infinity());
    if (row.values[time] <= before->second) {
      events.problem(static_cast<std::uint64_t>(row.line),
                     fmt::format("{} at {} s, after {} s; time must increase for each robot; left out", to_string(name), row.values[time],
                                 before->second));
      ++report.out_of_order;
      return;
    }
    before->second = row.values[time];
    events.see({.robot = name, .time_s = row.values[time], .x_m = row.values[x], .y_m = row.values[y], .yaw_rad = row.values[yaw]});
  });
  std::error_code error;
  report.bytes = std::filesystem::file_size(file, error);
}

}  // namespace

LogType csv() {
  return {.name = {}, .summary = "table with the columns t_s, team, robot_id, x_m, y_m, yaw_rad", .recognises = recognises, .read = read};
}

}  // namespace heatsoak::logs
