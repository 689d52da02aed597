// A diagnosis in words: what was looked for, what was found, how sure, what it does to the error, what to do next.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <span>

#include "attribution/diagnosis.h"
#include "base/quantity.h"
#include "calibration/unlogged_speed.h"

namespace heatsoak {
namespace {

/// What the model's own figures do when they are fitted alone stands between, so that nobody takes their share for that of an effect.
std::string errors_in_words(const Errors& before, const Errors& refitted, const Errors& after, std::string_view where) {
  std::string text;
  for (const auto& [signal, error] : before) {
    const auto found = after.find(signal);
    if (found != after.end()) {
      const auto own = refitted.find(signal);
      text += fmt::format("{} of the {}: {:.2g} K rms before, {}{:.2g} K after.",
                          text.empty() ? fmt::format("On {}, error", where) : std::string(" Error"), signal.substr(0, signal.rfind('_')),
                          error.rmse_K,
                          own == refitted.end() ? "" : fmt::format("{:.2g} K with only its own parameters refitted, ", own->second.rmse_K),
                          found->second.rmse_K);
    }
  }
  return text;
}

std::string condition_in_words(const std::map<std::string, std::string>& condition) {
  std::string text;
  for (const auto& [key, value] : condition) {
    text += text.empty() ? "" : " and ";
    text += key == "run" ? fmt::format("only in {}", value) : fmt::format("only where {} is {}", key, value);
  }
  return text.empty() ? "" : ", " + text;
}

std::string effect_in_words(const FoundEffect& effect) {
  std::string text = fmt::format("Found: {} at the {}{}", effect.id, effect.node, condition_in_words(effect.condition));
  for (const FittedParameter& parameter : effect.parameters) {
    if (parameter.low < parameter.high) {
      text += fmt::format("; {} {:.3g}{}{} (95 %: {:.3g} to {:.3g})", parameter.name, parameter.value, parameter.unit.empty() ? "" : " ",
                          parameter.unit, parameter.low, parameter.high);
      break;
    }
    if (parameter.is_at_bound) {
      text += fmt::format("; {} {:.3g} {}, the bound of what is looked for: perhaps it is something else", parameter.name, parameter.value,
                          parameter.unit);
      break;
    }
  }
  if (effect.mean_W > 0.0) {
    text += fmt::format("; {} W on average, up to {} W", significant(effect.mean_W, 2), significant(effect.peak_W, 2));
  }
  text += fmt::format(". Without it the model would be e^{:.0f} times less probable.", effect.gain_nats);
  if (!effect.confusable_with.empty()) {
    text += fmt::format(" These runs cannot tell it from {}.", fmt::join(effect.confusable_with, " or "));
  }
  return text;
}

/// What the reader must know before he trusts the model on other runs.
std::string reservations(const Diagnosis& diagnosis, const HoldoutScore& score) {
  constexpr double kElsewhere_ratio = 3.0;
  std::string text;
  const double before_K = rms_K(score.before);
  const double after_K = rms_K(score.after), train_K = rms_K(diagnosis.after_train);
  if (is_plainly_worse(after_K, before_K)) {
    text += " The error on runs the fit never saw grows: do not rely on the new model there.";
  }
  if (is_plainly_worse(train_K, rms_K(diagnosis.before_train))) {
    text += " The error on the training runs grows: keep the model's own figures.";
  }
  const auto report_growth = [&](const Errors& before, const Errors& after, std::string_view where) {
    for (const auto& [signal, error] : after) {
      const auto own = before.find(signal);
      if (own != before.end() && is_plainly_worse(error.rmse_K, own->second.rmse_K) && !is_plainly_worse(rms_K(after), rms_K(before))) {
        text += fmt::format(" That of the {} alone grows on {}, from {} to {} K.", signal.substr(0, signal.rfind('_')), where,
                            significant(own->second.rmse_K, 2), significant(error.rmse_K, 2));
      }
    }
  };
  report_growth(score.before, score.after, "the runs held out");
  report_growth(diagnosis.before_train, diagnosis.after_train, "the training runs");
  if (after_K > kElsewhere_ratio * train_K && after_K > train_K + 10.0 * kMatters_K) {
    text += fmt::format(" It is {:.0f} times that on the training runs: those runs hold something that these do not show.",
                        after_K / std::max(kMatters_K, train_K));
  }
  return text;
}

std::string verdict_in_words(const Diagnosis& diagnosis) {
  switch (diagnosis.verdict) {
    case DiagnosisVerdict::effect_found:
      if (std::ranges::any_of(diagnosis.effects, [](const FoundEffect& effect) { return effect.has_heat && effect.is_from_catalogue; })) {
        return "The runs show heat that the model does not have, and it follows a known law.";
      }
      return std::string("The sensors read wrongly, and the error follows a known law") +
             (diagnosis.unexplained.empty() ? "." : "; besides, there is heat that no law of the catalogue explains.");
    case DiagnosisVerdict::nothing_missing:
      return diagnosis.changed.empty()
                 ? "No effect of the catalogue and no curve over a measured signal explains the runs better than the model with an unknown "
                   "smooth heat of the size that every model leaves."
                 : "No effect is missing that these runs show, but not all of the file's parameters hold in them.";
    case DiagnosisVerdict::unexplained:
      return "The runs show heat that the model does not have, and no law of the catalogue explains it.";
    case DiagnosisVerdict::not_identifiable:
      break;
  }
  if (!diagnosis.changed.empty()) {
    return "The runs contradict the file's own parameters. These runs do not determine whether they have changed since "
           "(another mounting, another specimen of the motor) or an effect is missing that acts like such a change. No effect is named, "
           "and "
           "the parameters are those of these runs.";
  }
  return !diagnosis.selection.is_undecided()
             ? fmt::format(
                   "These runs cannot tell whether something is missing: at their usual size only {:.0f} % of the effects of the "
                   "catalogue would show in them.",
                   100.0 * diagnosis.selection.seen_share)
             : std::string(
                   "Something may be missing, but on these runs the model's own resistances and capacities can take its place; no name "
                   "is given.");
}

std::string changed_in_words(const ChangedParameter& figure) {
  // The interval has the scale of all heat in it, on which the file agrees: where it reaches the file's own figure it would mislead.
  const bool is_beyond_scale = figure.before < figure.low || figure.before > figure.high;
  return fmt::format(
      "Does not hold here: {}, {:.3g} {} in the file, {:.3g} {} in these runs{}; with the file's value the runs would be e^{:.0f} times "
      "less "
      "probable.",
      figure.name, figure.before, figure.unit, figure.value, figure.unit,
      is_beyond_scale ? fmt::format(" (95 %: {:.3g} to {:.3g})", figure.low, figure.high) : std::string(), figure.gain_nats);
}

/// Conductances count what flows out, sources what comes in.
bool is_leaving(const Unexplained& heat) {
  const double largest = std::ranges::max(heat.curve, {}, [](double value) { return std::abs(value); });
  return heat.curve_unit == "W/K" ? largest > 0.0 : largest < 0.0;
}

/// Of curves over one signal that share what they say.
std::string watts_in_words(std::span<const Unexplained* const> curves) {
  std::vector<std::string> each;
  for (const Unexplained* const heat : curves) {
    each.push_back(fmt::format("{} W on average, up to {} W", significant(heat->mean_W, 2), significant(heat->peak_W, 2)));
  }
  return curves.size() == 1 ? each.front() : fmt::format("in {} curves: {}", each.size(), fmt::join(each, "; "));
}

/// `curves` are all with the first one's node and signals.
std::string unexplained_in_words(std::span<const Unexplained* const> curves, const Diagnosis& diagnosis) {
  const Unexplained& heat = *curves.front();
  if (heat.drivers.empty()) {
    const std::string_view no_driver = std::ranges::any_of(diagnosis.runs, turns_unseen)
                                           ? "while not every log has a speed no signal is taken for what follows them"
                                           : "no signal that all logs have follows them";
    return fmt::format("Unexplained: {} W rms into the {}{} that come and go within {:.0f} s; {}.", significant(heat.rms_W, 2), heat.node,
                       heat.or_nodes.empty() ? "" : fmt::format(" (or the {}, which has no sensor)", fmt::join(heat.or_nodes, " or ")),
                       heat.time_scale_s, no_driver);
  }
  const bool goes_by_clock = heat.drivers.size() == 1 && heat.drivers.front() == kTimeDriver;
  const std::string where = fmt::format("{} the {}", is_leaving(heat) ? "out of" : "into", heat.node);
  return (goes_by_clock ? fmt::format("Unexplained: heat {} that no measured signal explains; it goes by the time since a run began", where)
                        : fmt::format("Unnamed: heat {} that follows {}{}", where,
                                      heat.times.empty() ? "" : heat.times + " times a curve over ", fmt::join(heat.drivers, " or "))) +
         fmt::format(", {}.", watts_in_words(curves)) + (heat.drivers.size() > 1 ? " The list of drivers is in order of evidence." : "") +
         (heat.is_in_model ? " The extended model has it as a curve."
                           : " The extended model does not have it: its figures carry what they can of it.");
}

/// Curves over one signal share what they have in common to say.
void add_unexplained(const Diagnosis& diagnosis, std::vector<std::string>& all) {
  const auto is_shared = [](const Unexplained& a, const Unexplained& b) {
    return !a.drivers.empty() && a.node == b.node && a.drivers == b.drivers && a.times == b.times && a.is_in_model == b.is_in_model &&
           is_leaving(a) == is_leaving(b);
  };
  std::vector<std::vector<const Unexplained*>> groups;
  for (const Unexplained& heat : diagnosis.unexplained) {
    const auto own = std::ranges::find_if(groups, [&](const auto& group) { return is_shared(*group.front(), heat); });
    (own == groups.end() ? groups.emplace_back() : *own).push_back(&heat);
  }
  for (const auto& group : groups) {
    all.push_back(unexplained_in_words(group, diagnosis));
  }
}

/// Where some runs have more or less of something, the motor's file cannot follow them as well as was said.
std::string file_alone_in_words(const Diagnosis& diagnosis, const HoldoutScore& score) {
  const std::vector<RunDeviation>& deviations = diagnosis.selection.after.model.deviations;
  if (deviations.empty()) {
    return {};
  }
  std::set<std::string> names;
  for (const RunDeviation& each : deviations) {
    names.insert(fmt::format("{} in {}", each.type->name, each.condition.begin()->second));
  }
  const bool is_held_out = !score.file.empty();
  std::vector<std::string> errors;
  for (const auto& [signal, error] : is_held_out ? score.file : diagnosis.file_train) {
    errors.push_back(fmt::format("{} {} K", signal.substr(0, signal.rfind('_')), significant(error.rmse_K, 2)));
  }
  return fmt::format("{} is of those runs, not of the motor, so the motor file has it as a note only: the file alone follows {} to {}.",
                     fmt::join(names, " and "), is_held_out ? "the runs the fit never saw" : "the training runs", fmt::join(errors, ", "));
}

}  // namespace

std::vector<std::string> describe(const Diagnosis& diagnosis, const HoldoutScore& score) {
  std::vector<std::string> all{verdict_in_words(diagnosis)};
  for (const FoundEffect& effect : diagnosis.effects) {
    // What has no name in the catalogue is described below, with its driver.
    if (effect.is_from_catalogue) {
      all.push_back(effect_in_words(effect));
    }
  }
  for (const ChangedParameter& figure : diagnosis.changed) {
    all.push_back(changed_in_words(figure));
  }
  if (!diagnosis.changed.empty() && diagnosis.verdict != DiagnosisVerdict::not_identifiable) {
    all.emplace_back("Whether that has changed since, or an effect that acts like such a change is missing, these runs cannot tell.");
  }
  add_unexplained(diagnosis, all);
  if (diagnosis.selection.is_as_usual) {
    all.emplace_back("The file's values stay: the runs are followed as well as those that the file was fitted to.");
  }
  const bool is_held_out = !score.before.empty();
  const bool is_more = !diagnosis.effects.empty();
  all.push_back(errors_in_words(is_held_out ? score.before : diagnosis.before_train,
                                !is_more      ? Errors{}
                                : is_held_out ? score.refitted
                                              : diagnosis.refitted_train,
                                is_held_out ? score.after : diagnosis.after_train,
                                is_held_out ? "runs the fit never saw" : "the training runs") +
                reservations(diagnosis, score));
  if (const std::string alone = file_alone_in_words(diagnosis, score); !alone.empty()) {
    all.push_back(alone);
  }
  all.insert(all.end(), score.beyond_training.begin(), score.beyond_training.end());
  for (const Refusal& refused : diagnosis.selection.refused) {
    all.push_back(fmt::format("Not named: {}.", refused.words));
  }
  if (!diagnosis.experiments.empty()) {
    const Experiment& next = diagnosis.experiments.front();
    all.push_back(fmt::format("Next, to tell {}: {}", next.rivals, next.what) +
                  (next.expected_nats > 0.0 ? fmt::format(" (expected to add {:.0f} nats).", next.expected_nats) : std::string(".")));
  }
  return all;
}

}  // namespace heatsoak
