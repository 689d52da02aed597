#include "robot/battery.h"

namespace heatsoak::robot {

double stored_energy_J(const BatteryConfig& battery, double charge_A_s) {
  return 0.5 * (battery.empty_V + open_circuit_V(battery, charge_A_s)) * charge_A_s;
}

}  // namespace heatsoak::robot
