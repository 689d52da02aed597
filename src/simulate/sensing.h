// Sensors of the robot: from the simulated truth to the samples that the drive core gets.
#pragma once

#include <array>
#include <cstdint>

#include "base/random.h"
#include "robot_core/drive_core.h"
#include "simulate/declared_number.h"
#include "simulate/simulated_robot.h"

namespace heatsoak::simulate {

/// sensing_numbers() has unit, origin and range of every number. 0 switches that error off.
struct SensingConfig {
  double encoder_turn_count = 8192.0;             ///< counts per turn of the motor's shaft
  double gyro_noise_rad_per_s = 0.003;            ///< standard deviation of one sample
  double gyro_bias_rad_per_s = 0.002;             ///< standard deviation over robots and starts; constant over a run
  double gyro_drift_rad_per_s_per_root_s = 1e-4;  ///< random walk of the bias
  double gyro_step_rad_per_s = 0.00107;           ///< resolution
  double current_noise_A = 0.03;
  double current_offset_A = 0.05;  ///< standard deviation over sensors; constant over a run
  double battery_step_V = 0.0081;
  double temperature_step_K = 0.1;
  double temperature_noise_K = 0.05;
  double delay_periods_count = 1.0;  ///< control periods from sampling to actuation, 0 or 1
  bool has_motor_current = false;
  bool has_stator = false;
  bool has_ambient = false;
};
std::span<const DeclaredNumber<SensingConfig>> sensing_numbers();

/// The defaults; a robot whose driver limits the current also measures it.
SensingConfig sensing_of(const robot::Robot& robot);
/// Exact samples of everything, ambient included, and no delay.
SensingConfig ideal_sensing();

/// Normal noise of standard deviation 1 to a fourth moment of 2.7: four uniform numbers of 13 bits, never beyond ±3.5. The same bits on
/// every machine.
double noise(base::Random& random);

/// One robot's sensors over one run. Same seed, same samples.
class Sensing {
 public:
  /// Throws Failure (bad_input) that names the numbers outside of their range.
  Sensing(const SensingConfig& config, const SimulatedRobot& robot, double control_period_s, std::uint64_t seed);

  /// One period of the plant has passed.
  void follow(const SimulatedRobot& robot, const robot::PlantOutput& out);
  /// Sets the sensors' part of `input` at the end of a control period: speeds are counts per control period, currents means over it.
  void sample(const SimulatedRobot& robot, double ambient_C, robot_core::Input& input);

 private:
  void sample_wheels(robot_core::Input& input);
  void sample_gyro(const SimulatedRobot& robot, robot_core::Input& input);
  double temperature_C(double true_C);

  SensingConfig config_;
  base::Random random_;
  int wheel_count_;
  double control_period_s_;
  double count_per_rad_ = 0.0;  ///< of the wheel
  double bias_rad_per_s_ = 0.0;
  robot::PerWheel offset_A_{};
  robot::PerWheel phase_count_{};  ///< of each encoder at the start: where between two edges
  robot::PerWheel last_rad_per_s_{};
  robot::PerWheel angle_rad_{};  ///< of the wheels
  std::array<std::int64_t, robot::kMostWheels> counts_{};
  robot::PerWheel current_A_{};  ///< sum since the last sample
  double battery_V_;
  int periods_ = 0;
  int samples_ = 0;
};

}  // namespace heatsoak::simulate
