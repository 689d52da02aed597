// The answer of `friction`: logs of a test to the friction of every wheel, and the robot's file with it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "friction/friction_fit.h"
#include "friction/read_friction_log.h"
#include "friction/roll_out.h"
#include "friction/steady_parts.h"
#include "input/data_folders.h"

namespace heatsoak::friction {

struct FrictionJob {
  robot::Robot robot;
  std::optional<motor::MotorValues> motor = {};  ///< motor that the robot drove with, if it is known
  std::vector<std::string> logs;                 ///< at least one; files, or names as log_named() resolves them
  input::DataFolders folders = {};               ///< folders of log_named()
  std::string map = {};                          ///< mapping of foreign logs; empty: the file beside each log, if there is one
  TravelDirection direction = TravelDirection::best;
  bool use_return_legs = false;         ///< steady-state test: use the return legs too
  bool is_lifted = false;               ///< roll-out test: the wheels were off the ground
  bool takes_logs_as_they_are = false;  ///< accept logs whose units, signs or wheels look wrong
  bool writes_robot_file = false;       ///< fill `robot_text`
};

/// Remarks on the logs, and the text of the robot's file with the measured friction.
struct FrictionRun {
  FrictionFindings findings;
  std::vector<std::string> suspicions;
  std::string robot_text;            ///< empty unless requested
  std::vector<WrittenAsZero> notes;  ///< remarks on `robot_text`
};

struct SteadyFriction : FrictionRun {
  SteadyParts steady;
  FrictionFit fit;
  FitSettings settings;
  HeldOutError error;
  bool has_expectation = false;  ///< true if `error` also contains the error of a robot file without measurement
  std::string expected_from;     ///< source of that expectation
};

struct RollOutFriction : FrictionRun {
  RollOutResult result;
  robot::DriveConstants drive;  ///< with a drag torque of 0
};

/// Fits friction and damping of every wheel to a steady-state test. Throws Failure: bad_input for logs that cannot be read, are given twice
/// or look wrong, and for a robot file without a known motor; cannot_answer if nothing is identifiable.
SteadyFriction steady_friction(const FrictionJob& job, const base::Progress& progress = {});

/// Estimates damping from decelerations with open motors. Throws Failure as above; the motor must be known.
RollOutFriction roll_out_friction(const FrictionJob& job, const base::Progress& progress = {});

}  // namespace heatsoak::friction
