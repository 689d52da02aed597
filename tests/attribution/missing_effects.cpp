#include "missing_effects.h"

#include <algorithm>
#include <cmath>

namespace heatsoak::attribution::truth {
namespace {

constexpr double kFull_rad_per_s = 500.0;

double full(const Moment& m) { return std::abs(m.in.speed_rad_per_s) / kFull_rad_per_s; }
double smooth_step(double x) { return 0.5 * (1.0 + std::tanh(x)); }

Missing heat(Heat one) {
  Missing missing;
  missing.heat.push_back(std::move(one));
  return missing;
}

void into_iron(PerPart& q, double heat_W) {
  q[tooth] += 0.5 * heat_W;
  q[yoke] += 0.5 * heat_W;
}
void into_copper(PerPart& q, double heat_W) {
  q[slot] += 0.66 * heat_W;
  q[overhang_front] += 0.17 * heat_W;
  q[overhang_back] += 0.17 * heat_W;
}
void to_air(const Moment& m, PerPart& q, double conductance_W_per_K) {
  q[sleeve] -= 0.7 * conductance_W_per_K * (m.part_C[sleeve] - m.in.ambient_C);
  q[shield_front] -= 0.15 * conductance_W_per_K * (m.part_C[shield_front] - m.in.ambient_C);
  q[shield_back] -= 0.15 * conductance_W_per_K * (m.part_C[shield_back] - m.in.ambient_C);
}
/// Moves heat across the gap between copper and iron.
void across(const Moment& m, PerPart& q, double conductance_W_per_K) {
  const double flow_W = conductance_W_per_K * (m.copper_C - m.iron_C);
  into_copper(q, -flow_W);
  q[tooth] += 0.7 * flow_W;
  q[yoke] += 0.3 * flow_W;
}

Missing third_node(double size) {
  Missing missing = heat([size](const Moment& m, PerPart& q) {
    const double in_W = 0.15 * size * (m.part_C[shield_front] - m.part_C[lump_a]);
    q[shield_front] -= in_W;
    q[lump_a] += in_W - 0.06 * size * (m.part_C[lump_a] - m.in.ambient_C);
  });
  missing.lump_capacity_J_per_K[lump_a] = 140.0;
  return missing;
}

Missing enclosure(double size) {
  // The motor's heat warms its surrounding air, while the log contains the temperature of the room.
  Missing missing = heat([size](const Moment& m, PerPart& q) {
    const double air_rise_K = m.part_C[lump_b] - m.in.ambient_C;
    const double taken_W = 0.18 * air_rise_K;
    q[sleeve] += 0.6 * taken_W;
    q[shield_front] += 0.2 * taken_W;
    q[shield_back] += 0.2 * taken_W;
    q[lump_b] += 0.18 * (m.iron_C - m.in.ambient_C) - air_rise_K / (1.6 * size);
  });
  missing.lump_capacity_J_per_K[lump_b] = 260.0 / size;
  return missing;
}

Missing sensor(SensorFault fault) {
  Missing missing;
  missing.sensors = fault;
  return missing;
}

const std::vector<Subject> kSubjects{
    {"iron_loss_hysteresis",
     Visibility::visible,
     {"bearing_friction", "no_load_loss"},
     [](double s) { return heat([s](const Moment& m, PerPart& q) { into_iron(q, 2.0 * s * std::pow(full(m), 1.04)); }); }},
    {"iron_loss_eddy",
     Visibility::visible,
     {"bearing_friction"},
     [](double s) { return heat([s](const Moment& m, PerPart& q) { into_iron(q, 2.0 * s * std::pow(full(m), 1.96)); }); }},
    {"windage",
     Visibility::visible,
     {},
     [](double s) { return heat([s](const Moment& m, PerPart& q) { q[sleeve] += 0.8 * s * std::pow(full(m), 2.9); }); }},
    {"ac_copper_loss",
     Visibility::visible,
     {},
     [](double s) {
       return heat([s](const Moment& m, PerPart& q) { into_copper(q, 0.35 * s * m.copper_loss_W * std::pow(full(m), 1.95)); });
     }},
    {"pwm_ripple_loss",
     Visibility::visible,
     {},
     [](double s) {
       return heat([s](const Moment& m, PerPart& q) {
         const double d = m.in.duty_ratio;
         into_copper(q, 1.0 * s * 4.0 * d * (1.0 - d) * m.in.bus_V * m.in.bus_V / 576.0);
       });
     }},
    {"driver_heat",
     Visibility::visible,
     {},
     [](double s) { return heat([s](const Moment& m, PerPart& q) { q[shield_back] += s * 1.5 * std::abs(m.in.current_A) / 8.0; }); },
     0.9375},
    {"connection_resistance",
     Visibility::visible,
     {"driver_heat"},
     [](double s) { return heat([s](const Moment& m, PerPart& q) { q[shield_back] += s * 0.02 * m.in.current_A * m.in.current_A; }); },
     0.02},
    {"speed_dependent_convection",
     Visibility::visible,
     {},
     [](double s) { return heat([s](const Moment& m, PerPart& q) { to_air(m, q, 0.1 * s * std::pow(full(m), 0.75)); }); }},
    {"vehicle_airflow",
     Visibility::visible,
     {},
     [](double s) {
       return heat([s](const Moment& m, PerPart& q) { to_air(m, q, 0.08 * s * std::pow(m.in.vehicle_speed_m_per_s / 3.0, 0.58)); });
     }},
    // A body behind the stator and warming air obey the same equation. They differ only in the share that the base model absorbs.
    {"third_node", Visibility::visible, {"enclosure_warm_up"}, third_node},
    {"neighbour_coupling",
     Visibility::visible,
     {},
     [](double s) {
       return heat([s](const Moment& m, PerPart& q) { q[shield_front] += 0.05 * s * (m.in.neighbour_C - m.part_C[shield_front]); });
     },
     0.05},
    {"enclosure_warm_up", Visibility::visible, {"third_node"}, enclosure},
    {"contact_temperature_dependence",
     Visibility::visible,
     {},
     [](double s) {
       return heat([s](const Moment& m, PerPart& q) { across(m, q, 0.0040 * s * (0.5 * (m.copper_C + m.iron_C) - 25.0) / 1.6); });
     }},
    {"air_gap_stirring",
     Visibility::visible,
     {},
     [](double s) { return heat([s](const Moment& m, PerPart& q) { across(m, q, 0.16 * s * full(m)); }); },
     0.16},
    {"winding_through_flow",
     Visibility::visible,
     {},
     [](double s) {
       return heat([s](const Moment& m, PerPart& q) { into_copper(q, -0.05 * s * full(m) * (m.copper_C - m.in.ambient_C)); });
     },
     0.05},
    {"stall_phase_imbalance",
     Visibility::visible,
     {},
     [](double s) {
       return heat([s](const Moment& m, PerPart& q) {
         into_copper(q, 0.4 * s * m.copper_loss_W * (std::abs(m.in.speed_rad_per_s) < 6.0 ? 1.0 : 0.0));
       });
     }},
    {"load_friction",
     Visibility::visible,
     {},
     [](double s) {
       return heat(
           [s](const Moment& m, PerPart& q) { q[shield_front] += 0.05 * s * 0.034 * std::abs(m.in.current_A * m.in.speed_rad_per_s); });
     }},
    {"armature_iron_loss",
     Visibility::visible,
     {},
     [](double s) {
       return heat([s](const Moment& m, PerPart& q) { into_iron(q, 1.5 * s * std::abs(m.in.current_A) / 5.0 * std::pow(full(m), 1.95)); });
     }},
    {"saturation",
     Visibility::visible,
     {},
     [](double s) {
       return heat([s](const Moment& m, PerPart& q) {
         into_copper(q, 0.35 * s * m.copper_loss_W * smooth_step((std::abs(m.in.current_A) - 5.0) / 0.3));
       });
     }},
    {"constant_heat",
     Visibility::visible,
     {"sensor_offset_stator"},
     [](double s) { return heat([s](const Moment&, PerPart& q) { into_iron(q, 1.0 * s); }); },
     1.0},
    {"sensor_offset_winding", Visibility::visible, {}, [](double s) { return sensor({.winding_offset_K = 1.2 * s}); }, 1.2},
    {"sensor_offset_stator", Visibility::visible, {"constant_heat"}, [](double s) { return sensor({.stator_offset_K = 1.2 * s}); }, 1.2},
    {"sensor_lag_winding", Visibility::visible, {}, [](double s) { return sensor({.winding_lag_s = 6.0 * s}); }, 6.0},
    {"sensor_lag_stator", Visibility::visible, {}, [](double s) { return sensor({.stator_lag_s = 10.0 * s}); }, 10.0},
    {"sensor_gain_winding", Visibility::visible, {}, [](double s) { return sensor({.winding_gain_ratio = 1.0 + 0.05 * s}); }, 0.05},
    // h ∝ ΔT^0.25: a fitted constant explains all but 0.6 % of the response.
    {"natural_convection",
     Visibility::faint,
     {"radiation"},
     [](double s) {
       return heat([s](const Moment& m, PerPart& q) { to_air(m, q, 0.03 * s * std::pow(std::abs(m.iron_C - m.in.ambient_C), 0.27)); });
     }},
    // 4 ε σ A T³: a fitted constant explains all but 0.1 % of the response.
    {"radiation",
     Visibility::faint,
     {"natural_convection"},
     [](double s) {
       return heat([s](const Moment& m, PerPart& q) {
         const auto fourth = [](double temperature_C) { return std::pow(temperature_C + 273.15, 4); };
         q[sleeve] -= s * 0.8 * 5.67e-8 * 0.009 * (fourth(m.part_C[sleeve]) - fourth(m.in.ambient_C));
       });
     }},
    // Copper that lies on the tooth passes its heat on at once.
    {"uneven_winding",
     Visibility::visible,
     {},
     [](double s) {
       return heat([s](const Moment& m, PerPart& q) {
         q[slot] -= 0.1 * s * m.copper_loss_W;
         q[tooth] += 0.1 * s * m.copper_loss_W;
       });
     },
     0.1},
};

const std::vector<Outsider> kOutsiders{
    {"a resonance at 300 rad/s",
     "stator",
     {"speed", "modulation"},
     [](double s) {
       return heat([s](const Moment& m, PerPart& q) {
         const double off = (std::abs(m.in.speed_rad_per_s) - 300.0) / 40.0;
         into_iron(q, 3.0 * s * std::exp(-0.5 * off * off));
       });
     }},
    {"drag in one direction only",
     "stator",
     {"velocity"},
     [](double s) { return heat([s](const Moment& m, PerPart& q) { into_iron(q, m.in.speed_rad_per_s < 0 ? 3.0 * s * full(m) : 0.0); }); }},
    {"extra copper loss under braking",
     "winding",
     {"shaft_power"},
     [](double s) {
       return heat([s](const Moment& m, PerPart& q) { into_copper(q, m.in.current_A * m.in.speed_rad_per_s < -5.0 ? 4.0 * s : 0.0); });
     }},
    {"a fan that starts at 45 °C of the stator",
     "stator",
     {"stator_temperature", "stator_excess"},
     [](double s) {
       return heat([s](const Moment& m, PerPart& q) { to_air(m, q, 0.15 * s * smooth_step((m.part_C[sleeve] - 45.0) / 1.0)); });
     }},
    {"heat that stops above 250 rad/s",
     "stator",
     {"speed", "modulation"},
     [](double s) {
       return heat(
           [s](const Moment& m, PerPart& q) { into_iron(q, 2.5 * s * smooth_step((250.0 - std::abs(m.in.speed_rad_per_s)) / 20.0)); });
     }},
    {"a fan that runs in the middle of a run",
     "stator",
     {"time"},
     [](double s) {
       return heat([s](const Moment& m, PerPart& q) { to_air(m, q, m.time_s > 700.0 && m.time_s < 1200.0 ? 0.12 * s : 0.0); });
     }},
    {"heat with every change of speed",
     "stator",
     {"acceleration"},
     [](double s) {
       return heat([s](const Moment& m, PerPart& q) { into_iron(q, 0.03 * s * std::abs(m.in.next_acceleration_rad_per_s2)); });
     }},
    {"copper that hums at 200 rad/s",
     "winding",
     {"speed", "modulation"},
     [](double s) {
       return heat([s](const Moment& m, PerPart& q) {
         const double off = (std::abs(m.in.speed_rad_per_s) - 200.0) / 50.0;
         into_copper(q, 1.2 * s * m.copper_loss_W * std::exp(-0.5 * off * off));
       });
     }},
    {"electronics that heat below 22.5 V",
     "stator",
     {"bus_voltage"},
     [](double s) { return heat([s](const Moment& m, PerPart& q) { into_iron(q, 3.0 * s * smooth_step((22.5 - m.in.bus_V) / 0.3)); }); }},
    {"air that reaches the motor above 1.2 m/s only",
     "stator",
     {"vehicle_speed"},
     [](double s) {
       return heat([s](const Moment& m, PerPart& q) { to_air(m, q, 0.15 * s * smooth_step((m.in.vehicle_speed_m_per_s - 1.2) / 0.1)); });
     }},
    {"heat with the current that fades with speed",
     "stator",
     {"speed", "velocity", "modulation", "current_speed_squared"},
     [](double s) {
       return heat([s](const Moment& m, PerPart& q) {
         into_iron(q, 2.5 * s * std::abs(m.in.current_A) / 8.0 * std::exp(-std::pow(std::abs(m.in.speed_rad_per_s) / 175.0, 2)));
       });
     },
     "current"},
    {"winding that lifts off the iron when it is hot",
     "winding",
     {"winding_temperature", "winding_excess", "winding_above_stator"},
     [](double s) { return heat([s](const Moment& m, PerPart& q) { across(m, q, -0.3 * s * smooth_step((m.copper_C - 50.0) / 2.0)); }); }},
};

/// Returns a pseudo-random number between 0 and 1, constant over each segment of running time and independent for each purpose.
double drawn(const Moment& m, double segment_s, std::uint64_t purpose, int later = 0) {
  const auto segment = static_cast<std::uint64_t>(m.age_h * 3600.0 / segment_s) + static_cast<std::uint64_t>(later);
  // The finaliser of splitmix64 needs no state, so the integrator can call this at every step.
  std::uint64_t bits = (segment * 1000003 + purpose) * 0x9e3779b97f4a7c15U;
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9U;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebU;
  return static_cast<double>((bits ^ (bits >> 31)) >> 11) * 0x1p-53;
}
/// Returns a smooth pseudo-random signal with mean 0 and RMS 1, which varies over the length of a segment.
double drifting(const Moment& m, double segment_s, std::uint64_t purpose) {
  const double share = std::fmod(m.age_h * 3600.0 / segment_s, 1.0);
  const double here = drawn(m, segment_s, purpose), next = drawn(m, segment_s, purpose, 1);
  const double blend = share * share * (3.0 - 2.0 * share);
  return 4.0 * (here + (next - here) * blend - 0.5);
}

Missing unlogged_neighbour(double size) {
  Missing missing = heat([size](const Moment& m, PerPart& q) {
    const double work_W = 12.0 * std::max(0.0, drawn(m, 300.0, 1) - 0.3);
    const double across_W = 0.06 * size * (m.part_C[lump_b] - m.part_C[shield_front]);
    q[shield_front] += across_W;
    q[lump_b] += work_W - across_W - 0.15 * (m.part_C[lump_b] - m.in.ambient_C);
  });
  missing.lump_capacity_J_per_K[lump_b] = 60.0;
  return missing;
}

/// A fan that switches on above 45 °C and off below 38 °C. The latch x' = x − x³ + d switches where |d| exceeds 0.385; a lump stores x as
/// tens of kelvin.
Missing thermostat_fan(double size) {
  Missing missing = heat([size](const Moment& m, PerPart& q) {
    const double x = (m.part_C[lump_b] - 25.0) / 10.0;
    const double push = std::clamp(0.385 * (m.part_C[sleeve] - 41.5) / 3.5, -0.8, 0.8);
    q[lump_b] += 10.0 * (x - x * x * x + push) / 3.0;
    to_air(m, q, 0.15 * size * smooth_step(4.0 * x));
  });
  missing.lump_capacity_J_per_K[lump_b] = 1.0;
  return missing;
}

const std::vector<Outsider> kStrangers{
    {"a fan that starts at 45 °C and stops at 38 °C", "stator", {}, thermostat_fan},
    {"a neighbouring motor without a log", "stator", {}, unlogged_neighbour},
    {"a lamp that somebody turns on and off",
     "stator",
     {},
     [](double s) { return heat([s](const Moment& m, PerPart& q) { q[sleeve] += drawn(m, 240.0, 2) < 0.4 ? 2.0 * s : 0.0; }); }},
    {"a draught now and then",
     "stator",
     {},
     [](double s) { return heat([s](const Moment& m, PerPart& q) { to_air(m, q, drawn(m, 300.0, 3) < 0.35 ? 0.12 * s : 0.0); }); }},
    {"0.7 W that drift at the stator",
     "stator",
     {},
     [](double s) { return heat([s](const Moment& m, PerPart& q) { into_iron(q, 0.7 * s * drifting(m, 240.0, 4)); }); }},
    {"0.7 W that drift in the copper",
     "winding",
     {},
     [](double s) { return heat([s](const Moment& m, PerPart& q) { into_copper(q, 0.7 * s * drifting(m, 240.0, 5)); }); }},
};

}  // namespace

Missing together(Missing one, const Missing& other) {
  one.heat.insert(one.heat.end(), other.heat.begin(), other.heat.end());
  for (int part = 0; part < part_count; ++part) {
    one.lump_capacity_J_per_K[static_cast<std::size_t>(part)] += other.lump_capacity_J_per_K[static_cast<std::size_t>(part)];
  }
  one.sensors.winding_offset_K += other.sensors.winding_offset_K;
  one.sensors.stator_offset_K += other.sensors.stator_offset_K;
  one.sensors.winding_lag_s += other.sensors.winding_lag_s;
  one.sensors.stator_lag_s += other.sensors.stator_lag_s;
  one.sensors.winding_gain_ratio *= other.sensors.winding_gain_ratio;
  return one;
}

const std::vector<Subject>& subjects() { return kSubjects; }
const std::vector<Outsider>& outsiders() { return kOutsiders; }
const std::vector<Outsider>& strangers() { return kStrangers; }

}  // namespace heatsoak::attribution::truth
