#include "present/robot_notes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

#include "robot/robot_lint.h"

namespace heatsoak::present {

void add_robot_notes(Document& document, const robot::Robot& robot) {
  std::vector<std::string> keys;
  for (const motor::LintFinding& each : robot::implausible_values(robot)) {
    if (each.level == motor::LintFinding::Level::warning) {
      keys.push_back(each.key);
      document.add_note(Severity::warning, fmt::format("The answer is wrong if this value is: {}: {}",
                                                       base::to_string(base::Location{each.at.file, each.at.line}), motor::words_of(each)));
    }
  }
  // The short form of an answer shows no notes.
  if (!keys.empty()) {
    document.headline.push_back(
        {fmt::format("The robot's file has implausible values, which may make the answer wrong: {}.", fmt::join(keys, ", ")), Tone::bad});
  }
}

void add_assumed_friction(Document& document, const robot::Robot& robot) {
  if (robot.friction.is_assumed) {
    document.add_note(
        Severity::warning,
        fmt::format("{} has no [friction]: the feed-forward of friction is off, and the simulated robot has the friction of other teams' "
                    "robots (estimate: wheel torque {:.1f} mN m, roller drag {:.2f}, rolling efficiency {:.2f}); measure yours with "
                    "`heatsoak friction`",
                    robot.file.filename().string(), 1e3 * robot.friction.wheel_torque_Nm.value(), robot.friction.roller_drag_ratio.value(),
                    robot.friction.rolling_efficiency.value()));
  }
}

}  // namespace heatsoak::present
