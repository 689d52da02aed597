#include "limiters.h"

#include <algorithm>
#include <cmath>

#include "base/diagnostic.h"
#include "base/unknown.h"
#include "motor/datasheet_network.h"

namespace heatsoak::simulate::studies {
namespace {

/// The accumulator's node has this value when the budget is used up. It is far above any stator temperature, because the table takes the
/// larger of both nodes. A stator temperature corresponds to less than a quarter of the budget, where the full current is allowed.
constexpr float kFull = 900.0F;
constexpr float kFallsFrom_share = 0.9F;
constexpr float kMost = 999.0F;  ///< the core treats more than 1000 as a corrupted state

derate::Derating scaled(derate::Derating exact, double ratio) {
  derate::CurrentTable& table = exact.table;
  std::ranges::transform(table.heat_per_ohm_A2, table.heat_per_ohm_A2.begin(), [ratio](double heat_A2) { return ratio * ratio * heat_A2; });
  table.straight_below_A *= ratio;
  table.most_current_A *= ratio;
  return exact;
}

}  // namespace

derate::Derating derating_with(double heat_factor, const motor::Motor& motor, const robot::Robot& robot) {
  const derate::DerateOptions options;
  const thermal::Network network = motor::datasheet_network(motor, motor::nominal_sample(motor));
  derate::Observer observer(network, motor.nominal, robot, heat_factor);
  derate::BarrierRules rules = derate::barrier_rules(motor, robot, options);
  const double reachable_rad_per_s = rules.most_speed_rad_per_s;
  rules.most_speed_rad_per_s = derate::sustainable_speed_rad_per_s(observer, rules);
  if (rules.most_speed_rad_per_s < reachable_rad_per_s) {
    rules.no_current_speed_rad_per_s.reset();
  }
  // The table is nearly exact.
  derate::CurrentTable table = derate::current_table(observer, rules, {.shortfall_ratio = 0.003, .most_bytes = 1U << 16U});
  return {.motor_id = motor.id,
          .robot_id = robot.id,
          .data_quality = {},
          .torque_constant_Nm_per_A = motor.nominal.torque_constant_Nm_per_A,
          .observer = std::move(observer),
          .rules = rules,
          .table = std::move(table),
          .options = options,
          .assumed = {},
          .effects = {},
          .guarantee = {},
          .uses = {},
          .reachable_speed_rad_per_s = reachable_rad_per_s};
}

Overload overload_of(const motor::MotorValues& motor) {
  Overload overload;
  overload.continuous_A = motor.nominal_current_A.value_or(
      motor.nominal_torque_Nm.value_or(base::kUnknown) / motor.torque_constant_Nm_per_A + motor.no_load_current_A);
  overload.peak_A = motor.nominal_voltage_V / motor.terminal_resistance_ohm;
  const double ratio = overload.peak_A / overload.continuous_A;
  overload.peak_s = motor.thermal_time_constant_winding_s * std::log(ratio * ratio / (ratio * ratio - 1.0));
  return overload;
}

Limiter::Limiter(const derate::Derating& exact, double resistance_ratio)
    : exact_(scaled(exact, resistance_ratio)), motor_(exact_), model_(motor_.model()), resistance_ratio_(resistance_ratio) {}

void Limiter::set_table(const std::vector<float>& body, const std::vector<double>& current_A) {
  constexpr float kAnyWinding_C = 1000.0F;
  constexpr float kAnySpeed_rad_per_s = 1e6F;
  constexpr int kParts = 32;  // the table interpolates heats linearly, these limiters interpolate the current
  speed_rad_per_s_ = {0.0F};
  winding_C_ = {0.0F, kAnyWinding_C};
  for (std::size_t i = 0; i + 1 < body.size(); ++i) {
    for (int part = i == 0 ? 0 : 1; part <= kParts; ++part) {
      const float share = static_cast<float>(part) / kParts;
      body_.push_back(std::lerp(body[i], body[i + 1], share));
      const auto each_A = static_cast<float>(resistance_ratio_ * std::lerp(current_A[i], current_A[i + 1], static_cast<double>(share)));
      square_A2_.insert(square_A2_.end(), winding_C_.size(), each_A * each_A);
    }
  }
  const auto axis = [](const std::vector<float>& points) { return heatsoak_axis{points.data(), static_cast<std::int32_t>(points.size())}; };
  heatsoak_current_table& table = model_.table;
  table.speed_rad_per_s = axis(speed_rad_per_s_);
  table.stator_C = axis(body_);
  table.winding_C = axis(winding_C_);
  table.heat_per_ohm_A2 = square_A2_.data();
  table.resistance_at_0C_ratio = 1.0F;
  table.resistance_ratio_per_K = 0.0F;
  table.straight_below_A = 1e-3F;
  table.most_current_A = static_cast<float>(resistance_ratio_ * *std::ranges::max_element(current_A));
  table.most_speed_rad_per_s = kAnySpeed_rad_per_s;
  table.no_current_speed_rad_per_s = 2.0F * kAnySpeed_rad_per_s;
  model_.cold_current_A = static_cast<float>(resistance_ratio_ * current_A.front());
}

std::unique_ptr<Limiter> Limiter::fixed_cap(const derate::Derating& exact, double resistance_ratio, double cap_A) {
  std::unique_ptr<Limiter> made(new Limiter(exact, resistance_ratio));
  made->set_table({0.0F, 1000.0F}, {cap_A, cap_A});
  return made;
}

std::unique_ptr<Limiter> Limiter::stator_ramp(const derate::Derating& exact, double resistance_ratio, double full_C, double none_C) {
  std::unique_ptr<Limiter> made(new Limiter(exact, resistance_ratio));
  const double most_A = exact.rules.most_current_A;
  made->set_table({0.0F, static_cast<float>(full_C), static_cast<float>(none_C), 1000.0F}, {most_A, most_A, 0.0, 0.0});
  return made;
}

std::unique_ptr<Limiter> Limiter::i_squared_t(const derate::Derating& exact, double resistance_ratio, const Overload& overload) {
  std::unique_ptr<Limiter> made(new Limiter(exact, resistance_ratio));
  if (made->model_.node_count != 2) {
    throw base::Failure(base::ExitCode::bug, "the I²t limiter expects a network of winding and stator");
  }
  const double most_A = exact.rules.most_current_A;
  made->set_table({0.0F, kFallsFrom_share * kFull, kFull, 1000.0F}, {most_A, most_A, overload.continuous_A, overload.continuous_A});
  made->continuous_squared_A2_ = static_cast<float>(overload.continuous_A * overload.continuous_A);
  made->fill_per_A2_s_ = kFull / static_cast<float>(overload.budget_A2_s());
  made->model_.node_count = 3;
  // No study restores a limiter. The core demands resting temperatures that are not below the hottest air.
  made->model_.resting_C[2] = made->model_.resting_C[1];
  made->model_.resting_C[1] = made->model_.hottest_ambient_C;
  made->model_.rates = &Limiter::overload_rates;
  made->model_.context = made.get();
  return made;
}

std::unique_ptr<Limiter> Limiter::guard(const derate::Derating& derating, double resistance_ratio, double braking_reserve_K) {
  std::unique_ptr<Limiter> made(new Limiter(derating, resistance_ratio));
  made->braking_reserve_K_ = braking_reserve_K;
  return made;
}

robot_core::Config Limiter::config(const robot::Robot& robot, const motor::Motor& known) const {
  robot_core::Config config = firmware::make_core_config(robot, known.nominal, firmware::with_tolerance({}, known));
  config.guard = &model_;
  config.limp_current_A = config.current_limit_A;
  config.braking_reserve_K = static_cast<float>(braking_reserve_K_);
  robot_core::complete(config);
  return config;
}

/// Nodes: winding, accumulator, stator. The core keeps the accumulator above the coldest air temperature, which is 0.
void Limiter::overload_rates(const void* context, const float* signal, const float* state_C, float* rate_K_per_s) {
  const Limiter& limiter = *static_cast<const Limiter*>(context);
  const robot_core::GuardModel& motor = limiter.motor_.model();
  const float motor_C[] = {state_C[0], state_C[2]};
  float motor_K_per_s[2];
  motor.rates(motor.context, signal, motor_C, motor_K_per_s);
  const float current_A = signal[robot_core::guard_current_A];
  const float filling_per_s = limiter.fill_per_A2_s_ * (current_A * current_A - limiter.continuous_squared_A2_);
  rate_K_per_s[0] = motor_K_per_s[0];
  rate_K_per_s[1] = std::min(filling_per_s, (kMost - state_C[1]) / motor.period_s);
  rate_K_per_s[2] = motor_K_per_s[1];
}

}  // namespace heatsoak::simulate::studies
