#include "robot/plant.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "robot/wheel_laws.h"

namespace heatsoak::robot {
namespace {

constexpr std::array<std::string_view, 2> kElectricTables{"drive", "battery"};

// Indices in Motion::body.
constexpr int kPose = 0;
constexpr int kVelocity = 3;
constexpr int kCharge = 6;
constexpr int kBodySize = 7;
/// In m, m/s, rad, rad/s or A s: far below the resolution of any state.
constexpr double kRest = 1e-60;

/// State or rate of change: x, y, yaw, v_x, v_y, yaw rate, charge, and wheel speeds.
struct Motion {
  std::array<double, kBodySize> body;
  Wheels wheels;

  [[nodiscard]] BodyVelocity velocity() const { return {body[kVelocity], body[kVelocity + 1], body[kVelocity + 2]}; }
};

Motion packed(const PlantState& state) {
  return {{state.pose.x_m, state.pose.y_m, state.pose.yaw_rad, state.velocity.x_m_per_s, state.velocity.y_m_per_s,
           state.velocity.yaw_rad_per_s, state.battery_charge_A_s},
          as_wheels(state.wheel_speed_rad_per_s)};
}

/// Returns from + factor·by.
Motion moved(const Motion& from, double factor, const Motion& by) {
  Motion made;
  for (int i = 0; i < kBodySize; ++i) {
    made.body[i] = from.body[i] + factor * by.body[i];
  }
  made.wheels = from.wheels + factor * by.wheels;
  return made;
}

/// Sets decayed values to 0, because arithmetic with denormal numbers is about a hundred times slower.
double or_rest(double value) { return std::abs(value) < kRest ? 0.0 : value; }

void unpack(const Motion& motion, PlantState& state) {
  const auto body = [&](int place) { return or_rest(motion.body[place]); };
  state.pose = {body(kPose), body(kPose + 1), body(kPose + 2)};
  state.velocity = {body(kVelocity), body(kVelocity + 1), body(kVelocity + 2)};
  state.battery_charge_A_s = body(kCharge);
  for (int i = 0; i < kMostWheels; ++i) {
    state.wheel_speed_rad_per_s[i] = or_rest(motion.wheels[i]);
  }
}

/// The two evaluations of a step. Each adds half of its values to the means.
enum class Half { first, second };

template <Half kHalf>
void book(PerWheel& mean, const Wheels& value) {
  if constexpr (kHalf == Half::first) {
    as_wheels(mean) = 0.5 * value;
  } else {
    as_wheels(mean) += 0.5 * value;
  }
}
template <Half kHalf>
void book(double& mean, double value) {
  mean = kHalf == Half::first ? 0.5 * value : mean + 0.5 * value;
}
template <Half kHalf>
void book(bool& any, bool value) {
  any = kHalf == Half::first ? value : any || value;
}

/// Constants of one step: both evaluations use them.
struct Held {
  Held(const PlantConfig& plant_of_step, const PlantInput& input_of_step)
      : plant(plant_of_step),
        input(input_of_step),
        wheels(wheel_arrays(plant.body.kinematics)),
        circuits(motor_circuits(plant.motor, plant.driver, as_wheels(input.winding_C), as_wheels(input.magnet_C))),
        demands(driver_demands(plant.driver, input.command, plant.body.kinematics.wheel_count)),
        standing_N(plane_loads_N(plant.body.weight, load_moment(plant.body.weight, {}, input.external, input.external_height_m))) {}

  const PlantConfig& plant;
  const PlantInput& input;
  WheelArrays wheels;
  MotorCircuits circuits;
  DriverDemands demands;
  Wheels standing_N;  ///< loads without forces from the ground
};

struct Electrics {
  MotorCurrents motors;
  BatteryLoad battery;
  double power_W = 0.0;           ///< power drawn from the battery
  double standby_W = 0.0;         ///< standby power of each driver
  double highest_bridge_V = 0.0;  ///< largest magnitude of any motor's bridge voltage
  bool undervoltage = false;
};

Electrics motors_at(const Held& held, const DriverDemands& demands, const Wheels& back_emf_V, double bus_V) {
  Electrics made;
  made.motors = motor_currents(held.circuits, demands, back_emf_V, bus_V);
  made.standby_W = held.plant.driver.standby_W;
  made.power_W = (made.motors.bridge_V * made.motors.current_A).sum() + held.plant.body.kinematics.wheel_count * made.standby_W;
  made.highest_bridge_V = made.motors.bridge_V.abs().maxCoeff();
  return made;
}

/// Finds the bus voltage when the motors are voltage-limited: V + R·P(V)/V = E, by the Illinois method.
Electrics sagging_bus(const Held& held, const Wheels& back_emf_V, double source_V) {
  const auto excess_V = [&](const Electrics& at, double bus_V) {
    return bus_V - source_V + held.plant.battery.internal_resistance_ohm * at.power_W / bus_V;
  };
  const auto motors = [&](double bus_V) { return motors_at(held, held.demands, back_emf_V, bus_V); };
  double high_V = source_V;
  Electrics at = motors(high_V);
  double high_excess_V = excess_V(at, high_V);
  // The current at full voltage gives a voltage that is too low, unless motors below their limit draw more current at less voltage.
  double low_V = std::max(high_V - high_excess_V, 0.01 * source_V);
  double low_excess_V = excess_V(motors(low_V), low_V);
  if (low_excess_V > 0.0) {
    low_V = 0.01 * source_V;
    low_excess_V = excess_V(motors(low_V), low_V);
  }
  if (high_excess_V <= 0.0 || low_excess_V >= 0.0) {
    return at;  // braking raises the bus voltage, so it is not a limit
  }
  for (int round = 0; round < 60 && high_V - low_V > 1e-12 * source_V; ++round) {
    const double bus_V = high_V - high_excess_V * (high_V - low_V) / (high_excess_V - low_excess_V);
    at = motors(bus_V);
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

DriverDemands all_open(const Held& held) { return driver_demands(held.plant.driver, {}, held.plant.body.kinematics.wheel_count); }

/// The battery is empty: even the drivers' electronics are off.
Electrics nothing_runs(const Held& held, double charge_A_s, const Wheels& back_emf_V) {
  Electrics made = motors_at(held, all_open(held), back_emf_V, 0.0);
  made.power_W = made.standby_W = 0.0;
  made.battery = battery_load(held.plant.battery, charge_A_s, 0.0);
  made.undervoltage = true;
  return made;
}

/// Motors and battery if the bus voltage limits a motor, or if the battery is empty or cannot supply the power.
[[gnu::noinline]] Electrics electrics_at_limits(const Held& held, double charge_A_s, const Wheels& back_emf_V, double source_V) {
  const BatteryConfig& battery = held.plant.battery;
  if (charge_A_s <= 0.0) {
    return nothing_runs(held, charge_A_s, back_emf_V);
  }
  Electrics made = motors_at(held, held.demands, back_emf_V, source_V);
  made.battery = battery_load(battery, charge_A_s, made.power_W);
  // The bus limits a motor only if its bridge voltage reaches the lower of source and terminal voltage.
  if (made.highest_bridge_V >= std::min(source_V, made.battery.terminal_V)) {
    made = sagging_bus(held, back_emf_V, source_V);
    made.battery = battery_load(battery, charge_A_s, made.power_W);
  }
  if (made.battery.collapsed) {
    made = motors_at(held, all_open(held), back_emf_V, source_V);
    made.battery = battery_load(battery, charge_A_s, made.power_W);
    made.undervoltage = true;
  }
  return made;
}

/// Returns motors and battery at their common bus voltage.
template <Half kHalf>
Electrics settle_electrics(const Held& held, double charge_A_s, const Wheels& back_emf_V, PlantOutput& out) {
  const double source_V = open_circuit_V(held.plant.battery, charge_A_s);
  Electrics made = motors_at(held, held.demands, back_emf_V, source_V);
  made.battery = battery_load(held.plant.battery, charge_A_s, made.power_W);
  const bool is_ordinary =
      charge_A_s > 0.0 && made.highest_bridge_V < std::min(source_V, made.battery.terminal_V) && !made.battery.collapsed;
  if (!is_ordinary) [[unlikely]] {
    made = electrics_at_limits(held, charge_A_s, back_emf_V, source_V);
  }
  const double current_A = made.battery.current_A;
  book<kHalf>(out.battery_V, made.battery.terminal_V);
  book<kHalf>(out.battery_current_A, current_A);
  book<kHalf>(out.battery_source_W, source_V * current_A);
  book<kHalf>(out.battery_loss_W, held.plant.battery.internal_resistance_ohm * current_A * current_A);
  book<kHalf>(out.undervoltage, made.undervoltage);
  book<kHalf>(out.limited, made.motors.limited);
  const double driver_ohm = held.plant.driver.resistance_ohm;
  const Wheels square_A2 = made.motors.current_A.square();
  book<kHalf>(out.current_A, made.motors.current_A);
  book<kHalf>(out.terminal_V, made.motors.bridge_V - driver_ohm * made.motors.current_A);
  book<kHalf>(out.copper_W, held.circuits.winding_ohm * square_A2);
  book<kHalf>(out.driver_W, driver_ohm * square_A2 + made.standby_W * held.wheels.present_share);
  return made;
}

struct Contacts {
  Wheels rolling_N;
  Wheels stiffness_N_s_per_m;  ///< rolling force over slip
  Wrench ground;               ///< sum of all forces along rolling directions and axles
};

/// Forces per normal force are known; the normal loads depend on the forces: F = Σ N_i(F)·g_i, a 2×2 system.
template <Half kHalf>
Contacts settle_contacts(const Held& held, const BodyVelocity& velocity, const Wheels& rim_m_per_s, PlantOutput& out) {
  const WheelArrays& wheels = held.wheels;
  const WeightConfig& weight = held.plant.body.weight;
  const Wheels rolling_m_per_s =
      wheels.rolling_x_share * velocity.x_m_per_s + wheels.rolling_y_share * velocity.y_m_per_s + wheels.arm_m * velocity.yaw_rad_per_s;
  const Wheels lateral_m_per_s = wheels.axle_x_share * velocity.x_m_per_s + wheels.axle_y_share * velocity.y_m_per_s;
  const Wheels slip_m_per_s = rim_m_per_s - rolling_m_per_s;
  const ContactRatios<Wheels> ratios = contact_ratios<Wheels>(held.plant.body.traction, slip_m_per_s, lateral_m_per_s);
  const Wheels g_x = ratios.rolling_ratio * wheels.rolling_x_share + ratios.lateral_ratio * wheels.axle_x_share;
  const Wheels g_y = ratios.rolling_ratio * wheels.rolling_y_share + ratios.lateral_ratio * wheels.axle_y_share;
  const Wheels along_x_share = weight.center_of_gravity_height_m * as_wheels(weight.along_x_per_m);
  const Wheels along_y_share = weight.center_of_gravity_height_m * as_wheels(weight.along_y_per_m);
  const double xx = 1.0 + (g_x * along_x_share).sum();
  const double xy = (g_x * along_y_share).sum();
  const double yx = (g_y * along_x_share).sum();
  const double yy = 1.0 + (g_y * along_y_share).sum();
  const double right_x_N = (held.standing_N * g_x).sum();
  const double right_y_N = (held.standing_N * g_y).sum();
  const double per_determinant = 1.0 / (xx * yy - xy * yx);
  const double x_N = (right_x_N * yy - right_y_N * xy) * per_determinant;
  const double y_N = (right_y_N * xx - right_x_N * yx) * per_determinant;
  Wheels normal_N = held.standing_N - along_x_share * x_N - along_y_share * y_N;
  const bool lifted = normal_N.minCoeff() < 0.0;
  if (lifted) [[unlikely]] {
    const LoadMoment moment = load_moment(weight, {x_N, y_N, 0.0}, held.input.external, held.input.external_height_m);
    normal_N = as_wheels(normal_loads(weight, moment).force_N);
  }
  Contacts made;
  made.rolling_N = ratios.rolling_ratio * normal_N;
  made.stiffness_N_s_per_m = ratios.rolling_slope_s_per_m * normal_N;
  made.ground = {(g_x * normal_N).sum(), (g_y * normal_N).sum(), (wheels.arm_m * made.rolling_N).sum()};
  book<kHalf>(out.rolling_force_N, made.rolling_N);
  book<kHalf>(out.normal_force_N, normal_N);
  book<kHalf>(out.slip_m_per_s, slip_m_per_s);
  book<kHalf>(out.slip_W, made.rolling_N * slip_m_per_s);
  book<kHalf>(out.roller_W, -ratios.lateral_ratio * normal_N * lateral_m_per_s);
  book<kHalf>(out.lifted, lifted);
  return made;
}

/// Stiff terms of the equations at the start of the step.
struct Stiffness {
  Wheels contact_N_s_per_m;        ///< rolling force over slip
  Wheels resistance_Nm_s_per_rad;  ///< slope of motor and friction torque over the wheel's speed
};

/// Motor through gear against friction, rolling loss and ground force. Returns accelerations of the wheels in rad/s². `dry_Nm` is the
/// magnitude of the dry friction torque.
template <Half kHalf>
Wheels accelerate_wheels(const Held& held, const Wheels& speed_rad_per_s, const Wheels& motor_current_A, const Wheels& dry_Nm,
                         const Contacts& contacts, PlantOutput& out, Stiffness& stiffness) {
  const PlantConfig& plant = held.plant;
  const FrictionConfig& friction = plant.body.friction;
  const double smoothing = friction.smoothing_rad_per_s;
  const Wheels per_root_s_per_rad = 1.0 / (speed_rad_per_s * speed_rad_per_s + smoothing * smoothing).sqrt();
  const Wheels sign = speed_rad_per_s * per_root_s_per_rad;
  const Wheels drag_Nm = plant.motor.drag_torque_Nm * sign;
  const Wheels motor_Nm = held.circuits.torque_constant_Nm_per_A * motor_current_A - drag_Nm;
  // The gear's input is the motor when driving and the wheel when braking; the loss is computed from the motor's torque in both cases.
  const Wheels geared_Nm = motor_Nm * plant.gear_ratio;
  const Wheels gear_loss_Nm = loss_torque_Nm(1.0 - plant.gear_efficiency, 1.0 / plant.gear_efficiency - 1.0, geared_Nm, sign);
  const Wheels wheel_Nm = geared_Nm - gear_loss_Nm;
  const Wheels ground_Nm = contacts.rolling_N * plant.body.kinematics.wheel_radius_m;
  const double efficiency = plant.body.rolling_efficiency;
  const Wheels rolling_loss_Nm = loss_torque_Nm(1.0 / efficiency - 1.0, 1.0 - efficiency, ground_Nm, sign);
  const Wheels friction_Nm = friction_torque_Nm(friction, dry_Nm, sign, speed_rad_per_s);
  const Wheels motor_rad_per_s = speed_rad_per_s * plant.gear_ratio;
  book<kHalf>(out.motor_speed_rad_per_s, motor_rad_per_s);
  book<kHalf>(out.motor_torque_Nm, motor_Nm);
  book<kHalf>(out.wheel_torque_Nm, wheel_Nm);
  book<kHalf>(out.motor_drag_W, drag_Nm * motor_rad_per_s);
  book<kHalf>(out.gear_W, gear_loss_Nm * speed_rad_per_s);
  book<kHalf>(out.rolling_W, rolling_loss_Nm * speed_rad_per_s);
  book<kHalf>(out.friction_W, friction_Nm * speed_rad_per_s);
  if constexpr (kHalf == Half::first) {
    const Wheels by_sign_Nm =
        friction.wheel_torque_Nm + as_wheels(friction.heading.constant_Nm) + plant.motor.drag_torque_Nm * plant.gear_ratio;
    const Wheels geared_constant_Nm_per_A = held.circuits.torque_constant_Nm_per_A * plant.gear_ratio;
    stiffness.contact_N_s_per_m = contacts.stiffness_N_s_per_m;
    stiffness.resistance_Nm_s_per_rad = by_sign_Nm * smoothing * smoothing * per_root_s_per_rad.cube() +
                                        friction.wheel_damping_Nm_s_per_rad +
                                        geared_constant_Nm_per_A.square() * held.circuits.conductance_S;
  }
  return (wheel_Nm - friction_Nm - rolling_loss_Nm - ground_Nm) * (1.0 / plant.body.wheel_inertia_kg_m2);
}

/// Returns the rate of change at a state and adds half of its values to `out`. Half::first also sets `stiffness`.
template <Half kHalf>
Motion evaluate(const Held& held, const Motion& at, PlantOutput& out, Stiffness& stiffness) {
  const BodyConfig& body = held.plant.body;
  const BodyVelocity velocity = at.velocity();
  const Wheels back_emf_V = held.circuits.torque_constant_Nm_per_A * held.plant.gear_ratio * at.wheels;
  const Electrics electrics = settle_electrics<kHalf>(held, at.body[kCharge], back_emf_V, out);
  const Contacts contacts = settle_contacts<kHalf>(held, velocity, body.kinematics.wheel_radius_m * at.wheels, out);
  const Wrench& push = held.input.external;
  book<kHalf>(out.external_W, push.x_N * velocity.x_m_per_s + push.y_N * velocity.y_m_per_s + push.yaw_Nm * velocity.yaw_rad_per_s);
  const Wrench& ground = contacts.ground;
  const BodyAcceleration rates = rates_from_acceleration(
      velocity,
      acceleration_of_wrench(body, velocity.yaw_rad_per_s, {ground.x_N + push.x_N, ground.y_N + push.y_N, ground.yaw_Nm + push.yaw_Nm}));
  const BodyVelocity global = to_global(velocity, at.body[kPose + 2]);
  const Wheels dry_Nm = dry_friction_Nm(body.friction, held.wheels, velocity);
  return {{global.x_m_per_s, global.y_m_per_s, global.yaw_rad_per_s, rates.x_m_per_s2, rates.y_m_per_s2, rates.yaw_rad_per_s2,
           -electrics.battery.current_A},
          accelerate_wheels<kHalf>(held, at.wheels, electrics.motors.current_A, dry_Nm, contacts, out, stiffness)};
}

/// Solves (1 − γ·h·A)·k = b. A holds the stiff terms: the contacts, k_i·(r·ω_i − J_i·v), which couple wheels and body, and the resistance
/// of each wheel. The wheels are eliminated, which leaves three equations for the body's velocity. Multiplied by mass and inertia they are
/// symmetric.
class StiffPart {
 public:
  StiffPart(const Held& held, const Stiffness& stiffness) : held_(held) {
    constexpr double kGamma = 1.0 - 0.5 * std::numbers::sqrt2;
    const BodyConfig& body = held.plant.body;
    const WheelArrays& wheels = held.wheels;
    const double share_s = kGamma * held.plant.period_s;
    const double radius_m = body.kinematics.wheel_radius_m;
    const double per_inertia = 1.0 / body.wheel_inertia_kg_m2;
    const Wheels contact_kg = share_s * stiffness.contact_N_s_per_m;
    const Wheels resisted_factor = 1.0 + share_s * per_inertia * stiffness.resistance_Nm_s_per_rad;
    per_wheel_factor_ = 1.0 / (resisted_factor + contact_kg * (radius_m * radius_m * per_inertia));
    by_wheel_kg_m_ = contact_kg * radius_m;
    by_body_per_m_ = by_wheel_kg_m_ * per_inertia;
    const Wheels left_kg = contact_kg * resisted_factor * per_wheel_factor_;
    const Wheels x_kg = left_kg * wheels.rolling_x_share;
    const Wheels y_kg = left_kg * wheels.rolling_y_share;
    const Wheels yaw_kg_m = left_kg * wheels.arm_m;
    invert(body.weight.mass_kg + (x_kg * wheels.rolling_x_share).sum(), (x_kg * wheels.rolling_y_share).sum(), (x_kg * wheels.arm_m).sum(),
           body.weight.mass_kg + (y_kg * wheels.rolling_y_share).sum(), (y_kg * wheels.arm_m).sum(),
           body.yaw_inertia_kg_m2 + (yaw_kg_m * wheels.arm_m).sum());
  }

  [[nodiscard]] Motion solved(const Motion& right) const {
    const WheelArrays& wheels = held_.wheels;
    const BodyConfig& body = held_.plant.body;
    const Wheels force = by_wheel_kg_m_ * right.wheels * per_wheel_factor_;
    const double x = body.weight.mass_kg * right.body[kVelocity] + (force * wheels.rolling_x_share).sum();
    const double y = body.weight.mass_kg * right.body[kVelocity + 1] + (force * wheels.rolling_y_share).sum();
    const double yaw = body.yaw_inertia_kg_m2 * right.body[kVelocity + 2] + (force * wheels.arm_m).sum();
    Motion solution = right;
    const double v_x = solution.body[kVelocity] = inverse_xx_ * x + inverse_xy_ * y + inverse_xz_ * yaw;
    const double v_y = solution.body[kVelocity + 1] = inverse_xy_ * x + inverse_yy_ * y + inverse_yz_ * yaw;
    const double v_yaw = solution.body[kVelocity + 2] = inverse_xz_ * x + inverse_yz_ * y + inverse_zz_ * yaw;
    const Wheels rolled = wheels.rolling_x_share * v_x + wheels.rolling_y_share * v_y + wheels.arm_m * v_yaw;
    solution.wheels = (right.wheels + by_body_per_m_ * rolled) * per_wheel_factor_;
    return solution;
  }

 private:
  /// Inverts a symmetric 3×3 matrix by cofactors; z is yaw.
  void invert(double xx, double xy, double xz, double yy, double yz, double zz) {
    inverse_xx_ = yy * zz - yz * yz;
    inverse_xy_ = xz * yz - xy * zz;
    inverse_xz_ = xy * yz - xz * yy;
    inverse_yy_ = xx * zz - xz * xz;
    inverse_yz_ = xy * xz - xx * yz;
    inverse_zz_ = xx * yy - xy * xy;
    const double per_determinant = 1.0 / (xx * inverse_xx_ + xy * inverse_xy_ + xz * inverse_xz_);
    for (double* const each : {&inverse_xx_, &inverse_xy_, &inverse_xz_, &inverse_yy_, &inverse_yz_, &inverse_zz_}) {
      *each *= per_determinant;
    }
  }

  const Held& held_;
  Wheels per_wheel_factor_;
  Wheels by_wheel_kg_m_;  ///< couples the wheels to the body
  Wheels by_body_per_m_;  ///< couples the body to the wheels
  double inverse_xx_, inverse_xy_, inverse_xz_, inverse_yy_, inverse_yz_, inverse_zz_;
};

}  // namespace

PlantConfig make_plant(const Robot& robot, const motor::MotorValues& motor, double period_s) {
  PlantConfig plant;
  plant.body = make_body(robot, motor);
  require_parameters(robot, kElectricTables);
  plant.motor = make_electrics(robot, motor);
  plant.driver = make_driver(robot);
  plant.battery = {robot.battery.full_V.value(), robot.battery.empty_V.value(), robot.battery.resistance_ohm.value(),
                   robot.battery.capacity_A_s.value()};
  plant.gear_ratio = robot.drive.gear_ratio;
  plant.gear_efficiency = robot.drive.gear_efficiency;
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

// Inlined completely: values of the wheels stay in registers, which saves about 10 % of the time.
[[gnu::flatten]] void step(const PlantConfig& plant, PlantState& state, const PlantInput& input, PlantOutput& output) {
  // y₁ = y + h·(3/2·k₁ + 1/2·k₂), (1 − γ·h·A)·k₁ = f(y), (1 − γ·h·A)·k₂ = f(y + h·k₁) − 2·k₁, γ = 1 − 1/√2.
  const double h_s = plant.period_s;
  const Held held(plant, input);
  const Motion y = packed(state);
  Stiffness stiffness;
  const Motion at_start = evaluate<Half::first>(held, y, output, stiffness);
  const StiffPart stiff(held, stiffness);
  const Motion k_1 = stiff.solved(at_start);
  const Motion between = moved(y, h_s, k_1);
  const Motion later = evaluate<Half::second>(held, between, output, stiffness);
  const Motion k_2 = stiff.solved(moved(later, -2.0, k_1));
  unpack(moved(y, 0.5 * h_s, moved(k_2, 3.0, k_1)), state);
}

PlantOutput step(const PlantConfig& plant, PlantState& state, const PlantInput& input) {
  PlantOutput output;
  step(plant, state, input, output);
  return output;
}

}  // namespace heatsoak::robot
