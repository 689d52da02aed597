#include "present/measured/diagnosis_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <set>
#include <span>

#include "base/confidence.h"
#include "base/quantity.h"
#include "calibration/unlogged_speed.h"
#include "estimation/run_deviation.h"
#include "estimation/thresholds.h"
#include "motor/sensor_effect.h"
#include "present/measured/calibration_words.h"
#include "present/measured/diagnosis_reservations.h"
#include "present/measured/log.h"
#include "present/measured/run_words.h"
#include "thermal/effect.h"

namespace heatsoak::present {
namespace {

/// Formats "RMS error of the stator: 0.35 K before, 0.13 K after." `refitted`: error with only the model's own parameters refitted; the
/// difference to it is due to the effects. Nullptr: not stated.
std::string error_in_words(std::string_view what, const std::string& signal, double before_K, const double* refitted_K, double after_K) {
  const std::string own =
      refitted_K ? fmt::format("{} K with only the model's own parameters refitted, ", base::significant(*refitted_K, 2)) : "";
  return fmt::format("{} of the {}: {} K before, {}{} K after.", what, part_of(signal), base::significant(before_K, 2), own,
                     base::significant(after_K, 2));
}

/// Reports each signal in the run in which its error after the diagnosis is largest. `kind`: "hold-out" or "training".
std::string errors_in_runs(const std::vector<diagnosis::ErrorInRun>& errors, std::string_view kind, bool states_refitted) {
  std::set<std::string> runs;
  std::ranges::transform(errors, std::inserter(runs, runs.end()), &diagnosis::ErrorInRun::run);
  std::string text;
  std::string last_run;
  for (const diagnosis::ErrorInRun& each : diagnosis::worst_runs(errors)) {
    const std::string where =
        runs.size() == 1 ? fmt::format("the {} run", kind) : fmt::format("{}, the worst of {} {} runs", each.run, runs.size(), kind);
    text += error_in_words(each.run == last_run ? " RMS error" : fmt::format("{}In {}, RMS error", text.empty() ? "" : " ", where),
                           each.signal, each.before.rmse_K, states_refitted ? &each.refitted.rmse_K : nullptr, each.after.rmse_K);
    last_run = each.run;
  }
  return text;
}

std::string condition_in_words(const std::map<std::string, std::string>& condition) {
  std::string text;
  for (const auto& [key, value] : condition) {
    text += text.empty() ? "" : " and ";
    text += key == "run" ? fmt::format("only in {}", value) : fmt::format("only in runs with {} = {}", key, value);
  }
  return text.empty() ? "" : ", " + text;
}

/// True if probabilities with this logarithmic ratio differ by at least ten.
bool is_clearly_less_probable(double nats) { return nats >= std::numbers::ln10; }

/// Returns "20 times less probable" or "10^36 times less probable" for a ratio of probabilities, given as its natural logarithm.
std::string less_probable(double nats) {
  constexpr double kLargestCounted = 1e4;
  constexpr double kLargestPower = 100.0;
  if (!is_clearly_less_probable(nats)) {
    return "hardly less probable";
  }
  if (nats < std::log(kLargestCounted)) {
    return fmt::format("{} times less probable", base::significant(std::exp(nats), 1));
  }
  const double power = nats / std::numbers::ln10;
  return fmt::format("{}10^{:.0f} times less probable", power > kLargestPower ? "more than " : "", std::min(power, kLargestPower));
}

std::string effect_in_words(const diagnosis::FoundEffect& effect) {
  std::string text = fmt::format("Found: {} at the {}{}", effect.id, effect.node, condition_in_words(effect.condition));
  for (const diagnosis::FittedParameter& parameter : effect.parameters) {
    if (parameter.low < parameter.high) {
      text += fmt::format("; {} {:.3g}{}{} ({}: {:.3g} to {:.3g})", parameter.name, parameter.value, parameter.unit.empty() ? "" : " ",
                          parameter.unit, base::level_text(base::kInterval_share), parameter.low, parameter.high);
      if (parameter.low <= 0.0 && parameter.high >= 0.0) {
        text += ", which these runs hardly determine";
      }
      break;
    }
    if (parameter.is_at_bound) {
      text += fmt::format("; {} {:.3g}{}{}, at the bound of the search range: another effect may be the cause", parameter.name,
                          parameter.value, parameter.unit.empty() ? "" : " ", parameter.unit);
      break;
    }
  }
  if (effect.mean_W > 0.0) {
    text += fmt::format("; {} W on average, up to {} W", base::significant(effect.mean_W, 2), base::significant(effect.peak_W, 2));
  }
  text += fmt::format(". Without it the model would be {}.", less_probable(effect.gain_nats));
  if (!effect.same_conditions.empty()) {
    std::vector<std::string> others;
    std::ranges::transform(effect.same_conditions, std::back_inserter(others), estimation::in_words);
    text += fmt::format(" The same runs, and no others, have {}: which of the conditions matters is not determined.",
                        fmt::join(others, " and "));
  }
  if (!effect.confusable_with.empty()) {
    text += fmt::format(" In these runs it cannot be distinguished from {}.", fmt::join(effect.confusable_with, " or "));
  }
  return text;
}

std::string verdict_in_words(const diagnosis::Diagnosis& diagnosis) {
  switch (diagnosis.verdict) {
    case diagnosis::DiagnosisVerdict::effect_found:
      if (std::ranges::any_of(diagnosis.effects,
                              [](const diagnosis::FoundEffect& effect) { return effect.has_heat && effect.is_from_catalogue; })) {
        return "The runs show unmodelled heat, and it follows a known law.";
      }
      return std::string("The sensors have an error that follows a known law") +
             (diagnosis.unexplained.empty() ? "." : "; there is also unmodelled heat that no law of the catalogue explains.");
    case diagnosis::DiagnosisVerdict::nothing_missing:
      return diagnosis.changed.empty()
                 ? "No effect of the catalogue and no curve over a measured signal explains the runs better than the model with a small, "
                   "smooth unknown heat."
                 : "These runs show no missing effect, but they contradict some of the file's parameters.";
    case diagnosis::DiagnosisVerdict::unexplained:
      return std::ranges::none_of(diagnosis.effects, &diagnosis::FoundEffect::is_from_catalogue)
                 ? "The runs show unmodelled heat, and no law of the catalogue explains it."
                 : "The runs show unmodelled heat. Laws of the catalogue explain only a part of it.";
    case diagnosis::DiagnosisVerdict::not_identifiable:
      break;
  }
  if (!diagnosis.changed.empty()) {
    return "The runs contradict the file's parameters. Either these have changed (another mounting, another specimen of the motor), "
           "or a missing effect acts like such a change; these runs do not determine which. No effect is named, and the parameters are "
           "fitted to these runs. If the file's thermal values are guesses, give all of them a range in the file, and repeat the "
           "diagnosis.";
  }
  return !diagnosis.selection.is_undecided()
             ? fmt::format("At typical size, only {:.0f} % of the effects of the catalogue would be visible in these runs.",
                           100.0 * diagnosis.selection.seen_share)
             : std::string(
                   "An effect may be missing, but in these runs it cannot be distinguished from a change of the model's own "
                   "resistances and capacities. No effect is named.");
}

std::string changed_in_words(const diagnosis::ChangedParameter& parameter) {
  // The interval includes a common factor on all heat. If it contains the file's value it would be misleading, so it is not printed.
  const bool is_beyond_scale = parameter.before < parameter.low || parameter.before > parameter.high;
  return fmt::format("Does not hold here: {}, {:.3g} {} in the file, {:.3g} {} in these runs{}{}.", parameter.name, parameter.before,
                     parameter.unit, parameter.value, parameter.unit,
                     is_beyond_scale
                         ? fmt::format(" ({}: {:.3g} to {:.3g})", base::level_text(base::kInterval_share), parameter.low, parameter.high)
                         : std::string(),
                     is_clearly_less_probable(parameter.gain_nats)
                         ? fmt::format("; with the file's value the runs would be {}", less_probable(parameter.gain_nats))
                         : std::string());
}

/// A positive conductance means heat out of the node, a positive source means heat into it.
bool is_leaving(const diagnosis::Unexplained& heat) {
  const double largest = std::ranges::max(heat.curve, {}, [](double value) { return std::abs(value); });
  return attribution::spec_of(heat.multiplier).is_conductance ? largest > 0.0 : largest < 0.0;
}

/// Names the factor that multiplies a curve, with "times"; "" if there is none.
std::string factor_in_words(const diagnosis::Unexplained& heat) {
  switch (heat.multiplier) {
    case attribution::Multiplier::source:
      return "";
    case attribution::Multiplier::excess:
      return fmt::format("the temperature rise of the {} above ambient times ", heat.node);
    case attribution::Multiplier::copper:
      return "the copper loss times ";
    case attribution::Multiplier::difference:
      return fmt::format("the temperature difference from {} to {} times ", heat.node, heat.other_node);
    case attribution::Multiplier::current:
      return "the current times ";
    case attribution::Multiplier::speed:
      return "the speed times ";
  }
  return "";
}

/// Formats the heat of several curves over one signal.
std::string watts_in_words(std::span<const diagnosis::Unexplained* const> curves) {
  std::vector<std::string> each;
  for (const diagnosis::Unexplained* const heat : curves) {
    each.push_back(fmt::format("{} W on average, up to {} W", base::significant(heat->mean_W, 2), base::significant(heat->peak_W, 2)));
  }
  return curves.size() == 1 ? each.front() : fmt::format("in {} curves: {}", each.size(), fmt::join(each, "; "));
}

bool has_one_recording(const std::vector<estimation::MeasuredRun>& runs) {
  return std::ranges::all_of(
      runs, [&](const estimation::MeasuredRun& run) { return estimation::recording_of(run) == estimation::recording_of(runs.front()); });
}

/// Describes unexplained heat. All `curves` have the node and the signals of the first one.
std::string unexplained_in_words(std::span<const diagnosis::Unexplained* const> curves, const diagnosis::Diagnosis& diagnosis) {
  const diagnosis::Unexplained& heat = *curves.front();
  if (heat.signals.empty()) {
    const std::string no_driver = std::ranges::any_of(diagnosis.runs, calibration::turns_unseen)
                                      ? "no signal can be assigned to it, because not every log has a speed"
                                  : !heat.unconfirmed_signal.empty()
                                      ? fmt::format("it may follow {}, but {}", heat.unconfirmed_signal,
                                                    has_one_recording(diagnosis.runs) ? "only a second run can confirm this; fit one more"
                                                                                      : "predictions of left-out runs do not confirm this")
                                      : "it follows no signal that all logs have";
    return fmt::format("Unexplained: unknown heat of {} W RMS into the {}{}, which varies within {:.0f} s; {}.",
                       base::significant(heat.rms_W, 2), heat.node,
                       heat.or_nodes.empty() ? "" : fmt::format(" (or the {}, which has no sensor)", fmt::join(heat.or_nodes, " or ")),
                       heat.time_scale_s, no_driver);
  }
  const bool goes_by_clock = heat.signals.size() == 1 && heat.signals.front() == attribution::kTimeRegressor;
  const std::string where = fmt::format("{} the {}", is_leaving(heat) ? "out of" : "into", heat.node);
  const std::string factor = factor_in_words(heat);
  return (goes_by_clock
              ? fmt::format(
                    "Unexplained: heat {} that no measured signal explains; it is {}a curve over the time since the start of the recording",
                    where, factor)
              : fmt::format("Unnamed: heat {} that follows {}{}", where, factor.empty() ? "" : factor + "a curve over ",
                            fmt::join(heat.signals, " or "))) +
         fmt::format(", {}.", watts_in_words(curves)) + (heat.signals.size() > 1 ? " The signals are in order of evidence." : "") +
         (heat.is_in_model ? " The extended model contains it as a curve."
                           : " The extended model does not contain it: its parameters absorb a part of it.");
}

/// Reports the larger errors of the motor file alone, which does not contain run deviations.
std::string file_alone_in_words(const diagnosis::Diagnosis& diagnosis, const diagnosis::HoldoutScore& score) {
  const std::vector<estimation::RunDeviation>& deviations = diagnosis.selection.after.model.deviations;
  if (deviations.empty()) {
    return {};
  }
  std::set<std::string> names;
  for (const estimation::RunDeviation& each : deviations) {
    names.insert(fmt::format("{} in {}", each.type->name, estimation::in_words(each.condition)));
  }
  const std::string whose =
      names.size() > 1 ? fmt::format("{} are no properties of the motor, and only notes in the motor file.", fmt::join(names, " and "))
                       : fmt::format("{} is no property of the motor, and only a note in the motor file.", *names.begin());
  if (!score.errors.empty()) {
    return whose;  // the errors in the hold-out runs are those of the file
  }
  std::vector<std::string> errors;
  for (const diagnosis::ErrorInRun& each : diagnosis::worst_runs(diagnosis.train_errors)) {
    errors.push_back(fmt::format("{} {} K", part_of(each.signal), base::significant(each.file.rmse_K, 2)));
  }
  return fmt::format("{} RMS error of the file alone in the worst training runs: {}.", whose, fmt::join(errors, ", "));
}

/// Reports the band of forecasts with the written file.
std::string band_in_words(const diagnosis::DiagnosisAnswer& answer) {
  if (!answer.band) {
    return fmt::format(
        "Forecasts with the new file have a band of the usual size, because {}.",
        has_one_recording(answer.diagnosis.runs) ? "a single recording cannot be left out" : "a fit without one of the recordings failed");
  }
  std::vector<std::string> widths;
  for (const auto& [signal, width_K] : answer.band->half_width_K) {
    widths.push_back(fmt::format("{} K at the {}", base::significant(width_K, 2), part_of(signal)));
  }
  return fmt::format(
      "The {} band of forecasts with the new file is ±{} on average over the training runs, from predictions of {} left-out recordings.",
      base::level_text(base::kBand_share), fmt::join(widths, " and ±"), answer.band->recordings);
}

std::string beyond_in_words(const diagnosis::BeyondTraining& beyond) {
  const thermal::OperatingQuantity<double>& quantity = thermal::quantity_of(beyond.signal);
  return fmt::format(
      "The forecast is an extrapolation for {:.0f} % of the time of the hold-out runs, because the {} is outside the range of the "
      "training runs ({} to {} {}).",
      100.0 * beyond.time_share, quantity.lacking, base::significant(beyond.low, 2), base::significant(beyond.high, 2), quantity.unit);
}

std::string reason_in_words(const attribution::Refusal& refused) {
  switch (refused.reason) {
    case attribution::RefusalReason::improbable:
      // Rounded down, so that a probability just below the required one does not read as enough.
      return fmt::format("its probability is {:.0f} %, but a name requires {:.0f} %", std::floor(100.0 * refused.probability),
                         100.0 * refused.needed_probability);
    case attribution::RefusalReason::one_run_only:
      return "only one run supports it; with it, the other runs are not predicted clearly better";
    case attribution::RefusalReason::curve_is_better:
      return fmt::format("a curve over {} explains the runs better", refused.signal);
    case attribution::RefusalReason::unknown_heat_remains:
      return "much unknown heat remains, and the effect does not reduce the error of whole runs enough";
    case attribution::RefusalReason::hardly_improves_whole_runs:
      return "the effect hardly improves the prediction of whole runs";
    case attribution::RefusalReason::no_size:
      return "the fit of the whole model cannot distinguish its size from zero";
  }
  return "";
}

std::string_view run_words(diagnosis::PlannedRun run) {
  switch (run) {
    case diagnosis::PlannedRun::speeds_without_load:
      return "ten minutes without load, with the speed raised in steps";
    case diagnosis::PlannedRun::pulses_at_standstill:
      return "ten minutes of current pulses at standstill";
    case diagnosis::PlannedRun::spin_after_standstill:
      return "heat at standstill for five minutes, then spin without load while hot";
    case diagnosis::PlannedRun::rest_after_spin:
      return "spin without load for five minutes from cold, then rest";
    case diagnosis::PlannedRun::one_current_at_speeds:
      return "one current at four speeds";
    case diagnosis::PlannedRun::one_speed_with_currents:
      return "one speed at four currents";
    case diagnosis::PlannedRun::rest_after_standstill:
      return "heat at standstill for five minutes, then rest";
  }
  return {};
}

/// Returns the id, with the node if it is not the effect's default node or if the id occurs twice: a motor may lack a body at the stator
/// and one at the winding.
std::string name_with_place(const diagnosis::FoundEffect& effect, const std::vector<diagnosis::FoundEffect>& all) {
  const thermal::EffectType* const type = thermal::find_effect(effect.id);
  const bool is_elsewhere = type && !type->nodes.empty() && type->nodes.front().default_node != effect.node;
  const bool is_twice = std::ranges::count(all, effect.id, &diagnosis::FoundEffect::id) > 1;
  return is_elsewhere || is_twice ? fmt::format("{} at the {}", effect.id, effect.node) : effect.id;
}

/// Names the unexplained heat with its sign, if most of it has one: that of its curves, or without a curve that of the unknown heat.
std::string_view heat_with_sign(const diagnosis::Diagnosis& diagnosis) {
  constexpr double kMostly_share = 0.5;
  double curves_W = 0.0;
  double net_W = 0.0;
  for (const diagnosis::Unexplained& heat : diagnosis.unexplained) {
    if (!heat.curve.empty()) {
      curves_W += heat.mean_W;
      net_W += is_leaving(heat) ? -heat.mean_W : heat.mean_W;
    }
  }
  const double share = curves_W > 0.0 ? net_W / curves_W : diagnosis::net_share(diagnosis.flux);
  return share > kMostly_share    ? "heat is missing"
         : share < -kMostly_share ? "the model has too much heat, a difference"
                                  : "the runs have unmodelled heat of both signs";
}

}  // namespace

std::string verdict_words(const diagnosis::Diagnosis& diagnosis) {
  std::vector<std::string> names;
  for (const diagnosis::FoundEffect& effect : diagnosis.effects) {
    if (effect.is_from_catalogue) {
      names.push_back(effect.confusable_with.empty()
                          ? name_with_place(effect, diagnosis.effects)
                          : fmt::format("{} or {} (these runs do not distinguish them)", name_with_place(effect, diagnosis.effects),
                                        fmt::join(effect.confusable_with, " or ")));
    }
  }
  const std::string lacks = fmt::format("the model lacks {}", fmt::join(names, " and "));
  switch (diagnosis.verdict) {
    case diagnosis::DiagnosisVerdict::nothing_missing:
      return "no effect is missing";
    case diagnosis::DiagnosisVerdict::effect_found:
      return lacks;
    case diagnosis::DiagnosisVerdict::unexplained:
      return names.empty() ? fmt::format("{} that no effect of the catalogue explains", heat_with_sign(diagnosis))
                           : lacks + ", and further heat that no effect of the catalogue explains";
    case diagnosis::DiagnosisVerdict::not_identifiable:
      break;
  }
  return "these runs do not determine whether an effect is missing";
}

std::vector<std::string> unexplained_words(const diagnosis::Diagnosis& diagnosis) {
  std::vector<std::string> all;
  const auto is_shared = [](const diagnosis::Unexplained& a, const diagnosis::Unexplained& b) {
    return !a.signals.empty() && a.node == b.node && a.signals == b.signals && a.multiplier == b.multiplier &&
           a.other_node == b.other_node && a.is_in_model == b.is_in_model && is_leaving(a) == is_leaving(b);
  };
  std::vector<std::vector<const diagnosis::Unexplained*>> groups;
  for (const diagnosis::Unexplained& heat : diagnosis.unexplained) {
    const auto own = std::ranges::find_if(groups, [&](const auto& group) { return is_shared(*group.front(), heat); });
    (own == groups.end() ? groups.emplace_back() : *own).push_back(&heat);
  }
  for (const auto& group : groups) {
    all.push_back(unexplained_in_words(group, diagnosis));
  }
  return all;
}

std::vector<std::string> diagnosis_words(const diagnosis::DiagnosisAnswer& answer) {
  const diagnosis::Diagnosis& diagnosis = answer.diagnosis;
  const diagnosis::HoldoutScore& score = answer.score;
  std::vector<std::string> all{verdict_in_words(diagnosis)};
  for (const diagnosis::FoundEffect& effect : diagnosis.effects) {
    // Effects outside the catalogue are described below, with their signals.
    if (effect.is_from_catalogue) {
      all.push_back(effect_in_words(effect));
    }
  }
  for (const diagnosis::ChangedParameter& parameter : diagnosis.changed) {
    all.push_back(changed_in_words(parameter));
  }
  if (!diagnosis.changed.empty() && diagnosis.verdict != diagnosis::DiagnosisVerdict::not_identifiable) {
    all.emplace_back("These runs do not determine whether this has changed, or whether a missing effect acts like such a change.");
  }
  std::ranges::move(unexplained_words(diagnosis), std::back_inserter(all));
  if (diagnosis.selection.is_as_usual) {
    all.emplace_back("The file's values are kept: the model follows these runs as well as those that it was fitted to.");
  }
  all.push_back((score.errors.empty() ? errors_in_runs(diagnosis.train_errors, "training", !diagnosis.effects.empty())
                                      : errors_in_runs(score.errors, "hold-out", !diagnosis.effects.empty())) +
                reservations(diagnosis, score));
  if (const std::string alone = file_alone_in_words(diagnosis, score); !alone.empty()) {
    all.push_back(alone);
  }
  all.push_back(band_in_words(answer));
  std::ranges::transform(score.beyond_training, std::back_inserter(all), beyond_in_words);
  for (const std::string& refused : refusal_words(diagnosis.selection)) {
    all.push_back(fmt::format("Not named: {}.", refused));
  }
  if (!diagnosis.experiments.empty()) {
    const diagnosis::Experiment& next = diagnosis.experiments.front();
    all.push_back(fmt::format("Next experiment, to decide whether it is {}: {}", rivals_of(next), experiment_words(next)) +
                  (next.expected_nats ? fmt::format(" (expected to add {:.0f} nats).", *next.expected_nats) : std::string(".")));
  }
  return all;
}

std::vector<std::string> notes_of_model_file(const diagnosis::Diagnosis& diagnosis) {
  std::vector<std::string> notes;
  for (const diagnosis::FoundEffect& effect : diagnosis.effects) {
    if (!effect.name.empty() || motor::find_sensor_effect(effect.id) || effect.parameters.empty()) {
      continue;
    }
    const diagnosis::FittedParameter& size = effect.parameters.front();
    notes.push_back(fmt::format("{} at the {}{}: {} {:.3g}{}{}; found in measurements, not a property of the motor", effect.id, effect.node,
                                effect.condition.empty() ? "" : fmt::format(" in {}", estimation::in_words(effect.condition)), size.name,
                                size.value, size.unit.empty() ? "" : " ", size.unit));
  }
  return notes;
}

std::vector<std::string> refusal_words(const attribution::Selection& selection) {
  std::vector<std::string> all;
  for (const attribution::Refusal& each : selection.refused) {
    std::string words = fmt::format("{}: {}", each.id, reason_in_words(each));
    if (std::ranges::find(all, words) == all.end()) {
      all.push_back(std::move(words));
    }
  }
  return all;
}

std::string untested_words(const attribution::UntestedEffect& untested) {
  return fmt::format("not every log has {}", fmt::join(untested.lacking, " and "));
}

std::string rivals_of(const diagnosis::Experiment& experiment) { return fmt::format("{} or {}", experiment.effect, experiment.rival); }

std::string experiment_words(const diagnosis::Experiment& experiment) {
  const std::string_view what = experiment.planned ? run_words(*experiment.planned) : experiment.other;
  std::vector<std::string> levels;
  if (experiment.most_A) {
    levels.push_back(base::significant(*experiment.most_A, 2) + " A");
  }
  if (experiment.most_rad_per_s) {
    levels.push_back(base::significant(*experiment.most_rad_per_s, 2) + " rad/s");
  }
  return levels.empty() ? std::string(what)
                        : fmt::format("{}; with at most {} the motor gets no hotter than in these runs", what, fmt::join(levels, " and "));
}

std::vector<Note> diagnosis_notes(const diagnosis::DiagnosisAnswer& answer, std::span<const recording::LogReading> readings) {
  std::vector<Note> notes;
  for (std::string& each : reading_words(readings)) {
    notes.push_back({Severity::background, std::move(each)});
  }
  const auto add_findings = [&](bool warnings) {
    for (const diagnosis::DiagnosisFinding& each : answer.findings) {
      if (const Severity severity = severity_of(each); (severity == Severity::warning) == warnings) {
        notes.push_back({severity, words_of(each)});
      }
    }
  };
  add_findings(true);
  for (std::string& each : words_of(answer.admission.notes)) {
    notes.push_back({Severity::note, std::move(each)});
  }
  add_findings(false);
  return notes;
}

}  // namespace heatsoak::present
