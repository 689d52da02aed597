// Check files: [[check]] tables. One kind has a robot, a duty, a motor … and limits on the results computed from them. The other kind has a
// command of this program and limits on the numbers of its answer.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "check/command_answers.h"
#include "check/threshold.h"
#include "derate/derating.h"
#include "duty/duty.h"
#include "input/data_folders.h"
#include "motor/motor.h"
#include "robot/robot.h"

namespace heatsoak::check {

struct NumberType;

struct Limit {
  const ThresholdType* type = nullptr;
  double value = 0.0;                          ///< in the type's unit
  std::string unit;                            ///< unit as written in the file
  std::string text;                            ///< limit as written in the file: "at most 150 degC"
  base::Location at;                           ///< place of that text
  std::shared_ptr<const NumberType> own = {};  ///< keeps `type` alive if it belongs to this limit alone
};

struct Check {
  std::string name;
  base::Location at;
  std::optional<robot::Robot> robot;
  std::optional<duty::Duty> duty;
  std::optional<motor::Motor> motor;
  std::vector<motor::Motor> against;
  std::map<std::string, std::string> conditions;
  int samples = 500;
  std::uint64_t seed = 1;
  std::optional<double> temperature_C = {};  ///< temperature of the key `temperature`; set if a limit needs it
  std::filesystem::path table;
  std::vector<std::filesystem::path> files;
  std::vector<std::filesystem::path> logs;
  std::filesystem::path mapping;
  std::optional<double> air_C = {};  ///< air temperature for logs without one
  derate::DerateOptions derate;
  std::filesystem::path folder = {};  ///< folder of the check file
  std::string command = {};           ///< if not empty, the limits are on numbers of this command's JSON answer
  std::vector<Limit> limits;
  /// Settings whose id or file does not exist, with place and reason; the thresholds that need them fail.
  std::map<Setting, base::Diagnostic> unreadable;
};

struct CheckFile {
  std::filesystem::path path;
  std::vector<Check> checks;
  std::vector<base::Diagnostic> unknown;  ///< ids of robots, duties and motors that do not exist
};

/// Reads the file and the robots, duties and motors that it names. Throws Failure (bad_input) with every problem of all of them: unknown
/// keys with "did you mean", invalid limits, missing settings that a limit needs, and settings that no limit uses. Committed tables, logs
/// and linted files are not opened here. If one of them is missing, its threshold fails. The same holds if the id or file of a robot, duty
/// or motor does not exist (Check::unreadable); an unknown id is a problem only beside another one. Commands do not run here, but
/// `check_inputs`, if given, reports their mistakes, also unknown ids and missing files.
CheckFile read_check_file(const std::filesystem::path& path, const input::DataFolders& folders, const CheckInputs& check_inputs = {});

}  // namespace heatsoak::check
