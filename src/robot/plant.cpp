#include "robot/plant.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace heatsoak {
namespace {

constexpr std::array<std::string_view, 2> kElectricTables{"drive", "battery"};

/// State and rate of change as one vector: x, y, yaw, v_x, v_y, yaw rate, charge, wheel speeds.
constexpr int kFirstWheel = 7;
constexpr int kSize = kFirstWheel + kMostWheels;
using Vector = std::array<double, kSize>;
/// In m, m/s, rad, rad/s or A s: far below what counts beside the grain of a double.
constexpr double kRest = 1e-60;

Vector packed(const PlantState& state) {
  Vector y{state.pose.x_m,           state.pose.y_m,           state.pose.yaw_rad,
           state.velocity.x_m_per_s, state.velocity.y_m_per_s, state.velocity.yaw_rad_per_s,
           state.battery_charge_A_s};
  std::copy(state.wheel_speed_rad_per_s.begin(), state.wheel_speed_rad_per_s.end(), y.begin() + kFirstWheel);
  return y;
}

PlantState unpacked(const Vector& y) {
  PlantState state{{y[0], y[1], y[2]}, {y[3], y[4], y[5]}, {}, y[6]};
  std::copy(y.begin() + kFirstWheel, y.end(), state.wheel_speed_rad_per_s.begin());
  return state;
}

struct Stage {
  PlantOutput output;
  Vector rate{};
  PerWheel contact_N_s_per_m{};        ///< rolling force over slip
  PerWheel resistance_Nm_s_per_rad{};  ///< of motor and friction against a wheel's turning
};

struct Electrics {
  std::array<MotorPoint, kMostWheels> points;
  double power_W = 0.0;
  double highest_bridge_V = 0.0;  ///< of any motor, without sign
  bool at_bus = false;            ///< the bus limits a motor
};

Electrics motors_at(const PlantConfig& plant, const PlantState& state, const PlantInput& input,
                    const std::array<MotorCommand, kMostWheels>& command, double bus_V) {
  Electrics made;
  for (int i = 0; i < plant.body.kinematics.wheel_count; ++i) {
    const double motor_rad_per_s = state.wheel_speed_rad_per_s[i] * plant.gear_ratio;
    made.points[i] = motor_point(plant.motor, plant.driver, command[i], motor_rad_per_s, input.winding_C[i], input.magnet_C[i], bus_V);
    made.power_W += made.points[i].input_W;
    made.highest_bridge_V = std::max(made.highest_bridge_V, std::abs(made.points[i].bridge_V));
  }
  made.at_bus = made.highest_bridge_V >= bus_V;
  return made;
}

/// The bus voltage that the motors it limits bring about: V + R·P(V)/V = E, by the Illinois rule.
Electrics sagging_bus(const PlantConfig& plant, const PlantState& state, const PlantInput& input) {
  const double source_V = open_circuit_V(plant.battery, state.battery_charge_A_s);
  const auto excess_V = [&](const Electrics& at, double bus_V) {
    return bus_V - source_V + plant.battery.internal_resistance_ohm * at.power_W / bus_V;
  };
  double high_V = source_V;
  Electrics at = motors_at(plant, state, input, input.command, high_V);
  double high_excess_V = excess_V(at, high_V);
  // The current that the full voltage draws sags too far, unless motors short of their limit draw more at less.
  double low_V = std::max(high_V - high_excess_V, 0.01 * source_V);
  double low_excess_V = excess_V(motors_at(plant, state, input, input.command, low_V), low_V);
  if (low_excess_V > 0.0) {
    low_V = 0.01 * source_V;
    low_excess_V = excess_V(motors_at(plant, state, input, input.command, low_V), low_V);
  }
  if (high_excess_V <= 0.0 || low_excess_V >= 0.0) {
    return at;  // braking lifts the bus: it limits nobody in the end
  }
  for (int round = 0; round < 60 && high_V - low_V > 1e-12 * source_V; ++round) {
    const double bus_V = high_V - high_excess_V * (high_V - low_V) / (high_excess_V - low_excess_V);
    at = motors_at(plant, state, input, input.command, bus_V);
    const double now_V = excess_V(at, bus_V);
    if (std::abs(now_V) < 1e-10 * source_V) {
      break;
    }
    if (now_V > 0.0) {
      high_V = bus_V;
      high_excess_V = now_V;
      low_excess_V *= 0.5;
    } else {
      low_V = bus_V;
      low_excess_V = now_V;
      high_excess_V *= 0.5;
    }
  }
  return at;
}

/// Not even the drivers' own electronics run any more.
Electrics nothing_runs(const PlantConfig& plant, const PlantState& state, const PlantInput& input) {
  Electrics made = motors_at(plant, state, input, {}, 0.0);
  made.power_W = 0.0;
  for (MotorPoint& each : made.points) {
    each.driver_W = each.input_W = 0.0;
  }
  return made;
}

/// Motors and battery at the voltage that they bring about together.
std::array<MotorPoint, kMostWheels> settle_electrics(const PlantConfig& plant, const PlantState& state, const PlantInput& input,
                                                     PlantOutput& out) {
  const double source_V = open_circuit_V(plant.battery, state.battery_charge_A_s);
  const bool is_empty = state.battery_charge_A_s <= 0.0;
  Electrics made = is_empty ? nothing_runs(plant, state, input) : motors_at(plant, state, input, input.command, source_V);
  BatteryLoad load = battery_load(plant.battery, state.battery_charge_A_s, made.power_W);
  // With the bus found, what it limits is limited by it; else only whoever is between source and bus.
  if (!is_empty && (made.at_bus || made.highest_bridge_V >= load.terminal_V)) {
    made = sagging_bus(plant, state, input);
    load = battery_load(plant.battery, state.battery_charge_A_s, made.power_W);
  }
  if (load.collapsed) {
    made = motors_at(plant, state, input, {}, source_V);
    load = battery_load(plant.battery, state.battery_charge_A_s, made.power_W);
    out.undervoltage = true;
  }
  out.undervoltage = out.undervoltage || is_empty;
  out.battery_V = load.terminal_V;
  out.battery_current_A = load.current_A;
  out.battery_source_W = source_V * load.current_A;
  out.battery_loss_W = plant.battery.internal_resistance_ohm * load.current_A * load.current_A;
  return made.points;
}

/// Contacts: their forces per normal force are known, the loads follow from the forces: F = Σ N_i(F)·g_i, a 2×2 system.
void settle_contacts(const BodyConfig& body, const PlantInput& input, const std::array<ContactRatios, kMostWheels>& ratios,
                     PlantOutput& out) {
  const WeightConfig& weight = body.weight;
  const double h_m = weight.center_of_gravity_height_m;
  const LoadMoment without = load_moment(weight, {}, input.external, input.external_height_m);
  std::array<std::array<double, 2>, 2> matrix{{{1.0, 0.0}, {0.0, 1.0}}};
  std::array<double, 2> right_N{};
  for (int i = 0; i < weight.wheel_count; ++i) {
    const WheelDirections& wheel = body.kinematics.wheels[i];
    const double g_x = ratios[i].rolling_ratio * wheel.rolling_x_share + ratios[i].lateral_ratio * wheel.axle_x_share;
    const double g_y = ratios[i].rolling_ratio * wheel.rolling_y_share + ratios[i].lateral_ratio * wheel.axle_y_share;
    const double standing_N = weight.level_share[i] * weight.mass_kg * kGravity_m_per_s2 + weight.along_x_per_m[i] * without.x_Nm +
                              weight.along_y_per_m[i] * without.y_Nm;
    right_N[0] += standing_N * g_x;
    right_N[1] += standing_N * g_y;
    matrix[0][0] += h_m * g_x * weight.along_x_per_m[i];
    matrix[0][1] += h_m * g_x * weight.along_y_per_m[i];
    matrix[1][0] += h_m * g_y * weight.along_x_per_m[i];
    matrix[1][1] += h_m * g_y * weight.along_y_per_m[i];
  }
  const double determinant = matrix[0][0] * matrix[1][1] - matrix[0][1] * matrix[1][0];
  const Wrench ground{(right_N[0] * matrix[1][1] - right_N[1] * matrix[0][1]) / determinant,
                      (right_N[1] * matrix[0][0] - right_N[0] * matrix[1][0]) / determinant, 0.0};
  const NormalLoads loads = normal_loads(weight, load_moment(weight, ground, input.external, input.external_height_m));
  out.normal_force_N = loads.force_N;
  out.lifted = loads.lifted;
}

/// Body: rolling forces, roller drag and push.
BodyAcceleration accelerate_body(const BodyConfig& body, const PlantState& state, const PlantInput& input,
                                 const std::array<ContactRatios, kMostWheels>& ratios, Stage& stage) {
  const PerWheel lateral_m_per_s = lateral_speeds_m_per_s(body.kinematics, state.velocity);
  PerWheel lateral_N{};
  for (int i = 0; i < body.kinematics.wheel_count; ++i) {
    stage.output.rolling_force_N[i] = ratios[i].rolling_ratio * stage.output.normal_force_N[i];
    lateral_N[i] = ratios[i].lateral_ratio * stage.output.normal_force_N[i];
    stage.output.roller_W[i] = -lateral_N[i] * lateral_m_per_s[i];
    stage.output.slip_W[i] = stage.output.rolling_force_N[i] * stage.output.slip_m_per_s[i];
  }
  const Wrench rolling = wrench_of_rolling_forces(body.kinematics, stage.output.rolling_force_N);
  const Wrench lateral = wrench_of_lateral_forces(body.kinematics, lateral_N);
  const Wrench& push = input.external;
  stage.output.external_W =
      push.x_N * state.velocity.x_m_per_s + push.y_N * state.velocity.y_m_per_s + push.yaw_Nm * state.velocity.yaw_rad_per_s;
  return acceleration_of_wrench(
      body, state.velocity.yaw_rad_per_s,
      {rolling.x_N + lateral.x_N + push.x_N, rolling.y_N + lateral.y_N + push.y_N, rolling.yaw_Nm + lateral.yaw_Nm + push.yaw_Nm});
}

/// Wheel i: motor through gear against friction, rolling loss and ground.
void accelerate_wheel(const PlantConfig& plant, int i, const PlantState& state, const MotorPoint& point, double friction_Nm,
                      const ContactRatios& ratios, Stage& stage) {
  PlantOutput& out = stage.output;
  const double speed_rad_per_s = state.wheel_speed_rad_per_s[i];
  const double radius_m = plant.body.kinematics.wheel_radius_m;
  const double smoothing = plant.body.friction.smoothing_rad_per_s;
  const double root_rad_per_s = std::sqrt(speed_rad_per_s * speed_rad_per_s + smoothing * smoothing);
  const double drag_Nm = plant.motor.drag_torque_Nm * speed_rad_per_s / root_rad_per_s;
  out.current_A[i] = point.current_A;
  out.terminal_V[i] = point.terminal_V;
  out.motor_speed_rad_per_s[i] = speed_rad_per_s * plant.gear_ratio;
  out.motor_torque_Nm[i] = point.torque_constant_Nm_per_A * point.current_A - drag_Nm;
  // A gear's input when it drives is the motor, when it brakes the wheel: loss by the motor's torque either way.
  const double geared_Nm = out.motor_torque_Nm[i] * plant.gear_ratio;
  const double part = geared_Nm * speed_rad_per_s >= 0.0 ? 1.0 - plant.gear_efficiency : 1.0 / plant.gear_efficiency - 1.0;
  const double gear_loss_Nm = part * std::abs(geared_Nm) * speed_rad_per_s / root_rad_per_s;
  out.wheel_torque_Nm[i] = geared_Nm - gear_loss_Nm;
  const double ground_Nm = out.rolling_force_N[i] * radius_m;
  const double rolling_loss_Nm = transmission_loss_Nm(plant.body.rolling_efficiency, ground_Nm, speed_rad_per_s, smoothing);
  const double inertia_kg_m2 = plant.body.wheel_inertia_kg_m2;
  stage.rate[kFirstWheel + i] = (out.wheel_torque_Nm[i] - friction_Nm - rolling_loss_Nm - ground_Nm) / inertia_kg_m2;
  out.copper_W[i] = point.copper_W;
  out.driver_W[i] = point.driver_W;
  out.motor_drag_W[i] = drag_Nm * out.motor_speed_rad_per_s[i];
  out.gear_W[i] = gear_loss_Nm * speed_rad_per_s;
  out.rolling_W[i] = rolling_loss_Nm * speed_rad_per_s;
  out.friction_W[i] = friction_Nm * speed_rad_per_s;
  const double geared_constant_Nm_per_A = point.torque_constant_Nm_per_A * plant.gear_ratio;
  const double dry_Nm =
      plant.body.friction.wheel_torque_Nm + plant.body.friction.heading.constant_Nm[i] + plant.motor.drag_torque_Nm * plant.gear_ratio;
  stage.contact_N_s_per_m[i] = ratios.rolling_slope_s_per_m * out.normal_force_N[i];
  stage.resistance_Nm_s_per_rad[i] = dry_Nm * smoothing * smoothing / (root_rad_per_s * root_rad_per_s * root_rad_per_s) +
                                     plant.body.friction.wheel_damping_Nm_s_per_rad +
                                     geared_constant_Nm_per_A * geared_constant_Nm_per_A / point.resistance_ohm;
}

Stage evaluate(const PlantConfig& plant, const PlantState& state, const PlantInput& input) {
  Stage stage;
  const BodyConfig& body = plant.body;
  const std::array<MotorPoint, kMostWheels> points = settle_electrics(plant, state, input, stage.output);
  const PerWheel rolling_m_per_s = rolling_speeds_m_per_s(body.kinematics, state.velocity);
  const PerWheel lateral_m_per_s = lateral_speeds_m_per_s(body.kinematics, state.velocity);
  std::array<ContactRatios, kMostWheels> ratios;
  for (int i = 0; i < body.kinematics.wheel_count; ++i) {
    stage.output.slip_m_per_s[i] = body.kinematics.wheel_radius_m * state.wheel_speed_rad_per_s[i] - rolling_m_per_s[i];
    ratios[i] = contact_ratios(body.traction, stage.output.slip_m_per_s[i], lateral_m_per_s[i]);
    stage.output.limited = stage.output.limited || points[i].limited;
  }
  settle_contacts(body, input, ratios, stage.output);
  const BodyAcceleration rates = rates_from_acceleration(state.velocity, accelerate_body(body, state, input, ratios, stage));
  const BodyVelocity global = to_global(state.velocity, state.pose.yaw_rad);
  stage.rate = {global.x_m_per_s, global.y_m_per_s,     global.yaw_rad_per_s,           rates.x_m_per_s2,
                rates.y_m_per_s2, rates.yaw_rad_per_s2, -stage.output.battery_current_A};
  const PerWheel friction_Nm = friction_torques_Nm(body.friction, body.kinematics, state.velocity, state.wheel_speed_rad_per_s);
  for (int i = 0; i < body.kinematics.wheel_count; ++i) {
    accelerate_wheel(plant, i, state, points[i], friction_Nm[i], ratios[i], stage);
  }
  return stage;
}

/// (1 − γ·h·A)·k = b, where A holds what is stiff: the contacts, k_i·(r·ω_i − J_i·v), which couple wheels and body, and
/// what resists each wheel. The wheels are eliminated, three equations for the body's velocity are left.
class StiffPart {
 public:
  StiffPart(const BodyConfig& body, const Stage& stage, double h_s) : body_(body), contact_N_s_per_m_(stage.contact_N_s_per_m) {
    static const double kGamma = 1.0 - std::sqrt(0.5);
    share_s_ = kGamma * h_s;
    inverse_mass_ << 1.0 / body.weight.mass_kg, 1.0 / body.weight.mass_kg, 1.0 / body.yaw_inertia_kg_m2;
    const double radius_m = body.kinematics.wheel_radius_m;
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
    for (int i = 0; i < body.kinematics.wheel_count; ++i) {
      const WheelDirections& wheel = body.kinematics.wheels[i];
      rows_[i] << wheel.rolling_x_share, wheel.rolling_y_share, body.kinematics.contact_radius_m;
      const double resisted_factor = 1.0 + share_s_ * stage.resistance_Nm_s_per_rad[i] / body.wheel_inertia_kg_m2;
      wheel_factor_[i] = resisted_factor + share_s_ * contact_N_s_per_m_[i] * radius_m * radius_m / body.wheel_inertia_kg_m2;
      matrix += rows_[i] * rows_[i].transpose() * (share_s_ * contact_N_s_per_m_[i] * resisted_factor / wheel_factor_[i]);
    }
    inverse_ = (Eigen::Matrix3d::Identity() + inverse_mass_.asDiagonal() * matrix).inverse();
  }

  [[nodiscard]] Vector solved(const Vector& right) const {
    const double radius_m = body_.kinematics.wheel_radius_m;
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    for (int i = 0; i < body_.kinematics.wheel_count; ++i) {
      force += rows_[i] * (share_s_ * contact_N_s_per_m_[i] * radius_m * right[kFirstWheel + i] / wheel_factor_[i]);
    }
    const Eigen::Vector3d velocity = inverse_ * (Eigen::Vector3d(right[3], right[4], right[5]) + inverse_mass_.cwiseProduct(force));
    Vector solution = right;
    std::copy(velocity.data(), velocity.data() + 3, solution.begin() + 3);
    for (int i = 0; i < body_.kinematics.wheel_count; ++i) {
      const double by_body = share_s_ * contact_N_s_per_m_[i] * radius_m / body_.wheel_inertia_kg_m2 * rows_[i].dot(velocity);
      solution[kFirstWheel + i] = (right[kFirstWheel + i] + by_body) / wheel_factor_[i];
    }
    return solution;
  }

 private:
  const BodyConfig& body_;
  PerWheel contact_N_s_per_m_;
  double share_s_ = 0.0;
  Eigen::Vector3d inverse_mass_;
  std::array<Eigen::Vector3d, kMostWheels> rows_;
  PerWheel wheel_factor_{};
  Eigen::Matrix3d inverse_;
};

void average(PerWheel& a, const PerWheel& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    a[i] = 0.5 * (a[i] + b[i]);
  }
}

PlantOutput mean(const PlantOutput& first, const PlantOutput& second) {
  PlantOutput out = first;
  for (PerWheel PlantOutput::*const each :
       {&PlantOutput::current_A, &PlantOutput::terminal_V, &PlantOutput::motor_torque_Nm, &PlantOutput::motor_speed_rad_per_s,
        &PlantOutput::wheel_torque_Nm, &PlantOutput::rolling_force_N, &PlantOutput::normal_force_N, &PlantOutput::slip_m_per_s,
        &PlantOutput::copper_W, &PlantOutput::driver_W, &PlantOutput::motor_drag_W, &PlantOutput::gear_W, &PlantOutput::rolling_W,
        &PlantOutput::friction_W, &PlantOutput::slip_W, &PlantOutput::roller_W}) {
    average(out.*each, second.*each);
  }
  for (double PlantOutput::*const each : {&PlantOutput::battery_V, &PlantOutput::battery_current_A, &PlantOutput::battery_source_W,
                                          &PlantOutput::battery_loss_W, &PlantOutput::external_W}) {
    out.*each = 0.5 * (first.*each + second.*each);
  }
  for (bool PlantOutput::*const each : {&PlantOutput::limited, &PlantOutput::lifted, &PlantOutput::undervoltage}) {
    out.*each = first.*each || second.*each;
  }
  return out;
}

}  // namespace

PlantConfig make_plant(const Robot& robot, const MotorValues& motor, double period_s) {
  PlantConfig plant;
  plant.body = make_body(robot, motor);
  require_figures(robot, kElectricTables);
  plant.motor = make_electrics(robot, motor);
  plant.driver = make_driver(robot);
  plant.battery = {robot.battery_full_V, robot.battery_empty_V, robot.battery_resistance_ohm, robot.battery_capacity_A_s};
  plant.gear_ratio = robot.gear_ratio;
  plant.gear_efficiency = robot.gear_efficiency;
  plant.period_s = period_s;
  return plant;
}

PlantState plant_at_rest(const PlantConfig& plant) {
  PlantState state;
  state.battery_charge_A_s = plant.battery.capacity_A_s;
  return state;
}

double heat_W(const PlantOutput& output) {
  double sum_W = 0.0;
  for (const PerWheel* const each : {&output.copper_W, &output.driver_W, &output.motor_drag_W, &output.gear_W, &output.rolling_W,
                                     &output.friction_W, &output.slip_W, &output.roller_W}) {
    for (const double power_W : *each) {
      sum_W += power_W;
    }
  }
  return sum_W;
}

PlantOutput step(const PlantConfig& plant, PlantState& state, const PlantInput& input) {
  // y₁ = y + h·(3/2·k₁ + 1/2·k₂), (1 − γ·h·A)·k₁ = f(y), (1 − γ·h·A)·k₂ = f(y + h·k₁) − 2·k₁, γ = 1 − 1/√2.
  const double h_s = plant.period_s;
  const Vector y = packed(state);
  const Stage first = evaluate(plant, state, input);
  const StiffPart stiff(plant.body, first, h_s);
  const Vector k_1 = stiff.solved(first.rate);
  Vector between;
  for (int j = 0; j < kSize; ++j) {
    between[j] = y[j] + h_s * k_1[j];
  }
  const Stage second = evaluate(plant, unpacked(between), input);
  Vector right;
  for (int j = 0; j < kSize; ++j) {
    right[j] = second.rate[j] - 2.0 * k_1[j];
  }
  const Vector k_2 = stiff.solved(right);
  Vector next;
  for (int j = 0; j < kSize; ++j) {
    next[j] = y[j] + h_s * (1.5 * k_1[j] + 0.5 * k_2[j]);
    // What dies away is at rest in the end: arithmetic with the smallest of numbers takes a hundred times as long.
    next[j] = std::abs(next[j]) < kRest ? 0.0 : next[j];
  }
  state = unpacked(next);
  return mean(first.output, second.output);
}

}  // namespace heatsoak
