#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <string>

#include "base/confidence.h"
#include "base/quantity.h"
#include "base/xml_text.h"
#include "estimation/thresholds.h"
#include "present/measured/diagnosis_output.h"
#include "present/measured/diagnosis_words.h"

namespace heatsoak::present {
namespace {

/// Returns a table row. Long names may be broken after underscores.
std::string row(const std::vector<std::string>& cells, std::string_view tag = "td") {
  std::string text = "<tr>";
  for (const std::string& cell : cells) {
    text += fmt::format("<{}>", tag);
    for (const char c : base::xml_text(cell)) {
      text += c == '_' ? "_<wbr>" : std::string(1, c);
    }
    text += fmt::format("</{}>", tag);
  }
  return text + "</tr>\n";
}

std::string error_table(const diagnosis::Diagnosis& diagnosis, const diagnosis::HoldoutScore& score) {
  std::string text = "<table>" + row({"signal", "runs", "before: rms / K", "model refitted: rms / K", "after: rms / K", "before: worst / K",
                                      "after: worst / K"},
                                     "th");
  const auto add = [&](const std::string& signal, const std::string& where, const estimation::ErrorOfSignal& before,
                       const estimation::ErrorOfSignal& refitted, const estimation::ErrorOfSignal& after) {
    text += row({signal, where, fmt::format("{:.2f}", before.rmse_K), fmt::format("{:.2f}", refitted.rmse_K),
                 fmt::format("{:.2f}", after.rmse_K), fmt::format("{:.1f}", before.max_abs_K), fmt::format("{:.1f}", after.max_abs_K)});
  };
  for (const diagnosis::ErrorInRun& each : diagnosis.train_errors) {
    add(each.signal, "training " + each.run, each.before, each.refitted, each.after);
  }
  for (const diagnosis::ErrorInRun& each : score.errors) {
    add(each.signal, "hold-out " + each.run, each.before, each.refitted, each.after);
  }
  return text + "</table>\n";
}

std::string heat_in_words(const diagnosis::FoundEffect& effect) {
  return effect.has_heat ? fmt::format("{} / {} W", base::significant(effect.mean_W, 2), base::significant(effect.peak_W, 2)) : "none";
}

/// Returns the name of an effect; a curve is named with its input signals.
std::string named(const diagnosis::FoundEffect& effect) {
  return effect.is_from_catalogue ? effect.id : fmt::format("{} over {}", effect.id, fmt::join(effect.signals, " times "));
}

std::string added_effects(const diagnosis::Diagnosis& diagnosis) {
  std::string text = "<table>" + row({"effect", "node", "acts", "parameter", "value", base::level_text(base::kInterval_share) + " interval",
                                      "heat: mean / peak", "evidence", "visibility", "confounded here"},
                                     "th");
  for (const diagnosis::FoundEffect& effect : diagnosis.effects) {
    std::string where = effect.condition.empty() ? "always" : "";
    for (const auto& [key, value] : effect.condition) {
      where += key + " = " + value + " ";
    }
    bool is_first = true;
    for (const diagnosis::FittedParameter& parameter : effect.parameters) {
      const bool is_fitted = parameter.low < parameter.high;
      text += row({is_first ? named(effect) : "", is_first ? effect.node : "", is_first ? where : "", parameter.name,
                   fmt::format("{:.4g} {}", parameter.value, parameter.unit),
                   is_fitted ? fmt::format("{:.3g} … {:.3g}", parameter.low, parameter.high)
                             : (parameter.is_at_bound ? "at its bound" : "not fitted"),
                   is_first ? heat_in_words(effect) : "", is_first ? fmt::format("{:.0f} nats", effect.gain_nats) : "",
                   is_first && effect.is_from_catalogue ? fmt::format("{:.2f}", effect.visibility_ratio) : "",
                   !is_first                        ? ""
                   : effect.confusable_with.empty() ? "none"
                                                    : fmt::format("{}", fmt::join(effect.confusable_with, ", "))});
      is_first = false;
    }
  }
  text += "</table>\n";
  std::set<std::string> printed;
  for (const diagnosis::FoundEffect& effect : diagnosis.effects) {
    if (!effect.confounded_with.empty() && effect.is_from_catalogue && printed.insert(effect.id).second) {
      text += fmt::format("<p>{} in general: {}</p>\n", base::xml_text(effect.id), base::xml_text(effect.confounded_with));
    }
  }
  return text;
}

std::string outcome_of(const attribution::Round& round) {
  if (round.taken.empty()) {
    return "No candidate was accepted: none of these may be named.";
  }
  return fmt::format("Accepted{}: {}; {:.0f} nats.", round.taken.size() > 1 ? ", none without the rest" : "", fmt::join(round.taken, ", "),
                     round.taken_nats);
}

/// Keeps the best variant of each effect; variants differ only in the start of their fit.
std::vector<attribution::JudgedCandidate> best_of_each(std::vector<attribution::JudgedCandidate> ladder) {
  std::ranges::stable_sort(ladder, std::greater(), &attribution::JudgedCandidate::gain_nats);
  std::set<std::string> printed;
  std::erase_if(ladder, [&](const attribution::JudgedCandidate& each) { return !printed.insert(each.candidate.id).second; });
  return ladder;
}

std::string ladder_table(const diagnosis::Diagnosis& diagnosis) {
  std::string text;
  int number = 1;
  for (const attribution::Round& round : diagnosis.selection.rounds) {
    text += fmt::format("<h3>Round {}</h3><table>", number++) +
            row({"candidate", "evidence / nats", "size in typical sizes", "visibility", "probability"}, "th");
    for (const attribution::JudgedCandidate& each : best_of_each(round.ladder)) {
      text += row({each.candidate.id, fmt::format("{:.1f}", each.gain_nats), fmt::format("{:.2f}", each.size_share),
                   fmt::format("{:.3f}", each.visibility_ratio), fmt::format("{:.0f} %", 100.0 * each.probability)});
    }
    text += round.ladder.empty() ? row({"no effect of the catalogue makes the runs more probable", "", "", "", ""}) : "";
    for (const attribution::ScanResult& each : round.scan) {
      const std::string& regressor = diagnosis.selection.regressors[static_cast<std::size_t>(each.term.regressor)].name;
      text += row({fmt::format("curve over {} × {} at {}{}", regressor, attribution::spec_of(each.term.multiplier).name, each.term.node,
                               each.term.other.empty() ? "" : "→" + each.term.other),
                   fmt::format("{:.1f}", each.gain_nats), fmt::format("{} W mean", base::significant(each.mean_W, 2)), "", ""});
    }
    text += "</table>\n" + fmt::format("<p>{}</p>\n", base::xml_text(outcome_of(round)));
  }
  return text;
}

std::string balance_table(const diagnosis::Diagnosis& diagnosis) {
  std::string text = "<table>" + row({"effect", "mean heat into nodes / W (training runs)"}, "th");
  std::map<std::string, double> kept_W;
  for (const diagnosis::BalanceRow& each : diagnosis.balance) {
    std::string heats;
    for (const auto& [node, heat_W] : each.heat_W) {
      heats += fmt::format("{}{} {:+.3g}", heats.empty() ? "" : ", ", node, heat_W);
    }
    text += row({each.effect, heats.empty() ? "none in these runs" : heats});
    for (const auto& [node, heat_W] : each.heat_W) {
      kept_W[node] += heat_W;
    }
  }
  std::string kept;
  for (const auto& [node, heat_W] : kept_W) {
    kept += node == thermal::Network::kAmbient ? "" : fmt::format("{}{} {:+.3g}", kept.empty() ? "" : ", ", node, heat_W);
  }
  text += row({"sum: net heat into the node", kept});
  return text + "</table>\n";
}

/// Describes deviations of the innovations from white noise of the assumed variance, and what they mean for the results.
std::string tests_in_words(const std::vector<estimation::InnovationTests>& tests) {
  constexpr double kWhite_probability = 0.01;
  constexpr double kLow_ratio = 0.7, kHigh_ratio = 1.4;
  std::string words;
  for (const estimation::InnovationTests& test : tests) {
    if (test.ljung_box_probability < kWhite_probability || test.periodogram_ratio > 1.0) {
      words += fmt::format(" The residual of {} is correlated from one second to the next: its intervals are too narrow.", test.signal);
    }
    if (test.variance_ratio < kLow_ratio || test.variance_ratio > kHigh_ratio) {
      words +=
          fmt::format(" The noise of {} is {} than assumed for its log.", test.signal, test.variance_ratio < 1.0 ? "smaller" : "larger");
    }
  }
  return words.empty() ? "" : "<p>" + words.substr(1) + "</p>\n";
}

std::string test_table(const diagnosis::Diagnosis& diagnosis) {
  std::string text = "<table>" + row({"innovations of", "model", "variance (1 is right)", "Ljung-Box p (40 lags)",
                                      "cumulated periodogram / band (below 1 is white)", "kurtosis / normal", "correlated with"},
                                     "th");
  const auto add = [&](const std::vector<estimation::InnovationTests>& tests, const char* model) {
    for (const estimation::InnovationTests& test : tests) {
      std::string inputs;
      for (const auto& [name, correlation] : test.correlated_with) {
        inputs += fmt::format("{}{} ({:+.3f})", inputs.empty() ? "" : ", ", name, correlation);
      }
      text += row({test.signal, model, fmt::format("{:.2f}", test.variance_ratio), fmt::format("{:.2g}", test.ljung_box_probability),
                   fmt::format("{:.2f}", test.periodogram_ratio), fmt::format("{:.2f}", test.kurtosis_ratio),
                   inputs.empty() ? "none" : inputs});
    }
  };
  add(diagnosis.tests_before, "before");
  add(diagnosis.tests_after, "after");
  return text + "</table>\n" + tests_in_words(diagnosis.tests_after);
}

/// Returns the names of the runs, with times if another part of the same recording is in `others`.
std::vector<std::string> names_of(const std::vector<estimation::MeasuredRun>& runs, const std::vector<estimation::MeasuredRun>& others) {
  std::vector<std::string> names;
  for (const estimation::MeasuredRun& run : runs) {
    const bool is_split = std::ranges::find(others, run.name, &estimation::MeasuredRun::name) != others.end();
    names.push_back(is_split ? fmt::format("{} ({:.0f} to {:.0f} s)", run.name, run.time_s.front(), run.time_s.back()) : run.name);
  }
  return names;
}

/// Groups the effects by the signals that they lack, one remark per group.
std::vector<std::string> by_reason(const std::vector<attribution::UntestedEffect>& untested) {
  std::map<std::string, std::vector<std::string>> effects;
  for (const attribution::UntestedEffect& each : untested) {
    effects[untested_words(each)].push_back(each.effect);
  }
  std::vector<std::string> remarks;
  for (const auto& [reason, names] : effects) {
    remarks.push_back(fmt::format("{}: {} cannot be judged", reason, fmt::join(names, ", ")));
  }
  return remarks;
}

std::string_view heading_of(diagnosis::DiagnosisVerdict verdict) {
  switch (verdict) {
    case diagnosis::DiagnosisVerdict::effect_found:
      return "an effect is missing in the model";
    case diagnosis::DiagnosisVerdict::nothing_missing:
      return "nothing is missing in the model";
    case diagnosis::DiagnosisVerdict::unexplained:
      return "heat that no effect of the catalogue explains";
    case diagnosis::DiagnosisVerdict::not_identifiable:
      return "these runs do not determine it";
  }
  return "";
}

constexpr std::string_view kStyle =
    "body{font:15px/1.5 system-ui,sans-serif;max-width:1080px;margin:2em auto;padding:0 1em;color:#222}"
    "table{border-collapse:collapse;margin:1em 0;font-size:13px;display:block;max-width:100%;overflow-x:auto}td,th{border:1px solid "
    "#ccc;padding:3px 8px;text-align:left}"
    "th{background:#f2f2f2}figure{margin:1em "
    "0}svg{max-width:100%;height:auto}div.words{font-size:17px;background:#f7f7f2;padding:1em;border-left:4px solid "
    "#c8102e}";

}  // namespace

std::string diagnosis_page(const diagnosis::DiagnosisAnswer& answer, std::span<const recording::LogReading> readings,
                           const std::vector<std::pair<std::string, std::string>>& svg) {
  const auto& [input, diagnosis, score, motor, band, admission, findings] = answer;
  std::string text = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Diagnosis</title><style>{}</style></head><body>\n", kStyle);
  text += fmt::format("<h1>Diagnosis: {}</h1>\n<div class=\"words\">\n", heading_of(diagnosis.verdict));
  for (const std::string& each : diagnosis_words(answer)) {
    text += fmt::format("<p>{}</p>\n", base::xml_text(each));
  }
  text += "</div>\n";
  const std::vector<std::string> train = names_of(input.train, score.runs);
  const std::vector<std::string> holdout = names_of(score.runs, input.train);
  text += fmt::format("<p>Fitted to {}. Hold-out runs: {}.</p>\n", base::xml_text(fmt::format("{}", fmt::join(train, ", "))),
                      holdout.empty() ? "none" : base::xml_text(fmt::format("{}", fmt::join(holdout, ", "))));
  text +=
      "<h2>Error before and after</h2><p>The model runs freely from the first measured temperatures. After the diagnosis, training errors "
      "are those of the extended model, and hold-out errors are those of the written motor file, without effects that are only notes.</p>" +
      error_table(diagnosis, score);
  if (!diagnosis.effects.empty()) {
    text += "<h2>Effects added</h2>" + added_effects(diagnosis);
  }
  for (const auto& [name, picture] : svg) {
    const std::size_t begin = picture.find("<svg");
    // Removes the XML header; each picture has its own title.
    text += fmt::format("<figure id=\"{}\">\n{}\n</figure>\n", base::xml_text(name),
                        begin == std::string::npos ? picture : picture.substr(begin));
  }
  text +=
      fmt::format(
          "<h2>Evidence ladder</h2><p>Each candidate alone: its gain in evidence over the model without any candidate, averaged over the "
          "probable unknown heat. Its probability is that of all sets of effects that contain it; a name needs {:.0f} % for all effects of "
          "one kind together. Visibility is the share of an effect that no change of the model's own parameters can imitate.</p>",
          100.0 * estimation::named_probability()) +
      ladder_table(diagnosis);
  text += "<h2>Power balance</h2>" + balance_table(diagnosis);
  text += "<h2>Residual tests</h2>" + test_table(diagnosis);
  if (!diagnosis.experiments.empty()) {
    text += "<h2>Next experiment</h2><ul>";
    for (const diagnosis::Experiment& each : diagnosis.experiments) {
      text += fmt::format("<li>To separate {}: {}{}</li>", base::xml_text(rivals_of(each)), base::xml_text(experiment_words(each)),
                          each.expected_nats ? fmt::format(" (expected to add {:.0f} nats)", *each.expected_nats) : "");
    }
    text += "</ul>\n";
  }
  std::vector<std::string> warnings, remarks;
  for (Note& each : diagnosis_notes(answer, readings)) {
    (each.severity == Severity::warning ? warnings : remarks).push_back(std::move(each.words));
  }
  if (!diagnosis.selection.unseen.empty()) {
    remarks.push_back(
        fmt::format("at their usual size these would not show in these runs: {}", fmt::join(diagnosis.selection.unseen, ", ")));
  }
  std::ranges::move(refusal_words(diagnosis.selection), std::back_inserter(remarks));
  std::ranges::move(by_reason(diagnosis.selection.not_judged), std::back_inserter(remarks));
  text += "<h2>Effects not tested, and assumptions</h2><ul>";
  for (const std::string& warning : warnings) {
    text += "<li><strong>Warning:</strong> " + base::xml_text(warning) + "</li>";
  }
  for (const std::string& remark : remarks) {
    text += "<li>" + base::xml_text(remark) + "</li>";
  }
  return text + "</ul></body></html>\n";
}

}  // namespace heatsoak::present
