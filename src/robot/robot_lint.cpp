#include "robot/robot_lint.h"

#include <fmt/format.h>

#include <algorithm>

#include "input/document.h"
#include "robot/body.h"

namespace heatsoak {

std::vector<LintFinding> lint(const Robot& robot, std::span<const std::string> known_motors) {
  std::vector<LintFinding> findings;
  if (robot.drive_motor != "none" && std::ranges::find(known_motors, robot.drive_motor) == known_motors.end()) {
    findings.push_back(
        {LintFinding::Level::warning, "motor",
         fmt::format("drive.motor: there is no motor '{}'{}", robot.drive_motor, did_you_mean(robot.drive_motor, known_motors)),
         place_of(robot.file, "drive.motor")});
  }
  try {
    MotorValues any;
    any.rotor_inertia_kg_m2 = 0.0;
    make_body(robot, any);
  } catch (const Failure& failure) {
    if (std::ranges::any_of(robot.figures, [](const auto& each) { return each.first.starts_with("body."); })) {
      throw;
    }
    for (const Diagnostic& each : failure.diagnostics()) {
      findings.push_back({LintFinding::Level::note, "motion",
                          each.key + " " + each.message + "; a match needs it, a prescribed duty does not",
                          place_of(robot.file, each.key)});
    }
  }
  return findings;
}

}  // namespace heatsoak
