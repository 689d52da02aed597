#include "calibration/motor_model.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/diagnostic.h"
#include "base/quantity.h"
#include "calibration/current_of_torque.h"
#include "calibration/loss_at_stator.h"
#include "calibration/unlogged_speed.h"
#include "estimation/log_rows.h"
#include "motor/datasheet_network.h"
#include "recording/quantities.h"

namespace heatsoak::calibration {
namespace {

/// Prior standard deviation of a logarithm by origin, if the file states no spread, and the factor that widens a stated spread. Data sheet
/// values hold only for the mounting in which they were measured; estimates are less certain still.
struct Trust {
  base::Origin origin;
  double unstated_sd;
  double widening;
};
constexpr std::array kTrust{Trust{base::Origin::measured, 0.1, 1.0}, Trust{base::Origin::datasheet, kSheet_sd, 1.5},
                            Trust{base::Origin::third_party, 0.5, 1.5}, Trust{base::Origin::derived, 0.5, 1.5},
                            Trust{base::Origin::estimated, 0.9, 2.0}};

/// Mean specific heat of motor materials (copper 385, steel 460, magnets 450, aluminium 900 J/(kg K)), and the standard deviation of the
/// logarithm of the heat capacity that follows from the mass: part of the mass is only weakly coupled to the stator.
constexpr double kSpecificHeat_J_per_kg_K = 440.0;
constexpr double kMassPrior_sd = 0.25;

int place_of(const thermal::Network& network, std::string_view parameter) {
  const auto all = network.parameters();
  const auto found = std::ranges::find(all, parameter, &thermal::NetworkParameter::name);
  return found == all.end() ? -1 : static_cast<int>(found - all.begin());
}

/// Share of the input power that heats the winding: 1 minus the shares of the file's input_power_loss effects, at least 0.
double implicit_power_share(const motor::Motor& motor) {
  double share = 1.0;
  for (const motor::MotorEffect& effect : motor.effects) {
    share -= effect.type->name == std::string_view("input_power_loss") ? effect.parameters.front().value : 0.0;
  }
  return std::max(0.0, share);
}

/// Returns the motor with every effect in its network, whatever its condition: runs with and without it are fitted together.
motor::Motor unconditional(motor::Motor motor) {
  std::ranges::for_each(motor.effects, [](motor::MotorEffect& effect) { effect.condition.clear(); });
  return motor;
}

/// Returns the motor with the effects that act with this heat input. Without a logged current, a remaining_loss would be the whole loss,
/// in addition to that of the input power; without the balance, it would act beside the no-load loss.
motor::Motor with_acting_effects(motor::Motor motor, HeatInput heat) {
  if (heat != HeatInput::power_balance) {
    std::erase_if(motor.effects, is_remaining_loss);
  }
  return motor;
}

class ModelBuilder {
 public:
  ModelBuilder(const motor::Motor& motor, HeatInput heat, bool with_speed)
      : motor_(unconditional(with_acting_effects(motor, heat))), with_speed_(with_speed) {
    all_.heat = heat;
    all_.model.network = motor::datasheet_network(motor_, motor::nominal_sample(motor_));
    if (heat == HeatInput::input_power) {
      // This is the only loss: the copper loss is 0 without a current, and the no-load loss is set to 0 below.
      all_.model.network.add_effect(std::string(kImplicitPowerLoss), *thermal::find_effect("input_power_loss"),
                                    std::vector<std::string>{"winding"}, std::vector<double>{implicit_power_share(motor_)});
      // An estimated no-load current is too uncertain for this split.
      if (with_speed && motor.nominal.no_load_current_A > 0.0 &&
          motor.parameters.find("no_load_current")->second.origin != base::Origin::estimated) {
        add_loss_at_stator(all_.model.network, motor::drag_torque_Nm(motor.nominal));
      }
    }
    if (heat == HeatInput::torque && with_speed && motor.nominal.torque_constant_Nm_per_A > 0.0 && motor.nominal.no_load_current_A > 0.0) {
      add_current_of_torque(all_.model.network, motor::drag_torque_Nm(motor.nominal), motor.nominal.torque_constant_Nm_per_A);
    }
    all_.model.values = all_.model.network.values();
    if (!is_by_current(heat)) {
      all_.model.values[static_cast<std::size_t>(place_of(all_.model.network, "no_load_loss.drag_torque"))] = 0.0;
    }
    conditions(motor);
    all_.model.flux_nodes = {all_.model.network.node("winding"), all_.model.network.node("stator")};
    all_.needed = {heat == HeatInput::input_power ? thermal::Signal::input_power : thermal::Signal::current};
    if (heat == HeatInput::power_balance) {
      all_.needed.insert(all_.needed.end(), {thermal::Signal::input_power, thermal::Signal::shaft_power, thermal::Signal::speed});
    }
  }

  MotorModel build() {
    const int winding = free("winding.heat_capacity");
    const int across = free("winding_stator.thermal_resistance");
    const int stator = free("stator.heat_capacity");
    const int out = free("stator_ambient.thermal_resistance");
    add_parameter("thermal_resistance_winding_stator", {{across, 1.0}});
    add_parameter("thermal_resistance_stator_ambient", {{out, 1.0}});
    add_parameter("thermal_time_constant_winding", {{winding, 1.0}, {across, 1.0}});
    add_parameter("thermal_time_constant_stator", {{stator, 1.0}, {out, 1.0}});
    if (all_.heat == HeatInput::input_power) {
      heat_of_power();
    } else {
      heat_of_current();
    }
    effects();
    const auto file_parameters = all_.parameters.size();
    capacity("winding_heat_capacity", winding);
    capacity("stator_heat_capacity", stator);
    set_prior(file_parameters, winding, stator);
    return std::move(all_);
  }

 private:
  // Bounds of the search, relative to the value of the file.
  static constexpr double kSheet_ratio = 30.0;
  static constexpr double kGuess_ratio = 1000.0;

  /// Sets the size of conditional effects to 0 in runs without their condition. An effect without such a size acts in all runs.
  void conditions(const motor::Motor& motor) {
    for (const motor::MotorEffect& effect : motor.effects) {
      const std::optional<int> size = effect.type->candidacy.size_parameter;
      const auto in_place = std::ranges::find(all_.model.network.effects(), effect.name, &thermal::EffectInPlace::name);
      if (!effect.condition.empty() && size && in_place != all_.model.network.effects().end()) {
        all_.model.conditional.push_back({effect.name, in_place->parameter_index[static_cast<std::size_t>(*size)], 0.0, effect.condition});
      }
    }
  }

  /// Frees a parameter within a factor `far_ratio` of its value. Returns its index among the free ones.
  int free(const std::string& parameter, double far_ratio = kSheet_ratio) {
    const int place = place_of(all_.model.network, parameter);
    const double value = all_.model.values[static_cast<std::size_t>(place)];
    all_.model.free.push_back({.place = place, .by_log = true, .scale = 1.0, .low = value / far_ratio, .high = value * far_ratio});
    return static_cast<int>(all_.model.free.size()) - 1;
  }

  void add_parameter(std::string_view key, const std::vector<std::pair<int, double>>& exponents) {
    const base::ParameterValue& parameter = motor_.parameters.find(key)->second;
    const auto specs = motor::motor_parameter_specs();
    const auto spec = std::ranges::find(specs, key, [](const motor::MotorParameterSpec& each) { return each.spec.key; });
    add(std::string(key), std::string(spec->spec.unit), parameter, exponents);
  }
  void add(std::string name, std::string unit, const base::ParameterValue& parameter,
           const std::vector<std::pair<int, double>>& exponents) {
    // A result of an earlier fit holds for this mounting, so it is not widened.
    const double prior_sd = is_of_fit(name) && parameter.spread ? prior_sd_of_spread(parameter) : prior_sd_of(parameter);
    CalibratedValue fitted{std::move(name), std::move(unit), true, Eigen::VectorXd::Zero(kMostFree), parameter.value,
                           prior_sd,        parameter.origin};
    for (const auto& [place, exponent] : exponents) {
      fitted.exponents[place] = exponent;
    }
    all_.parameters.push_back(std::move(fitted));
  }

  void heat_of_current() {
    const base::ParameterValue& resistance = motor_.parameters.find("terminal_resistance")->second;
    // A published or measured resistance sets the scale of all heat and is held; an estimate is fitted.
    if (resistance.spread || resistance.origin == base::Origin::estimated) {
      // A resistance does not depend on the mounting, so its spread is not widened. It sets the scale of all heat, which temperatures do not
      // determine: an incomplete model must not move it far from its stated range.
      const double sd = resistance.spread ? std::min(prior_sd_of(resistance), prior_sd_of_spread(resistance)) : prior_sd_of(resistance);
      constexpr double kFurthest_sd = 6.0;
      add_parameter("terminal_resistance",
                    {{free("copper_loss.terminal_resistance", std::min(kSheet_ratio, std::exp(kFurthest_sd * sd))), 1.0}});
      all_.parameters.back().prior_sd = std::min(all_.parameters.back().prior_sd, sd);
    } else {
      all_.held.emplace_back(ResistanceHeld{});
    }
    if (all_.heat == HeatInput::power_balance) {
      all_.held.emplace_back(NoLoadCurrentUnused{});
    } else if (!with_speed_) {
      all_.held.emplace_back(NoLoadCurrentHeld{});
    } else if (motor_.nominal.no_load_current_A > 0.0) {
      all_.needed.push_back(thermal::Signal::speed);
      add_parameter("no_load_current", {{free("no_load_loss.drag_torque"), 1.0}});
    }
  }

  void heat_of_power() {
    const bool has_loss_at_stator = place_of(all_.model.network, kDragAtStator) >= 0;
    all_.held.emplace_back(HeatShareHeld{has_loss_at_stator});
    if (has_loss_at_stator) {
      all_.needed.push_back(thermal::Signal::speed);
      add_parameter("no_load_current", {{free(std::string(kDragAtStator)), 1.0}});
    }
  }

  void effects() {
    for (const motor::MotorEffect& effect : motor_.effects) {
      const std::vector<double> values = effect.values();
      std::vector<std::string> held;
      for (std::size_t i = 0; i < effect.parameters.size(); ++i) {
        const base::ParameterSpec& spec = effect.type->parameters[i];
        const std::string name = fmt::format("{}.{}", effect.name, spec.key);
        if (!spec.choices.empty() || !effect.parameters[i].spread || !(effect.parameters[i].value > 0.0)) {
          if (spec.choices.empty()) {
            held.emplace_back(spec.key);
          }
          continue;
        }
        add("effects." + name, std::string(base::unit_of(effect.type->parameters, i, values)), effect.parameters[i],
            {{free(name, kGuess_ratio), 1.0}});
        // The values of an effect are often guesses, so its range and the prior decide, not the bounds of a data sheet's values.
        estimation::FreeParameter& bounded = all_.model.free.back();
        bounded.low = std::max(bounded.low, spec.range.low);
        bounded.high = std::min(bounded.high, spec.range.high);
      }
      if (!held.empty()) {
        all_.held.emplace_back(EffectHeld{effect.name, std::move(held)});
      }
    }
  }

  void capacity(const std::string& name, int place) {
    const double before = all_.model.values[static_cast<std::size_t>(all_.model.free[static_cast<std::size_t>(place)].place)];
    all_.parameters.push_back(
        {name, "J/K", false, Eigen::VectorXd::Zero(kMostFree), before, 0.0, motor_.fit ? base::Origin::measured : base::Origin::derived});
    all_.parameters.back().exponents[place] = 1.0;
  }

  static double prior_sd_of_spread(const base::ParameterValue& parameter) {
    return 0.25 * std::log(parameter.spread->high / parameter.spread->low);
  }

  [[nodiscard]] bool is_of_fit(const std::string& name) const {
    return motor_.fit && std::ranges::find(motor_.fit->parameters, name) != motor_.fit->parameters.end();
  }

  /// Prior precision of the logarithms of the file's parameters. They are independent, except for those from one earlier fit, which have
  /// its correlation.
  [[nodiscard]] Eigen::MatrixXd precision_of_parameters(Eigen::Index count) const {
    Eigen::VectorXd inverse_sd(count);
    Eigen::MatrixXd correlation = Eigen::MatrixXd::Identity(count, count);
    std::vector<Eigen::Index> in_fit(static_cast<std::size_t>(count), -1);
    for (Eigen::Index i = 0; i < count; ++i) {
      const CalibratedValue& each = all_.parameters[static_cast<std::size_t>(i)];
      inverse_sd[i] = 1.0 / each.prior_sd;
      if (is_of_fit(each.name)) {
        in_fit[static_cast<std::size_t>(i)] = std::ranges::find(motor_.fit->parameters, each.name) - motor_.fit->parameters.begin();
      }
    }
    for (Eigen::Index i = 0; i < count; ++i) {
      for (Eigen::Index j = 0; j < i; ++j) {
        const Eigen::Index a = in_fit[static_cast<std::size_t>(i)];
        const Eigen::Index b = in_fit[static_cast<std::size_t>(j)];
        correlation(i, j) = correlation(j, i) =
            a >= 0 && b >= 0 ? motor_.fit->correlation(static_cast<std::size_t>(a), static_cast<std::size_t>(b)) : 0.0;
      }
    }
    // The file has five digits, so smaller eigenvalues are rounding errors.
    constexpr double kRounding = 5e-5;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(correlation);
    const Eigen::MatrixXd inverse =
        solver.eigenvectors() * solver.eigenvalues().cwiseMax(kRounding).cwiseInverse().asDiagonal() * solver.eigenvectors().transpose();
    return inverse_sd.asDiagonal() * inverse * inverse_sd.asDiagonal();
  }

  /// Converts the prior of the file's parameters to the parameters of the model.
  void set_prior(std::size_t file_parameters, int winding, int stator) {
    estimation::Model& model = all_.model;
    const Eigen::Index count = model.free_count();
    for (CalibratedValue& each : all_.parameters) {
      each.exponents.conservativeResize(count);
    }
    model.prior.mean = model.theta();
    Eigen::MatrixXd exponents(static_cast<Eigen::Index>(file_parameters), count);
    for (std::size_t i = 0; i < file_parameters; ++i) {
      exponents.row(static_cast<Eigen::Index>(i)) = all_.parameters[i].exponents.transpose();
    }
    model.prior.precision = exponents.transpose() * precision_of_parameters(exponents.rows()) * exponents;
    // An earlier fit has already used the mass.
    if (const std::optional<double> mass_kg = motor_.nominal.mass_kg; mass_kg && !motor_.fit) {
      const double winding_J_per_K = std::exp(model.prior.mean[winding]);
      const double stator_J_per_K = std::exp(model.prior.mean[stator]);
      const double sum_J_per_K = winding_J_per_K + stator_J_per_K;
      Eigen::VectorXd share = Eigen::VectorXd::Zero(count);
      share[winding] = winding_J_per_K / sum_J_per_K;
      share[stator] = stator_J_per_K / sum_J_per_K;
      const double off = std::log(kSpecificHeat_J_per_kg_K * *mass_kg / sum_J_per_K);
      const Eigen::MatrixXd before = model.prior.precision;
      model.prior.precision += share * share.transpose() / (kMassPrior_sd * kMassPrior_sd);
      model.prior.mean += model.prior.precision.ldlt().solve(share) * off / (kMassPrior_sd * kMassPrior_sd);
    }
    const Eigen::MatrixXd covariance = model.prior.precision.inverse();
    for (CalibratedValue& each : all_.parameters) {
      if (!each.is_of_file) {
        each.prior_sd = std::sqrt(each.exponents.dot(covariance * each.exponents));
      }
    }
  }

  static constexpr Eigen::Index kMostFree = 64;
  const motor::Motor motor_;
  bool with_speed_;
  MotorModel all_;
};

}  // namespace

bool is_learned(double sd_share, const CalibratedValue& parameter) {
  constexpr double kNews_share = 0.7;
  return sd_share < kNews_share * parameter.prior_sd;
}

bool is_identifiable(double sd_share, const CalibratedValue& parameter) {
  // The interval then extends by a factor of two to each side.
  constexpr double kIdentifiable_sd = 0.35;
  return sd_share < kIdentifiable_sd && (parameter.origin == base::Origin::measured || is_learned(sd_share, parameter));
}

double prior_sd_of(const base::ParameterValue& parameter) {
  const auto* const trust = std::ranges::find(kTrust, parameter.origin, &Trust::origin);
  if (!parameter.spread || !(parameter.spread->low > 0.0) || !(parameter.spread->high > parameter.spread->low)) {
    return trust->unstated_sd;
  }
  // Both kinds of spread are taken as 95 % intervals, ±2 standard deviations.
  return trust->widening * 0.25 * std::log(parameter.spread->high / parameter.spread->low);
}

static estimation::ShaftTorque shaft_torque_of(const motor::Motor& motor) {
  const auto known = [](double value) { return value > 0.0 ? value : 0.0; };
  return {known(motor.nominal.torque_constant_Nm_per_A), known(motor::drag_torque_Nm(motor.nominal)),
          known(motor.nominal.terminal_resistance_ohm)};
}

estimation::MeasuredRunOptions how_to_read(const motor::Motor& motor, HeatInput heat) {
  // Limits of the step, whatever time constant the data sheet states.
  constexpr double kShortest_s = 0.05;
  constexpr double kLongest_s = 2.0;
  estimation::MeasuredRunOptions how;
  how.longest_step_s = std::clamp(motor.nominal.thermal_time_constant_winding_s / 10.0, kShortest_s, kLongest_s);
  how.ignores_current = heat == HeatInput::input_power || heat == HeatInput::torque;
  // A current from the torque would count the copper loss twice.
  if (heat != HeatInput::input_power) {
    how.torque = shaft_torque_of(motor);
  }
  how.least_current_A = least_driving_current_A(motor);
  for (const motor::MotorSensor& sensor : motor.sensors) {
    how.faults.push_back({sensor.type, sensor.size.value});
  }
  for (const motor::MotorEffect& effect : motor.effects) {
    if (!effect.column.empty()) {
      how.columns.resize(std::max(how.columns.size(), effect.column_place() + 1));
      how.columns[effect.column_place()] = effect.column;
    }
  }
  return how;
}

bool is_remaining_loss(const motor::MotorEffect& effect) { return effect.type->name == std::string_view("remaining_loss"); }

bool has_remaining_loss(const motor::Motor& motor) { return std::ranges::any_of(motor.effects, is_remaining_loss); }

static bool has_heat_input(const motor::Motor& motor, const recording::Recording& recording, HeatInput heat, const HeatRules& rules) {
  const auto has = [&](thermal::Signal signal) { return estimation::has_signal(recording, signal); };
  switch (heat) {
    case HeatInput::current:
      return has(thermal::Signal::current);
    case HeatInput::input_power:
      return has(thermal::Signal::input_power);
    case HeatInput::torque: {
      estimation::MeasuredRunOptions how = how_to_read(motor, heat);
      return std::ranges::count(estimation::signals_of(recording, how), thermal::Signal::current) > 0;
    }
    case HeatInput::power_balance:
      break;
  }
  const bool may_add = rules.may_add_remaining_loss && motor.effects.empty() && !motor.fit;
  return (has_remaining_loss(motor) || may_add) && has(thermal::Signal::current) && has(thermal::Signal::input_power) &&
         has(thermal::Signal::shaft_power);
}

static std::optional<HeatInput> wanted_heat_input(const motor::Motor& motor, const HeatRules& rules) {
  return rules.wanted || !motor.fit ? rules.wanted : motor.fit->heat_input;
}

HeatInput heat_input_of(const motor::Motor& motor, std::span<const recording::Recording> recordings, const HeatRules& rules) {
  const auto all_have = [&](HeatInput heat) {
    return std::ranges::all_of(recordings, [&](const recording::Recording& each) { return has_heat_input(motor, each, heat, rules); });
  };
  if (const std::optional<HeatInput> wanted = wanted_heat_input(motor, rules); wanted && all_have(*wanted)) {
    return *wanted;
  }
  for (const HeatInput heat : {HeatInput::power_balance, HeatInput::current, HeatInput::input_power, HeatInput::torque}) {
    if (all_have(heat)) {
      return heat;
    }
  }
  std::vector<base::Diagnostic> lacking;
  for (const recording::Recording& each : recordings) {
    if (!has_heat_input(motor, each, HeatInput::current, rules) && !has_heat_input(motor, each, HeatInput::torque, rules)) {
      lacking.push_back({{each.file.string()},
                         std::string(recording::column_of(thermal::Signal::current)),
                         "is missing in this log or has no valid value (see `heatsoak log inspect`), and not all logs have power_in_W "
                         "instead, so heat cannot be computed; add one of the two columns"});
    }
  }
  if (!lacking.empty()) {
    throw base::Failure(base::ExitCode::bad_input, "the logs have no heat input", std::move(lacking));
  }
  return HeatInput::current;
}

std::optional<ShaftPowerUnknown> shaft_power_unknown(std::span<const recording::Recording> recordings, HeatInput used) {
  ShaftPowerUnknown finding;
  for (const recording::Recording& each : recordings) {
    const bool is_known =
        estimation::has_signal(each, thermal::Signal::shaft_power) && estimation::has_signal(each, thermal::Signal::speed);
    if (used == HeatInput::input_power && !is_known) {
      finding.recordings.push_back(each.name);
    }
  }
  return finding.recordings.empty() ? std::nullopt : std::optional(std::move(finding));
}

std::optional<HeatInputLacking> lacking_heat_input(const motor::Motor& motor, std::span<const recording::Recording> recordings,
                                                   const HeatRules& rules, HeatInput used) {
  const std::optional<HeatInput> wanted = wanted_heat_input(motor, rules);
  if (!wanted || *wanted == used) {
    return std::nullopt;
  }
  HeatInputLacking finding{*wanted, used, {}};
  for (const recording::Recording& each : recordings) {
    if (!has_heat_input(motor, each, *wanted, rules)) {
      finding.recordings.push_back(each.name);
    }
  }
  return finding;
}

/// True if the recording states the condition. Its name is its condition "run".
static bool holds(const recording::Recording& recording, const std::map<std::string, std::string>& condition) {
  return std::ranges::all_of(condition, [&](const auto& part) {
    const auto found = recording.conditions.find(part.first);
    return found != recording.conditions.end() ? found->second == part.second : part.first == "run" && part.second == recording.name;
  });
}

std::vector<HeldValue> held_in_recordings(const motor::Motor& motor, std::span<const recording::Recording> recordings) {
  std::vector<HeldValue> held;
  for (const motor::MotorSensor& sensor : motor.sensors) {
    const motor::SensorEffectType& type = *sensor.type;
    const bool is_shown =
        std::ranges::any_of(recordings, [&](const recording::Recording& each) { return estimation::has_values(each.find(type.signal)); });
    if (is_shown) {
      held.emplace_back(SensorHeld{sensor.name, std::string(type.size.key), sensor.size.value, std::string(type.size.unit)});
    } else {
      held.emplace_back(SensorUnused{sensor.name, std::string(type.signal)});
    }
  }
  for (const motor::MotorEffect& effect : motor.effects) {
    if (effect.condition.empty()) {
      continue;
    }
    const auto count = std::ranges::count_if(recordings, [&](const recording::Recording& each) { return holds(each, effect.condition); });
    if (!effect.type->candidacy.size_parameter && count < std::ssize(recordings)) {
      held.emplace_back(ConditionNotApplied{effect.name, std::string(effect.type->name), effect.condition});
    } else if (count == 0) {
      held.emplace_back(ConditionNeverMet{effect.name, effect.condition});
    }
  }
  return held;
}

MotorModel motor_model(const motor::Motor& motor, HeatInput heat, bool with_speed) { return ModelBuilder(motor, heat, with_speed).build(); }

}  // namespace heatsoak::calibration
