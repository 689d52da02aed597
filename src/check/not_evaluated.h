// Reasons for which a threshold has no value, as data. src/present makes the words.
#pragma once

#include <cstddef>
#include <exception>
#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/diagnostic.h"
#include "check/limit.h"
#include "derate/committed_table.h"
#include "derate/header_text.h"
#include "select/evaluate.h"
#include "simulate/drive_score.h"

namespace heatsoak::check {

/// A file is missing or wrong, or a computation of another layer failed.
struct Failed {
  base::Failure failure;
  std::exception_ptr own = {};  ///< the failure with its own type, whose findings need words; null if it has none
};
struct ResultNotFinite {};
struct OutOfMemory {};

/// The motor cannot deliver the demand, so its temperatures are meaningless.
struct DemandNotDelivered {
  std::string motor_id;
  select::LimitingFactor limit = select::LimitingFactor::none;
  double least_torque_share = 0.0;
  double short_time_share = 0.0;
};
/// Too few samples for a confidence bound of the 95th percentile.
struct TooFewSamples {
  int samples = 0;
};
/// No factor on the load brings the motor to a limit.
struct LimitNeverReached {};

struct DutyIsNoMatch {
  std::string duty_id;
  std::string shape;
};
struct RotorInertiaMissing {
  std::filesystem::path motor_file;
};
struct MatchNotDriven {
  simulate::DriveProblem problem{};
};

struct TableOfOtherMotor {
  std::filesystem::path table;
  std::string its_motor_id;
  std::string motor_id;
};
struct SensorOptionsDiffer {
  std::filesystem::path table;
  derate::SensorDifference difference;
};
/// The observer in the committed header differs from a fresh one, so its table has another meaning.
struct ObserverDiffers {
  std::filesystem::path table;
  derate::HeaderDifference first;
  std::size_t count = 0;
  std::string other_version = {};  ///< derate::TableComparison::other_version
};

/// The check names neither files nor a motor, robot or duty.
struct NothingToLint {};

struct NoLogs {};
struct NoMeasuredTemperature {};

/// The answer of a command has nothing of that name.
struct NumberMissing {
  std::string missing;               ///< part of the name that is not there
  std::string group;                 ///< name of the group that was reached; empty: the answer itself
  std::vector<std::string> members;  ///< names that the group has
};
struct NumberIsGroup {
  std::string name;
  std::vector<std::string> members;  ///< empty if the group is
};
struct NumberIsNull {
  std::string name;
};
struct NumberIsOther {
  std::string name;
  std::string value;  ///< as in the JSON answer
};
/// The name is that of a threshold, which a check with a command cannot have.
struct NumberIsThreshold {
  std::string name;
};
struct UnitsDiffer {
  std::string name;
  std::string other_name;
};
/// The limit is a percentage.
struct NumberIsCount {
  std::string name;
  double value = 0.0;
};
/// The 95 % interval is unbounded on the side of the limit.
struct IntervalUnbounded {
  std::string name;
};
/// The limit's text is invalid in the unit of its number, which is known only now.
struct LimitInvalid {
  LimitProblem problem;
};

using Reason = std::variant<Failed, ResultNotFinite, OutOfMemory, DemandNotDelivered, TooFewSamples, LimitNeverReached, DutyIsNoMatch,
                            RotorInertiaMissing, MatchNotDriven, TableOfOtherMotor, SensorOptionsDiffer, ObserverDiffers, NothingToLint,
                            NoLogs, NoMeasuredTemperature, NumberMissing, NumberIsGroup, NumberIsNull, NumberIsOther, NumberIsThreshold,
                            UnitsDiffer, NumberIsCount, IntervalUnbounded, LimitInvalid>;

/// Thrown where a threshold has no value.
class NotEvaluated : public std::exception {
 public:
  explicit NotEvaluated(Reason reason) : reason_(std::move(reason)) {}
  [[nodiscard]] const Reason& reason() const { return reason_; }
  [[nodiscard]] const char* what() const noexcept override { return "a threshold cannot be evaluated"; }

 private:
  Reason reason_;
};

}  // namespace heatsoak::check
