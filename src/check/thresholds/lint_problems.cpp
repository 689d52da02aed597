#include <algorithm>

#include "check/computations.h"
#include "check/not_evaluated.h"
#include "duty/file_kind.h"
#include "motor/lint.h"
#include "robot/robot_lint.h"

namespace heatsoak::check::thresholds {
namespace {

bool is_problem(const motor::LintFinding& finding) { return finding.level != motor::LintFinding::Level::note; }

/// Returns the findings of the robot and the motor of the check, or of the files that it names, whose keys determine their kind.
std::vector<motor::LintFinding> findings_of(const Check& check) {
  std::vector<motor::LintFinding> all;
  const auto take = [&all](std::vector<motor::LintFinding> findings) { std::ranges::move(findings, std::back_inserter(all)); };
  // The robot's motor counts as known, because its file may lie anywhere; `heatsoak lint` checks that.
  const auto of_robot = [&take](const robot::Robot& robot) { take(robot::lint(robot, std::vector{robot.drive.motor})); };
  for (const std::filesystem::path& file : check.files) {
    switch (duty::file_kind(file)) {
      case duty::FileKind::robot:
        of_robot(robot::read_robot(file));
        break;
      case duty::FileKind::duty:
        duty::read_duty(file);
        break;
      case duty::FileKind::motor:
        take(motor::lint(motor::read_motor(file)));
    }
  }
  if (check.files.empty()) {
    if (check.motor) {
      take(motor::lint(*check.motor));
    }
    if (check.robot) {
      of_robot(*check.robot);
    }
  }
  return all;
}

Measured measure_lint_problems(const Check& check, Computations& /*computations*/) {
  if (check.files.empty() && !check.motor && !check.robot && !check.duty) {
    throw NotEvaluated(NothingToLint{});
  }
  const std::vector<motor::LintFinding> all = findings_of(check);
  const auto count = std::ranges::count_if(all, is_problem);
  const auto first = std::ranges::find_if(all, is_problem);
  return {static_cast<double>(count), 0.0, first == all.end() ? Basis() : LintBasis{*first}};
}

/// Files with as many problems as a motor file has values are no data.
std::optional<LoosestLimit> one_for_each_value(const Check& check) {
  const std::size_t own = (check.motor ? 1U : 0U) + (check.robot ? 1U : 0U) + (check.duty ? 1U : 0U);
  const std::size_t files = check.files.empty() ? own : check.files.size();
  return files > 0 ? std::optional<LoosestLimit>(
                         {static_cast<double>(files * motor::motor_parameter_specs().size()), LoosestBy::values_of_files, true})
                   : std::nullopt;
}

}  // namespace

ThresholdType lint_problems() {
  return {.name = {},
          .unit = "",
          .is_whole = true,
          .range = base::Range::between(0.0, 1e4),
          .room = Room::none,
          .meaning = "number of errors and warnings of `lint`, without notes, for 'files' or for the check's own motor, robot and duty",
          .example = "at most 0",
          .needs = {},
          .takes = {Setting::robot, Setting::duty, Setting::motor, Setting::conditions, Setting::files},
          .loosest = one_for_each_value,
          .measure = measure_lint_problems};
}

}  // namespace heatsoak::check::thresholds
