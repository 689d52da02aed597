#include "derate/observer.h"

#include <fmt/format.h>

#include <algorithm>
#include <type_traits>

#include "robot/machine_point.h"
#include "thermal/lanes.h"

namespace heatsoak::derate {

namespace observed {

std::span<const SignalSpec> signals() {
  static constexpr std::array<SignalSpec, kSignalCount> kSignals = [] {
    std::array<SignalSpec, kSignalCount> all{};
    for (std::size_t i = 0; i < kSignalCount; ++i) {
      const base::FirmwareInput& input = firmware_of(i);
      all[i] = {input.field, input.meaning, input.worst, input.without_power, {}};
      if (input.worst != thermal::WorstCase::both_directions) {
        all[i].row = kRows[i];
      }
    }
    return all;
  }();
  return kSignals;
}

}  // namespace observed

template <class S>
thermal::OperatingPoint<S> operating_point(const motor::MotorValues& motor, const robot::Robot& robot,
                                           std::span<const S, observed::kSignalCount> signals) {
  const S& current_A = signals[observed::current];
  const S& speed_rad_per_s = signals[observed::speed];
  const S shaft_power_W = thermal::named("shaft_power_W", motor.torque_constant_Nm_per_A * current_A * speed_rad_per_s -
                                                              motor::drag_torque_Nm(motor) * thermal::magnitude(speed_rad_per_s));
  thermal::OperatingPoint<S> at = robot::machine_point<S>(motor, robot, current_A, speed_rad_per_s, shaft_power_W);
  for (std::size_t i = 0; i < observed::kSignalCount; ++i) {
    if (const std::optional<std::size_t> row = observed::signals()[i].row) {
      thermal::set_quantity(at, *row, signals[i]);
    }
  }
  at.bus_V = robot.battery.full_V.value_or(robot.battery.nominal_V);
  return at;
}

template thermal::OperatingPoint<double> operating_point<double>(const motor::MotorValues&, const robot::Robot&,
                                                                 std::span<const double, observed::kSignalCount>);
template thermal::OperatingPoint<thermal::Lanes> operating_point<thermal::Lanes>(const motor::MotorValues&, const robot::Robot&,
                                                                                 std::span<const thermal::Lanes, observed::kSignalCount>);
template thermal::OperatingPoint<thermal::Traced> operating_point<thermal::Traced>(
    const motor::MotorValues&, const robot::Robot&, std::span<const thermal::Traced, observed::kSignalCount>);

namespace {

std::array<thermal::Traced, observed::kSignalCount> traced_signals(thermal::Formula& formula) {
  std::array<thermal::Traced, observed::kSignalCount> traced;
  for (std::size_t i = 0; i < traced.size(); ++i) {
    traced[i] = thermal::Traced(formula, formula.input(std::string(observed::signals()[i].name)));
  }
  return traced;
}

}  // namespace

Observer::Observer(const thermal::Network& network, const motor::MotorValues& motor, const robot::Robot& robot, double heat_safety_factor)
    : heat_safety_factor_(heat_safety_factor), resistance_rise_per_K_(motor.temperature_coefficient_per_K) {
  const std::array<thermal::Traced, observed::kSignalCount> signals = traced_signals(formula_);
  const thermal::OperatingPoint<thermal::Traced> at = operating_point<thermal::Traced>(motor, robot, signals);
  std::vector<thermal::Traced> temperature_C;
  for (int node = 0; node < network.state_count(); ++node) {
    state_names_.emplace_back(network.node_name(node));
    temperature_C.emplace_back(formula_, formula_.input(fmt::format("{}_C", network.node_name(node))));
  }
  temperature_C.push_back(at.ambient_C);
  std::vector<thermal::TracedHeat> heat(temperature_C.size());
  network.trace(at, temperature_C, heat);
  formula_.begin_law("node_heat");
  const std::vector<double> values = network.values();
  const auto add_rates = [&](double heat_ratio, std::string_view of, std::vector<int>& steps) {
    for (int node = 0; node < network.state_count(); ++node) {
      const thermal::TracedHeat& here = heat[static_cast<std::size_t>(node)];
      const std::string name = state_names_[static_cast<std::size_t>(node)] + std::string(of);
      const thermal::Traced losses_W = thermal::named(name + "_losses_W", here.made_W);
      const thermal::Traced guarded_W = thermal::named(name + "_guarded_losses_W", heat_ratio * losses_W);
      const thermal::Traced heat_W = thermal::named(name + "_heat_W", guarded_W + thermal::named(name + "_inflow_W", here.moved_W));
      const thermal::Traced rate_K_per_s = heat_W / values[static_cast<std::size_t>(network.capacity_index(node))];
      steps.push_back(thermal::named(name + "_rate_K_per_s", rate_K_per_s).step_in(formula_));
    }
  };
  add_rates(heat_safety_factor, "", rate_steps_);
  add_rates(1.0, "_nominal", nominal_rate_steps_);
  const std::vector<char> needed = formula_.needed_for(rate_steps_);
  for (std::size_t i = 0; i < needed.size(); ++i) {
    const thermal::Formula::Step& step = formula_.steps()[i];
    if (step.operation == thermal::Operation::input && static_cast<std::size_t>(step.left) < is_used_.size()) {
      is_used_[static_cast<std::size_t>(step.left)] = needed[i];
    }
  }
  is_used_[observed::current] = is_used_[observed::speed] = is_used_[observed::ambient] = 1;
}

template <class Number>
ObserverRun<Number>::ObserverRun(const Observer& observer, Number period_s, Number start_C)
    : rates_(observer.formula(), observer.rate_steps()),
      period_s_(period_s),
      state_C_(observer.state_count(), start_C),
      carry_K_(observer.state_count(), Number(start_C - start_C)),
      inputs_(observed::kSignalCount + observer.state_count()),
      rate_(observer.state_count()) {}

template <class Number>
void ObserverRun<Number>::step(std::span<const Number, observed::kSignalCount> signals) {
  std::ranges::copy(signals, inputs_.begin());
  std::ranges::copy(state_C_, inputs_.begin() + observed::kSignalCount);
  rates_.run(inputs_, rate_);
  for (std::size_t i = 0; i < state_C_.size(); ++i) {
    const Number change_K = period_s_ * rate_[i] - carry_K_[i];
    const Number next_C = state_C_[i] + change_K;
    carry_K_[i] = (next_C - state_C_[i]) - change_K;
    state_C_[i] = next_C;
  }
}

template <class Number>
Number ObserverRun<Number>::hottest_body_C() const {
  if constexpr (std::is_arithmetic_v<Number>) {
    return *std::max_element(state_C_.begin() + 1, state_C_.end());
  } else {
    Number hottest_C = state_C_[1];
    for (std::size_t i = 2; i < state_C_.size(); ++i) {
      hottest_C = hottest_C.max(state_C_[i]);
    }
    return hottest_C;
  }
}

template class ObserverRun<float>;
template class ObserverRun<double>;
template class ObserverRun<thermal::SingleLanes>;

}  // namespace heatsoak::derate
