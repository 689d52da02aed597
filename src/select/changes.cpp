#include "select/changes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "select/evaluate.h"

namespace heatsoak {
namespace {

struct Variant {
  ChangedQuantity quantity;
  double factor;
  std::string_view name;
  std::string_view unit;
  double* (*value)(Robot&);  ///< null if the robot file does not give it
};

double* given(std::optional<double>& value) { return value ? &*value : nullptr; }

/// Steps that a team can make from one day to the next.
constexpr std::array<Variant, 7> kVariants{{
    {ChangedQuantity::acceleration, 0.8, "acceleration limit", "m/s²",
     [](Robot& robot) { return given(robot.limits.acceleration_m_per_s2); }},
    {ChangedQuantity::jerk, 0.5, "jerk limit", "m/s³", [](Robot& robot) { return given(robot.limits.jerk_m_per_s3); }},
    {ChangedQuantity::speed, 0.9, "speed limit", "m/s", [](Robot& robot) { return given(robot.limits.speed_m_per_s); }},
    {ChangedQuantity::yaw_acceleration, 0.7, "yaw acceleration limit", "rad/s²",
     [](Robot& robot) { return given(robot.limits.yaw_acceleration_rad_per_s2); }},
    {ChangedQuantity::mass, 0.9, "mass", "kg", [](Robot& robot) { return &robot.mass_kg; }},
    {ChangedQuantity::wheel_radius, 0.9, "wheel radius", "m", [](Robot& robot) { return &robot.wheels.radius_m; }},
    {ChangedQuantity::gear_ratio, 1.25, "gear ratio", "", [](Robot& robot) { return &robot.drive.gear_ratio; }},
}};

const Variant& variant_of(ChangedQuantity quantity) { return *std::ranges::find(kVariants, quantity, &Variant::quantity); }

Robot changed(const Robot& robot, const Variant& variant) {
  Robot result = robot;
  const auto scale = [&](double* value) {
    if (value) {
      *value *= variant.factor;
    }
  };
  scale(variant.value(result));
  if (variant.quantity == ChangedQuantity::acceleration) {
    scale(given(result.limits.braking_m_per_s2));
  } else if (variant.quantity == ChangedQuantity::mass) {
    scale(given(result.body.yaw_inertia_kg_m2));
  }
  return result;
}

struct Played {
  double peak_C = 0.0;
  bool is_deliverable = true;
};

Played play(const Robot& robot, const Duty& duty, const Motor& motor, std::uint64_t seed) {
  const std::vector<WheelDemand> wheels = duty.demand(robot, seed);
  const MotorEvaluation result = evaluate(robot, duty, wheels, std::span(&motor, 1), {.samples = 0, .seed = seed, .threads = 1}).front();
  return {result.winding_peak_C.nominal, result.short_time_share <= kTolerableShortTime};
}

ChangeEffect effect_of(const Variant& variant, Robot robot, std::span<const Played> before, std::span<const Played> after) {
  const auto count = static_cast<double>(before.size());
  ChangeEffect effect{.quantity = variant.quantity, .before = *variant.value(robot), .factor = variant.factor};
  double sum_squares_K2 = 0.0;
  for (std::size_t game = 0; game < before.size(); ++game) {
    effect.saved_K += (before[game].peak_C - after[game].peak_C) / count;
    effect.is_deliverable = effect.is_deliverable && after[game].is_deliverable;
  }
  for (std::size_t game = 0; game < before.size(); ++game) {
    const double off_K = before[game].peak_C - after[game].peak_C - effect.saved_K;
    sum_squares_K2 += off_K * off_K;
  }
  effect.standard_error_K = count > 1.0 ? std::sqrt(sum_squares_K2 / (count - 1.0) / count) : std::numeric_limits<double>::quiet_NaN();
  return effect;
}

}  // namespace

std::vector<ChangeEffect> effects_of_changes(const Robot& robot, const Duty& duty, const Motor& motor, std::uint64_t seed, int threads,
                                             const Progress& progress) {
  std::vector<const Variant*> variants;
  Robot own = robot;
  for (const Variant& each : kVariants) {
    const bool acts = duty.shape_data->depends_on_robot() || each.quantity == ChangedQuantity::gear_ratio;
    if (acts && each.value(own)) {
      variants.push_back(&each);
    }
  }
  const std::size_t games = duty.shape_data->has_unknowns() ? static_cast<std::size_t>(kChangeGames) : 1;
  // The robot as it is first, then one group of games for each change.
  std::vector<Played> played((variants.size() + 1) * games);
  in_parallel(played.size(), threads, 0, played.size(), progress, [&](std::size_t job) {
    const std::size_t variant = job / games;
    const Robot driven = variant == 0 ? robot : changed(robot, *variants[variant - 1]);
    played[job] = play(driven, duty, motor, seed + job % games);
  });
  std::vector<ChangeEffect> effects;
  const std::span<const Played> all(played);
  for (std::size_t i = 0; i < variants.size(); ++i) {
    effects.push_back(effect_of(*variants[i], robot, all.first(games), all.subspan((i + 1) * games, games)));
  }
  std::ranges::stable_sort(effects, std::ranges::greater(),
                           [](const ChangeEffect& each) { return std::pair(each.is_deliverable, each.saved_K); });
  return effects;
}

std::string_view name_of(ChangedQuantity quantity) { return variant_of(quantity).name; }
std::string_view unit_of(ChangedQuantity quantity) { return variant_of(quantity).unit; }

}  // namespace heatsoak
