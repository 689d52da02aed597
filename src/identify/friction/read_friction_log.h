// A recording of measured quantities as the friction test needs it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "identify/friction/friction_log.h"
#include "identify/measurement/recording.h"
#include "robot/friction.h"
#include "robot/robot.h"

namespace heatsoak {

/// Whose word counts for the direction of travel.
enum class TravelDirection {
  best,       ///< the first of the following that the log has
  commanded,  ///< heading_rad, vx_set_m_per_s and vy_set_m_per_s, or on the field: heading_field_rad, vx_field_set_m_per_s, …
  measured,   ///< vx_m_per_s and vy_m_per_s, or on the field vx_field_m_per_s and vy_field_m_per_s
  wheels      ///< what the wheels' speeds amount to
};

/// What a log's columns were taken for, in sentences; one per fact, however many logs say it.
using Findings = std::vector<std::string>;

struct FrictionLogNeeds {
  bool voltage = true;                  ///< of every wheel
  std::optional<DriveConstants> drive;  ///< turns currents into voltages
  TravelDirection direction = TravelDirection::best;
};

/// Speeds of motor shafts become speeds of wheels, directions on the field become directions in the robot's frame, the
/// voltage is wheel_voltage_V, or wheel_pwm_ratio × battery_V (bus_V, else the robot's nominal voltage), or from
/// wheel_current_A: R·I + K_t·n·ω, where a current without sign has that of the speed.
/// Throws Failure (bad_input) that names every column that is missing.
FrictionLog friction_log(const Recording& recording, const Robot& robot, const FrictionLogNeeds& needs, Findings& findings);

}  // namespace heatsoak
