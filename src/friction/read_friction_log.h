// Converts a recording to the columns that the friction test needs.
#pragma once

#include <cstddef>
#include <optional>

#include "friction/findings.h"
#include "friction/friction_log.h"
#include "recording/recording.h"
#include "robot/friction.h"
#include "robot/robot.h"

namespace heatsoak::friction {

/// Source of the direction of travel.
enum class TravelDirection {
  best,       ///< the first of the following that the log has
  commanded,  ///< heading_rad, vx_set_m_per_s and vy_set_m_per_s, or on the field: heading_field_rad, vx_field_set_m_per_s, …
  measured,   ///< vx_m_per_s and vy_m_per_s, or on the field vx_field_m_per_s and vy_field_m_per_s
  wheels      ///< computed from the wheel speeds
};

struct FrictionLogNeeds {
  bool all_wheels = true;                                            ///< false: the speed of one wheel is enough
  bool voltage = true;                                               ///< the voltage of every wheel is needed
  std::optional<TravelDirection> direction = TravelDirection::best;  ///< empty: not needed, so neither it nor the orientation is read
  std::optional<robot::DriveConstants> drive = {};                   ///< motor constants to convert currents to voltages
};

/// Converts speeds of motor shafts to speeds of wheels, and directions on the field to directions in the robot's frame. The voltage is
/// wheel_voltage_V, else wheel_modulation_ratio × battery_V (or bus_V, or the robot's nominal voltage), else R·I + K_t·n·ω. I is
/// wheel_current_A; it gets the sign of the speed if it has none. Throws Failure (bad_input) with all missing columns. Adds to
/// `findings` how it read the columns.
FrictionLog friction_log(const recording::Recording& recording, const robot::Robot& robot, const FrictionLogNeeds& needs,
                         FrictionFindings& findings);

/// Returns the largest number of a wheel whose speed, voltage, modulation or current is not always 0 or blank; 0 if there is none.
std::size_t last_wheel(const recording::Recording& recording);

}  // namespace heatsoak::friction
