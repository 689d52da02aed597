// Error bound of the energy balance for voltages that jump.
#pragma once

#include <algorithm>

#include "motor/motor.h"
#include "robot/robot.h"
#include "robot/traction.h"
#include "simulate/simulated_robot.h"

namespace heatsoak::simulate {

/// A jump of the voltage moves the wheel against its contact with the time constant J/(c·r²); c = μ·N/slip speed is the contact's slope.
/// For RoboTeam Twente this is 0.4 ms, less than the plant's period T. The plant's method damps such fast motions. The power that the
/// balance misses in that period is of the order of ΔM·ΔM/(c·r²): the torque jump times the jump of the wheel's speed.
class JumpEnergy {
 public:
  JumpEnergy(const robot::Robot& robot, const motor::Motor& motor)
      : torque_per_V_(motor.nominal.torque_constant_Nm_per_A * robot.drive.gear_ratio / motor.nominal.terminal_resistance_ohm),
        slope_Nm_s_per_rad_(robot.traction.coefficient_ratio.value() * robot.mass_kg * robot::kGravity_m_per_s2 /
                            static_cast<double>(robot.wheels.axis_rad.size()) / robot.traction.slip_speed_m_per_s.value() *
                            robot.wheels.radius_m * robot.wheels.radius_m) {}

  void take(const robot::PlantOutput& out) {
    for (int i = 0; i < robot::kMostWheels; ++i) {
      const double jump_Nm = torque_per_V_ * (out.terminal_V[i] - last_V_[i]);
      sum_J_ += jump_Nm * jump_Nm / slope_Nm_s_per_rad_ * SimulatedRobot::kPeriod_s;
    }
    last_V_ = out.terminal_V;
  }
  /// Returns the sum over all jumps so far.
  [[nodiscard]] double unresolved_J() const { return sum_J_; }

 private:
  double torque_per_V_;
  double slope_Nm_s_per_rad_;
  robot::PerWheel last_V_{};
  double sum_J_ = 0.0;
};

}  // namespace heatsoak::simulate
