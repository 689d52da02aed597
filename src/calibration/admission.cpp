#include "calibration/admission.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "base/collected_failures.h"
#include "base/copper.h"
#include "base/diagnostic.h"
#include "base/quantity.h"
#include "base/unknown.h"
#include "calibration/motor_model.h"
#include "estimation/log_rows.h"
#include "estimation/measured_run.h"
#include "recording/clock_offset.h"
#include "recording/fingerprint.h"
#include "recording/quality.h"
#include "recording/quantities.h"
#include "recording/spread.h"

namespace heatsoak::calibration {
namespace {

/// Ratio to the value that the nominal voltage can produce. A larger current or speed is probably in another unit.
constexpr double kMost_ratio = 3.0;

/// Key of the problem that no temperature can be compared with the model.
constexpr const char* kNoSensor = "winding_C";

/// Throws RowsGivenTwice if two logs share rows. A run that counts twice makes the confidence intervals too narrow; a fitted run
/// cannot serve as hold-out run.
void refuse_repeated(std::span<const recording::Recording> fitted, std::span<const recording::Recording> held_out) {
  std::vector<std::pair<std::string, const recording::Recording*>> seen;
  std::vector<recording::RowsGivenTwice::Pair> repeated;
  for (const auto& recordings : {fitted, held_out}) {
    for (const recording::Recording& recording : recordings) {
      std::string fingerprint = recording::fingerprint_of(recording);
      const auto found = std::ranges::find_if(seen, [&](const auto& other) {
        return recording::share_rows(other.first, fingerprint) || recording::is_cut_from(recording, *other.second) ||
               recording::is_cut_from(*other.second, recording);
      });
      if (found != seen.end()) {
        repeated.push_back({recording::RowsGivenTwice::Rows(recording), recording::RowsGivenTwice::Rows(*found->second)});
      }
      seen.emplace_back(std::move(fingerprint), &recording);
    }
  }
  if (!repeated.empty()) {
    throw recording::RowsGivenTwice(std::move(repeated));
  }
}

struct Reached {
  double usual = 0.0;    ///< top_of_sizes()
  double largest = 0.0;  ///< largest magnitude of all rows
  int line = 0;          ///< line of that row in the file
};

Reached reached(const recording::Recording& recording, std::string_view key) {
  Reached found;
  const recording::Channel* const channel = recording.find(key);
  if (channel == nullptr) {
    return found;
  }
  found.usual = recording::top_of_sizes(channel->values);
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    if (std::abs(channel->values[row]) > found.largest) {
      found.largest = std::abs(channel->values[row]);
      found.line = recording.line[row];
    }
  }
  return found;
}

/// True for single outlying rows. The unit is right if the usual magnitude is possible and only the largest one is not.
bool only_single_rows_exceed(double most, const Reached& reached) { return reached.largest > most && !(reached.usual > most); }

/// Reports currents and speeds that this motor cannot reach at three times its nominal voltage.
void beyond_the_motor(const motor::Motor& motor, const recording::Recording& recording, std::vector<LogProblem>& wrong) {
  const motor::MotorValues& nominal = motor.nominal;
  const double most_A = kMost_ratio * nominal.nominal_voltage_V / nominal.terminal_resistance_ohm;
  const Reached current_A = reached(recording, recording::column_of(thermal::Signal::current));
  if (only_single_rows_exceed(most_A, current_A)) {
    wrong.emplace_back(CurrentOutliers{current_A.largest, most_A, current_A.line});
  }
  if (const double reached_A = current_A.usual; reached_A > most_A) {
    wrong.emplace_back(CurrentExceedsMotor{reached_A, most_A, nominal.terminal_resistance_ohm});
  }
  const double most_rad_per_s = kMost_ratio * nominal.nominal_voltage_V / nominal.torque_constant_Nm_per_A;
  const Reached speed_rad_per_s = reached(recording, recording::column_of(thermal::Signal::speed));
  if (only_single_rows_exceed(most_rad_per_s, speed_rad_per_s)) {
    wrong.emplace_back(SpeedOutliers{speed_rad_per_s.largest, most_rad_per_s, speed_rad_per_s.line});
  }
  if (const double reached_rad_per_s = speed_rad_per_s.usual; reached_rad_per_s > most_rad_per_s) {
    wrong.emplace_back(SpeedExceedsMotor{reached_rad_per_s, most_rad_per_s});
  }
}

/// Upper estimate of the heat of a row's interval in W: copper loss plus twice the no-load loss of the data sheet, or the input power if
/// that is larger. NaN if neither is known.
double generous_heat_W(const motor::MotorValues& nominal, const recording::Recording& recording, std::size_t row) {
  constexpr double kSpeedLoss_ratio = 2.0;
  const auto value = [&](std::string_view key) {
    const recording::Channel* const channel = recording.find(key);
    return channel != nullptr ? channel->values[row] : std::numeric_limits<double>::quiet_NaN();
  };
  const auto known_or = [](double known, double otherwise) { return std::isnan(known) ? otherwise : known; };
  const double power_W = std::abs(value(recording::column_of(thermal::Signal::input_power)));
  const double hot_ratio =
      base::resistance_ratio(nominal.temperature_coefficient_per_K, known_or(value("winding_C"), base::kSheetTemperature_C));
  const double speed_rad_per_s =
      known_or(std::abs(value(recording::column_of(thermal::Signal::speed))), nominal.no_load_speed_rad_per_s.value_or(base::kUnknown));
  const double copper_W =
      std::pow(value(recording::column_of(thermal::Signal::current)), 2) * nominal.terminal_resistance_ohm * std::max(1.0, hot_ratio);
  const double turning_W = nominal.torque_constant_Nm_per_A * nominal.no_load_current_A * speed_rad_per_s;
  const double of_current_W = copper_W + kSpeedLoss_ratio * known_or(turning_W, 0.0);
  return std::isnan(of_current_W) ? power_W : std::max(of_current_W, known_or(power_W, 0.0));
}

/// Returns the heat that the observed temperature rises need, divided by the heat supplied: the median over rises of 10 K or more with at
/// least a quarter of the largest mean heat. Empty if there is no such rise.
std::optional<double> heat_ratio_of_rises(const recording::Recording& recording, const recording::Channel& channel, double capacity_J_per_K,
                                          std::span<const double> heat_W) {
  constexpr double kRise_K = 10.0;
  constexpr double kMuchHeat_share = 0.25;
  struct Rise {
    double heat_ratio = 0.0;
    double mean_W = 0.0;
  };
  std::vector<Rise> rises;
  for (const auto& [begin, end] : recording.runs()) {
    double from_C = std::numeric_limits<double>::infinity();
    double from_s = 0.0;
    double heat_J = 0.0;
    for (std::size_t row = begin; row < end; ++row) {
      const double now_C = channel.values[row];
      if (row > begin) {
        heat_J += heat_W[row - 1] * (recording.time_s[row] - recording.time_s[row - 1]);
      }
      const bool is_risen = now_C - from_C >= kRise_K;
      if (is_risen && heat_J > 0.0) {
        rises.push_back({(now_C - from_C) * capacity_J_per_K / heat_J, heat_J / (recording.time_s[row] - from_s)});
      }
      if (is_risen || now_C < from_C || (std::isnan(heat_J) && !std::isnan(now_C))) {
        from_C = now_C;
        from_s = recording.time_s[row];
        heat_J = 0.0;
      }
    }
  }
  double most_W = 0.0;
  std::ranges::for_each(rises, [&most_W](const Rise& each) { most_W = std::max(most_W, each.mean_W); });
  std::vector<double> ratios;
  for (const Rise& each : rises) {
    if (each.mean_W >= kMuchHeat_share * most_W) {
      ratios.push_back(each.heat_ratio);
    }
  }
  return ratios.empty() ? std::nullopt : std::optional(recording::middle_of(ratios));
}

/// Reports temperatures that rise faster than possible even if all losses heated this one body and none of the heat flowed away.
void faster_than_the_motor(const motor::Motor& motor, const recording::Recording& recording, std::vector<LogProblem>& wrong) {
  constexpr double kTooFast_ratio =
      8.0;  // more than errors of the data sheet's heat capacities and another convention for the current explain
  constexpr double kHours_ratio = 300.0;
  const motor::MotorValues& nominal = motor.nominal;
  std::vector<double> heat_W;
  for (const auto& [key, capacity_J_per_K] :
       {std::pair("winding_C", nominal.thermal_time_constant_winding_s / nominal.thermal_resistance_winding_stator_K_per_W),
        std::pair("stator_C", nominal.thermal_time_constant_stator_s / nominal.thermal_resistance_stator_ambient_K_per_W)}) {
    const recording::Channel* const channel = recording.find(key);
    if (channel == nullptr || !(capacity_J_per_K > 0.0)) {
      continue;
    }
    for (std::size_t row = heat_W.size(); row < recording.rows(); ++row) {
      heat_W.push_back(generous_heat_W(nominal, recording, row));
    }
    const std::optional<double> ratio = heat_ratio_of_rises(recording, *channel, capacity_J_per_K, heat_W);
    if (ratio && *ratio > kTooFast_ratio) {
      wrong.emplace_back(RisesTooFast{key, *ratio, *ratio > kHours_ratio ? recording::TimeUnit::hours : recording::TimeUnit::minutes});
      return;
    }
  }
}

/// Adds a note for each temperature that lags, unless the motor file states the lag. It is not an error: real sensors lag, and a fit can
/// still use them.
void late_answers(const motor::Motor& motor, const recording::Recording& recording, const recording::DataQuality& quality,
                  Admission& admission) {
  for (const recording::ClockOffset& offset : quality.clock_offsets) {
    const std::optional<recording::RespondsLate> late = recording::late_answer(offset, quality.sampling.usual_period_s);
    const bool is_stated = std::ranges::any_of(motor::faults_of(motor, offset.temperature), [](const motor::SensorFault& fault) {
      return fault.type->law.after != nullptr && fault.size > 0.0;
    });
    if (!late || is_stated) {
      continue;
    }
    admission.notes.emplace_back(SensorLags{recording.name, *late});
    if (std::ranges::find(admission.lagging, offset.temperature) == admission.lagging.end()) {
      admission.lagging.push_back(offset.temperature);
    }
  }
}

/// Returns the problem with the first negative operating hours of a log. They are no outlier that may be left out: the clock is wrong.
std::optional<base::Diagnostic> negative_age(const recording::Recording& recording) {
  const std::string_view column = estimation::column_of(thermal::Signal::age);
  const recording::Channel* const channel = recording.find(column);
  for (std::size_t row = 0; channel != nullptr && row < recording.rows(); ++row) {
    if (channel->values[row] < 0.0) {
      const int line = row < recording.line.size() ? recording.line[row] : 0;
      return base::Diagnostic{{recording.file.string(), line},
                              std::string(column),
                              fmt::format("is {} h; expected operating hours of 0 or more", base::significant(channel->values[row], 3))};
    }
  }
  return std::nullopt;
}

bool has_it(const std::vector<recording::Suspicion>& some, const recording::Suspicion& wanted) {
  return std::ranges::any_of(some, [&wanted](const recording::Suspicion& each) { return recording::have_one_subject(wanted, each); });
}

template <class... Kinds>
bool has_any(const std::vector<recording::Lack>& lacks) {
  return std::ranges::any_of(lacks, [](const recording::Lack& each) { return (std::holds_alternative<Kinds>(each) || ...); });
}

/// Returns what a log that is only predicted lacks for a comparison: temperatures that change. A log without any is not among them.
std::vector<recording::Lack> lacks_of_comparison(const recording::Recording& recording, const std::vector<recording::Lack>& lacks,
                                                 const estimation::MeasuredRunOptions& how) {
  const std::vector<base::Diagnostic> columns = estimation::lacking_columns(recording, how);
  if (std::ranges::find(columns, kNoSensor, &base::Diagnostic::key) == columns.end() || !has_any<recording::TemperatureIsConstant>(lacks)) {
    return {};
  }
  std::vector<recording::Lack> found;
  std::ranges::copy_if(lacks, std::back_inserter(found), [](const recording::Lack& each) {
    return std::holds_alternative<recording::TemperatureIsConstant>(each) || std::holds_alternative<recording::TooFewRows>(each);
  });
  return found;
}

/// Checks the logs one by one and collects what is wrong with them.
class Admitting {
 public:
  Admitting(const motor::Motor& motor, bool takes_logs_as_they_are, std::optional<double> ambient_C)
      : motor_(motor), takes_logs_as_they_are_(takes_logs_as_they_are), ambient_C_(ambient_C) {}

  Admission admit(std::span<const recording::Recording> fitted, std::span<const recording::Recording> held_out) {
    base::CollectedFailures failures;
    if (!fitted.empty()) {
      failures.attempt([&] { refuse_repeated(fitted, held_out); });
    }
    for (const recording::Recording& recording : fitted) {
      const recording::DataQuality quality = recording::assess(recording, {}, ambient_C_);
      if (!quality.thermal.is_good()) {
        without_heat_.push_back({recording.file, quality.thermal.lacks});
      }
      look(recording, quality, quality.thermal.lacks);
    }
    for (const recording::Recording& recording : held_out) {
      const recording::DataQuality quality = recording::assess(recording, {}, ambient_C_);
      const std::vector<recording::Lack> lacks = lacks_of_comparison(recording, quality.thermal.lacks, how_to_read(motor_, HeatInput::current));
      if (!lacks.empty()) {
        without_heat_.push_back({recording.file, lacks});
      }
      look(recording, quality, lacks);
    }
    failures.attempt([&] { throw_findings(); });
    failures.throw_if_any();
    return std::move(admission_);
  }

 private:
  /// `known`: what the log lacks and is reported for already.
  void look(const recording::Recording& recording, const recording::DataQuality& quality, const std::vector<recording::Lack>& known) {
    if (!recording.motor.empty() && recording.motor != motor_.id && !(motor_.fit && recording.motor == motor_.fit->motor)) {
      admission_.notes.emplace_back(OfOtherMotor{recording.name, recording.motor, motor_.id});
    }
    const std::vector<recording::Suspicion>& blocking = recording.blocking_of_whole ? *recording.blocking_of_whole : quality.blocking;
    for (const recording::Suspicion& each : quality.suspicions) {
      const bool is_of_part = has_it(quality.blocking, each) && !has_it(blocking, each);
      if (!is_of_part) {
        admission_.notes.emplace_back(recording::SuspicionOfLog{recording.name, each});
      }
    }
    late_answers(motor_, recording, quality, admission_);
    std::vector<LogProblem> problems(blocking.begin(), blocking.end());
    if (problems.empty()) {
      beyond_the_motor(motor_, recording, problems);
      faster_than_the_motor(motor_, recording, problems);
    }
    for (LogProblem& each : problems) {
      wrong_.push_back({recording.file.string(), std::move(each)});
    }
    look_for_columns(recording, known);
  }

  /// Columns without which no answer is possible, whatever the other logs have.
  void look_for_columns(const recording::Recording& recording, const std::vector<recording::Lack>& known) {
    estimation::MeasuredRunOptions how = how_to_read(motor_, HeatInput::current);
    how.ambient_C = ambient_C_;
    const bool lacks_temperature = has_any<recording::NoTemperature, recording::TemperatureIsConstant>(known);
    for (base::Diagnostic& each : estimation::lacking_columns(recording, how)) {
      if (!lacks_temperature || each.key != kNoSensor) {
        lacking_.push_back(std::move(each));
      }
    }
    if (std::optional<base::Diagnostic> negative = negative_age(recording)) {
      lacking_.push_back(*std::move(negative));
    }
    if (!has_any<recording::NoHeatInput>(known)) {
      without_source_.attempt([&] { return heat_input_of(motor_, {&recording, 1}); });
    }
  }

  void throw_findings() {
    base::CollectedFailures failures;
    failures.attempt([this] {
      if (!without_heat_.empty()) {
        throw recording::NothingAboutHeat(std::move(without_heat_));
      }
    });
    failures.attempt([this] { without_source_.throw_if_any(); });
    failures.attempt([this] {
      if (!lacking_.empty()) {
        throw base::Failure(base::ExitCode::bad_input, "", std::move(lacking_));
      }
    });
    failures.attempt([this] {
      if (!wrong_.empty() && !takes_logs_as_they_are_) {
        throw LogsLookWrong(std::move(wrong_));
      }
    });
    failures.throw_if_any();
  }

  const motor::Motor& motor_;
  bool takes_logs_as_they_are_;
  std::optional<double> ambient_C_;
  Admission admission_;
  std::vector<recording::NothingAboutHeat::Log> without_heat_;
  base::CollectedFailures without_source_;
  std::vector<base::Diagnostic> lacking_;
  std::vector<LogsLookWrong::Finding> wrong_;
};

}  // namespace

LogsLookWrong::LogsLookWrong(std::vector<Finding> findings)
    : base::Failure(base::ExitCode::bad_input,
                    "units or sensors of the logs look wrong; correct them in a mapping (--map), or use --as-is if they are right"),
      findings_(std::move(findings)) {}

Admission admit(const motor::Motor& motor, std::span<const recording::Recording> fitted, std::span<const recording::Recording> held_out,
                bool takes_logs_as_they_are, std::optional<double> ambient_C) {
  return Admitting(motor, takes_logs_as_they_are, ambient_C).admit(fitted, held_out);
}

Admission admit(const motor::Motor& motor, const recording::NamedLogs& logs) {
  base::CollectedFailures failures = logs.unread;
  std::optional<Admission> admission =
      failures.attempt([&] { return admit(motor, logs.fitted, logs.held_out, logs.choice.takes_logs_as_they_are, logs.choice.ambient_C); });
  failures.throw_if_any();
  return *std::move(admission);
}

RunsOfTheFile::RunsOfTheFile(std::string motor_id, std::vector<std::filesystem::path> files)
    : base::Failure(base::ExitCode::bad_input,
                    "a run would count twice; start from the file as it was before that fit, or use --as-is if it is another run"),
      motor_id_(std::move(motor_id)),
      files_(std::move(files)) {}

bool was_fitted_to(const motor::MotorFit& fit, const recording::Recording& recording) {
  return std::ranges::any_of(fit.runs, [&recording](const std::string& run) { return recording::is_of_run(recording, run); });
}

void refuse_runs_of_the_file(const motor::Motor& motor, std::span<const recording::Recording> fitted,
                             std::span<const recording::Recording> held_out) {
  std::vector<std::filesystem::path> known;
  for (const auto& recordings : {fitted, held_out}) {
    for (const recording::Recording& recording : recordings) {
      if (motor.fit && was_fitted_to(*motor.fit, recording)) {
        known.push_back(recording.file);
      }
    }
  }
  if (!known.empty()) {
    throw RunsOfTheFile(motor.id, std::move(known));
  }
}

}  // namespace heatsoak::calibration
