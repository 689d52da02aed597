// Stage 5: PI control of the wheel speeds on top of the feed-forward. The limits of stage 6 feed back into the integrator
// (back-calculation; Åström and Hägglund, PID controllers, 1995, section 3.5), in limits.cpp.
#include "robot_core/drive_stages.h"

namespace robot_core {
namespace {

constexpr float kStanding_rad_per_s = 1.0F;
constexpr float kRelease_s = 0.3F;

}  // namespace

void control_wheel_speeds(const Config& config, State& state, const Believed& believed, const WheelReference& wheels,
                          WheelVoltage& voltage) {
  for (int i = 0; i < config.wheel_count; ++i) {
    WheelState& wheel = state.wheel[i];
    voltage.wanted_V[i] = voltage.feed_forward_V[i];
    if (believed.mode == Mode::wheel_torque || !believed.is_speed_sensed[i] || believed.robot_fault == Reason::time_jump) {
      wheel.integral_V = 0.0F;
      continue;
    }
    const float error_rad_per_s = wheels.speed_rad_per_s[i] - believed.wheel_speed_rad_per_s[i];
    wheel.integral_V = clamped(wheel.integral_V + config.wheel_integral_V_per_rad * error_rad_per_s * believed.elapsed_s,
                               -config.battery_full_V, config.battery_full_V);
    // Standing, integrators of wheels that hold each other back would heat motors for nothing.
    if (absolute(wheels.speed_rad_per_s[i]) < kStanding_rad_per_s && absolute(believed.wheel_speed_rad_per_s[i]) < kStanding_rad_per_s) {
      wheel.integral_V -= wheel.integral_V * smaller(1.0F, believed.elapsed_s / kRelease_s);
    }
    voltage.wanted_V[i] += config.wheel_gain_V_s_per_rad * error_rad_per_s + wheel.integral_V;
  }
}

}  // namespace robot_core
