#include "drive.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace heatsoak::suite {
namespace {

std::size_t drawn_steps(Random& random) { return static_cast<std::size_t>(random.uniform(1500.0, 1800.0)) * kStepsPerRow; }

/// Piecewise constant level with random durations.
class Level {
 public:
  Level(std::vector<double> levels, double shortest_s, double longest_s)
      : levels_(std::move(levels)), shortest_s_(shortest_s), longest_s_(longest_s) {}
  double next(Random& random) {
    if (left_s_ <= 0.0) {
      now_ = levels_[random.index(levels_.size())];
      left_s_ = random.uniform(shortest_s_, longest_s_);
    }
    left_s_ -= kStep_s;
    return now_;
  }

 private:
  std::vector<double> levels_;
  double shortest_s_;
  double longest_s_;
  double now_ = 0.0;
  double left_s_ = 0.0;
};

/// Ambient, fan, neighbouring motor and battery: what does not depend on the wheel, except for the sag of the battery.
void add_surroundings(const Motor& motor, Random random, Inputs& inputs) {
  const double base_C = random.uniform(19.0, 27.0);
  const double swing_K = random.uniform(0.3, 1.5);
  const double period_s = random.uniform(1800.0, 5000.0);
  const double phase_rad = random.uniform(0.0, 2.0 * std::numbers::pi);
  const double full_V = motor.nominal.bus_V * random.uniform(1.0, 1.06);
  const double discharge_V = motor.nominal.bus_V * random.uniform(0.03, 0.08);
  const double internal_ohm = 0.12 * motor.resistance_25C_ohm;
  Level fan({0.0, 0.3, 0.6, 1.0}, 40.0, 240.0);
  Level neighbour_rise({0.0, 6.0, 15.0, 30.0}, 60.0, 400.0);
  double neighbour_K = random.uniform(0.0, 12.0);
  for (Instant& now : inputs) {
    now.ambient_C = base_C + swing_K * std::sin(2.0 * std::numbers::pi * now.time_s / period_s + phase_rad);
    now.fan_ratio = fan.next(random);
    neighbour_K += (neighbour_rise.next(random) - neighbour_K) * kStep_s / 200.0;
    now.neighbour_C = now.ambient_C + neighbour_K;
    const double terminal_V = motor.resistance_25C_ohm * now.current_A + motor.torque_constant_Nm_per_A * now.speed_rad_per_s;
    const double open_V = full_V - discharge_V * now.time_s / 1800.0;
    const double supply_A = terminal_V * now.current_A / open_V;
    now.bus_V = open_V - internal_ohm * supply_A;
    now.modulation_ratio = std::clamp(terminal_V / now.bus_V, -1.0, 1.0);
  }
}

struct BenchSegment {
  double duration_s = 0.0;
  double current_A = 0.0;
  double speed_rad_per_s = 0.0;
};

std::vector<BenchSegment> bench_plan(const Motor& motor, double load_factor, double total_s, Random& random) {
  const double nominal_A = load_factor * motor.nominal.nominal_current_A;
  const double top_rad_per_s = motor.nominal.top_speed_rad_per_s;
  std::vector<BenchSegment> plan;
  for (const double ratio : {0.25, 0.5, 0.8, 1.1}) {  // no-load speeds
    plan.push_back({random.uniform(45.0, 80.0), motor.no_load_current_A, ratio * top_rad_per_s * random.uniform(0.9, 1.1)});
  }
  for (const double ratio : {0.6, 0.9, 1.2, 1.5}) {  // against a brake
    plan.push_back({random.uniform(50.0, 90.0), ratio * nominal_A, random.uniform(0.15, 0.9) * top_rad_per_s});
  }
  for (const double ratio : {0.5, 0.9, 1.3}) {  // locked rotor
    plan.push_back({random.uniform(60.0, 120.0), ratio * nominal_A * random.uniform(0.9, 1.1), 0.0});
  }
  plan.push_back({random.uniform(80.0, 140.0), 0.0, 0.0});  // a rest in between
  for (std::size_t i = plan.size(); i > 1; --i) {
    std::swap(plan[i - 1], plan[random.index(i)]);
  }
  double used_s = 0.0;
  for (const BenchSegment& segment : plan) {
    used_s += segment.duration_s;
  }
  const double first_rest_s = random.uniform(20.0, 60.0);
  plan.insert(plan.begin(), {first_rest_s, 0.0, 0.0});
  plan.push_back({std::max(total_s - used_s - first_rest_s, 1.0) + 1.0, 0.0, 0.0});  // cool-down
  return plan;
}

/// Motions of a wheel of a small robot.
enum class Motion { kSprint, kCruise, kDuel, kPause, kSideways };

struct Demand {
  Motion motion = Motion::kPause;
  double duration_s = 0.0;
  double speed_rad_per_s = 0.0;
  double most_A = 0.0;
  double load_Nm = 0.0;
  double heading_cosine = 1.0;  ///< share of the vehicle's speed in the wheel's direction of rolling
};

Demand drawn_demand(const Motor& motor, double load_factor, Random& random) {
  const double nominal_A = load_factor * motor.nominal.nominal_current_A;
  const double top_rad_per_s = motor.nominal.top_speed_rad_per_s;
  const double nominal_Nm = nominal_A * motor.torque_constant_Nm_per_A;
  Demand demand{.most_A = nominal_A * random.uniform(0.8, 2.0),
                .load_Nm = nominal_Nm * random.uniform(0.1, 0.35),
                .heading_cosine = random.uniform(0.3, 1.0)};
  const double dice = random.uniform();
  if (dice < 0.40) {
    demand.motion = Motion::kSprint;
    demand.duration_s = random.uniform(0.8, 3.5);
    demand.speed_rad_per_s = random.sign() * random.uniform(0.2, 1.0) * top_rad_per_s;
  } else if (dice < 0.60) {
    demand.motion = Motion::kCruise;
    demand.duration_s = random.uniform(3.0, 18.0);
    demand.speed_rad_per_s = random.sign() * random.uniform(0.2, 1.0) * top_rad_per_s;
  } else if (dice < 0.78) {
    demand.motion = Motion::kDuel;
    demand.duration_s = random.uniform(1.5, 7.0);
    demand.speed_rad_per_s = random.sign() * random.uniform(0.0, 0.05) * top_rad_per_s;
    demand.most_A = nominal_A * random.uniform(0.8, 1.7);
  } else {
    demand.motion = random.chance(0.35) ? Motion::kSideways : Motion::kPause;
    demand.duration_s = random.chance(0.08) ? random.uniform(60.0, 150.0) : random.uniform(1.0, 14.0);
  }
  return demand;
}

/// Wheel and its speed controller.
class Wheel {
 public:
  explicit Wheel(const Motor& motor) : motor_(motor) {}

  /// Moves the wheel by one step.
  void follow(const Demand& demand, Random& ripple, Instant& now) {
    const double direction = demand.speed_rad_per_s < 0.0 ? -1.0 : 1.0;
    const double drag_Nm = motor_.torque_constant_Nm_per_A * motor_.no_load_current_A;
    double current_A = 0.0;
    if (demand.motion == Motion::kDuel) {
      // The opponent holds the wheel, and the pushing force trembles.
      current_A = direction * demand.most_A * (0.85 + 0.15 * std::sin(2.0 * std::numbers::pi * 1.7 * now.time_s) + 0.05 * ripple.normal());
      speed_rad_per_s_ += (demand.speed_rad_per_s - speed_rad_per_s_) * kStep_s / 0.15;
    } else {
      const bool moves = std::abs(speed_rad_per_s_) > 1.0 || demand.speed_rad_per_s != 0.0;
      const double rolling_Nm = moves ? std::copysign(drag_Nm + demand.load_Nm, moves_to(demand)) : 0.0;
      const double wanted_A = (motor_.nominal.inertia_kg_m2 * (demand.speed_rad_per_s - speed_rad_per_s_) / 0.12 + rolling_Nm) /
                              motor_.torque_constant_Nm_per_A;
      const double ripple_A = moves ? 0.04 * motor_.nominal.nominal_current_A * ripple.normal() : 0.0;
      current_A = std::clamp(wanted_A + ripple_A, -demand.most_A, demand.most_A);
      const double torque_Nm = motor_.torque_constant_Nm_per_A * current_A - rolling_Nm;
      speed_rad_per_s_ += torque_Nm / motor_.nominal.inertia_kg_m2 * kStep_s;
    }
    if (demand.speed_rad_per_s == 0.0 && std::abs(speed_rad_per_s_) < 1.0) {
      speed_rad_per_s_ = 0.0;
      current_A = 0.0;
    }
    now.current_A = current_A;
    now.speed_rad_per_s = speed_rad_per_s_;
  }

 private:
  double moves_to(const Demand& demand) const { return std::abs(speed_rad_per_s_) > 1.0 ? speed_rad_per_s_ : demand.speed_rad_per_s; }

  const Motor& motor_;
  double speed_rad_per_s_ = 0.0;
};

}  // namespace

Inputs bench_run(const Motor& motor, double load_factor, std::uint64_t seed) {
  Random random(seed, "plan");
  Random ripple(seed, "ripple");
  Inputs inputs(drawn_steps(random));
  const std::vector<BenchSegment> plan = bench_plan(motor, load_factor, static_cast<double>(inputs.size()) * kStep_s, random);
  std::size_t at = 0;
  double left_s = plan[0].duration_s;
  double speed_rad_per_s = 0.0;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    while (left_s <= 0.0 && at + 1 < plan.size()) {
      left_s += plan[++at].duration_s;
    }
    left_s -= kStep_s;
    Instant& now = inputs[i];
    now.time_s = static_cast<double>(i) * kStep_s;
    speed_rad_per_s += (plan[at].speed_rad_per_s - speed_rad_per_s) * kStep_s / 0.4;
    now.speed_rad_per_s = std::abs(speed_rad_per_s) < 0.5 ? 0.0 : speed_rad_per_s;
    now.current_A = plan[at].current_A * (1.0 + 0.03 * ripple.normal());
  }
  add_surroundings(motor, Random(seed, "surroundings"), inputs);
  return inputs;
}

Inputs wheel_run(const Motor& motor, double load_factor, std::uint64_t seed) {
  Random random(seed, "plan");
  Random ripple(seed, "ripple");
  Inputs inputs(drawn_steps(random));
  Wheel wheel(motor);
  Demand demand;
  double left_s = 0.0;
  double vehicle_m_per_s = 0.0;
  const double metre_per_rad = 3.5 / motor.nominal.top_speed_rad_per_s;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (left_s <= 0.0) {
      demand = drawn_demand(motor, load_factor, random);
      left_s = demand.duration_s;
    }
    left_s -= kStep_s;
    Instant& now = inputs[i];
    now.time_s = static_cast<double>(i) * kStep_s;
    wheel.follow(demand, ripple, now);
    const double along_m_per_s = std::abs(now.speed_rad_per_s) * metre_per_rad;
    const double wanted_m_per_s =
        demand.motion == Motion::kSideways ? 3.0 * demand.heading_cosine : std::min(along_m_per_s / demand.heading_cosine, 4.0);
    vehicle_m_per_s += (wanted_m_per_s - vehicle_m_per_s) * kStep_s / 0.5;
    now.vehicle_speed_m_per_s = vehicle_m_per_s;
  }
  add_surroundings(motor, Random(seed, "surroundings"), inputs);
  return inputs;
}

}  // namespace heatsoak::suite
