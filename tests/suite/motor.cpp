#include "motor.h"

#include <cmath>

namespace heatsoak::suite {

const Family& small_family() {
  // EC 45 flat, 70 W, 24 V, as in motor_db. The capacities are time constant / resistance.
  static const Family kSmall{.name = "small",
                             .scale = 1.0,
                             .resistance_25C_ohm = 0.608,
                             .torque_constant_Nm_per_A = 0.0369,
                             .no_load_current_A = 0.234,
                             .nominal_current_A = 3.21,
                             .bus_V = 24.0,
                             .top_speed_rad_per_s = 450.0,
                             .inertia_kg_m2 = 4.5e-4,
                             .contact_K_per_W = 4.1,
                             .air_K_per_W = 3.56,
                             .winding_J_per_K = 29.6 / 4.1,
                             .stator_J_per_K = 178.0 / 3.56,
                             .hottest_C = 118.0};
  return kSmall;
}

const Family& large_family() {
  // No product: an outer-rotor motor of 900 W with ten times the heat.
  static const Family kLarge{.name = "large",
                             .scale = 10.0,
                             .resistance_25C_ohm = 0.157,
                             .torque_constant_Nm_per_A = 0.085,
                             .no_load_current_A = 0.55,
                             .nominal_current_A = 21.5,
                             .bus_V = 48.0,
                             .top_speed_rad_per_s = 400.0,
                             .inertia_kg_m2 = 6.0e-3,
                             .contact_K_per_W = 0.52,
                             .air_K_per_W = 0.47,
                             .winding_J_per_K = 38.0 / 0.52,
                             .stator_J_per_K = 235.0 / 0.47,
                             .hottest_C = 140.0};
  return kLarge;
}

double mean_C(const Parts& parts, std::span<const double> temperature_C) {
  double sum_C = 0.0;
  for (const Part& part : parts) {
    sum_C += part.share * temperature_C[part.body];
  }
  return sum_C;
}

void source(const Parts& parts, double power_W, HeatBook& book) {
  for (const Part& part : parts) {
    book.source(part.body, part.share * power_W);
  }
}

void flow(const Parts& from, const Parts& to, double power_W, HeatBook& book) {
  for (const Part& one : from) {
    for (const Part& other : to) {
      book.flow(one.body, other.body, one.share * other.share * power_W);
    }
  }
}

void to_air(const Parts& from, double power_W, HeatBook& book) {
  for (const Part& part : from) {
    book.to_air(part.body, part.share * power_W);
  }
}

void add_losses(Motor& motor) {
  const double resistance_ohm = motor.resistance_25C_ohm;
  const Parts winding = motor.winding;
  motor.network.laws.emplace_back([=](const Instant& now, std::span<const double> temperature_C, HeatBook& book) {
    for (const Part& part : winding) {
      const double hot_ohm = resistance_ohm * (1.0 + kCopper_per_K * (temperature_C[part.body] - 25.0));
      book.source(part.body, part.share * hot_ohm * now.current_A * now.current_A);
    }
  });
  const double drag_Nm = motor.torque_constant_Nm_per_A * motor.no_load_current_A;
  const Parts stator = motor.stator;
  motor.network.laws.emplace_back(
      [=](const Instant& now, std::span<const double>, HeatBook& book) { source(stator, drag_Nm * std::abs(now.speed_rad_per_s), book); });
}

namespace {

void draw_electrical(Motor& motor, Random& random) {
  motor.resistance_25C_ohm = motor.nominal.resistance_25C_ohm * random.uniform(0.95, 1.05);
  motor.torque_constant_Nm_per_A = motor.nominal.torque_constant_Nm_per_A * random.uniform(0.97, 1.03);
  motor.no_load_current_A = motor.nominal.no_load_current_A * random.uniform(0.75, 1.35);
}

/// Factors of a resistance and a capacity, each within 25 %, whose product is within 25 %, too.
std::pair<double, double> within_a_quarter(Random& random) {
  for (;;) {
    const double resistance_factor = random.uniform(0.75, 1.25);
    const double capacity_factor = random.uniform(0.75, 1.25);
    if (std::abs(resistance_factor * capacity_factor - 1.0) < 0.25) {
      return {resistance_factor, capacity_factor};
    }
  }
}

}  // namespace

Motor two_body_motor(const Family& family, Random random) {
  Motor motor;
  motor.nominal = family;
  draw_electrical(motor, random);
  const auto [contact_factor, winding_factor] = within_a_quarter(random);
  const auto [air_factor, stator_factor] = within_a_quarter(random);
  motor.network.bodies = {{"winding", family.winding_J_per_K * winding_factor}, {"stator", family.stator_J_per_K * stator_factor}};
  motor.network.links = {{0, 1, 1.0 / (family.contact_K_per_W * contact_factor)}};
  motor.network.air_links = {{1, 1.0 / (family.air_K_per_W * air_factor)}};
  motor.winding = {{0, 1.0}};
  motor.stator = {{1, 1.0}};
  add_losses(motor);
  return motor;
}

Motor eight_body_motor(const Family& family, Random random) {
  enum : std::size_t { kSlot, kEndTurns, kTeeth, kYoke, kMagnets, kPlate, kHousing, kMount };
  Motor motor;
  motor.nominal = family;
  draw_electrical(motor, random);
  // The numbers are those of the small motor, estimated from masses of copper, steel and aluminium and from contact areas.
  const auto about = [&](double nominal) { return family.scale * nominal * random.log_uniform(0.7, 1.4); };
  motor.network.bodies = {{"slot_copper", about(4.0)}, {"end_turns", about(3.2)},     {"teeth", about(11.0)},  {"yoke", about(13.0)},
                          {"magnets", about(17.0)},    {"bearing_plate", about(9.0)}, {"housing", about(8.0)}, {"mount", about(30.0)}};
  motor.network.links = {{kSlot, kEndTurns, about(0.20)}, {kSlot, kTeeth, about(0.27)},    {kEndTurns, kYoke, about(0.045)},
                         {kTeeth, kYoke, about(1.0)},     {kTeeth, kMagnets, about(0.06)}, {kYoke, kPlate, about(0.5)},
                         {kYoke, kHousing, about(0.2)},   {kMagnets, kPlate, about(0.05)}, {kPlate, kHousing, about(0.4)},
                         {kPlate, kMount, about(0.2)}};
  motor.network.air_links = {
      {kEndTurns, about(0.008)}, {kMagnets, about(0.06)}, {kPlate, about(0.03)}, {kHousing, about(0.12)}, {kMount, about(0.10)}};
  const double slot_share = random.uniform(0.45, 0.65);
  motor.winding = {{kSlot, slot_share}, {kEndTurns, 1.0 - slot_share}};
  const double teeth_share = random.uniform(0.3, 0.45);
  const double yoke_share = random.uniform(0.2, 0.3);
  motor.stator = {{kTeeth, teeth_share}, {kYoke, yoke_share}, {kMagnets, 0.1}, {kPlate, 0.9 - teeth_share - yoke_share}};
  // The thermistor lies in the end turns of most motors; the outer sensor is glued to the yoke or to the bearing plate.
  motor.winding_sensor = random.chance(0.7) ? kEndTurns : kSlot;
  motor.stator_sensor = random.chance(0.5) ? kYoke : kPlate;
  add_losses(motor);
  return motor;
}

}  // namespace heatsoak::suite
