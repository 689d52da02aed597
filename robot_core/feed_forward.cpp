// Stage 4: the part of the voltage that can be calculated from the wanted motion.
//   V = d·ω + f(θ),  f(θ) = a·sin(θ + φ) + b·sign(sin(θ + φ))      (RoboTeam Twente, ETDP 2025, equations (2) and (3))
//   + R/(K_t·n·η)·(r·F + J·dω/dt),  F = J⁺ᵀ·(m·a_x + push_x, m·a_y + push_y, I·a_yaw + push_yaw)
// θ is the direction of travel, and sin(θ + φ) = (v_y·cos φ + v_x·sin φ)/|v|. The sign is smoothed near standstill. In rotation f changes
// to a constant, with the share γ = s²·(3 − 2·s), s = min(1, R·|yaw rate|/|v|).
#include "robot_core/drive_stages.h"

namespace robot_core {
namespace {

/// Friction of all wheels for one motion of the body.
struct Friction {
  float x_m_per_s;
  float y_m_per_s;
  float per_speed_s_per_m;
  float rotation_share;
  float rotation_V;
  float smoothing_m_per_s;
  float wheel_radius_m;

  float voltage_V(const WheelConfig& wheel, float wheel_rad_per_s) const {
    const float of_rotation_V = rotation_V * smooth_sign(wheel_rad_per_s * wheel_radius_m, smoothing_m_per_s);
    if (rotation_share >= 1.0F) {
      return of_rotation_V;
    }
    const float along_m_per_s = y_m_per_s * wheel.phase_cosine_ratio + x_m_per_s * wheel.phase_sine_ratio;
    const float sine = along_m_per_s * per_speed_s_per_m;
    const float of_translation_V = wheel.sine_V * sine + wheel.sign_V * smooth_sign(along_m_per_s, smoothing_m_per_s);
    return of_translation_V + rotation_share * (of_rotation_V - of_translation_V);
  }
};

Friction friction_of(const Config& config, const BodyReference& body) {
  const float x_m_per_s = body.velocity.x;
  const float y_m_per_s = body.velocity.y;
  const float speed_m_per_s = square_root(x_m_per_s * x_m_per_s + y_m_per_s * y_m_per_s);
  const float turning_m_per_s = config.contact_radius_m * absolute(body.velocity.yaw);
  const float s = turning_m_per_s < speed_m_per_s ? turning_m_per_s / speed_m_per_s : 1.0F;
  const float smoothing_m_per_s = config.friction_smoothing_m_per_s;
  const float smoothed_m_per_s = square_root(speed_m_per_s * speed_m_per_s + smoothing_m_per_s * smoothing_m_per_s);
  return {.x_m_per_s = x_m_per_s,
          .y_m_per_s = y_m_per_s,
          .per_speed_s_per_m = smoothed_m_per_s > 0.0F ? 1.0F / smoothed_m_per_s : 0.0F,
          .rotation_share = body.is_wheelwise ? 1.0F : s * s * (3.0F - 2.0F * s),
          .rotation_V = config.rotation_friction_V,
          .smoothing_m_per_s = smoothing_m_per_s,
          .wheel_radius_m = config.wheel_radius_m};
}

[[gnu::noinline]] void take_torques(const Config& config, const Input& input, const Validated& validated, WheelVoltages& voltage) {
  for (int i = 0; i < config.wheel_count; ++i) {
    voltage.wheel[i].feed_forward_V = config.derived.geared_constant_V_s_per_rad * validated.wheel[i].speed_rad_per_s +
                                      config.derived.volt_per_Nm * input.command.wheel_torque_Nm[i];
  }
}

}  // namespace

void feed_forward(const Config& config, const Input& input, const Validated& validated, const BodyReference& body,
                  const WheelReferences& wheels, WheelVoltages& voltage) {
  if (validated.mode == Mode::wheel_torque) {
    take_torques(config, input, validated, voltage);
    return;
  }
  const Friction friction = friction_of(config, body);
  const float force_x_N = config.mass_kg * body.acceleration.x + body.push.x;
  const float force_y_N = config.mass_kg * body.acceleration.y + body.push.y;
  const float moment_Nm = config.yaw_inertia_kg_m2 * body.acceleration.yaw + body.push.yaw;
  // Local values: the compiler cannot know that a voltage written in the loop does not change them.
  const int count = config.wheel_count;
  const bool has_friction = config.has_friction;
  const float inertia_kg_m2 = config.wheel_inertia_kg_m2;
  const float volt_per_Nm = config.derived.volt_per_Nm;
  for (int i = 0; i < count; ++i) {
    const WheelConfig& wheel = config.wheel[i];
    const float reference = wheels.wheel[i].speed_rad_per_s;
    const float force_N = wheel.inverse_x_factor * force_x_N + wheel.inverse_y_factor * force_y_N + wheel.inverse_yaw_per_m * moment_Nm;
    const float torque_Nm = friction.wheel_radius_m * force_N + inertia_kg_m2 * wheels.wheel[i].acceleration_rad_per_s2;
    const float motion_V = wheel.damping_V_s_per_rad * reference + volt_per_Nm * torque_Nm;
    voltage.wheel[i].feed_forward_V = has_friction ? motion_V + friction.voltage_V(wheel, reference) : motion_V;
  }
}

}  // namespace robot_core
