// Findings of a friction test as data: how the logs were read, what looks wrong, why a wheel was not fitted, and what could not be written.
// src/present puts them into words. Wheels are numbered from 1.
#pragma once

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "recording/findings.h"

namespace heatsoak::friction {

/// Source of the wheels' voltages.
struct VoltageFrom {
  enum class Source {
    log,
    modulation,                       ///< times the logged battery voltage
    modulation_with_nominal_battery,  ///< times `battery_V`, the robot's nominal battery voltage; the logs have none
    current,                          ///< with the motor's resistance and torque constant
    current_without_sign              ///< from the current, with the sign of the speed
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

/// The logged direction of travel differs from that computed from the wheels' speeds.
struct DirectionDiffers {
  double off_deg = 0.0;  ///< median
};
/// A part of the wheels' speeds fits no motion of the robot.
struct SpeedsContradict {
  double share = 0.0;  ///< median
};
/// The voltage of every wheel falls as it turns faster.
struct VoltageFallsWithSpeed {};
/// The damping of every wheel is far from the motor's back-EMF.
struct DampingDiffersFromBackEmf {
  double ratio = 0.0;  ///< median of damping / back-EMF; 1 to 2 is usual
};
/// The log has values of more wheels than the robot.
struct MoreWheelsThanRobot {
  std::size_t logged = 0;    ///< largest number of a wheel in the log
  std::size_t of_robot = 0;  ///< number of wheels in the robot's file
};
/// A wheel turns with hardly any voltage.
struct WheelWithoutVoltage {
  std::size_t wheel = 0;
};
/// The voltage of one wheel falls as it turns faster.
struct WheelVoltageFallsWithSpeed {
  std::size_t wheel = 0;
};
/// The friction of a wheel would drive it.
struct FrictionDrivesWheel {
  std::size_t wheel = 0;
  double sine_V = 0.0;      ///< a
  double constant_V = 0.0;  ///< b
};
/// Speed and direction explain too little of a wheel's voltage.
struct WheelVoltageUnexplained {
  std::size_t wheel = 0;
  double r2_ratio = 0.0;
};
/// The damping of one wheel is far from the motor's back-EMF.
struct WheelDampingDiffers {
  std::size_t wheel = 0;
  double ratio = 0.0;  ///< damping / back-EMF; 1 to 2 is usual
};
/// Probable wrong unit, sign or order of wheels.
using FrictionSuspicion = std::variant<recording::Suspicion, DirectionDiffers, SpeedsContradict, VoltageFallsWithSpeed,
                                       DampingDiffersFromBackEmf, MoreWheelsThanRobot, WheelWithoutVoltage, WheelVoltageFallsWithSpeed,
                                       FrictionDrivesWheel, WheelVoltageUnexplained, WheelDampingDiffers>;
/// Suspicion about one log of a test, or about the test.
struct SuspicionOfTest {
  std::string log;  ///< name of the recording; empty: the fit to all logs
  FrictionSuspicion suspicion;
};

/// Why a wheel was not fitted.
enum class WheelProblem { hardly_turns, constant_voltage, one_speed, too_few_headings, too_few_legs };

/// Scatter that the deviations between headings are compared with.
enum class Repeats { legs_on_one_heading, speeds_of_one_leg, neighbouring_headings };

/// Source of the voltages that are expected before a fit.
enum class ExpectedFrom { robot_file, motor_data_sheet };

/// The motor's drag alone is larger than the measured offset of a wheel, so that 0 is written for the offset.
struct DragExceedsOffset {
  std::size_t wheel = 0;
  double drag_V = 0.0;  ///< by the motor's data sheet
};
/// The motor's back-EMF alone is larger than the measured damping of a wheel, so that 0 is written for the damping.
struct BackEmfExceedsDamping {
  std::size_t wheel = 0;
  double back_emf_V_s_per_rad = 0.0;  ///< by the motor's data sheet
};
using WrittenAsZero = std::variant<DragExceedsOffset, BackEmfExceedsDamping>;

}  // namespace heatsoak::friction
