#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/counted.h"
#include "base/quantity.h"
#include "calibration/admission.h"
#include "calibration/calibrate.h"
#include "diagnosis/findings.h"
#include "estimation/findings.h"
#include "friction/friction_job.h"
#include "friction/robot_file.h"
#include "present/failure_words.h"
#include "present/measured/calibration_words.h"
#include "present/measured/friction_words.h"
#include "present/measured/log_words.h"
#include "present/measured/run_words.h"
#include "recording/quality.h"

namespace heatsoak::present::failure_words {
namespace {

base::Failure with_message(const base::Failure& failure, std::string message) {
  return {failure.code(), std::move(message), {failure.diagnostics().begin(), failure.diagnostics().end()}};
}

/// Line of the log that the problem names.
std::optional<int> line_of(const calibration::LogProblem& problem) {
  const auto* const current = std::get_if<calibration::CurrentOutliers>(&problem);
  const auto* const speed = std::get_if<calibration::SpeedOutliers>(&problem);
  if (current != nullptr) {
    return current->line;
  }
  return speed != nullptr ? std::optional(speed->line) : std::nullopt;
}

base::Failure worded(const recording::NothingAboutHeat& failure) {
  std::vector<base::Diagnostic> diagnostics;
  for (const auto& [file, lacks] : failure.logs()) {
    diagnostics.push_back({{file.string()}, {}, fmt::format("{}: {}", failure.message(), fmt::join(words_of(lacks), "; "))});
  }
  return {failure.code(), "", std::move(diagnostics)};
}

std::string line_words(const std::optional<recording::RowsGivenTwice::Lines>& lines) {
  return lines ? fmt::format("lines {} to {}", lines->first, lines->last) : "its rows";
}

base::Failure worded(const recording::RowsGivenTwice& failure) {
  std::vector<base::Diagnostic> diagnostics;
  for (const auto& [rows, earlier] : failure.pairs()) {
    diagnostics.push_back({{rows.file.string(), rows.lines ? rows.lines->first : 0, 1},
                           {},
                           fmt::format("{} share rows with {} of {}; give each row once, to fit or as hold-out", line_words(rows.lines),
                                       line_words(earlier.lines), earlier.file.string())});
  }
  return {failure.code(), failure.message(), std::move(diagnostics)};
}

base::Failure worded(const calibration::RunsOfTheFile& failure) {
  std::vector<base::Diagnostic> diagnostics;
  for (const std::filesystem::path& file : failure.files()) {
    diagnostics.push_back(
        {{file.string()}, {}, fmt::format("the motor file of {} was fitted to these rows (fit.runs)", failure.motor_id())});
  }
  return {failure.code(), failure.message(), std::move(diagnostics)};
}

base::Failure worded(const estimation::RunNotSimulated& failure) {
  return with_message(failure, failure.message() +
                                   "; check the units of the log's columns (milliamperes, a sensor's gain) and the resistances of the "
                                   "model; `heatsoak log inspect` shows the log, `heatsoak lint` checks the motor");
}

base::Failure worded(const friction::WheelNotIdentifiable& failure) {
  return with_message(failure, fmt::format("{}: {}", failure.message(),
                                           failure.problem() ? words_of(*failure.problem()) : "its logs only turn on the spot"));
}

base::Failure worded(const friction::DampingNegative& failure) {
  return with_message(failure, fmt::format("{} ({:.3g} mN m s/rad): the motors drove the wheels. Expected a robot that rolls out with open "
                                           "motors, or a log with the PWM, which shows when the motors are off",
                                           failure.message(), 1e3 * failure.damping_Nm_s_per_rad()));
}

/// The problem of wheel 1 serves as the example.
base::Failure worded(const friction::NothingIdentifiable& failure) {
  const friction::NothingIdentifiable::Reason& reason = failure.reason();
  std::string message =
      reason.legs == 0
          ? fmt::format("{}: in no interval do the wheels turn steadily; legs of one speed and direction must last a second or more",
                        failure.message())
          : fmt::format("{} from {} on {}: of wheel 1, {}", failure.message(), base::counted(reason.legs, "steady leg"),
                        base::counted(reason.headings, "heading"), reason.of_first_wheel ? words_of(*reason.of_first_wheel) : "");
  for (const std::string& each : words_of(reason.suspicions)) {
    message += fmt::format("\nsuspicious: {}", each);
  }
  return with_message(failure, std::move(message));
}

base::Failure worded(const friction::LogsLookWrong& failure) {
  std::vector<base::Diagnostic> diagnostics;
  for (const auto& [file, suspicion] : failure.findings()) {
    diagnostics.push_back({{file}, {}, words_of(suspicion)});
  }
  return {failure.code(), failure.message(), std::move(diagnostics)};
}

base::Failure worded(const calibration::LogsLookWrong& failure) {
  std::vector<base::Diagnostic> diagnostics;
  for (const auto& [file, problem] : failure.findings()) {
    const std::optional<int> line = line_of(problem);
    diagnostics.push_back({{file, line, line ? std::optional(1) : std::nullopt}, {}, words_of(problem)});
  }
  return {failure.code(), failure.message(), std::move(diagnostics)};
}

base::Failure worded(const calibration::NothingLearned& failure) {
  std::string message = failure.message();
  for (const calibration::OpenDirection& each : failure.open()) {
    message += fmt::format("\n  not identifiable: {}: {}\n  cheapest experiment: {}", parameter_words(each), reason_words(each),
                           words_of(each.remedy));
  }
  if (failure.has_heat_input()) {
    message += "\n  also check the units of the heat inputs (kiloamperes, kilowatts); `heatsoak log inspect` shows each channel";
  }
  return with_message(failure, std::move(message));
}

base::Failure worded(const calibration::NothingFollows& failure) {
  std::string message = failure.message();
  for (const calibration::PoorFit& each : failure.signals()) {
    message += fmt::format("\n  {} has an error of {} K rms, {} its variation (standard deviation {} K)", each.signal,
                           base::significant(each.rmse_K, 2), each.rmse_K > each.varies_K ? "more than" : "close to",
                           base::significant(each.varies_K, 2));
  }
  if (!failure.has_speed()) {
    message += "\n  a log lacks the speed (speed_rad_per_s), so the loss at speed is unknown";
  }
  return with_message(failure, message +
                                   "\n  check for another motor, a wrong unit (degrees Fahrenheit, minutes, milliamperes), a misplaced "
                                   "sensor, or heat that no column contains; `heatsoak log inspect` shows each channel");
}

base::Failure worded(const estimation::NoUsableInterval& failure) {
  return with_message(failure, fmt::format("{}: {}; see `heatsoak log inspect {}`", failure.message(), words_of(failure.reasons()),
                                           failure.file().string()));
}

base::Failure worded(const diagnosis::NothingHeatsModel& failure) {
  return with_message(failure,
                      failure.message() + "; expected current_A, or power_in_W with an effect input_power_loss; add one to the logs");
}

/// Returns the words of the first type that the failure has.
template <class First, class... Others>
std::optional<base::Failure> worded_as(const base::Failure& failure) {
  if (const auto* const found = dynamic_cast<const First*>(&failure)) {
    return worded(*found);
  }
  if constexpr (sizeof...(Others) > 0) {
    return worded_as<Others...>(failure);
  } else {
    return std::nullopt;
  }
}

}  // namespace

FailureWords measured_logs() {
  return {&worded_as<recording::NothingAboutHeat, recording::RowsGivenTwice, calibration::RunsOfTheFile, estimation::RunNotSimulated,
                     calibration::NothingLearned, calibration::NothingFollows, calibration::LogsLookWrong, friction::LogsLookWrong,
                     friction::DampingNegative, friction::NothingIdentifiable, friction::WheelNotIdentifiable, estimation::NoUsableInterval,
                     diagnosis::NothingHeatsModel>};
}

}  // namespace heatsoak::present::failure_words
