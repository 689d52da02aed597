// Effects of the catalogue. Sizes are relative to the nominal copper loss, the nominal conductances and the top speed of the family.
#include "effects.h"

#include <algorithm>
#include <cmath>

namespace heatsoak::suite {

double copper_W(const Motor& motor, const Instant& now, std::span<const double> temperature_C) {
  const double hot_ohm = motor.resistance_25C_ohm * (1.0 + kCopper_per_K * (motor.winding_C(temperature_C) - 25.0));
  return hot_ohm * now.current_A * now.current_A;
}

namespace {

using Heat = std::function<double(const Motor&, const Instant&, std::span<const double>)>;

double speed_ratio(const Motor& motor, const Instant& now) { return std::abs(now.speed_rad_per_s) / motor.nominal.top_speed_rad_per_s; }
double current_ratio(const Motor& motor, const Instant& now) { return std::abs(now.current_A) / motor.nominal.nominal_current_A; }
double air_W_per_K(const Motor& motor) { return 1.0 / motor.nominal.air_K_per_W; }
double contact_W_per_K(const Motor& motor) { return 1.0 / motor.nominal.contact_K_per_W; }

/// Adds the law `to(book, strength * heat)`. The law has a copy of the motor as it was before.
std::function<void(Motor&, double)> law_of(Heat heat, void (*to)(const Motor&, double, HeatBook&)) {
  return [=](Motor& motor, double strength) {
    const Motor before = motor;
    motor.network.laws.emplace_back([=](const Instant& now, std::span<const double> temperature_C, HeatBook& book) {
      to(before, strength * heat(before, now, temperature_C), book);
    });
  };
}

std::function<void(Motor&, double)> in_winding(Heat heat) {
  return law_of(std::move(heat), [](const Motor& motor, double power_W, HeatBook& book) { source(motor.winding, power_W, book); });
}

std::function<void(Motor&, double)> in_stator(Heat heat) {
  return law_of(std::move(heat), [](const Motor& motor, double power_W, HeatBook& book) { source(motor.stator, power_W, book); });
}

std::function<void(Motor&, double)> stator_to_air(Heat heat) {
  return law_of(std::move(heat), [](const Motor& motor, double power_W, HeatBook& book) { to_air(motor.stator, power_W, book); });
}

std::function<void(Motor&, double)> winding_to_air(Heat heat) {
  return law_of(std::move(heat), [](const Motor& motor, double power_W, HeatBook& book) { to_air(motor.winding, power_W, book); });
}

std::function<void(Motor&, double)> across_contact(Heat heat) {
  return law_of(std::move(heat),
                [](const Motor& motor, double power_W, HeatBook& book) { flow(motor.winding, motor.stator, power_W, book); });
}

/// Adds a body that the stator exchanges heat with, and a leak of the body to the air.
void add_third_body(Motor& motor, double strength) {
  const std::size_t body = motor.network.bodies.size();
  motor.network.bodies.push_back({"plate", 1.6 * motor.nominal.stator_J_per_K});
  const double exchange_W_per_K = 0.6 * strength * air_W_per_K(motor);
  for (const Part& part : motor.stator) {
    motor.network.links.push_back({part.body, body, part.share * exchange_W_per_K});
  }
  motor.network.air_links.push_back({body, 0.3 * exchange_W_per_K});
}

/// The motor no longer cools to the room but to the air of an enclosure, which the motor warms.
void add_enclosure(Motor& motor, double strength) {
  const std::size_t air = motor.network.bodies.size();
  const double room_K_per_W = 0.35 * strength * motor.nominal.air_K_per_W;
  motor.network.bodies.push_back({"enclosure", 500.0 / room_K_per_W});
  for (const AirLink& link : motor.network.air_links) {
    motor.network.links.push_back({link.body, air, link.conductance_W_per_K});
  }
  motor.network.air_links = {{air, 1.0 / room_K_per_W}};
}

/// Replaces a share of the linear cooling, at most all of it: cooling is never negative.
void add_natural_convection(Motor& motor, double strength) {
  const double share = std::min(1.0, 0.7 * strength);
  const std::vector<AirLink> links = motor.network.air_links;
  motor.network.laws.emplace_back([=](const Instant& now, std::span<const double> temperature_C, HeatBook& book) {
    for (const AirLink& link : links) {
      const double rise_K = temperature_C[link.body] - now.ambient_C;
      book.to_air(link.body, share * link.conductance_W_per_K * rise_K * (std::cbrt(std::abs(rise_K) / 30.0) - 1.0));
    }
  });
}

const std::vector<std::string> kSpeedLosses{"iron_loss_hysteresis", "iron_loss_eddy", "bearing_friction", "windage"};
const std::vector<std::string> kStatorCurrentLosses{"driver_heat", "connection_resistance"};
const std::vector<std::string> kCurvedCooling{"natural_convection", "radiation"};
const std::vector<std::string> kThirdBodies{"third_node", "enclosure_warm_up"};
const std::vector<std::string> kSpeed{"speed"};
const std::vector<std::string> kCurrent{"current"};

using BodyTemperatures = std::span<const double>;

std::vector<EffectKind> speed_losses() {
  return {
      {"iron_loss_hysteresis", "stator", "0.35 P |w|^1.2", kSpeedLosses, kSpeed,
       in_stator([](const Motor& m, const Instant& now, BodyTemperatures) {
         return 0.35 * m.nominal.copper_W() * std::pow(speed_ratio(m, now), 1.2);
       })},
      {"iron_loss_eddy", "stator", "0.4 P |w|^1.8", kSpeedLosses, kSpeed,
       in_stator([](const Motor& m, const Instant& now, BodyTemperatures) {
         return 0.4 * m.nominal.copper_W() * std::pow(speed_ratio(m, now), 1.8);
       })},
      {"bearing_friction", "stator", "Palmgren: 0.4 P |w|^(5/3), thinner grease when warm", kSpeedLosses, kSpeed,
       in_stator([](const Motor& m, const Instant& now, BodyTemperatures at_C) {
         return 0.4 * m.nominal.copper_W() * std::pow(speed_ratio(m, now), 5.0 / 3.0) * std::exp(-0.012 * (m.stator_C(at_C) - 30.0));
       })},
      {"windage", "stator", "0.5 P |w|^2.7", kSpeedLosses, kSpeed, in_stator([](const Motor& m, const Instant& now, BodyTemperatures) {
         return 0.5 * m.nominal.copper_W() * std::pow(speed_ratio(m, now), 2.7);
       })},
  };
}

std::vector<EffectKind> winding_losses() {
  return {
      {"ac_copper_loss",
       "winding",
       "0.5 copper loss |w|^1.8",
       {"ac_copper_loss"},
       {"speed", "current"},
       in_winding([](const Motor& m, const Instant& now, BodyTemperatures at_C) {
         return 0.5 * copper_W(m, now, at_C) * std::pow(speed_ratio(m, now), 1.8);
       })},
      {"ac_copper_loss",
       "winding",
       "0.7 copper loss w^2 / (1 + 0.6 w^2)",
       {"ac_copper_loss"},
       {"speed", "current"},
       in_winding([](const Motor& m, const Instant& now, BodyTemperatures at_C) {
         const double square = std::pow(speed_ratio(m, now), 2.0);
         return 0.7 * copper_W(m, now, at_C) * square / (1.0 + 0.6 * square);
       })},
      {"pwm_ripple_loss",
       "winding",
       "0.4 P V^2 (4 D (1 - D))^2",
       {"pwm_ripple_loss"},
       {"modulation"},
       in_winding([](const Motor& m, const Instant& now, BodyTemperatures) {
         const double duty = std::abs(now.modulation_ratio);
         return 0.4 * m.nominal.copper_W() * std::pow(now.bus_V / m.nominal.bus_V * 4.0 * duty * (1.0 - duty), 2.0);
       })},
      {"stall_phase_imbalance",
       "winding",
       "0.5 copper loss / (1 + (w / 8 rad/s)^2)",
       {"stall_phase_imbalance"},
       {"speed", "current"},
       in_winding([](const Motor& m, const Instant& now, BodyTemperatures at_C) {
         return 0.5 * copper_W(m, now, at_C) / (1.0 + std::pow(now.speed_rad_per_s / 8.0, 2.0));
       })},
      {"saturation",
       "winding",
       "0.6 copper loss s^2 / (1 + s^2), s = (|I| / I_n - 1.1) / 0.4 above the knee",
       {"saturation"},
       kCurrent,
       in_winding([](const Motor& m, const Instant& now, BodyTemperatures at_C) {
         const double above = std::max(0.0, (current_ratio(m, now) - 1.1) / 0.4);
         return 0.6 * copper_W(m, now, at_C) * above * above / (1.0 + above * above);
       })},
  };
}

std::vector<EffectKind> stator_losses() {
  return {
      {"driver_heat", "stator", "0.25 P |I|^1.2", kStatorCurrentLosses, kCurrent,
       in_stator([](const Motor& m, const Instant& now, BodyTemperatures) {
         return 0.25 * m.nominal.copper_W() * std::pow(current_ratio(m, now), 1.2);
       })},
      {"connection_resistance", "stator", "0.25 P I^2, copper at the stator's temperature", kStatorCurrentLosses, kCurrent,
       in_stator([](const Motor& m, const Instant& now, BodyTemperatures at_C) {
         return 0.25 * m.nominal.copper_W() * std::pow(current_ratio(m, now), 2.0) * (1.0 + kCopper_per_K * (m.stator_C(at_C) - 25.0));
       })},
      {"load_friction",
       "stator",
       "gear: 0.07 |K I w|^0.95, relative to P",
       {"load_friction"},
       {"power", "speed", "current"},
       in_stator([](const Motor& m, const Instant& now, BodyTemperatures) {
         const double power_W = std::abs(m.torque_constant_Nm_per_A * now.current_A * now.speed_rad_per_s);
         return 0.07 * m.nominal.copper_W() * std::pow(power_W / m.nominal.copper_W(), 0.95);
       })},
      {"armature_iron_loss",
       "stator",
       "0.4 P |I| |w|^1.7",
       {"armature_iron_loss"},
       {"speed", "current"},
       in_stator([](const Motor& m, const Instant& now, BodyTemperatures) {
         return 0.4 * m.nominal.copper_W() * current_ratio(m, now) * std::pow(speed_ratio(m, now), 1.7);
       })},
  };
}

std::vector<EffectKind> cooling_by_air() {
  return {
      {"speed_dependent_convection",
       "stator",
       "0.9 G |w|^0.7 (T_s - T_a)",
       {"speed_dependent_convection"},
       kSpeed,
       stator_to_air([](const Motor& m, const Instant& now, BodyTemperatures at_C) {
         return 0.9 * air_W_per_K(m) * std::pow(speed_ratio(m, now), 0.7) * (m.stator_C(at_C) - now.ambient_C);
       })},
      {"vehicle_airflow",
       "stator",
       "0.6 G (v / 2 m/s)^0.6 (T_s - T_a)",
       {"vehicle_airflow"},
       {"vehicle_speed"},
       stator_to_air([](const Motor& m, const Instant& now, BodyTemperatures at_C) {
         return 0.6 * air_W_per_K(m) * std::pow(std::abs(now.vehicle_speed_m_per_s) / 2.0, 0.6) * (m.stator_C(at_C) - now.ambient_C);
       })},
      {"natural_convection",
       "stator",
       "(T_s - T_a)^(4/3) in place of linear cooling, equal at 30 K",
       kCurvedCooling,
       {"stator"},
       add_natural_convection},
      {"radiation",
       "stator",
       "0.5 G (T_s^4 - T_a^4) / (4 (308 K)^3)",
       kCurvedCooling,
       {"stator"},
       stator_to_air([](const Motor& m, const Instant& now, BodyTemperatures at_C) {
         const double hot_K = m.stator_C(at_C) + 273.15;
         const double cold_K = now.ambient_C + 273.15;
         return 0.5 * air_W_per_K(m) * (std::pow(hot_K, 4.0) - std::pow(cold_K, 4.0)) / (4.0 * std::pow(308.0, 3.0));
       })},
      {"winding_through_flow",
       "winding",
       "0.3 G |w|^0.8 (T_w - T_a)",
       {"winding_through_flow"},
       kSpeed,
       winding_to_air([](const Motor& m, const Instant& now, BodyTemperatures at_C) {
         return 0.3 * air_W_per_K(m) * std::pow(speed_ratio(m, now), 0.8) * (m.winding_C(at_C) - now.ambient_C);
       })},
  };
}

std::vector<EffectKind> exchanges() {
  return {
      {"neighbour_coupling",
       "stator",
       "0.35 G (T_n - T_s)",
       {"neighbour_coupling"},
       {"neighbour"},
       stator_to_air([](const Motor& m, const Instant& now, BodyTemperatures at_C) {
         return 0.35 * air_W_per_K(m) * (m.stator_C(at_C) - now.neighbour_C);
       })},
      {"contact_temperature_dependence",
       "winding",
       "contact conductance grows by 25 % in 30 K",
       {"contact_temperature_dependence"},
       {"winding"},
       across_contact([](const Motor& m, const Instant&, BodyTemperatures at_C) {
         const double mean = 0.5 * (m.winding_C(at_C) + m.stator_C(at_C));
         return contact_W_per_K(m) * (std::pow(1.25, (mean - 25.0) / 30.0) - 1.0) * (m.winding_C(at_C) - m.stator_C(at_C));
       })},
      {"air_gap_stirring",
       "winding",
       "0.4 G_c |w|^0.8 (T_w - T_s)",
       {"air_gap_stirring"},
       kSpeed,
       across_contact([](const Motor& m, const Instant& now, BodyTemperatures at_C) {
         return 0.4 * contact_W_per_K(m) * std::pow(speed_ratio(m, now), 0.8) * (m.winding_C(at_C) - m.stator_C(at_C));
       })},
      {"third_node", "stator", "a plate of 1.6 C_s behind 0.6 G, with a leak of a third of it", kThirdBodies, {}, add_third_body},
      {"enclosure_warm_up", "stator", "the motor cools to air that has 0.35 R_sa to the room and 500 s", kThirdBodies, {}, add_enclosure},
  };
}

std::vector<EffectKind> sensor_errors() {
  return {
      {"sensor_offset_winding",
       "winding",
       "1.5 K",
       {"sensor_offset_winding"},
       {},
       [](Motor& m, double strength) { m.sensors.offset_winding_K = 1.5 * strength; }},
      {"sensor_offset_stator",
       "stator",
       "-1.5 K",
       {"sensor_offset_stator"},
       {},
       [](Motor& m, double strength) { m.sensors.offset_stator_K = -1.5 * strength; }},
      {"sensor_lag_winding",
       "winding",
       "6 s",
       {"sensor_lag_winding"},
       {},
       [](Motor& m, double strength) { m.sensors.lag_winding_s = 6.0 * strength; }},
      {"sensor_lag_stator",
       "stator",
       "15 s",
       {"sensor_lag_stator"},
       {},
       [](Motor& m, double strength) { m.sensors.lag_stator_s = 15.0 * strength; }},
      {"sensor_gain_winding",
       "winding",
       "5 % about 25 degC",
       {"sensor_gain_winding"},
       {},
       [](Motor& m, double strength) { m.sensors.gain_winding = 1.0 + 0.05 * strength; }},
  };
}

}  // namespace

const std::vector<EffectKind>& catalogue_effects() {
  static const std::vector<EffectKind> kEffects = [] {
    std::vector<EffectKind> all;
    for (const auto& part : {speed_losses(), winding_losses(), stator_losses(), cooling_by_air(), exchanges(), sensor_errors()}) {
      all.insert(all.end(), part.begin(), part.end());
    }
    return all;
  }();
  return kEffects;
}

}  // namespace heatsoak::suite
