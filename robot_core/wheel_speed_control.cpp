// Stage 5: PI control of the wheel speeds, added to the feed-forward. The limits of stage 6 feed back into the integrator in limits.cpp
// (back-calculation; Åström and Hägglund, PID controllers, 1995, section 3.5).
#include "robot_core/drive_stages.h"

namespace robot_core {
namespace {

constexpr float kStanding_rad_per_s = 2.0F;  // sum of the magnitudes of reference and speed
constexpr float kRelease_per_s = 3.0F;

}  // namespace

void control_wheel_speeds(const Config& config, State& state, const Validated& validated, const WheelReferences& wheels,
                          WheelVoltages& voltage) {
  const bool is_off = validated.mode == Mode::wheel_torque || validated.robot_fault == Reason::time_jump;
  const float integral_gain_V_s_per_rad = config.wheel_integral_V_per_rad * validated.elapsed_s;
  const float release_share = smaller(1.0F, validated.elapsed_s * kRelease_per_s);
  // Local values: the compiler cannot know that a voltage written in the loop does not change them.
  const int count = config.wheel_count;
  const float gain_V_s_per_rad = config.wheel_gain_V_s_per_rad;
  for (int i = 0; i < count; ++i) {
    WheelState& wheel = state.wheel[i];
    WheelVoltage& asked = voltage.wheel[i];
    const float feed_forward_V = asked.feed_forward_V;
    if (is_off || !validated.wheel[i].is_speed_sensed) {
      asked.wanted_V = feed_forward_V;
      wheel.integral_V = 0.0F;
      continue;
    }
    const float reference_rad_per_s = wheels.wheel[i].speed_rad_per_s;
    const float speed_rad_per_s = validated.wheel[i].speed_rad_per_s;
    const float error_rad_per_s = reference_rad_per_s - speed_rad_per_s;
    float integral_V = wheel.integral_V + integral_gain_V_s_per_rad * error_rad_per_s;
    // At standstill, integrators of wheels that work against each other would only heat the motors.
    if (absolute(reference_rad_per_s) + absolute(speed_rad_per_s) < kStanding_rad_per_s) {
      integral_V -= integral_V * release_share;
    }
    wheel.integral_V = integral_V;
    asked.wanted_V = feed_forward_V + gain_V_s_per_rad * error_rad_per_s + integral_V;
  }
}

}  // namespace robot_core
