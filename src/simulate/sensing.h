// Simulates the robot's sensors: converts the true state to the samples that the drive core receives.
#pragma once

#include <array>
#include <cstdint>

#include "base/random.h"
#include "robot_core/drive_core.h"
#include "simulate/declared_number.h"
#include "simulate/simulated_robot.h"

namespace heatsoak::simulate {

/// Parameters of the sensors. sensing_numbers() declares unit, origin and range of each. The value 0 disables an error.
struct SensingConfig {
  double encoder_turn_count = 8192.0;             ///< counts per turn of the motor's shaft
  double gyro_noise_rad_per_s = 0.003;            ///< standard deviation of one sample
  double gyro_bias_rad_per_s = 0.002;             ///< standard deviation over robots and starts; constant in a run
  double gyro_drift_rad_per_s_per_root_s = 1e-4;  ///< intensity of the random walk of the bias
  double gyro_step_rad_per_s = 0.00107;           ///< resolution
  double current_noise_A = 0.03;                  ///< standard deviation of one sample
  double current_offset_A = 0.05;                 ///< standard deviation over sensors; constant in a run
  double battery_step_V = 0.0081;                 ///< resolution
  double temperature_step_K = 0.1;                ///< resolution
  double temperature_noise_K = 0.05;              ///< standard deviation of one sample
  double delay_periods_count = 1.0;               ///< control periods from sampling to actuation, 0 or 1
  bool has_motor_current = false;
  bool has_stator = false;
  bool has_ambient = false;
};
std::span<const DeclaredNumber<SensingConfig>> sensing_numbers();

/// Returns the defaults, with motor current sensors if the robot's driver limits the current.
SensingConfig sensing_of(const robot::Robot& robot);
/// Returns sensors without errors and delay for all quantities, including the ambient temperature.
SensingConfig ideal_sensing();

/// Returns approximately normal noise of standard deviation 1: the sum of four uniform numbers of 13 bits, with a fourth moment of 2.7 and
/// a range of ±3.5. The result has the same bits on every machine.
double noise(base::Random& random);

/// Sensors of one robot during one run. Equal seeds give equal samples.
class Sensing {
 public:
  /// Throws Failure (bad_input) that names the numbers outside their range.
  Sensing(const SensingConfig& config, const SimulatedRobot& robot, double control_period_s, std::uint64_t seed);

  /// Accumulates one plant period.
  void follow(const SimulatedRobot& robot, const robot::PlantOutput& out);
  /// Sets the sensor values of `input` at the end of a control period. Speeds are encoder counts per control period, currents are means
  /// over it.
  void sample(const SimulatedRobot& robot, double ambient_C, robot_core::Input& input);

 private:
  void sample_wheels(robot_core::Input& input);
  void sample_gyro(const SimulatedRobot& robot, robot_core::Input& input);
  double temperature_C(double true_C);

  SensingConfig config_;
  base::Random random_;
  int wheel_count_;
  double control_period_s_;
  double count_per_rad_ = 0.0;  ///< encoder counts per radian of the wheel
  double bias_rad_per_s_ = 0.0;
  robot::PerWheel offset_A_{};
  robot::PerWheel phase_count_{};  ///< initial position of each encoder between two edges
  robot::PerWheel last_rad_per_s_{};
  robot::PerWheel angle_rad_{};  ///< wheel angles
  std::array<std::int64_t, robot::kMostWheels> counts_{};
  robot::PerWheel current_A_{};  ///< sum since the last sample
  double battery_V_;
  int periods_ = 0;
  int samples_ = 0;
};

}  // namespace heatsoak::simulate
