#include "calibration/forecast/forecast_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "calibration/unlogged_speed.h"
#include "thermal/reference_point.h"

namespace heatsoak::calibration {
namespace {

/// Prior standard deviations of logarithms. kContact_sd corresponds to 0.5 for the whole conductance, of which half varies.
constexpr double kContact_sd = 1.0;
constexpr double kShape_sd = 0.7;
constexpr double kLoose_sd = 1.0;
/// For the winding's share of the remaining loss, and for the factor on the remaining loss.
constexpr double kWindingShare_sd = 0.5;
constexpr double kRemainder_sd = 0.1;
/// Linearised radiation coefficient 4·σ·T³ at 320 K.
constexpr double kRadiation_W_per_m2_K = 7.432;

bool all_have(std::span<const recording::Recording> recordings, thermal::Signal signal) {
  return std::ranges::all_of(recordings, [&](const recording::Recording& each) { return estimation::has_signal(each, signal); });
}

base::ParameterValue held(double value) {
  base::ParameterValue parameter;
  parameter.value = value;
  parameter.derivation = "held by the fit";
  return parameter;
}

/// Free parameter with prior standard deviation `sd` of its logarithm. The range follows from prior_sd_of() for the origin "estimated".
base::ParameterValue free_parameter(double value, double sd) {
  base::ParameterValue parameter = held(value);
  parameter.derivation = "start of the fit";
  parameter.spread = base::Spread{base::Spread::Kind::range, value * std::exp(-sd), value * std::exp(sd), true};
  return parameter;
}

motor::MotorEffect effect(std::string name, std::string_view type, std::vector<std::string> nodes,
                          std::vector<base::ParameterValue> parameters) {
  return {std::move(name), thermal::find_effect(type), std::move(nodes), std::move(parameters), {}, {}};
}

/// Lists the possible extensions.
class Listing {
 public:
  Listing(const ForecastSetup& setup, const ForecastModel& model, const Eigen::VectorXd& theta,
          std::span<const estimation::MeasuredRun> runs)
      : setup_(setup), model_(model), runs_(runs), values_(model.values_in(runs.front(), theta, 0.0)) {}

  std::vector<Extension> list() {
    const double across_W_per_K = 1.0 / value("winding_stator.thermal_resistance");
    const double out_W_per_K = 1.0 / value("stator_ambient.thermal_resistance");
    contact(across_W_per_K);
    lag("sensor_lag_winding");
    lag("sensor_lag_stator");
    cooling(out_W_per_K);
    third_nodes(across_W_per_K, out_W_per_K);
    heat_split();
    speed_losses();
    return std::move(all_);
  }

 private:
  [[nodiscard]] double value(std::string_view parameter) const {
    const auto all = model_.network().parameters();
    return values_[static_cast<std::size_t>(std::ranges::find(all, parameter, &thermal::NetworkParameter::name) - all.begin())];
  }
  [[nodiscard]] bool has(std::string_view effect) const {
    return std::ranges::find(setup_.motor.effects, effect, &motor::MotorEffect::name) != setup_.motor.effects.end();
  }
  void add(motor::MotorEffect effect) {
    if (has(effect.name)) {
      return;
    }
    const auto free = static_cast<int>(
        std::ranges::count_if(effect.parameters, [](const base::ParameterValue& each) { return each.spread.has_value(); }));
    const std::string name = effect.name == "contact_law"
                                 ? fmt::format("contact_law_of_{}{}{}", effect.parameters[1].spread ? "mean" : "",
                                               effect.parameters[1].spread && effect.parameters[2].spread ? "_and_" : "",
                                               effect.parameters[2].spread ? "difference" : "")
                                 : effect.name;
    all_.push_back({name, {std::move(effect)}, {}, free, {}});
  }

  /// Replaces half of the winding-stator conductance by one that varies with temperature.
  void contact(double conductance_W_per_K) {
    constexpr double kVaries_share = 0.5;
    for (const auto& [by_mean, by_difference] : {std::pair(true, false), std::pair(false, true), std::pair(true, true)}) {
      const auto ratio = [](bool is_free) { return is_free ? free_parameter(1.0, kContact_sd) : held(1.0); };
      const std::size_t before = all_.size();
      add(effect("contact_law", "contact_law", {"winding", "stator"},
                 {free_parameter(kVaries_share * conductance_W_per_K, kShape_sd), ratio(by_mean), ratio(by_difference)}));
      if (all_.size() > before) {
        all_.back().start_ratio = {{"winding_stator.thermal_resistance", 1.0 / (1.0 - kVaries_share)}};
      }
    }
  }

  void lag(std::string_view name) {
    constexpr double kUsual_s = 3.0;
    const motor::SensorEffectType* const type = motor::find_sensor_effect(name);
    const bool is_stated = std::ranges::any_of(setup_.motor.sensors, [&](const motor::MotorSensor& each) { return each.type == type; }) ||
                           std::ranges::any_of(setup_.faults, [&](const FreeFault& each) { return each.type == type; });
    const bool is_shown = std::ranges::any_of(runs_, [&](const estimation::MeasuredRun& run) {
      return std::ranges::find(run.sensors, type->signal, &estimation::Sensor::signal) != run.sensors.end();
    });
    if (!is_stated && is_shown) {
      all_.push_back({std::string(name), {}, {{type, kUsual_s, kLoose_sd}}, 1, {}});
    }
  }

  void cooling(double out_W_per_K) {
    add(effect("natural_convection", "natural_convection", {"stator", "ambient"},
               {free_parameter(0.3 * out_W_per_K, kLoose_sd), held(0.25)}));
    add(effect("radiation", "radiation", {"stator", "ambient"}, {free_parameter(0.2 * out_W_per_K / kRadiation_W_per_m2_K, kLoose_sd)}));
    add(effect("winding_to_air", "conduction", {"winding", "ambient"}, {free_parameter(10.0 / out_W_per_K, kLoose_sd)}));
  }

  void third_nodes(double across_W_per_K, double out_W_per_K) {
    const auto body = [&](const char* node, double conductance_W_per_K, double capacity_J_per_K) {
      const std::string name = fmt::format("body_at_{}", node);
      add(effect(name, "third_node", {node, name, "ambient"},
                 {free_parameter(conductance_W_per_K, kShape_sd), held(0.0), free_parameter(capacity_J_per_K, kShape_sd)}));
    };
    body("winding", across_W_per_K, 0.5 * value("winding.heat_capacity"));
    body("stator", std::max(3.0 * out_W_per_K, 0.3 * across_W_per_K), 0.5 * value("stator.heat_capacity"));
  }

  void heat_split() {
    constexpr double kElsewhere_share = 0.1;
    if (setup_.heat == HeatInput::input_power) {
      add(effect("input_power_at_stator", "input_power_loss", {"stator"}, {free_parameter(kElsewhere_share, kShape_sd)}));
    } else {
      add(effect("connection_resistance", "connection_resistance", {"stator"},
                 {free_parameter(kElsewhere_share * value("copper_loss.terminal_resistance"), kShape_sd)}));
    }
  }

  void speed_losses() {
    constexpr double kGuess_share = 0.05;
    double squares = 0.0;
    double time_s = 0.0;
    double heat_W = 0.0;
    for (const estimation::MeasuredRun& run : runs_) {
      if (!run.has(thermal::Signal::speed)) {
        return;
      }
      const Eigen::MatrixXd state_C = Eigen::MatrixXd::Constant(model_.network().state_count(), run.samples(), run.at.front().ambient_C);
      heat_W = std::max(heat_W, rms_heat_W(model_.network(), values_, run, state_C));
      for (std::size_t k = 0; k < run.at.size(); ++k) {
        const double duration_s = run.time_s[k + 1] - run.time_s[k];
        squares += duration_s * run.at[k].speed_rms_rad_per_s * run.at[k].speed_rms_rad_per_s;
        time_s += duration_s;
      }
    }
    const double ratio = std::sqrt(squares / time_s) / thermal::kReferenceSpeed_rad_per_s;
    if (!(ratio > 0.01) || !(heat_W > 0.0) || !is_by_current(setup_.heat)) {
      return;
    }
    for (const char* node : {"winding", "stator"}) {
      add(effect(fmt::format("speed_loss_{}", node), "iron_loss_hysteresis", {node},
                 {free_parameter(kGuess_share * heat_W / ratio, kLoose_sd)}));
      add(effect(fmt::format("square_speed_loss_{}", node), "iron_loss_eddy", {node},
                 {free_parameter(kGuess_share * heat_W / (ratio * ratio), kLoose_sd), held(2.0)}));
    }
  }

  const ForecastSetup& setup_;
  const ForecastModel& model_;
  std::span<const estimation::MeasuredRun> runs_;
  std::vector<double> values_;
  std::vector<Extension> all_;
};

}  // namespace

ForecastModel ForecastSetup::model() const {
  MotorModel all = motor_model(motor, heat, has_speed);
  if (opens_loss_at_speed) {
    open_loss_at_speed(all, motor);
  }
  return {std::move(all), faults};
}

ForecastSetup forecast_setup(const motor::Motor& motor, std::span<const recording::Recording> recordings,
                             std::optional<HeatInput> wanted_heat) {
  ForecastSetup setup{.motor = motor, .heat = heat_input_of(motor, recordings, {wanted_heat, true})};
  setup.has_speed = all_have(recordings, thermal::Signal::speed);
  if (setup.heat == HeatInput::power_balance && !has_remaining_loss(motor)) {
    setup.motor.effects.push_back(effect("remaining_loss", "remaining_loss", {"winding", "stator"},
                                         {free_parameter(1.0, kRemainder_sd), free_parameter(0.5, kWindingShare_sd)}));
  }
  return setup;
}

std::vector<Extension> extensions_for(const ForecastSetup& setup, const ForecastModel& model, const Eigen::VectorXd& theta,
                                      std::span<const estimation::MeasuredRun> runs) {
  return Listing(setup, model, theta, runs).list();
}

ForecastSetup with_extension(ForecastSetup setup, const Extension& extension) {
  setup.motor.effects.insert(setup.motor.effects.end(), extension.effects.begin(), extension.effects.end());
  setup.faults.insert(setup.faults.end(), extension.faults.begin(), extension.faults.end());
  return setup;
}

Eigen::VectorXd carried_over(const ForecastModel& from, const Eigen::VectorXd& theta, const ForecastModel& to, const Extension& added) {
  Eigen::VectorXd out = to.start();
  const estimation::Model& old = from.motor().model;
  const estimation::Model& now = to.motor().model;
  for (Eigen::Index i = 0; i < now.free_count(); ++i) {
    for (Eigen::Index j = 0; j < old.free_count(); ++j) {
      out[i] = now.name(i) == old.name(j) ? theta[j] : out[i];
    }
    for (const auto& [name, factor] : added.start_ratio) {
      out[i] += now.name(i) == name ? std::log(factor) : 0.0;
    }
  }
  for (std::size_t i = 0; i < to.faults().size(); ++i) {
    for (std::size_t j = 0; j < from.faults().size(); ++j) {
      if (to.faults()[i].type == from.faults()[j].type) {
        out[now.free_count() + static_cast<Eigen::Index>(i)] = theta[old.free_count() + static_cast<Eigen::Index>(j)];
      }
    }
  }
  return to.within_bounds(std::move(out));
}

double rms_heat_W(const thermal::Network& network, std::span<const double> values, const estimation::MeasuredRun& run,
                  const Eigen::MatrixXd& state_C) {
  const auto nodes = static_cast<std::size_t>(network.node_count());
  const auto states = static_cast<std::size_t>(network.state_count());
  std::vector<double> heat_W(network.effects().size() * nodes);
  double squares_W2_s = 0.0;
  double time_s = 0.0;
  for (std::size_t k = 0; k < run.at.size(); ++k) {
    network.balance_W(run.at[k], values, {state_C.col(static_cast<Eigen::Index>(k)).data(), states}, heat_W);
    double made_W = 0.0;
    double leaving_W = 0.0;
    for (std::size_t e = 0; e < network.effects().size(); ++e) {
      double sum_W = 0.0;
      for (std::size_t n = 0; n < nodes; ++n) {
        sum_W += heat_W[e * nodes + n];
      }
      made_W += sum_W;
      leaving_W += heat_W[e * nodes + states];
    }
    const double duration_s = run.time_s[k + 1] - run.time_s[k];
    const double most_W = std::max(std::abs(made_W), std::abs(leaving_W));
    squares_W2_s += duration_s * most_W * most_W;
    time_s += duration_s;
  }
  return std::sqrt(squares_W2_s / time_s);
}

}  // namespace heatsoak::calibration
