#include "diagnosis/found_effects.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "attribution/terms.h"
#include "diagnosis/heat_of_effects.h"
#include "estimation/interval.h"

namespace heatsoak::diagnosis {
namespace {

class EffectReport {
 public:
  EffectReport(const attribution::Selection& selection, const std::vector<estimation::MeasuredRun>& runs)
      : selection_(selection), runs_(runs) {}

  FoundEffect found(const attribution::AcceptedTerm& term) const {
    FoundEffect effect;
    effect.name = term.effect_name;
    effect.probability = term.probability;
    effect.gain_nats = term.loss_without_nats;
    effect.delta_bic = -2.0 * term.loss_without_nats;
    effect.p_value = p_of(term.loss_without_nats);
    effect.visibility_ratio = term.visibility_ratio;
    effect.confusable_with = term.confusable_with;
    if (term.candidate && term.candidate->sensor_type) {
      report_sensor(*term.candidate, effect);
      return effect;
    }
    if (term.candidate && term.candidate->deviation_type) {
      report_deviation(*term.candidate, effect);
      return effect;
    }
    const thermal::EffectInPlace& in_place = *effect_named(after().model.network, term.effect_name);
    effect.id = in_place.type->name;
    effect.node = after().model.network.node_name(in_place.node_index.front());
    effect.description = in_place.type->summary;
    effect.confounded_with = in_place.type->confounded_with;
    for (const estimation::ConditionalTerm& conditional : after().model.conditional) {
      if (conditional.effect_name == term.effect_name) {
        effect.condition = conditional.condition;
      }
    }
    if (term.curve) {
      effect.node = term.curve->term.node;
      effect.signals.push_back(selection_.regressors[static_cast<std::size_t>(term.curve->term.regressor)].name);
      if (const std::string_view second = attribution::spec_of(term.curve->term.multiplier).second_signal; !second.empty()) {
        effect.signals.emplace_back(second);
      }
      effect.is_from_catalogue = false;
    }
    report_parameters(in_place, effect);
    const HeatOfEffect heat = heat_of(
        after(), runs_, [&](const thermal::EffectInPlace& each) { return &each == &in_place; }, effect.condition);
    effect.mean_W = heat.mean_W;
    effect.peak_W = heat.peak_W;
    return effect;
  }

 private:
  void report_sensor(const attribution::Candidate& candidate, FoundEffect& effect) const {
    const motor::SensorEffectType& type = *candidate.sensor_type;
    effect.id = type.name;
    effect.has_heat = false;
    effect.node = type.signal.substr(0, type.signal.rfind('_'));
    effect.description = type.summary;
    effect.confounded_with = type.confounded_with;
    report_size(candidate, type.size, type.typical_size, type.size.range.low, effect);
  }

  /// Reports the size of a sensor error or a run deviation, its only parameter. `unit_size` is the size per unit of the coordinate.
  void report_size(const attribution::Candidate& candidate, const base::ParameterSpec& spec, double unit_size, double low,
                   FoundEffect& effect) const {
    const Eigen::Index own = attribution::size_coordinate(after().model, candidate, {});
    const double value = unit_size * after().model.theta()[own];
    const double sd = unit_size * std::sqrt(after().covariance(own, own));
    FittedParameter size{std::string(spec.key), std::string(spec.unit), value, std::max(value - estimation::kInterval_sd * sd, low),
                         value + estimation::kInterval_sd * sd};
    drop_interval_at_bound(own, size);
    effect.parameters.push_back(std::move(size));
  }

  void report_deviation(const attribution::Candidate& candidate, FoundEffect& effect) const {
    const estimation::RunDeviationType& type = *candidate.deviation_type;
    effect.id = type.name;
    effect.node = type.node;
    effect.condition = candidate.condition;
    effect.description = type.summary;
    effect.confounded_with = type.confounded_with;
    report_size(candidate, type.size, type.usual, std::max(-1.0, type.size.range.low), effect);
    const double value = effect.parameters.front().value;
    const thermal::Network& network = after().model.network;
    const HeatOfEffect heat = heat_of(
        after(), runs_, [&](const thermal::EffectInPlace& in_place) { return type.concerns(network, in_place); }, candidate.condition);
    effect.mean_W = std::abs(type.part_ratio(value)) * heat.mean_W;
    effect.peak_W = std::abs(type.part_ratio(value)) * heat.peak_W;
  }

  /// p-value of a likelihood ratio with one degree of freedom (Wilks 1938), from the evidence. It ignores that the effect was chosen
  /// among many; the probability does not. Tiny values end at the smallest normal number.
  static double p_of(double gain_nats) {
    return std::max(std::erfc(std::sqrt(std::max(0.0, gain_nats))), std::numeric_limits<double>::min());
  }

  void drop_interval_at_bound(Eigen::Index coordinate, FittedParameter& parameter) const {
    constexpr double kThere = 1e-6;
    const estimation::Model& model = after().model;
    const double theta = model.theta()[coordinate];
    if (theta < model.low(coordinate) + kThere && model.low(coordinate) == 0.0) {
      parameter.value = 0.0;
    }
    if (theta < model.low(coordinate) + kThere || theta > model.high(coordinate) - kThere) {
      parameter.is_at_bound = true;
      parameter.low = parameter.high = parameter.value;
    }
  }

  void report_parameters(const thermal::EffectInPlace& in_place, FoundEffect& effect) const {
    const estimation::Model& model = after().model;
    const Eigen::VectorXd theta = model.theta();
    std::vector<double> values;
    for (const int place : in_place.parameter_index) {
      values.push_back(model.values[static_cast<std::size_t>(place)]);
    }
    for (std::size_t p = 0; p < values.size(); ++p) {
      const base::ParameterSpec& spec = in_place.type->parameters[p];
      if (!spec.choices.empty()) {
        continue;
      }
      FittedParameter parameter{std::string(spec.key), std::string(base::unit_of(in_place.type->parameters, p, values)), values[p],
                                values[p], values[p]};
      for (Eigen::Index i = 0; i < model.network_count(); ++i) {
        if (model.free[static_cast<std::size_t>(i)].place == in_place.parameter_index[p]) {
          const double sd = std::sqrt(after().covariance(i, i));
          parameter.low = std::max(model.value_of(i, theta[i] - estimation::kInterval_sd * sd), spec.range.low);
          parameter.high = std::min(model.value_of(i, theta[i] + estimation::kInterval_sd * sd), spec.range.high);
          drop_interval_at_bound(i, parameter);
        }
      }
      effect.parameters.push_back(std::move(parameter));
    }
  }

  [[nodiscard]] const estimation::Posterior& after() const { return selection_.after; }

  const attribution::Selection& selection_;
  const std::vector<estimation::MeasuredRun>& runs_;
};

}  // namespace

const thermal::EffectInPlace* effect_named(const thermal::Network& network, const std::string& name) {
  const auto found = std::ranges::find(network.effects(), name, &thermal::EffectInPlace::name);
  return found == network.effects().end() ? nullptr : &*found;
}

FoundEffect found_effect(const attribution::AcceptedTerm& term, const attribution::Selection& selection,
                         const std::vector<estimation::MeasuredRun>& runs) {
  return EffectReport(selection, runs).found(term);
}

}  // namespace heatsoak::diagnosis
