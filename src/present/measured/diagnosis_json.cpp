#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/number_ranges.h"
#include "present/measured/diagnosis_output.h"
#include "present/measured/diagnosis_words.h"
#include "present/measured/prediction.h"

namespace heatsoak::present {
namespace {

/// NaN and infinity become null, because JSON cannot represent them.
Json errors_json(const estimation::Errors& errors) {
  Json json = Json::object();
  for (const auto& [signal, error] : errors) {
    json[signal] = {{"rmse_K", rounded(error.rmse_K, 4)}, {"max_abs_K", rounded(error.max_abs_K, 4)}};
  }
  return json;
}

Json errors_json(const std::vector<diagnosis::ErrorInRun>& worst, estimation::ErrorOfSignal diagnosis::ErrorInRun::*file) {
  estimation::Errors errors;
  for (const diagnosis::ErrorInRun& each : worst) {
    errors[each.signal] = each.*file;
  }
  return errors_json(errors);
}

Json runs_of_signals(const std::vector<diagnosis::ErrorInRun>& worst) {
  Json json = Json::object();
  for (const diagnosis::ErrorInRun& each : worst) {
    json[each.signal] = each.run;
  }
  return json;
}

/// Returns the names in the catalogue: "constant_heat" for "constant_heat@stator in run4".
std::vector<std::string> plain_ids(const std::vector<std::string>& candidates) {
  std::vector<std::string> ids;
  for (const std::string& candidate : candidates) {
    std::string id = candidate.substr(0, candidate.find_first_of("@ "));
    if (std::ranges::find(ids, id) == ids.end()) {
      ids.push_back(std::move(id));
    }
  }
  return ids;
}

Json effect_json(const diagnosis::FoundEffect& effect) {
  Json parameters = Json::array();
  for (const diagnosis::FittedParameter& parameter : effect.parameters) {
    const bool is_fitted = parameter.low < parameter.high;
    parameters.push_back({{"name", parameter.name},
                          {"value", parameter.value},
                          {"unit", parameter.unit},
                          {"ci95", {parameter.low, parameter.high}},
                          {"fitted", is_fitted}});
  }
  Json json{{"id", effect.id},
            {"name", effect.name.empty() ? effect.id : effect.name},
            {"node", effect.node},
            {"parameters", parameters},
            {"condition", effect.condition},
            {"same_conditions", effect.same_conditions},
            {"drivers", effect.signals},
            {"heat_W", {{"mean", rounded(effect.mean_W, 4)}, {"max", rounded(effect.peak_W, 4)}}},
            {"evidence",
             {{"delta_bic", rounded(effect.delta_bic, 2)},
              {"p_value", effect.p_value},
              {"nats", rounded(effect.gain_nats, 2)},
              {"probability", rounded(effect.probability, 4)}}},
            {"confusable_with", plain_ids(effect.confusable_with)},
            {"look_alike", effect.confounded_with}};
  if (effect.is_from_catalogue) {
    json["visibility"] = rounded(effect.visibility_ratio, 4);
  }
  return json;
}

Json tests_json(const std::vector<estimation::InnovationTests>& tests) {
  Json json = Json::object();
  for (const estimation::InnovationTests& test : tests) {
    Json correlated = Json::object();
    for (const auto& [name, correlation] : test.correlated_with) {
      correlated[name] = rounded(correlation, 4);
    }
    json[test.signal] = {{"samples", test.count},
                         {"variance_ratio", rounded(test.variance_ratio, 4)},
                         {"ljung_box_p", test.ljung_box_probability},
                         {"cumulated_periodogram_over_band", rounded(test.periodogram_ratio, 3)},
                         {"kurtosis_over_normal", rounded(test.kurtosis_ratio, 3)},
                         {"correlated_with", correlated}};
  }
  return json;
}

Json unexplained_json(const diagnosis::Unexplained& heat) {
  Json json{{"node", heat.node},
            {"drivers", heat.signals},
            {"heat_W", {{"mean", rounded(heat.mean_W, 4)}, {"max", rounded(heat.peak_W, 4)}}},
            {"time_scale_s", rounded(heat.time_scale_s, 1)},
            {"nats", rounded(heat.gain_nats, 2)},
            {"in_model", heat.is_in_model}};
  if (heat.signals.empty()) {
    json["heat_W"]["rms"] = rounded(heat.rms_W, 4);
    if (!heat.unconfirmed_signal.empty()) {
      json["unconfirmed_driver"] = heat.unconfirmed_signal;
    }
  }
  if (!heat.or_nodes.empty()) {
    json["or_nodes"] = heat.or_nodes;
  }
  const attribution::MultiplierSpec& factor = attribution::spec_of(heat.multiplier);
  if (!factor.second_signal.empty()) {
    json["drivers"].push_back(factor.second_signal);
    json["times"] = factor.second_signal;
  }
  if (!heat.knots.empty()) {
    json["curve"] = {{"driver", heat.knots}, {"driver_unit", heat.signal_unit},
                     {"value", heat.curve},  {"sd", heat.curve_sd},
                     {"unit", factor.unit},  {"form", factor.form}};
  }
  return json;
}

Json untested_json(const std::vector<attribution::UntestedEffect>& untested) {
  Json words = Json::array();
  for (const attribution::UntestedEffect& each : untested) {
    words.push_back(fmt::format("{}: {}", each.effect, untested_words(each)));
  }
  return words;
}

Json ladder_json(const attribution::Selection& selection) {
  Json rounds = Json::array();
  for (const attribution::Round& round : selection.rounds) {
    Json candidates = Json::array();
    for (const attribution::JudgedCandidate& each : round.ladder) {
      candidates.push_back({{"id", each.candidate.id},
                            {"variant", each.candidate.variant},
                            {"nats", rounded(each.gain_nats, 2)},
                            {"visibility", rounded(each.visibility_ratio, 4)},
                            {"probability", rounded(each.probability, 4)}});
    }
    Json curves = Json::array();
    for (const attribution::ScanResult& each : round.scan) {
      curves.push_back({{"node", each.term.node},
                        {"other", each.term.other},
                        {"driver", selection.regressors[static_cast<std::size_t>(each.term.regressor)].name},
                        {"per", attribution::spec_of(each.term.multiplier).name},
                        {"nats", rounded(each.gain_nats, 2)}});
    }
    rounds.push_back({{"effects", candidates}, {"curves", curves}, {"taken", round.taken}, {"taken_nats", rounded(round.taken_nats, 2)}});
  }
  return rounds;
}

}  // namespace

Json diagnosis_json(const diagnosis::DiagnosisAnswer& answer, std::span<const recording::LogReading> readings) {
  const diagnosis::Diagnosis& diagnosis = answer.diagnosis;
  const diagnosis::HoldoutScore& score = answer.score;
  Json json{{"schema", "heatsoak.diagnosis/1"}, {"verdict", diagnosis::to_string(diagnosis.verdict)}, {"effects", Json::array()}};
  for (const diagnosis::FoundEffect& effect : diagnosis.effects) {
    json["effects"].push_back(effect_json(effect));
  }
  const std::vector<diagnosis::ErrorInRun> train = diagnosis::worst_runs(diagnosis.train_errors);
  const std::vector<diagnosis::ErrorInRun> holdout = diagnosis::worst_runs(score.errors);
  using File = estimation::ErrorOfSignal diagnosis::ErrorInRun::*;
  for (const auto& [key, file] : {std::pair<const char*, File>{"before", &diagnosis::ErrorInRun::before},
                                  {"refitted", &diagnosis::ErrorInRun::refitted},
                                  {"after", &diagnosis::ErrorInRun::after},
                                  {"model_file", &diagnosis::ErrorInRun::file}}) {
    json[key] = {{"train", errors_json(train, file)}, {"holdout", errors_json(holdout, file)}};
  }
  json["train_run"] = runs_of_signals(train);
  json["holdout_run"] = runs_of_signals(holdout);
  json["forecast_band"] = nullptr;
  if (answer.band) {
    json["forecast_band"] = band_json(*answer.motor.fit->band);
    json["forecast_band"]["recordings"] = answer.band->recordings;
    for (const auto& [signal, width_K] : answer.band->half_width_K) {
      json["forecast_band"]["half_width_K"][signal] = rounded(width_K, 4);
    }
  }
  json["residual_tests"] = {{"before", tests_json(diagnosis.tests_before)}, {"after", tests_json(diagnosis.tests_after)}};
  json["description"] = fmt::format("{}", fmt::join(diagnosis_words(answer), " "));
  json["figures_contradicted"] = Json::array();
  for (const diagnosis::ChangedParameter& parameter : diagnosis.changed) {
    json["figures_contradicted"].push_back({{"name", parameter.name},
                                            {"unit", parameter.unit},
                                            {"before", parameter.before},
                                            {"value", parameter.value},
                                            {"ci95", {parameter.low, parameter.high}},
                                            {"nats", rounded(parameter.gain_nats, 2)}});
  }
  if (!diagnosis.unexplained.empty()) {
    json["unexplained"] = unexplained_json(*std::ranges::max_element(diagnosis.unexplained, {}, &diagnosis::Unexplained::mean_W));
    json["unexplained_all"] = Json::array();
    for (const diagnosis::Unexplained& heat : diagnosis.unexplained) {
      json["unexplained_all"].push_back(unexplained_json(heat));
    }
  }
  json["runs"] = {{"train", Json::array()}, {"holdout", Json::object()}};
  for (const estimation::MeasuredRun& run : answer.input.train) {
    json["runs"]["train"].push_back(
        {{"name", run.name}, {"error", errors_json(estimation::open_loop_errors(diagnosis.selection.after.model, {run}, {}))}});
  }
  json["runs"]["holdout"] = {
      {"before", runs_json(score.runs_before)}, {"refitted", runs_json(score.runs_refitted)}, {"after", runs_json(score.runs_after)}};
  json["ladder"] = ladder_json(diagnosis.selection);
  json["refused"] = refusal_words(diagnosis.selection);
  json["would_not_show"] = diagnosis.selection.unseen;
  json["not_judged"] = untested_json(diagnosis.selection.not_judged);
  json["unknown_heat_rms_W"] = {{"before", diagnosis.flux_rms_before_W}, {"after", diagnosis.flux_rms_after_W}};
  json["unknown_heat_net_ratio"] = rounded(diagnosis::net_share(diagnosis.flux), 3);
  json["power_balance_W"] = Json::object();
  for (const diagnosis::BalanceRow& row : diagnosis.balance) {
    json["power_balance_W"][row.effect] = row.heat_W;
  }
  json["next_experiments"] = Json::array();
  for (const diagnosis::Experiment& each : diagnosis.experiments) {
    json["next_experiments"].push_back(
        {{"tells", rivals_of(each)}, {"what", experiment_words(each)}, {"expected_nats", rounded(each.expected_nats.value_or(0.0), 1)}});
  }
  add_notes(json, diagnosis_notes(answer, readings));
  return base::with_ranges(std::move(json), {{"rmse_K", base::kNotNegative},
                                             {"max_abs_K", base::kNotNegative},
                                             {"coverage_90", base::kShare},
                                             {"probability", base::kShare},
                                             {"p_value", base::kShare},
                                             {"ljung_box_p", base::kShare},
                                             {"unknown_heat_winding_share", base::kNotNegative},
                                             {"unknown_heat_stator_share", base::kNotNegative},
                                             {"unknown_heat_rms_W", base::kNotNegative},
                                             {"unknown_heat_net_ratio", base::Range::between(-1.0, 1.0)},
                                             {"half_width_K", base::kNotNegative},
                                             {"time_scale_s", base::kNotNegative}});
}

}  // namespace heatsoak::present
