// Stage 4: the part of the voltage that can be calculated from the wanted motion.
//   V = d·ω + f(θ),  f(θ) = a·sin(θ + φ) + b·sign(sin(θ + φ))      (RoboTeam Twente, ETDP 2025, equations (2) and (3))
//   + R/(K_t·n·η)·(r·F + J·dω/dt),  F = J⁺ᵀ·(m·a_x + push_x, m·a_y + push_y, I·a_yaw + push_yaw)
// θ is the direction of travel, and sin(θ + φ) = (v_y·cos φ + v_x·sin φ)/|v|. The sign is smoothed near standstill. In rotation f changes
// to a constant, with the share γ = s²·(3 − 2·s), s = min(1, R·|yaw rate|/|v|).
#include "robot_core/drive_stages.h"

namespace robot_core {
namespace {

/// Friction voltage of one wheel for a motion of the body.
float friction_V(const Config& config, const WheelConfig& wheel, const Vector3& velocity, float per_speed_s_per_m, float rotation_share,
                 float wheel_rad_per_s) {
  const float smoothing = config.friction_smoothing_m_per_s;
  const float rotation_V = config.rotation_friction_V * smooth_sign(wheel_rad_per_s * config.wheel_radius_m, smoothing);
  if (rotation_share >= 1.0F) {
    return rotation_V;
  }
  const float along_m_per_s = velocity.y * wheel.phase_cosine_ratio + velocity.x * wheel.phase_sine_ratio;
  const float sine = along_m_per_s * per_speed_s_per_m;
  const float translation_V = wheel.sine_V * sine + wheel.sign_V * smooth_sign(along_m_per_s, smoothing);
  return translation_V + rotation_share * (rotation_V - translation_V);
}

}  // namespace

void feed_forward(const Config& config, const Input& input, const Validated& validated, const BodyReference& body,
                  const WheelReferences& wheels, WheelVoltages& voltage) {
  const float speed_m_per_s = square_root(body.velocity.x * body.velocity.x + body.velocity.y * body.velocity.y);
  const float turning_m_per_s = config.contact_radius_m * absolute(body.velocity.yaw);
  const float s = turning_m_per_s < speed_m_per_s ? turning_m_per_s / speed_m_per_s : 1.0F;
  const float rotation_share = body.is_wheelwise ? 1.0F : s * s * (3.0F - 2.0F * s);
  const float force_x_N = config.mass_kg * body.acceleration.x + body.push.x;
  const float force_y_N = config.mass_kg * body.acceleration.y + body.push.y;
  const float moment_Nm = config.yaw_inertia_kg_m2 * body.acceleration.yaw + body.push.yaw;
  const float smoothing = config.friction_smoothing_m_per_s;
  const float smoothed_m_per_s = square_root(speed_m_per_s * speed_m_per_s + smoothing * smoothing);
  const float per_speed_s_per_m = smoothed_m_per_s > 0.0F ? 1.0F / smoothed_m_per_s : 0.0F;
  for (int i = 0; i < config.wheel_count; ++i) {
    const WheelConfig& wheel = config.wheel[i];
    const float reference = wheels.wheel[i].speed_rad_per_s;
    if (validated.mode == Mode::wheel_torque) {
      voltage.wheel[i].feed_forward_V = config.derived.geared_constant_V_s_per_rad * validated.wheel[i].speed_rad_per_s +
                                        config.derived.volt_per_Nm * input.command.wheel_torque_Nm[i];
      continue;
    }
    const float force_N = wheel.inverse_x_factor * force_x_N + wheel.inverse_y_factor * force_y_N + wheel.inverse_yaw_per_m * moment_Nm;
    const float torque_Nm = config.wheel_radius_m * force_N + config.wheel_inertia_kg_m2 * wheels.wheel[i].acceleration_rad_per_s2;
    voltage.wheel[i].feed_forward_V = wheel.damping_V_s_per_rad * reference + config.derived.volt_per_Nm * torque_Nm;
    if (config.has_friction) {
      voltage.wheel[i].feed_forward_V += friction_V(config, wheel, body.velocity, per_speed_s_per_m, rotation_share, reference);
    }
  }
}

}  // namespace robot_core
