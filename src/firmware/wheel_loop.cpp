#include "firmware/wheel_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/diagnostic.h"

namespace heatsoak::firmware {
namespace {

constexpr double kDamping = 1.0;
constexpr double kDelayShare = 0.2;  ///< ω_0·L
constexpr double kDelay_periods = 2.0;
constexpr double kWheelMargin = 3.0;
constexpr double kWholeMargin = 2.0;
constexpr double kBodyShare = 0.25;
constexpr double kYawShare = 0.5;
constexpr double kTrackingShare = 0.2;
constexpr double kLeastTracking_periods = 5.0;
constexpr double kLeastGain_ratio = 0.5;  ///< k_p/(K_t·n)

double ultimate_gain() { return 2.0 * std::tan(std::numbers::pi / 8.0); }

/// Time constants of a wheel on the ground and in the air.
double loaded_time_s(const WheelLoopPlant& plant) {
  return plant.loaded_inertia_kg_m2 * plant.volt_per_Nm / (plant.back_emf_V_s_per_rad * plant.gear_efficiency);
}
double time_in_air_s(const WheelLoopPlant& plant) { return plant.wheel_inertia_kg_m2 * plant.volt_per_Nm / plant.back_emf_V_s_per_rad; }

}  // namespace

WheelLoopPlant wheel_loop_plant(const robot::BodyConfig& body, const robot::DriveConstants& drive) {
  const robot::Kinematics& kinematics = body.kinematics;
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  double level = 0.0;
  for (int i = 0; i < kinematics.wheel_count; ++i) {
    xx += kinematics.inverse_x_factor[i] * kinematics.inverse_x_factor[i];
    xy += kinematics.inverse_x_factor[i] * kinematics.inverse_y_factor[i];
    yy += kinematics.inverse_y_factor[i] * kinematics.inverse_y_factor[i];
    level += body.weight.level_share[i] / kinematics.wheel_count;
  }
  const double eigenvalue = 0.5 * (xx + yy) + std::hypot(0.5 * (xx - yy), xy);
  const double mass_inertia_kg_m2 = body.weight.mass_kg * kinematics.wheel_radius_m * kinematics.wheel_radius_m;
  WheelLoopPlant plant;
  plant.back_emf_V_s_per_rad = drive.torque_constant_Nm_per_A * drive.gear_ratio;
  plant.volt_per_Nm = drive.resistance_ohm / plant.back_emf_V_s_per_rad;
  plant.gear_efficiency = drive.gear_efficiency * body.rolling_efficiency;
  plant.wheel_inertia_kg_m2 = body.wheel_inertia_kg_m2;
  plant.loaded_inertia_kg_m2 = body.wheel_inertia_kg_m2 + level * mass_inertia_kg_m2;
  plant.hardest_body_inertia_kg_m2 = eigenvalue * mass_inertia_kg_m2;
  return plant;
}

double longest_loop_period_s(const WheelLoopPlant& plant) {
  return std::min(ultimate_gain() / kWheelMargin * time_in_air_s(plant) / kLeastGain_ratio,
                  2.0 * kDamping * kDelayShare / (kDelay_periods * (1.0 + kLeastGain_ratio)) * loaded_time_s(plant));
}

WheelLoopGains wheel_loop_gains(const WheelLoopPlant& plant, double period_s) {
  const double longest_s = longest_loop_period_s(plant);
  if (period_s > longest_s) {
    throw base::Failure(
        base::ExitCode::bad_input,
        fmt::format("a control period of {:.3g} ms is too long for the wheel-speed loop of this robot: expected at most {:.3g} ms. Shorten "
                    "it with `generate core --period` (the simulation has 1 ms), or choose a motor with more inertia at the wheel",
                    1e3 * period_s, 1e3 * longest_s));
  }
  const double back_emf = plant.back_emf_V_s_per_rad;
  const double loaded_s = loaded_time_s(plant);
  const double in_air_s = time_in_air_s(plant);
  WheelLoopGains gains;
  const double by_delay = 2.0 * kDamping * kDelayShare / (kDelay_periods * period_s) * loaded_s - 1.0;
  const double in_air = ultimate_gain() / kWheelMargin * in_air_s / period_s;
  const double ratio = std::min(by_delay, in_air);
  gains.wheel_gain_V_s_per_rad = ratio * back_emf;
  gains.wheel_rate_per_s = (1.0 + ratio) / loaded_s;
  const double frequency_per_s = gains.wheel_rate_per_s / (2.0 * kDamping);
  gains.wheel_integral_V_per_rad = frequency_per_s * frequency_per_s * loaded_s * back_emf;
  const double left = ultimate_gain() / kWholeMargin - ratio * period_s / in_air_s;
  const double body_per_wheel = (plant.hardest_body_inertia_kg_m2 + plant.wheel_inertia_kg_m2) / plant.wheel_inertia_kg_m2;
  gains.body_gain_per_s = std::min(kBodyShare * gains.wheel_rate_per_s, left / (period_s * body_per_wheel));
  gains.yaw_gain_per_s = kYawShare * gains.wheel_rate_per_s;
  gains.yaw_integral_per_s2 = 0.25 * gains.yaw_gain_per_s * gains.yaw_gain_per_s;
  gains.tracking_time_s =
      std::max(kTrackingShare * gains.wheel_gain_V_s_per_rad / gains.wheel_integral_V_per_rad, kLeastTracking_periods * period_s);
  return gains;
}

}  // namespace heatsoak::firmware
