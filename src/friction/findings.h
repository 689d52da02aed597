// Findings of a friction test as data: how the logs were read, and what could not be written. src/present puts them into words.
#pragma once

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

namespace heatsoak::friction {

/// Source of the wheels' voltages.
struct VoltageFrom {
  enum class Source {
    log,
    modulation,                       ///< times the logged battery voltage
    modulation_with_nominal_battery,  ///< times `battery_V`, the robot's nominal battery voltage; the logs have none
    current,                          ///< with the motor's resistance and torque constant
    current_without_sign              ///< same, with the sign of the speed
  };
  Source source = Source::log;
  double battery_V = 0.0;

  bool operator==(const VoltageFrom&) const = default;
};
/// Source of the direction of travel.
struct DirectionFrom {
  enum class Source { commanded, measured, wheels };
  Source source = Source::commanded;

  bool operator==(const DirectionFrom&) const = default;
};
using FrictionFinding = std::variant<VoltageFrom, DirectionFrom>;
/// Each finding occurs once, even if several logs cause it.
using FrictionFindings = std::vector<FrictionFinding>;

/// The motor's drag alone is larger than the measured offset of a wheel, so that 0 is written for the offset.
struct DragExceedsOffset {
  std::size_t wheel = 0;  ///< from 1
  double drag_V = 0.0;    ///< by the motor's data sheet
};
/// The motor's back-EMF alone is larger than the measured damping of a wheel, so that 0 is written for the damping.
struct BackEmfExceedsDamping {
  std::size_t wheel = 0;              ///< from 1
  double back_emf_V_s_per_rad = 0.0;  ///< by the motor's data sheet
};
using WrittenAsZero = std::variant<DragExceedsOffset, BackEmfExceedsDamping>;

}  // namespace heatsoak::friction
