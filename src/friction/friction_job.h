// The answer of `friction`: fits the friction of every wheel to the logs of a test, and writes it into the robot file.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/diagnostic.h"
#include "base/parallel.h"
#include "friction/friction_fit.h"
#include "friction/read_friction_log.h"
#include "friction/roll_out.h"
#include "friction/steady_parts.h"
#include "input/data_folders.h"

namespace heatsoak::friction {

enum class FrictionMethod {
  steady_state,  ///< voltage over speed while the robot drives steadily: friction and damping of every wheel
  roll_out       ///< decelerations with open motors: damping alone
};

struct FrictionJob {
  FrictionMethod method = FrictionMethod::steady_state;
  robot::Robot robot;
  std::string motor_id = {};                     ///< motor that the robot drove with
  std::optional<motor::MotorValues> motor = {};  ///< its values, if it has a file
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
  std::vector<SuspicionOfTest> suspicions;
  std::string robot_text;            ///< empty unless requested
  std::vector<WrittenAsZero> notes;  ///< remarks on `robot_text`
};

struct SteadyFriction : FrictionRun {
  SteadyParts steady;
  FrictionFit fit;
  FitSettings settings;
  HeldOutError error;
  std::optional<ExpectedFrom> expected_from;  ///< set if `error` also contains the error of a robot file without measurement
};

struct RollOutFriction : FrictionRun {
  RollOutResult result;
  robot::DriveConstants drive;  ///< with a drag torque of 0
};

/// Units, signs or wheels of the logs look wrong (bad_input). Values from a wrong unit would get into the robot's file and from there into
/// its firmware.
class LogsLookWrong : public base::Failure {
 public:
  struct Finding {
    std::string file;
    FrictionSuspicion suspicion;
  };
  explicit LogsLookWrong(std::vector<Finding> findings);
  [[nodiscard]] const std::vector<Finding>& findings() const { return findings_; }

 private:
  std::vector<Finding> findings_;
};

/// No wheel was fitted (cannot_answer).
class NothingIdentifiable : public base::Failure {
 public:
  struct Reason {
    std::size_t legs = 0;  ///< steady legs; 0: in no interval do the wheels turn steadily
    std::size_t headings = 0;
    std::optional<WheelProblem> of_first_wheel = {};
    std::vector<SuspicionOfTest> suspicions = {};
  };
  explicit NothingIdentifiable(Reason reason);
  [[nodiscard]] const Reason& reason() const { return reason_; }

 private:
  Reason reason_;
};

using FrictionAnswer = std::variant<SteadyFriction, RollOutFriction>;

/// Returns the text of the robot's file with the measured friction; empty unless the job requests it.
const std::string& robot_text(const FrictionAnswer& answer);

/// Evaluates the test by the method of the job. Throws LogsLookWrong, NothingIdentifiable, and Failure (bad_input) for logs that cannot be
/// read or are given twice, and without the values of the motor for a roll-out or a robot file.
FrictionAnswer run_friction(const FrictionJob& job, const base::Progress& progress = {});

}  // namespace heatsoak::friction
