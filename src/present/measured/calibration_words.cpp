#include "present/measured/calibration_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/confidence.h"
#include "base/quantity.h"
#include "estimation/interval.h"
#include "estimation/log_rows.h"
#include "present/measured/log_words.h"
#include "present/measured/run_words.h"
#include "present/measured/severity_of_kind.h"
#include "recording/quantities.h"

namespace heatsoak::present {
namespace {

std::string say(const calibration::LossAtSpeedUnknown& of) {
  return fmt::format(
      "the loss at speed is treated as unknown, 0 to {} W (the loss at no-load speed), in logs that have a current but no speed; if the "
      "motor stood still, add speed_rad_per_s = 0",
      base::significant(of.most_W, 2));
}

std::string say(const calibration::RowsTurn& /*of*/) {
  return "the speed is interpolated linearly within rows: it changes its sign from row to row, and this explains the runs better than a "
         "constant speed per row";
}

std::string say(const calibration::UnmodelledHeat& of) {
  return fmt::format(
      "the network of the motor file lacks {}: unmodelled heat {} {} % of the {} W that flow through the motor on average; `heatsoak "
      "diagnose` searches for the effect",
      of.exceeds_share ? "a large effect" : "an effect", of.exceeds_share ? "exceeds" : "is", base::significant(100.0 * of.share, 2),
      base::significant(of.usual_heat_W, 2));
}

std::string say(const calibration::SensorDrift& of) {
  return fmt::format(
      "the sensors seem to drift by {} K (standard deviation) over about {} s: either sensor errors or an error of the two-node model",
      base::significant(of.drift_K, 2), base::significant(of.time_scale_s, 1));
}

std::string say(const calibration::WindingNotMeasured& /*of*/) {
  return "the values of the winding may be wrong by more than their intervals, because only the stator is measured: heat that follows the "
         "current but enters the stator directly (iron loss, driver, connections) looks like a faster winding";
}

std::string say(const calibration::ResponseNeedsOtherValues& /*of*/) {
  return "the values are those that follow the whole runs best; the response within seconds of a load change needs other values, because "
         "the motor has more than two thermal nodes or an effect is missing in all of these runs";
}

std::string say(const calibration::FitStoppedEarly& /*of*/) {
  return "the values are accurate to a few tenths of their intervals only, because the fit was stopped before it had fully converged";
}

std::string say(const calibration::HeatSeemsWrong& of) {
  return fmt::format(
      "all heat capacities are {1} and all resistances {2} than the file's by a factor of {0} or more: the heat of the logs seems too {3} "
      "for this motor; is a current a peak value or an amplitude ({4}), is the resistance wrong, or is it another motor?",
      base::significant(of.factor, 2), of.is_too_large ? "larger" : "smaller", of.is_too_large ? "smaller" : "larger",
      of.is_too_large ? "large" : "small", of.is_too_large ? "its heat counts double" : "or that of one phase of several");
}

std::string say(const calibration::ResistanceDiffers& of) {
  return fmt::format(
      "motor_V, current_A and speed of these logs give a terminal resistance of {} ohm at 25 °C, but the file states {} ohm, and every "
      "value scales with it; check whether it is this motor, and if so state the measured resistance in its file",
      base::significant(of.found_ohm, 3), base::significant(of.stated_ohm, 3));
}

std::string say(const calibration::LargeChange& of) {
  return fmt::format(
      "{} becomes {} times the value of the file, a change of {} prior standard deviations: check the units of the logs, and whether "
      "motor, "
      "mounting and cooling are those of the file",
      of.parameter, base::significant(of.factor, 2), base::significant(of.change_sd, 2));
}

std::string say(const calibration::OutsideDeclaredRange& of) {
  const std::string unit = of.unit.empty() ? "" : fmt::format(" {}", base::unit_for_display(of.unit));
  return fmt::format(
      "{} becomes {}{}, outside of its declared range of {} to {}{}: check the units of the logs, and whether the range holds for this "
      "motor, its mounting and its cooling; state a wider range if the value is a guess",
      of.parameter, base::significant(of.value, 3), unit, base::significant(of.low, 3), base::significant(of.high, 3), unit);
}

std::string say(const calibration::PoorFit& of) {
  return fmt::format(
      "do not rely on the fitted parameters: the model has an error of {} K rms in {}, which varies by {} K (standard deviation); is it "
      "another motor, or is a unit wrong (degrees Fahrenheit, minutes, milliamperes)?",
      base::significant(of.rmse_K, 2), of.signal, base::significant(of.varies_K, 2));
}

std::string say(const calibration::UnidentifiableAreWritten& /*of*/) {
  return "values that are not identifiable are written too: the forecast depends on all values together, so do not use these as "
         "measurements";
}

/// Returns how the sensor seems to have been moved: the shares of at least 2 % and an offset of at least 0.2 K.
std::string move_words(const estimation::MovedSensor& moved) {
  constexpr double kLeast_share = 0.02;
  constexpr double kLeast_K = 0.2;
  std::vector<std::string> parts;
  for (const auto& [share, place] : {std::pair(moved.to_other_share, "the other sensor"), std::pair(moved.to_ambient_share, "the air")}) {
    if (std::abs(share) >= kLeast_share) {
      parts.push_back(fmt::format("{} % of the way {} the temperature of {}", base::significant(100.0 * std::abs(share), 2),
                                  share > 0.0 ? "to" : "away from", place));
    }
  }
  if (std::abs(moved.offset_K) >= kLeast_K) {
    parts.push_back(fmt::format("{} K too {}", base::significant(std::abs(moved.offset_K), 2), moved.offset_K > 0.0 ? "much" : "little"));
  }
  return fmt::format("its {} sensor reads {}, which leaves {} K", part_of(moved.signal),
                     parts.empty() ? "almost as before" : fmt::format("{}", fmt::join(parts, " and ")), base::significant(moved.rmse_K, 2));
}

std::string say(const calibration::ContradictingRun& run) {
  return fmt::format(
      "{0}{1}: with parameters that follow the others to {2} K RMS, its {3} is wrong by {4} K, although {5}. Check whether a sensor was "
      "moved "
      "or the mounting was changed before {0}{6}",
      run.run,
      run.is_left_out ? " is left out, because it contradicts the other runs"
                      : " contradicts the other runs, so the written values may hold for none of them",
      base::significant(run.usual_K, 2), part_of(run.signal), base::significant(run.by_others_K, 2),
      run.moved ? fmt::format("it fits if {}", move_words(*run.moved))
                : fmt::format("{} alone can be followed to {} K", run.run, base::significant(run.alone_K, 2)),
      run.is_left_out ? "" : "; leave it out, or state what differs as a condition in a mapping (--map), for `heatsoak diagnose`");
}

std::string say(const calibration::HoldoutDiverges& of) {
  return fmt::format(
      "{} has no score: with its inputs, the temperatures of the model leave -273 to 1000 °C; check the units of its columns (`heatsoak "
      "log "
      "inspect`)",
      of.recording);
}

std::string say(const calibration::TooFewPieces& of) {
  const std::string parts = of.are_whole_runs
                                ? fmt::format("run{}", of.pieces == 1 ? "" : "s")
                                : fmt::format("part{} of {}", of.pieces == 1 ? "" : "s", of.runs == 1 ? "the one run" : "the runs");
  return fmt::format(
      "the network is not extended and the {} band of forecasts is wide, because cross-validation can leave out only {} {} that "
      "contain{} "
      "heat, and needs at least {}",
      base::level_text(base::kBand_share), of.pieces, parts, of.pieces == 1 ? "s" : "", of.needed);
}

std::string say(const calibration::ForecastFitIsWritten& /*of*/) {
  return "the parameters of the forecast fit are written: they follow whole runs best, not the response within seconds";
}

std::string say(const calibration::FilePredictsBest& of) {
  return of.is_written ? "no fit predicts left-out pieces better than the file: its values are written as they are"
         : of.is_better_than_fit
             ? "for forecasts the values of the file are better than the written ones: they predict left-out pieces better"
             : "no fit predicts left-out pieces better than the file, but the written values predict them equally well";
}

std::string say(const calibration::FreeRunsPredictBest& of) {
  return fmt::format("least squares of free runs has the smallest expected error in other runs: {}",
                     of.is_written ? "its parameters are written" : "`--forecast` writes its parameters");
}

std::string say(const calibration::ExtendedForForecasts& of) {
  return fmt::format("{} {}; this is no diagnosis: another effect may be the cause (`heatsoak diagnose`)",
                     of.is_written ? "for better forecasts the network now has"
                                   : "left-out pieces are predicted best by a network that `--forecast` writes, with",
                     fmt::join(of.effects, ", "));
}

std::string say(const calibration::ResistanceHeld& /*of*/) {
  return "terminal_resistance is held at its stated value: all heat capacities and resistances scale with it";
}

std::string say(const calibration::NoLoadCurrentUnused& /*of*/) {
  return "no_load_current is not used: the loss other than copper loss is the measured power balance";
}

std::string say(const calibration::NoLoadCurrentHeld& /*of*/) {
  return "no_load_current is held: its loss depends on speed, which not every log has";
}

std::string say(const calibration::HeatShareHeld& of) {
  return fmt::format(
      "the share of the stated power that becomes heat is held at 1: all heat capacities and resistances scale with it; {} to arise at the "
      "winding, and iron loss, friction or a driver's heat at the stator {}would shift thermal_resistance_winding_stator and "
      "winding_heat_capacity",
      of.has_loss_at_stator ? "the part due to no_load_current is assumed to arise at the stator and the rest" : "all of it is assumed",
      of.has_loss_at_stator ? "beyond that " : "");
}

std::string say(const calibration::EffectHeld& of) {
  return fmt::format("effects.{}: {} {} held: the file states no tolerance or range", of.effect, fmt::join(of.parameters, ", "),
                     of.parameters.size() == 1 ? "is" : "are");
}

/// Returns what a law assumes about a signal that no log has, by its row of the table of quantities.
std::string assumption_in_words(thermal::Signal signal) {
  const thermal::OperatingQuantity<double>& row = thermal::quantity_of(signal);
  return row.is_optional ? fmt::format("the {} is treated as unknown", row.lacking)
                         : fmt::format("the value {} is used", thermal::OperatingPoint<double>{}.*row.value);
}

std::string say(const calibration::SignalsMissing& of) {
  std::vector<std::string_view> columns;
  std::vector<std::string> assumptions;
  for (const thermal::Signal signal : of.signals) {
    columns.push_back(estimation::column_of(signal));
    if (std::string assumption = assumption_in_words(signal); std::ranges::find(assumptions, assumption) == assumptions.end()) {
      assumptions.push_back(std::move(assumption));
    }
  }
  const std::string who = of.recording.empty() ? of.is_unread ? "no log is read with" : "no log has"
                                               : of.recording + (of.is_unread ? " is read without" : " does not have");
  return fmt::format("{} {}, on which {} depends; {}", who, fmt::join(columns, " and "), of.effect,
                     of.is_unused ? "the effect is not used" : fmt::format("{}", fmt::join(assumptions, " and ")));
}

std::string say(const calibration::SensorHeld& of) {
  return fmt::format("effects.{}.{} is held at {}{}{}: an error of the sensor is not a property of the motor", of.sensor, of.parameter,
                     base::significant(of.value, 3), of.unit.empty() ? "" : " ", of.unit);
}

std::string say(const calibration::ConditionNotApplied& of) {
  return fmt::format(
      "{} acts in every run here, although its condition is {}: an effect of the type {} has no size that could be set to 0; leave out the "
      "runs without that condition",
      of.effect, estimation::in_words(of.condition), of.type);
}

std::string say(const calibration::ConditionNeverMet& of) {
  return fmt::format("{} acts in none of these runs: no log has its condition {}", of.effect, estimation::in_words(of.condition));
}

std::string say(const calibration::SensorUnused& of) {
  return fmt::format("no log has the {} to which effects.{} applies: the effect is not used", of.signal, of.sensor);
}

std::string say(const calibration::HeldValue& of) {
  return std::visit([](const auto& each) { return say(each); }, of);
}

std::string say(const calibration::BandIncludesLossAtSpeed& of) {
  return fmt::format(
      "the band of {} is wider, because its log has a current but no speed: the loss at speed may be anything up to {} W; if the motor "
      "stood still, add speed_rad_per_s = 0",
      of.recording, base::significant(of.most_W, 2));
}

std::string say(const calibration::BandIsEstimated& of) {
  return fmt::format(
      "the band of {} is only an estimate from its declared uncertainties and the usual error of forecasts; `heatsoak calibrate`, or "
      "`heatsoak diagnose` with two logs or more, determines a band",
      of.motor);
}

std::string_view columns_of(motor::HeatInput heat) {
  switch (heat) {
    case motor::HeatInput::current:
      return recording::column_of(thermal::Signal::current);
    case motor::HeatInput::torque:
      return recording::column_of(thermal::Signal::shaft_power);
    case motor::HeatInput::input_power:
      return recording::column_of(thermal::Signal::input_power);
    case motor::HeatInput::power_balance:
      break;
  }
  return "the power balance (current_A, power_in_W, torque_Nm and speed_rad_per_s)";
}

std::string say(const calibration::ShaftPowerUnknown& of) {
  return fmt::format(
      "{} {} no torque or no speed, so all of the input power counts as heat: valid only while the shaft gives no power. Log torque_Nm and "
      "speed_rad_per_s, or current_A",
      fmt::join(of.recordings, ", "), of.recordings.size() == 1 ? "has" : "have");
}

std::string say(const calibration::HeatInputLacking& of) {
  return fmt::format(
      "temperatures may be wrong by several kelvin: the model was fitted with heat from {}, which {} {} not have, so that the heat comes "
      "from {}",
      columns_of(of.of_model), fmt::join(of.recordings, ", "), of.recordings.size() == 1 ? "does" : "do", columns_of(of.used));
}

std::string say(const estimation::RunNote& of) { return words_of(of); }

std::string say(const recording::Suspicion& of) { return words_of(of); }

std::string outliers_in_words(std::string_view channel, double largest, int line, double most, std::string_view unit,
                              std::string_view suspected) {
  return fmt::format(
      "{} reaches {} {} in line {}; at three times the nominal voltage this motor reaches {} {}, and less than 2 % of the rows exceed "
      "that: "
      "exclude outliers with valid = \"…\" in a mapping, or is it in {}?",
      channel, base::significant(largest, 3), unit, line, base::significant(most, 3), unit, suspected);
}

std::string say(const calibration::CurrentOutliers& of) {
  return outliers_in_words(recording::column_of(thermal::Signal::current), of.largest_A, of.line, of.most_A, "A", "milliamperes");
}

std::string say(const calibration::SpeedOutliers& of) {
  return outliers_in_words(recording::column_of(thermal::Signal::speed), of.largest_rad_per_s, of.line, of.most_rad_per_s, "rad/s", "rpm");
}

std::string say(const calibration::CurrentExceedsMotor& of) {
  return fmt::format(
      "current_A reaches {} A; through {} ohm at most {} A flow at three times the nominal voltage: is it in milliamperes, or is it "
      "another "
      "motor?",
      base::significant(of.top_A, 3), base::significant(of.terminal_resistance_ohm, 3), base::significant(of.most_A, 3));
}

std::string say(const calibration::SpeedExceedsMotor& of) {
  return fmt::format(
      "speed_rad_per_s reaches {} rad/s; at three times the nominal voltage this motor turns at {} rad/s: is it in rpm ({} rad/s), or is "
      "it "
      "another motor?",
      base::significant(of.top_rad_per_s, 3), base::significant(of.most_rad_per_s, 3),
      base::significant(base::convert(of.top_rad_per_s, "rpm", "rad/s"), 3));
}

std::string say(const calibration::RisesTooFast& of) {
  return fmt::format(
      "{} rises about {} times as fast as the losses of this motor can heat it: is the time in {}, is a heat input in another unit, or is "
      "it another motor?",
      of.channel, base::significant(of.ratio, 1), words_of(of.suspected));
}

std::string say(const calibration::OfOtherMotor& of) {
  return fmt::format("{} states that it is of the motor {}, not of {}", of.recording, of.stated, of.motor);
}

std::string say(const recording::SuspicionOfLog& of) { return words_of(of); }

std::string say(const calibration::SensorLags& of) { return fmt::format("{}: {}", of.log, words_of(of.response)); }

}  // namespace

std::string words_of(const calibration::CalibrationFinding& finding) {
  return std::visit([](const auto& each) { return say(each); }, finding);
}

std::string words_of(const calibration::LogProblem& problem) {
  return std::visit([](const auto& each) { return say(each); }, problem);
}

std::vector<std::string> words_of(const std::vector<calibration::AdmissionNote>& notes) {
  std::vector<std::string> words;
  for (const calibration::AdmissionNote& note : notes) {
    words.push_back(std::visit([](const auto& each) { return say(each); }, note));
  }
  return words;
}

std::vector<std::string> words_of(const std::vector<calibration::PredictionNote>& notes) {
  std::vector<std::string> words;
  for (const calibration::PredictionNote& note : notes) {
    words.push_back(std::visit([](const auto& each) { return say(each); }, note));
  }
  return words;
}

Severity severity_of(const calibration::PredictionNote& note) {
  return std::visit([](const auto& each) { return severity_of(calibration::CalibrationFinding(each)); }, note);
}

std::string parameter_words(const calibration::OpenDirection& open) {
  std::vector<std::string> moves;
  std::ranges::transform(open.together, std::back_inserter(moves), [](const calibration::MovedParameter& each) {
    return fmt::format("{} {}", each.name, each.is_raised ? "raised" : "lowered");
  });
  std::vector<std::string> all = open.parameters;
  if (!moves.empty()) {
    all.insert(all.begin(), fmt::format("{} together", fmt::join(moves, ", ")));
  }
  return fmt::format("{}", fmt::join(all, ", "));
}

std::string reason_words(const calibration::OpenDirection& open) {
  switch (open.reason) {
    case calibration::OpenReason::no_heat:
      return "these runs have no heat input: a cool-down determines time constants, but no heat capacity or resistance";
    case calibration::OpenReason::common_factor:
      return "a common factor on all heat, all heat capacities and all conductances changes no temperature: the scale depends on the "
             "stated "
             "terminal resistance";
    case calibration::OpenReason::only_stator_measured:
      return "only the stator is measured: a larger winding behind a smaller resistance to the stator gives the same stator temperature";
    case calibration::OpenReason::only_winding_measured:
      return "only the winding is measured and the runs are short against the stator's time constant, or never cool down";
    case calibration::OpenReason::motor_hardly_turns:
      return "the motor hardly turns in these runs";
    case calibration::OpenReason::small_loss_at_speed:
      return "the loss at speed is small against the copper loss";
    case calibration::OpenReason::not_excited:
      return "the measured temperatures of these runs hardly depend on it";
    case calibration::OpenReason::speed_not_logged:
      return "the runs do not contain the speed: the loss may be anything from none to that at no-load speed, and the stator's values "
             "depend on it";
    case calibration::OpenReason::stator_not_settled:
      return fmt::format(
          "the runs neither reach a steady state nor cool down far enough: the longest lasts {} min, the stator's time constant is about "
          "{} min",
          base::significant(open.longest_run_s / 60.0, 2), base::significant(open.stator_s / 60.0, 1));
    case calibration::OpenReason::stator_beside_unknown_heat:
      return fmt::format("beside the unmodelled heat of these runs, the uncertainty stays a factor of {}",
                         base::significant(std::exp(estimation::kInterval_sd * open.left_sd), 2));
    case calibration::OpenReason::winding_not_stepped:
      break;
  }
  return "the winding's temperature hardly differs from the stator's in these runs, or never changes in steps";
}

std::string_view words_of(calibration::Remedy remedy) {
  switch (remedy) {
    case calibration::Remedy::heated_run:
      return "one run with a constant current at standstill, 10 minutes, current and terminal voltage measured";
    case calibration::Remedy::four_wire_resistance:
      return "measure the terminal resistance at a known temperature with four wires (minutes, no run needed)";
    case calibration::Remedy::winding_sensor:
      return "a thermocouple at the winding, or the winding's resistance from voltage and current right after switching off, during one "
             "warm-up";
    case calibration::Remedy::stator_sensor:
      return "a thermocouple on the housing, or one long warm-up with its cool-down to ambient";
    case calibration::Remedy::no_load_run:
      return "10 minutes at no load and full speed";
    case calibration::Remedy::long_run:
      return "one run from cold with a constant current up to the steady state, then the cool-down";
    case calibration::Remedy::logged_speed:
      return "the same runs with the speed logged (speed_rad_per_s; 0 throughout if the motor stood still)";
    case calibration::Remedy::current_steps:
      break;
  }
  return "several steps of current at standstill, on and off for two of the winding's time constants each";
}

std::string lag_words(const std::string& temperature) {
  return fmt::format(
      "{} lags: record one event, such as a step of the current, with both loggers; state a clock offset in a mapping (clock_offset), or "
      "replace a lagging sensor by one in better contact",
      temperature);
}

std::string words_of(const calibration::GrownError& error) {
  return fmt::format(
      "do not forecast such runs with this model: {} of {} is predicted worse than with the values of the file, {} K rms instead of {} K; "
      "{}{} constant values do not describe this motor (`heatsoak diagnose` searches for the missing effect)",
      error.signal, error.is_holdout ? "the hold-out runs" : "the fitted runs", base::significant(error.after_K, 3),
      base::significant(error.before_K, 3), error.is_holdout ? "they show something that the fitted ones do not, or " : "",
      error.is_extended ? "the extended network and its" : "two temperatures with");
}

Severity severity_of(const calibration::CalibrationFinding& finding) {
  using namespace calibration;
  if (const auto* const note = std::get_if<estimation::RunNote>(&finding)) {
    return severity_of(*note);
  }
  using Warnings = Kinds<HeatSeemsWrong, ResistanceDiffers, LargeChange, OutsideDeclaredRange, PoorFit, ContradictingRun, HeatInputLacking,
                         ShaftPowerUnknown, HoldoutDiverges>;
  using Notes = Kinds<LossAtSpeedUnknown, RowsTurn, UnmodelledHeat, SensorDrift, WindingNotMeasured, ResponseNeedsOtherValues,
                      FitStoppedEarly, UnidentifiableAreWritten, TooFewPieces, ForecastFitIsWritten, FilePredictsBest, FreeRunsPredictBest,
                      ExtendedForForecasts, HeldValue, BandIncludesLossAtSpeed, BandIsEstimated, SignalsMissing, estimation::RunNote>;
  return severity_in<Warnings, Notes, Kinds<>>(finding);
}

namespace {

template <class Finding>
std::vector<std::string> all_words(const std::vector<Finding>& findings) {
  std::vector<std::string> words;
  std::ranges::transform(findings, std::back_inserter(words), [](const Finding& each) { return words_of(each); });
  return words;
}

}  // namespace

std::vector<std::string> words_of(const std::vector<calibration::CalibrationFinding>& findings) { return all_words(findings); }
std::vector<std::string> words_of(const std::vector<calibration::GrownError>& errors) { return all_words(errors); }

}  // namespace heatsoak::present
