#include "attribution/terms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "attribution/curve.h"
#include "attribution/rules.h"

namespace heatsoak::attribution {
namespace {

/// Prior standard deviation of a size, in typical sizes.
constexpr double kSizeSpread_share = SelectionRules{}.size_sd;
/// Prior standard deviation of the logarithm of a shape parameter.
constexpr double kShapeSpread = 0.3;
/// Prior standard deviation of the first and last knot of a curve over a temperature, in gaps between knots.
constexpr double kKnotSpread = 0.5;
/// Prior standard deviation of the logarithm for an effect with a body: its capacity may be almost anything.
constexpr double kBodySpread = 1.0;

/// Returns the text as a valid name in a motor file.
std::string as_word(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return std::isalnum(c) != 0 ? static_cast<char>(std::tolower(c)) : '_'; });
  return text;
}

std::string unused_name(const thermal::Network& network, const std::string& wanted) {
  std::string name = wanted;
  const auto is_used = [&] {
    return std::ranges::any_of(network.effects(), [&](const thermal::EffectInPlace& e) { return e.name == name; });
  };
  for (int number = 2; is_used(); ++number) {
    name = fmt::format("{}_{}", wanted, number);
  }
  return name;
}

/// Adds the effect. The present values of the model's parameters are kept.
const thermal::EffectInPlace& add(estimation::Model& model, const std::string& name, const thermal::EffectType& type,
                                  const std::vector<std::string>& nodes, const std::vector<double>& parameters) {
  model.network.add_effect(unused_name(model.network, name), type, nodes, parameters);
  const std::vector<double> all = model.network.values();
  model.values.insert(model.values.end(), all.begin() + static_cast<std::ptrdiff_t>(model.values.size()), all.end());
  return model.network.effects().back();
}

/// Frees a parameter with a prior mean of 0.
void set_free_around_zero(estimation::Model& model, int place, double scale, const base::Range& range, double spread) {
  model.set_free({.place = place, .by_log = false, .scale = scale, .low = range.low, .high = range.high}, spread);
  model.prior.mean[model.network_count() - 1] = 0.0;
}

std::optional<double> choice_value(const base::ParameterSpec& spec, std::string_view name) {
  const auto found = std::ranges::find(spec.choices, name, &base::Choice::name);
  return found == spec.choices.end() ? std::nullopt : std::optional(static_cast<double>(found - spec.choices.begin()));
}

/// Returns the curve without negative values, because losses and conductances cannot be negative. The constant part of a conductance
/// belongs to the base network and is subtracted.
Eigen::VectorXd passive(const ScanResult& curve) {
  const double shift = spec_of(curve.term.multiplier).is_conductance ? curve.curve.minCoeff() : 0.0;
  return (curve.curve.array() - shift).cwiseMax(0.0);
}

}  // namespace

estimation::Model with_candidate(const estimation::Model& model, const Candidate& candidate, double size_share, ShapesAre shapes) {
  estimation::Model out = model;
  if (candidate.sensor_type) {
    const base::Range& faults = candidate.sensor_type->size.range;
    out.sensors.push_back({candidate.sensor_type, std::clamp(size_share * candidate.typical_size(), faults.low, faults.high),
                           kSizeSpread_share * candidate.typical_size()});
    return out;
  }
  if (candidate.deviation_type) {
    const base::Range& deviations = candidate.deviation_type->size.range;
    out.deviations.push_back({candidate.deviation_type, candidate.condition,
                              std::clamp(size_share * candidate.typical_size(), deviations.low, deviations.high),
                              kSizeSpread_share * candidate.typical_size()});
    return out;
  }
  std::vector<double> parameters = candidate.parameters;
  const base::Range& range = candidate.size_spec().range;
  double& size = parameters[static_cast<std::size_t>(candidate.size_parameter())];
  size = std::clamp(size_share * size, range.low, range.high);
  bool brings_body = false;
  for (const thermal::NodeRole& role : candidate.type->nodes) {
    brings_body = brings_body || role.own_capacity.has_value();
    if (role.own_capacity) {
      parameters[static_cast<std::size_t>(*role.own_capacity)] *= std::max(0.05, size_share);
    }
  }
  const thermal::EffectInPlace effect = add(out, std::string(candidate.type->name), *candidate.type, candidate.nodes, parameters);
  for (std::size_t p = 0; shapes == ShapesAre::free && p < parameters.size(); ++p) {
    const base::ParameterSpec& spec = candidate.type->parameters[p];
    if (static_cast<int>(p) != candidate.size_parameter() && spec.choices.empty() && parameters[p] > 0.0 && spec.range.low >= 0.0) {
      // Exponents, thresholds and capacities have a prior around the typical value.
      out.set_free({.place = effect.parameter_index[p],
                    .by_log = true,
                    .scale = 1.0,
                    .low = std::max(spec.range.low, parameters[p] / 20.0),
                    .high = std::min(spec.range.high, parameters[p] * 20.0)},
                   brings_body ? kBodySpread : kShapeSpread);
    }
  }
  set_free_around_zero(out, effect.parameter_index[static_cast<std::size_t>(candidate.size_parameter())], candidate.typical_size(), range,
                       kSizeSpread_share);
  if (!candidate.condition.empty()) {
    out.conditional.push_back(
        {effect.name, effect.parameter_index[static_cast<std::size_t>(candidate.size_parameter())], 0.0, candidate.condition});
  }
  return out;
}

Eigen::Index size_coordinate(const estimation::Model& model, const Candidate& candidate, std::string_view effect_name) {
  if (candidate.sensor_type) {
    return model.network_count() +
           (std::ranges::find(model.sensors, candidate.sensor_type, &estimation::SensorTerm::type) - model.sensors.begin());
  }
  if (candidate.deviation_type) {
    const auto is_own = [&](const estimation::RunDeviation& each) { return each.is_same(candidate.deviation_type, candidate.condition); };
    return model.first_deviation() + (std::ranges::find_if(model.deviations, is_own) - model.deviations.begin());
  }
  const auto effect = std::ranges::find(model.network.effects(), effect_name, &thermal::EffectInPlace::name);
  const int place = effect->parameter_index[static_cast<std::size_t>(candidate.size_parameter())];
  return std::ranges::find(model.free, place, &estimation::FreeParameter::place) - model.free.begin();
}

std::optional<estimation::Model> with_curve(const estimation::Model& model, const ScanResult& curve, const Regressor& regressor) {
  if (regressor.choice.empty()) {
    return std::nullopt;
  }
  const thermal::EffectType& type = *thermal::find_effect("tabulated");
  const std::optional<double> form = choice_value(type.parameters[1], spec_of(curve.term.multiplier).form);
  estimation::Model out = model;
  std::string_view signal_choice = regressor.choice;
  if (regressor.choice == thermal::kColumnChoice) {
    const auto place = static_cast<std::size_t>(std::ranges::find(out.columns, regressor.name) - out.columns.begin());
    if (place == thermal::kLogColumns) {
      return std::nullopt;
    }
    out.columns.resize(std::max(out.columns.size(), place + 1), regressor.name);
    signal_choice = thermal::kColumnChoices[place];
  }
  const std::optional<double> choice = choice_value(type.parameters[0], signal_choice);
  if (!choice || !form) {
    return std::nullopt;
  }
  const Eigen::VectorXd values = passive(curve);
  const std::string ambient(thermal::Network::kAmbient);
  const std::string cold = curve.term.other.empty() ? ambient : curve.term.other;
  const std::string watched = regressor.watched.empty() ? curve.term.node : regressor.watched;
  const std::string reference = regressor.reference.empty() ? ambient : regressor.reference;
  std::vector<double> parameters{*choice, *form, curve.knots.front(), curve.knots.back()};
  parameters.insert(parameters.end(), values.begin(), values.end());
  const thermal::EffectInPlace effect = add(out, as_word(fmt::format("unnamed_{}_with_{}", curve.term.node, regressor.name)), type,
                                            {curve.term.node, cold, watched, reference}, parameters);
  const double gap = (curve.knots.back() - curve.knots.front()) / static_cast<double>(values.size() - 1);
  for (const std::size_t end : {2U, 3U}) {
    // The scan used measured temperatures with noise and sensor errors, so the knots may be off.
    if (regressor.kind == RegressorKind::node_temperature) {
      const double knot = parameters[end];
      out.set_free({.place = effect.parameter_index[end], .by_log = false, .scale = gap, .low = knot - 2.0 * gap, .high = knot + 2.0 * gap},
                   kKnotSpread);
    }
  }
  for (Eigen::Index knot = 0; knot < values.size(); ++knot) {
    set_free_around_zero(out, effect.parameter_index[static_cast<std::size_t>(4 + knot)], curve.usual, base::Range::non_negative(), 1.0);
  }
  out.prior.precision.bottomRightCorner(values.size(), values.size()) = curve_precision(values.size(), {});
  return out;
}

estimation::Model with_values_of(estimation::Model model, const estimation::Model& other) {
  const std::span<const thermal::NetworkParameter> names = model.network.parameters();
  const std::span<const thermal::NetworkParameter> others = other.network.parameters();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto found = std::ranges::find(others, names[i].name, &thermal::NetworkParameter::name);
    if (found != others.end()) {
      model.values[i] = other.values[static_cast<std::size_t>(found - others.begin())];
    }
  }
  for (estimation::SensorTerm& term : model.sensors) {
    const auto found = std::ranges::find(other.sensors, term.type, &estimation::SensorTerm::type);
    term.value = found != other.sensors.end() ? found->value : term.value;
  }
  for (estimation::RunDeviation& each : model.deviations) {
    const auto found = std::ranges::find_if(
        other.deviations, [&](const estimation::RunDeviation& of_other) { return of_other.is_same(each.type, each.condition); });
    each.deviation_share = found != other.deviations.end() ? found->deviation_share : each.deviation_share;
  }
  return model;
}

}  // namespace heatsoak::attribution
