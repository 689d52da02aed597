#include "robot/battery.h"

#include <algorithm>
#include <cmath>

namespace heatsoak {

double open_circuit_V(const BatteryConfig& battery, double charge_A_s) {
  return battery.empty_V + (battery.full_V - battery.empty_V) * charge_A_s / battery.capacity_A_s;
}

double stored_energy_J(const BatteryConfig& battery, double charge_A_s) {
  return 0.5 * (battery.empty_V + open_circuit_V(battery, charge_A_s)) * charge_A_s;
}

BatteryLoad battery_load(const BatteryConfig& battery, double charge_A_s, double power_W) {
  const double source_V = open_circuit_V(battery, charge_A_s);
  const double below_root_V2 = source_V * source_V - 4.0 * battery.internal_resistance_ohm * power_W;
  BatteryLoad load;
  load.collapsed = below_root_V2 < 0.0;
  load.terminal_V = 0.5 * (source_V + std::sqrt(std::max(below_root_V2, 0.0)));
  const double given_W = load.collapsed ? source_V * source_V / (4.0 * battery.internal_resistance_ohm) : power_W;
  load.current_A = given_W / load.terminal_V;
  return load;
}

}  // namespace heatsoak
