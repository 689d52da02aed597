// Checks whether a log can be used to fit a motor. Runs before any simulation.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "base/diagnostic.h"
#include "motor/motor.h"
#include "recording/findings.h"
#include "recording/named_logs.h"
#include "recording/quality.h"
#include "recording/recording.h"

namespace heatsoak::calibration {

/// Single rows exceed the current that the motor can draw at three times its nominal voltage.
struct CurrentOutliers {
  double largest_A = 0.0;
  double most_A = 0.0;  ///< largest possible current
  int line = 0;         ///< line of the largest value
};
/// Single rows exceed the speed that the motor can reach at three times its nominal voltage.
struct SpeedOutliers {
  double largest_rad_per_s = 0.0;
  double most_rad_per_s = 0.0;  ///< largest possible speed
  int line = 0;
};
/// The motor cannot draw such a current at three times its nominal voltage.
struct CurrentExceedsMotor {
  double top_A = 0.0;  ///< usual largest magnitude
  double most_A = 0.0;
  double terminal_resistance_ohm = 0.0;
};
/// The motor cannot turn so fast at three times its nominal voltage.
struct SpeedExceedsMotor {
  double top_rad_per_s = 0.0;  ///< usual largest magnitude
  double most_rad_per_s = 0.0;
};
/// A temperature rises faster than the losses of the motor can heat it.
struct RisesTooFast {
  std::string channel;
  double ratio = 0.0;  ///< heat that the rises need, divided by the heat supplied
  recording::TimeUnit suspected = recording::TimeUnit::minutes;
};
/// Property of a log that prevents a fit if it is an error.
using LogProblem = std::variant<recording::Suspicion, CurrentOutliers, SpeedOutliers, CurrentExceedsMotor, SpeedExceedsMotor, RisesTooFast>;

/// Units or sensors of the logs look wrong (bad_input).
class LogsLookWrong : public base::Failure {
 public:
  struct Finding {
    std::string file;
    LogProblem problem;
  };
  explicit LogsLookWrong(std::vector<Finding> findings);
  [[nodiscard]] const std::vector<Finding>& findings() const { return findings_; }

 private:
  std::vector<Finding> findings_;
};

/// Logs contain rows to which the motor's file was fitted before (bad_input).
class RunsOfTheFile : public base::Failure {
 public:
  RunsOfTheFile(std::string motor_id, std::vector<std::filesystem::path> files);
  [[nodiscard]] const std::string& motor_id() const { return motor_id_; }
  [[nodiscard]] const std::vector<std::filesystem::path>& files() const { return files_; }

 private:
  std::string motor_id_;
  std::vector<std::filesystem::path> files_;
};

/// A recording states that it is of another motor.
struct OfOtherMotor {
  std::string recording;
  std::string stated;
  std::string motor;
};
/// A sensor of a log lags, or a clock is off.
struct SensorLags {
  std::string log;
  recording::RespondsLate response;
};
/// Property of a log that looks wrong but may be right.
using AdmissionNote = std::variant<OfOtherMotor, recording::SuspicionOfLog, SensorLags>;

struct Admission {
  std::vector<AdmissionNote> notes;
  std::vector<std::string> lagging;  ///< temperatures that lag in any log: to be changed before recording more runs
};

/// Checks all logs and throws the problems of all of them, several as base::SeveralFailures:
/// - It throws RowsGivenTwice if the same rows are fitted twice, or both fitted and held out. Without a fit each log is predicted on its
///   own, so the same log may be given again.
/// - It throws NothingAboutHeat with all fitted logs that contain no information about heat.
/// - It throws Failure (bad_input) with all logs that lack heat input, ambient or motor temperature.
/// - It throws LogsLookWrong with the findings of every log if units, signs or sensors look wrong in themselves or for this motor. If
///   `takes_logs_as_they_are`, these findings are only notes.
/// `ambient_C` is the user's air temperature for logs without one.
Admission admit(const motor::Motor& motor, std::span<const recording::Recording> fitted, std::span<const recording::Recording> held_out,
                bool takes_logs_as_they_are, std::optional<double> ambient_C = {});

/// Checks logs as they were read. The thrown problems include those of logs that could not be read.
Admission admit(const motor::Motor& motor, const recording::NamedLogs& logs);

/// Returns true if the fit used rows of this recording. Compares fingerprints of the content; older fit files stored only the name.
bool was_fitted_to(const motor::MotorFit& fit, const recording::Recording& recording);

/// Throws Failure (bad_input) if the motor file was already fitted to rows of one of the logs: that run would count twice.
void refuse_runs_of_the_file(const motor::Motor& motor, std::span<const recording::Recording> fitted,
                             std::span<const recording::Recording> held_out);

}  // namespace heatsoak::calibration
