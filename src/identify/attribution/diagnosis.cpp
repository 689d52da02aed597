#include "identify/attribution/diagnosis.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

#include "identify/attribution/advisor.h"
#include "identify/attribution/coverage.h"
#include "identify/attribution/terms.h"
#include "identify/interval.h"

namespace heatsoak {
namespace {

/// Unknown heat below this share of the heat that the model knows is what every model leaves.
constexpr double kTolerableUnknown_share = 0.03;

/// Runs in which fewer of the catalogue's effects would show at their usual size cannot say that nothing is missing.
constexpr double kLeastSeen_share = 0.5;

struct HeatOfEffect {
  double mean_W = 0.0;
  double peak_W = 0.0;
};

/// Heat of one effect along a run: effects × nodes per interval.
template <class Visit>
void along(const RefitResult& fit, const MeasuredRun& run, const LinearisedRun& path, const Visit& visit) {
  const Network& network = fit.model.model.network;
  const std::vector<double> values = fit.model.values_in(run);
  std::vector<double> heat_W(network.effects().size() * static_cast<std::size_t>(network.node_count()));
  for (std::size_t k = 0; k < run.at.size(); ++k) {
    const std::span<const double> state_C(path.state_C.col(static_cast<Eigen::Index>(k)).data(), static_cast<std::size_t>(path.states));
    network.balance_W(run.at[k], values, state_C, heat_W);
    visit(k, std::span<const double>(heat_W));
  }
}

class Teller {
 public:
  Teller(const DiagnosisInput& input, Selection selection) : input_(input) { out_.selection = std::move(selection); }

  Diagnosis tell() {
    for (const AcceptedTerm& term : out_.selection.terms) {
      out_.effects.push_back(found(term));
    }
    out_.runs = input_.train;
    tell_errors();
    tell_flux();
    tell_balance();
    out_.tests_before = tests_of(out_.selection.before);
    out_.tests_after = tests_of(out_.selection.after);
    tell_unexplained();
    out_.verdict = verdict();
    out_.experiments = next_experiments(out_.selection, input_.train);
    out_.beyond_training = beyond_fitted(input_.train, input_.holdout);
    out_.words = describe(out_);
    out_.description = fmt::format("{}", fmt::join(out_.words, " "));
    return std::move(out_);
  }

 private:
  [[nodiscard]] const RefitResult& after() const { return out_.selection.after; }

  [[nodiscard]] const EffectInPlace* effect_named(const std::string& name) const {
    for (const EffectInPlace& effect : after().model.model.network.effects()) {
      if (effect.name == name) {
        return &effect;
      }
    }
    return nullptr;
  }

  FoundEffect found(const AcceptedTerm& term) const {
    FoundEffect effect;
    effect.name = term.effect_name;
    effect.gain_nats = term.loss_without_nats;
    effect.delta_bic = -2.0 * term.loss_without_nats;
    effect.visibility_ratio = term.visibility_ratio;
    effect.confusable_with = term.confusable_with;
    if (term.candidate && term.candidate->sensor_type) {
      tell_sensor(*term.candidate->sensor_type, effect);
      return effect;
    }
    if (term.candidate && term.candidate->is_heat_share()) {
      tell_heat_share(*term.candidate, effect);
      return effect;
    }
    const EffectInPlace& in_place = *effect_named(term.effect_name);
    effect.id = in_place.type->name;
    effect.node = after().model.model.network.node_name(in_place.node_index.front());
    effect.description = in_place.type->summary;
    effect.look_alike = in_place.type->look_alike;
    for (const ConditionalTerm& conditional : after().model.conditional) {
      if (conditional.effect_name == term.effect_name) {
        effect.condition = conditional.condition;
      }
    }
    if (term.curve) {
      effect.node = term.curve->term.node;
      effect.drivers.push_back(out_.selection.drivers[static_cast<std::size_t>(term.curve->term.driver)].name);
      effect.is_from_catalogue = !effect.condition.empty();
    }
    tell_parameters(in_place, effect);
    const HeatOfEffect heat = heat_of([&](const EffectInPlace& each) { return &each == &in_place; }, effect.condition);
    effect.mean_W = heat.mean_W;
    effect.peak_W = heat.peak_W;
    return effect;
  }

  void tell_sensor(const SensorEffectType& type, FoundEffect& effect) const {
    effect.id = type.name;
    effect.has_heat = false;
    effect.node = type.signal.substr(0, type.signal.rfind('_'));
    effect.description = type.summary;
    effect.look_alike = type.look_alike;
    for (std::size_t i = 0; i < after().model.sensors.size(); ++i) {
      if (after().model.sensors[i].type == &type) {
        const auto own = after().model.model.free_count() + static_cast<Eigen::Index>(i);
        const double sd = type.typical_size * std::sqrt(after().covariance(own, own));
        const double value = after().model.sensors[i].value;
        FittedParameter size{std::string(type.size.key), std::string(type.size.unit), value,
                             std::max(value - kInterval_sd * sd, type.size.range.low), value + kInterval_sd * sd};
        drop_interval_at_bound(own, size);
        effect.parameters.push_back(std::move(size));
        effect.p_value = p_of(value, sd);
      }
    }
  }

  void tell_heat_share(const Candidate& candidate, FoundEffect& effect) const {
    const auto& terms = after().model.heat_shares;
    const auto place = std::ranges::find(terms, candidate.condition, &HeatShareTerm::condition) - terms.begin();
    const Eigen::Index own = after().model.first_heat_share() + place;
    const double value = terms[static_cast<std::size_t>(place)].deviation_share;
    const double sd = kUsualDeviation_share * std::sqrt(after().covariance(own, own));
    effect.id = "heat_share";
    effect.node = "winding";
    effect.condition = candidate.condition;
    effect.description =
        "More or less heat goes in than the log says: another phase carries the current, or the driver takes another share.";
    effect.parameters.push_back(
        {std::string(candidate.size_spec().key), "", value, std::max(value - kInterval_sd * sd, -1.0), value + kInterval_sd * sd});
    effect.p_value = p_of(value, sd);
    const HeatOfEffect heat = heat_of([](const EffectInPlace& in_place) { return is_heat_input(*in_place.type); }, candidate.condition);
    const double share = std::abs(value) / std::max(0.01, 1.0 + value);
    effect.mean_W = share * heat.mean_W;
    effect.peak_W = share * heat.peak_W;
  }

  static double p_of(double value, double sd) {
    return sd > 0.0 ? 2.0 * boost::math::cdf(boost::math::complement(boost::math::normal(), std::min(37.0, std::abs(value) / sd))) : 1.0;
  }

  void drop_interval_at_bound(Eigen::Index coordinate, FittedParameter& parameter) const {
    constexpr double kThere = 1e-6;
    const ExtendedModel& model = after().model;
    const double theta = model.theta()[coordinate];
    if (theta < model.low(coordinate) + kThere || theta > model.high(coordinate) - kThere) {
      parameter.is_at_bound = true;
      parameter.low = parameter.high = parameter.value;
    }
  }

  void tell_parameters(const EffectInPlace& in_place, FoundEffect& effect) const {
    const Model& model = after().model.model;
    const Eigen::VectorXd theta = model.theta();
    std::vector<double> values;
    for (const int place : in_place.parameter_index) {
      values.push_back(model.values[static_cast<std::size_t>(place)]);
    }
    for (std::size_t p = 0; p < values.size(); ++p) {
      const ParameterSpec& spec = in_place.type->parameters[p];
      if (!spec.choices.empty()) {
        continue;
      }
      FittedParameter parameter{std::string(spec.key), std::string(unit_of(in_place.type->parameters, p, values)), values[p], values[p],
                                values[p]};
      for (Eigen::Index i = 0; i < model.free_count(); ++i) {
        if (model.free[static_cast<std::size_t>(i)].place == in_place.parameter_index[p]) {
          const double sd = std::sqrt(after().covariance(i, i));
          parameter.low = std::max(model.value_of(i, theta[i] - kInterval_sd * sd), spec.range.low);
          parameter.high = std::min(model.value_of(i, theta[i] + kInterval_sd * sd), spec.range.high);
          effect.p_value = std::min(effect.p_value, model.free[static_cast<std::size_t>(i)].by_log ? p_of(1.0, sd) : p_of(theta[i], sd));
          drop_interval_at_bound(i, parameter);
        }
      }
      effect.parameters.push_back(std::move(parameter));
    }
  }

  /// Into the first node of the effects that `counts` says, in runs of the condition.
  template <class Counts>
  [[nodiscard]] HeatOfEffect heat_of(const Counts& counts, const std::map<std::string, std::string>& condition) const {
    const auto nodes = static_cast<std::size_t>(after().model.model.network.node_count());
    std::vector<std::size_t> places;
    for (const EffectInPlace& in_place : after().model.model.network.effects()) {
      if (counts(in_place)) {
        const auto effect = static_cast<std::size_t>(&in_place - after().model.model.network.effects().data());
        places.push_back(effect * nodes + static_cast<std::size_t>(in_place.node_index.front()));
      }
    }
    std::vector<double> magnitude_W;
    HeatOfEffect out;
    double time_s = 0.0;
    for (std::size_t r = 0; r < input_.train.size(); ++r) {
      const MeasuredRun& run = input_.train[r];
      if (!has_condition(run, condition)) {
        continue;
      }
      along(after(), run, after().fitted[r], [&](std::size_t k, std::span<const double> heat_W) {
        const double duration_s = run.time_s[k + 1] - run.time_s[k];
        magnitude_W.push_back(0.0);
        for (const std::size_t place : places) {
          magnitude_W.back() += std::abs(heat_W[place]);
        }
        out.mean_W += duration_s * magnitude_W.back();
        time_s += duration_s;
      });
    }
    if (!magnitude_W.empty()) {
      out.mean_W /= time_s;
      const auto peak = magnitude_W.begin() + static_cast<std::ptrdiff_t>(magnitude_W.size() * 99 / 100);
      std::nth_element(magnitude_W.begin(), peak, magnitude_W.end());
      out.peak_W = *peak;
    }
    return out;
  }

  void tell_errors() {
    out_.before_train = open_loop_errors(input_.model, input_.train, {});
    out_.refitted_train = open_loop_errors(out_.selection.before.model, input_.train, {});
    out_.after_train = open_loop_errors(after().model, input_.train, {});
    out_.before_holdout = open_loop_errors(input_.model, input_.holdout, input_.train);
    out_.refitted_holdout = open_loop_errors(out_.selection.before.model, input_.holdout, input_.train);
    out_.after_holdout = open_loop_errors(after().model, input_.holdout, input_.train);
  }

  [[nodiscard]] LatentFlux flux_at(const RefitResult& fit) const { return out_.selection.grid.at(fit.place); }

  /// Smoothed unknown heat of every run: fluxes × samples.
  [[nodiscard]] std::vector<FluxEstimate> smoothed(const RefitResult& fit) const {
    std::vector<FluxEstimate> all;
    const std::vector<DesignRun> designs = design(fit.model.model.network, fit.fitted, input_.train, out_.selection.errors, {}, {});
    for (std::size_t r = 0; r < fit.fitted.size(); ++r) {
      all.push_back(Whitening(fit.fitted[r], flux_at(fit), designs[r].noise).smoothed_flux(fit.fitted[r].residual_K));
    }
    return all;
  }

  void tell_flux() {
    const std::vector<FluxEstimate> before = smoothed(out_.selection.before);
    const std::vector<FluxEstimate> now = smoothed(after());
    const std::vector<int>& nodes = input_.model.model.flux_nodes;
    std::map<std::string, double> counts;
    for (std::size_t r = 0; r < input_.train.size(); ++r) {
      for (std::size_t f = 0; f < nodes.size(); ++f) {
        const std::string node(input_.model.model.network.node_name(nodes[f]));
        const auto row = static_cast<Eigen::Index>(f);
        FluxTrace trace{input_.train[r].name, node, input_.train[r].time_s, {}, {}, {}};
        trace.before_W.assign(before[r].mean_W.row(row).begin(), before[r].mean_W.row(row).end());
        trace.after_W.assign(now[r].mean_W.row(row).begin(), now[r].mean_W.row(row).end());
        trace.after_sd_W.assign(now[r].sd_W.row(row).begin(), now[r].sd_W.row(row).end());
        out_.flux_rms_before_W[node] += before[r].mean_W.row(row).squaredNorm();
        out_.flux_rms_after_W[node] += now[r].mean_W.row(row).squaredNorm();
        counts[node] += static_cast<double>(before[r].mean_W.cols());
        out_.flux.push_back(std::move(trace));
      }
    }
    for (auto& [node, count] : counts) {
      out_.flux_rms_before_W[node] = std::sqrt(out_.flux_rms_before_W[node] / count);
      out_.flux_rms_after_W[node] = std::sqrt(out_.flux_rms_after_W[node] / count);
    }
  }

  void tell_balance() {
    const Network& network = after().model.model.network;
    const auto nodes = static_cast<std::size_t>(network.node_count());
    std::vector<double> energy_J(network.effects().size() * nodes, 0.0);
    double time_s = 0.0;
    for (std::size_t r = 0; r < input_.train.size(); ++r) {
      const MeasuredRun& run = input_.train[r];
      along(after(), run, after().fitted[r], [&](std::size_t k, std::span<const double> heat_W) {
        const double duration_s = run.time_s[k + 1] - run.time_s[k];
        time_s += duration_s;
        for (std::size_t i = 0; i < energy_J.size(); ++i) {
          energy_J[i] += duration_s * heat_W[i];
        }
      });
    }
    for (std::size_t e = 0; e < network.effects().size(); ++e) {
      BalanceRow row{network.effects()[e].name, {}};
      for (std::size_t n = 0; n < nodes; ++n) {
        if (energy_J[e * nodes + n] != 0.0) {
          row.heat_W[std::string(network.node_name(static_cast<int>(n)))] = energy_J[e * nodes + n] / time_s;
        }
      }
      out_.balance.push_back(std::move(row));
    }
  }

  [[nodiscard]] std::vector<InnovationTests> tests_of(const RefitResult& fit) const {
    std::map<std::string, Eigen::VectorXd> innovations;
    std::map<std::string, std::vector<NamedInput>> inputs;
    const std::vector<DesignRun> designs = design(fit.model.model.network, fit.fitted, input_.train, out_.selection.errors, {}, {});
    for (std::size_t r = 0; r < fit.fitted.size(); ++r) {
      const LinearisedRun& path = fit.fitted[r];
      const Eigen::VectorXd standardised = Whitening(path, flux_at(fit), designs[r].noise).innovations(path.residual_K).standardised;
      const Eigen::VectorXd& weight = out_.selection.errors.weights[r];
      for (Eigen::Index sensor = 0; sensor < path.sensors(); ++sensor) {
        const std::string& signal = input_.train[r].sensors[static_cast<std::size_t>(sensor)].signal;
        Eigen::VectorXd& all = innovations[signal];
        const Eigen::Index begin = all.size();
        all.conservativeResize(begin + path.samples());
        for (Eigen::Index k = 0; k < path.samples(); ++k) {
          const Eigen::Index row = k * path.sensors() + sensor;
          const bool counts = !std::isnan(path.residual_K[row]) && (weight.size() == 0 || weight[row] > 0.0);
          all[begin + k] = counts ? standardised[row] : std::nan("");
        }
        add_inputs(input_.train[r], inputs[signal]);
      }
    }
    std::vector<InnovationTests> tests;
    for (const auto& [signal, all] : innovations) {
      tests.push_back(test_innovations(signal, all, inputs[signal]));
    }
    return tests;
  }

  static void add_inputs(const MeasuredRun& run, std::vector<NamedInput>& inputs) {
    const auto add = [&](std::string_view name, Signal signal, auto value) {
      if (!run.has(signal)) {
        return;
      }
      auto found = std::ranges::find(inputs, name, &NamedInput::name);
      if (found == inputs.end()) {
        inputs.push_back({std::string(name), {}});
        found = inputs.end() - 1;
      }
      const Eigen::Index begin = found->values.size();
      found->values.conservativeResize(begin + run.samples());
      for (Eigen::Index k = 0; k < run.samples(); ++k) {
        found->values[begin + k] = value(run.at[static_cast<std::size_t>(std::min(k, run.samples() - 2))]);
      }
    };
    using Point = OperatingPoint<double>;
    add("current", Signal::current, [](const Point& at) { return at.current_rms_A; });
    add("speed", Signal::speed, [](const Point& at) { return at.speed_mean_rad_per_s; });
    add("input power", Signal::input_power, [](const Point& at) { return at.input_power_W; });
  }

  /// Curves that were found, curves that could not be put into the network, and heat that no signal follows.
  void tell_unexplained() {
    for (const AcceptedTerm& term : out_.selection.terms) {
      if (term.curve && out_.selection.drivers[static_cast<std::size_t>(term.curve->term.driver)].kind != DriverKind::run) {
        add_curve(*term.curve, term.confusable_with);
        tell_as_added(term, out_.unexplained.back());
      }
    }
    if (out_.selection.open_curve) {
      add_curve(*out_.selection.open_curve, {});
    }
    for (const auto& [node, rms_W] : out_.flux_rms_after_W) {
      if (rms_W > kTolerableUnknown_share * out_.selection.mean_heat_W && !is_told(node)) {
        if (const ScanResult* const refused = driver_of_what_was_refused(node)) {
          add_curve(*refused, {});
          continue;
        }
        Unexplained heat;
        heat.node = node;
        heat.rms_W = rms_W;
        for (const FluxTrace& trace : out_.flux) {
          if (trace.node == node) {
            for (const double each_W : trace.after_W) {
              heat.peak_W = std::max(heat.peak_W, std::abs(each_W));
              heat.mean_W += std::abs(each_W);
            }
          }
        }
        double count = 0.0;
        for (const FluxTrace& trace : out_.flux) {
          count += trace.node == node ? static_cast<double>(trace.after_W.size()) : 0.0;
        }
        heat.mean_W /= count;
        heat.time_scale_s = flux_at(after()).time_scale_s;
        out_.unexplained.push_back(std::move(heat));
      }
    }
  }

  /// A law that the base could stand for gets no name, but the signal that its heat goes with is known. Null where nothing was refused.
  [[nodiscard]] const ScanResult* driver_of_what_was_refused(const std::string& node) const {
    if (out_.selection.refused.empty() || out_.selection.rounds.empty()) {
      return nullptr;
    }
    // The round whose model is the one that is left.
    const Round& round = out_.selection.terms.empty() ? out_.selection.rounds.front() : out_.selection.rounds.back();
    const std::vector<ScanResult>& scan = round.scan;
    const auto found = std::ranges::find_if(
        scan, [&](const ScanResult& each) { return each.term.node == node && each.gain_nats >= SelectionRules{}.least_gain_nats; });
    return found == scan.end() ? nullptr : &*found;
  }

  /// The curve as the model has it, which is what physics leaves of the scan's.
  void tell_as_added(const AcceptedTerm& term, Unexplained& heat) const {
    const auto effect = std::ranges::find(out_.effects, term.effect_name, &FoundEffect::name);
    heat.is_in_model = true;
    heat.mean_W = heat.rms_W = effect->mean_W;
    heat.peak_W = effect->peak_W;
    const Model& model = after().model.model;
    const EffectInPlace& in_place = *effect_named(term.effect_name);
    const std::size_t first = in_place.parameter_index.size() - heat.curve.size();
    for (std::size_t knot = 0; knot < heat.curve.size(); ++knot) {
      const int place = in_place.parameter_index[first + knot];
      heat.curve[knot] = model.values[static_cast<std::size_t>(place)];
      const auto free = std::ranges::find(model.free, place, &FreeParameter::place);
      const Eigen::Index own = free - model.free.begin();
      heat.curve_sd[knot] = free == model.free.end() ? 0.0 : free->scale * std::sqrt(after().covariance(own, own));
    }
  }

  [[nodiscard]] bool is_told(const std::string& node) const {
    return std::ranges::any_of(out_.unexplained, [&](const Unexplained& each) { return each.node == node; });
  }

  void add_curve(const ScanResult& curve, const std::vector<std::string>& others) {
    const Driver& driver = out_.selection.drivers[static_cast<std::size_t>(curve.term.driver)];
    Unexplained heat;
    heat.node = curve.term.node;
    heat.drivers = {driver.name};
    heat.drivers.insert(heat.drivers.end(), others.begin(), others.end());
    heat.mean_W = curve.mean_W;
    heat.peak_W = curve.peak_W;
    heat.rms_W = curve.mean_W;
    heat.time_scale_s = flux_at(after()).time_scale_s;
    heat.gain_nats = curve.gain_nats;
    heat.knots = curve.knots;
    heat.curve.assign(curve.curve.begin(), curve.curve.end());
    for (Eigen::Index i = 0; i < curve.covariance.rows(); ++i) {
      heat.curve_sd.push_back(std::sqrt(curve.covariance(i, i)));
    }
    heat.curve_unit = unit_of(curve.term.multiplier);
    heat.driver_unit = driver.unit;
    out_.unexplained.push_back(std::move(heat));
  }

  [[nodiscard]] DiagnosisVerdict verdict() const {
    if (std::ranges::any_of(out_.effects, &FoundEffect::is_from_catalogue)) {
      return DiagnosisVerdict::effect_found;
    }
    if (!out_.unexplained.empty()) {
      return DiagnosisVerdict::unexplained;
    }
    const bool would_show = out_.selection.seen_share >= kLeastSeen_share;
    return out_.selection.refused.empty() && would_show ? DiagnosisVerdict::nothing_missing : DiagnosisVerdict::not_identifiable;
  }

  const DiagnosisInput& input_;
  Diagnosis out_;
};

}  // namespace

std::string_view to_string(DiagnosisVerdict verdict) {
  switch (verdict) {
    case DiagnosisVerdict::effect_found:
      return "effect_found";
    case DiagnosisVerdict::nothing_missing:
      return "nothing_missing";
    case DiagnosisVerdict::unexplained:
      return "unexplained";
    case DiagnosisVerdict::not_identifiable:
      return "not_identifiable";
  }
  return "?";
}

Diagnosis diagnose(const DiagnosisInput& input, const SelectionRules& rules) {
  return Teller(input, select_effects({input.model, input.train, input.free, true}, rules)).tell();
}

}  // namespace heatsoak
