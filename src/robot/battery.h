// Battery whose voltage falls with load and with discharge.
#pragma once

#include <algorithm>
#include <cmath>

namespace heatsoak::robot {

/// The open-circuit voltage is linear in the remaining charge; one internal resistance.
struct BatteryConfig {
  double full_V = 0.0;
  double empty_V = 0.0;
  double internal_resistance_ohm = 0.0;
  double capacity_A_s = 1.0;
};

inline double open_circuit_V(const BatteryConfig& battery, double charge_A_s) {
  return battery.empty_V + (battery.full_V - battery.empty_V) * charge_A_s / battery.capacity_A_s;
}

/// Returns the energy in J that the remaining charge can deliver, ∫E dq. Its decrease over a step is the energy E·I·t of the step.
double stored_energy_J(const BatteryConfig& battery, double charge_A_s);

struct BatteryLoad {
  double terminal_V = 0.0;
  double current_A = 0.0;  ///< positive when discharging
  bool collapsed = false;  ///< the demanded power exceeds the maximum E²/(4·R)
};
/// Returns terminal voltage and current at a power: P = V·I with V = E − R·I gives V = (E + √(E² − 4·R·P))/2. Without a solution the result
/// is the maximum power point, V = E/2, and `collapsed`; the caller must then reduce the load.
inline BatteryLoad battery_load(const BatteryConfig& battery, double charge_A_s, double power_W) {
  const double source_V = open_circuit_V(battery, charge_A_s);
  const double below_root_V2 = source_V * source_V - 4.0 * battery.internal_resistance_ohm * power_W;
  BatteryLoad load;
  load.collapsed = below_root_V2 < 0.0;
  load.terminal_V = 0.5 * (source_V + std::sqrt(std::max(below_root_V2, 0.0)));
  const double given_W = load.collapsed ? source_V * source_V / (4.0 * battery.internal_resistance_ohm) : power_W;
  load.current_A = given_W / load.terminal_V;
  return load;
}

}  // namespace heatsoak::robot
