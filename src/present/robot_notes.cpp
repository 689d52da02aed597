#include "present/robot_notes.h"

#include <fmt/format.h>

#include "robot/robot_lint.h"

namespace heatsoak::present {

void add_robot_notes(Document& document, const robot::Robot& robot) {
  for (const motor::LintFinding& each : robot::implausible_values(robot)) {
    if (each.level == motor::LintFinding::Level::warning) {
      document.add_note(Severity::warning,
                        fmt::format("The answer is wrong if this value is: {}:{}: {}", each.at.file, each.at.line, motor::words_of(each)));
    }
  }
}

}  // namespace heatsoak::present
