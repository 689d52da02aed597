#include "select/changes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "select/evaluate.h"

namespace heatsoak {
namespace {

/// One value of the robot and the factor of a usual step.
struct Variant {
  ChangedQuantity quantity;
  double factor;
  double* (*value)(Robot&);  ///< null if the robot file does not give it
};

double* given(std::optional<double>& value) { return value ? &*value : nullptr; }

/// Steps that a team can make from one day to the next.
constexpr std::array<Variant, 6> kVariants{
    {{ChangedQuantity::acceleration, 0.8, [](Robot& robot) { return given(robot.limits.acceleration_m_per_s2); }},
     {ChangedQuantity::jerk, 0.5, [](Robot& robot) { return given(robot.limits.jerk_m_per_s3); }},
     {ChangedQuantity::speed, 0.9, [](Robot& robot) { return given(robot.limits.speed_m_per_s); }},
     {ChangedQuantity::yaw_acceleration, 0.7, [](Robot& robot) { return given(robot.limits.yaw_acceleration_rad_per_s2); }},
     {ChangedQuantity::mass, 0.9, [](Robot& robot) { return &robot.mass_kg; }},
     {ChangedQuantity::wheel_radius, 0.9, [](Robot& robot) { return &robot.wheels.radius_m; }}}};
constexpr Variant kHigherGear{ChangedQuantity::gear_ratio, 1.25, [](Robot& robot) { return &robot.drive.gear_ratio; }};
/// A motor that lacks voltage needs less speed, not less torque.
constexpr Variant kLowerGear{ChangedQuantity::gear_ratio, 0.8, [](Robot& robot) { return &robot.drive.gear_ratio; }};
constexpr double kLongerPauses_ratio = 1.5;

Robot changed(const Robot& robot, const Variant& variant) {
  Robot result = robot;
  if (double* const value = variant.value(result)) {
    *value *= variant.factor;
  }
  if (variant.quantity == ChangedQuantity::acceleration && result.limits.braking_m_per_s2) {
    *result.limits.braking_m_per_s2 *= variant.factor;
  } else if (variant.quantity == ChangedQuantity::mass && result.body.yaw_inertia_kg_m2) {
    *result.body.yaw_inertia_kg_m2 *= variant.factor;
  }
  return result;
}

bool is_pause(const LoadBin& bin) { return bin.torque_rms_Nm == 0.0 && bin.current_rms_A == 0.0; }

double pause_s(const WheelDemand& wheel) {
  double sum_s = 0.0;
  for (const LoadBin& bin : wheel.bins) {
    sum_s += is_pause(bin) ? bin.duration_s : 0.0;
  }
  return sum_s;
}

struct Played {
  double peak_C = 0.0;
  double margin_K = 0.0;
  double pause_s = 0.0;  ///< time without load of the first wheel
  bool is_deliverable = true;
  bool lacks_voltage = false;
  bool passes = false;
};

Played played(const MotorEvaluation& result, const WheelDemand& wheel) {
  const bool is_deliverable = result.short_time_share <= kTolerableShortTime;
  return {.peak_C = result.winding_peak_C.nominal,
          .margin_K = nearest_margin_K(result),
          .pause_s = pause_s(wheel),
          .is_deliverable = is_deliverable,
          .lacks_voltage = !is_deliverable && result.limiting_factor == LimitingFactor::voltage,
          .passes = result.verdict == Verdict::pass};
}

/// The same games for every change: seeds follow each other.
class Games {
 public:
  Games(const Duty& duty, const Motor& motor, std::uint64_t seed)
      : duty_(duty), motor_(motor), seed_(seed), count_(duty.shape_data->has_unknowns() ? static_cast<std::size_t>(kChangeGames) : 1) {}

  [[nodiscard]] std::size_t count() const { return count_; }

  [[nodiscard]] Played play(const Robot& robot, std::size_t game, double pauses_ratio = 1.0) const {
    std::vector<WheelDemand> wheels = duty_.demand(robot, seed_ + game);
    for (WheelDemand& wheel : wheels) {
      for (LoadBin& bin : wheel.bins) {
        bin.duration_s *= is_pause(bin) ? pauses_ratio : 1.0;
      }
    }
    return results(robot, wheels, std::span(&motor_, 1), game).front();
  }

  /// Plays one game with every motor; in the order of `motors`.
  [[nodiscard]] std::vector<Played> play_all(const Robot& robot, std::span<const Motor> motors, std::size_t game) const {
    return results(robot, duty_.demand(robot, seed_ + game), motors, game);
  }

 private:
  [[nodiscard]] std::vector<Played> results(const Robot& robot, const std::vector<WheelDemand>& wheels, std::span<const Motor> motors,
                                            std::size_t game) const {
    const std::vector<MotorEvaluation> all = evaluate(robot, duty_, wheels, motors, {.samples = 0, .seed = seed_ + game, .threads = 1});
    std::vector<Played> in_order;
    for (const Motor& motor : motors) {
      in_order.push_back(played(*std::ranges::find(all, motor.id, &MotorEvaluation::motor_id), wheels.front()));
    }
    return in_order;
  }

  const Duty& duty_;
  const Motor& motor_;
  std::uint64_t seed_;
  std::size_t count_;
};

ChangeEffect effect_of(ChangedQuantity quantity, double value, double factor, std::span<const Played> before,
                       std::span<const Played> after) {
  const auto count = static_cast<double>(before.size());
  ChangeEffect effect{.quantity = quantity, .before = value, .factor = factor};
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
  effect.makes_deliverable = effect.is_deliverable && !std::ranges::all_of(before, &Played::is_deliverable);
  return effect;
}

/// Adds the best other motor. `all` holds the games of each candidate.
void add_other_motor(std::span<const Motor> candidates, const std::vector<std::vector<Played>>& all, std::span<const Played> before,
                     std::vector<ChangeEffect>& effects) {
  std::size_t best = candidates.size();
  double most_K = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const double margin_K = std::ranges::min(all[i], {}, &Played::margin_K).margin_K;
    if (std::ranges::all_of(all[i], &Played::passes) && margin_K > most_K) {
      best = i;
      most_K = margin_K;
    }
  }
  if (best < candidates.size()) {
    effects.push_back(effect_of(ChangedQuantity::motor, 0.0, 1.0, before, all[best]));
    effects.back().other_motor = candidates[best].id;
  }
}

}  // namespace

std::vector<ChangeEffect> effects_of_changes(const Robot& robot, const Duty& duty, const Motor& motor, std::span<const Motor> others,
                                             std::uint64_t seed, int threads, const Progress& progress) {
  const Games games(duty, motor, seed);
  const std::size_t count = games.count();
  std::vector<Variant> variants;
  Robot own = robot;
  for (const Variant& each : kVariants) {
    if (duty.shape_data->depends_on_robot() && each.value(own)) {
      variants.push_back(each);
    }
  }
  std::vector<Motor> candidates;
  std::ranges::copy_if(others, std::back_inserter(candidates), [&](const Motor& each) { return each.id != motor.id; });
  // The robot as it is, then groups of games: one for each variant, the gear, the pauses, and all other motors.
  const std::size_t groups = variants.size() + 3;
  const std::size_t total = (groups + 1) * count;
  std::vector<Played> before(count);
  in_parallel(count, threads, 0, total, progress, [&](std::size_t game) { before[game] = games.play(robot, game); });
  variants.push_back(std::ranges::any_of(before, &Played::lacks_voltage) ? kLowerGear : kHigherGear);
  std::vector<std::vector<Played>> after(groups - 1, std::vector<Played>(count));
  std::vector<std::vector<Played>> of_motors(candidates.size(), std::vector<Played>(count));
  in_parallel(groups * count, threads, count, total, progress, [&](std::size_t job) {
    const std::size_t group = job / count;
    const std::size_t game = job % count;
    if (group < variants.size()) {
      after[group][game] = games.play(changed(robot, variants[group]), game);
    } else if (group == variants.size()) {
      after[group][game] = games.play(robot, game, kLongerPauses_ratio);
    } else if (!candidates.empty()) {
      const std::vector<Played> all = games.play_all(robot, candidates, game);
      for (std::size_t i = 0; i < all.size(); ++i) {
        of_motors[i][game] = all[i];
      }
    }
  });
  std::vector<ChangeEffect> effects;
  for (std::size_t i = 0; i < variants.size(); ++i) {
    effects.push_back(effect_of(variants[i].quantity, *variants[i].value(own), variants[i].factor, before, after[i]));
  }
  if (before.front().pause_s > 0.0) {
    effects.push_back(effect_of(ChangedQuantity::pauses, before.front().pause_s, kLongerPauses_ratio, before, after.back()));
  }
  add_other_motor(candidates, of_motors, before, effects);
  std::ranges::stable_sort(effects, std::ranges::greater(),
                           [](const ChangeEffect& each) { return std::pair(each.is_deliverable, each.saved_K); });
  return effects;
}

std::string_view name_of(ChangedQuantity quantity) {
  constexpr std::array<std::string_view, 9> kNames{
      "acceleration limit", "jerk limit",        "speed limit", "yaw acceleration limit", "mass", "wheel radius",
      "gear ratio",         "time without load", "motor"};
  return kNames.at(static_cast<std::size_t>(quantity));
}

std::string_view unit_of(ChangedQuantity quantity) {
  constexpr std::array<std::string_view, 9> kUnits{"m/s²", "m/s³", "m/s", "rad/s²", "kg", "m", "", "s", ""};
  return kUnits.at(static_cast<std::size_t>(quantity));
}

}  // namespace heatsoak
