#include "select/changes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <tuple>
#include <utility>

#include "select/evaluate.h"

namespace heatsoak::select {
namespace {

/// One value of the robot and the factor of a usual step.
struct Variant {
  ChangedQuantity quantity;
  double factor;
  double* (*value)(robot::Robot&);  ///< null if the robot file does not give it
};

double* given(std::optional<double>& value) { return value ? &*value : nullptr; }

/// Changes that a team can make within a day.
constexpr std::array<Variant, 6> kVariants{
    {{ChangedQuantity::acceleration, 0.8, [](robot::Robot& robot) { return given(robot.limits.acceleration_m_per_s2); }},
     {ChangedQuantity::jerk, 0.5, [](robot::Robot& robot) { return given(robot.limits.jerk_m_per_s3); }},
     {ChangedQuantity::speed, 0.9, [](robot::Robot& robot) { return given(robot.limits.speed_m_per_s); }},
     {ChangedQuantity::yaw_acceleration, 0.7, [](robot::Robot& robot) { return given(robot.limits.yaw_acceleration_rad_per_s2); }},
     {ChangedQuantity::mass, 0.9, [](robot::Robot& robot) { return &robot.mass_kg; }},
     {ChangedQuantity::wheel_radius, 0.9, [](robot::Robot& robot) { return &robot.wheels.radius_m; }}}};
constexpr Variant kHigherGear{ChangedQuantity::gear_ratio, 1.25, [](robot::Robot& robot) { return &robot.drive.gear_ratio; }};
/// Replaces kHigherGear for a motor that lacks voltage, which needs less speed rather than less torque.
constexpr Variant kLowerGear{ChangedQuantity::gear_ratio, 0.8, [](robot::Robot& robot) { return &robot.drive.gear_ratio; }};
constexpr double kLongerPauses_ratio = 1.5;

robot::Robot changed(const robot::Robot& robot, const Variant& variant) {
  robot::Robot result = robot;
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

/// Returns the changes that need games of their own.
std::vector<Variant> variants_of(const robot::Robot& robot, const duty::Duty& duty) {
  std::vector<Variant> variants;
  robot::Robot own = robot;
  for (const Variant& each : kVariants) {
    if (duty.shape_data->depends_on_robot() && each.value(own)) {
      variants.push_back(each);
    }
  }
  return variants;
}

bool is_pause(const duty::LoadBin& bin) { return bin.torque_rms_Nm == 0.0 && bin.current_rms_A == 0.0; }

double pause_s(const duty::WheelDemand& wheel) {
  double sum_s = 0.0;
  for (const duty::LoadBin& bin : wheel.bins) {
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

Played played(const MotorEvaluation& result, const duty::WheelDemand& wheel) {
  const bool is_deliverable = result.short_time_share <= kTolerableShortTime;
  return {.peak_C = result.winding_peak_C.nominal,
          .margin_K = nearest_margin_K(result),
          .pause_s = pause_s(wheel),
          .is_deliverable = is_deliverable,
          .lacks_voltage = !is_deliverable && result.limiting_factor == LimitingFactor::voltage,
          .passes = result.verdict == Verdict::pass};
}

/// Plays the same games for every change, with consecutive seeds.
class Games {
 public:
  Games(const duty::Duty& duty, std::uint64_t seed)
      : duty_(duty), seed_(seed), count_(duty.shape_data->has_unknowns() ? static_cast<std::size_t>(kChangeGames) : 1) {}

  [[nodiscard]] std::size_t count() const { return count_; }

  [[nodiscard]] std::vector<duty::WheelDemand> demand(const robot::Robot& robot, std::size_t game) const {
    return duty_.demand(robot, seed_ + game);
  }

  [[nodiscard]] Played result(const robot::Robot& robot, const motor::Motor& motor, const std::vector<duty::WheelDemand>& wheels) const {
    const EvaluateOptions nominal{.samples = 0, .threads = 1, .with_current_margin = false};
    return played(evaluate(robot, duty_, wheels, std::span(&motor, 1), nominal).front(), wheels.front());
  }

 private:
  const duty::Duty& duty_;
  std::uint64_t seed_;
  std::size_t count_;
};

std::vector<duty::WheelDemand> with_longer_pauses(std::vector<duty::WheelDemand> wheels) {
  for (duty::WheelDemand& wheel : wheels) {
    for (duty::LoadBin& bin : wheel.bins) {
      bin.duration_s *= is_pause(bin) ? kLongerPauses_ratio : 1.0;
    }
  }
  return wheels;
}

/// Combines the progress of jobs of different length. The unit is one motor in one game; playing the game takes about five units.
class ChangeWork {
 public:
  static constexpr std::size_t kEvaluation = 1;
  static constexpr std::size_t kPlayedGame = 6;

  static constexpr double kUnit_s = 0.026;  ///< on two cores

  /// Returns the work of all changes: those that need games of their own, those that do not, and other motors.
  static std::size_t units(std::size_t variants, std::size_t games, std::size_t others) {
    return kPlayedGame * (variants + 1) * games + kEvaluation * (2 * games + others);
  }

  ChangeWork(std::size_t total, int threads, const base::Progress& progress) : total_(total), threads_(threads), progress_(progress) {}

  void run(std::size_t count, std::size_t units_each, const std::function<void(std::size_t)>& job) {
    const auto show = [this, units_each](std::size_t done, std::size_t /*count*/) {
      progress_(std::min(total_, done_ + units_each * done), total_);
    };
    base::in_parallel(count, threads_, 0, count, progress_ ? base::Progress(show) : base::Progress(), job);
    done_ += units_each * count;
  }

 private:
  std::size_t total_;
  int threads_;
  const base::Progress& progress_;
  std::size_t done_ = 0;
};

ChangeEffect effect_of(ChangedQuantity quantity, std::optional<double> value, double factor, std::span<const Played> before,
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
  effect.standard_error_K = count > 1.0 ? std::optional(std::sqrt(sum_squares_K2 / (count - 1.0) / count)) : std::nullopt;
  effect.makes_deliverable = effect.is_deliverable && !std::ranges::all_of(before, &Played::is_deliverable);
  return effect;
}

/// Motor with the largest margin among those that pass all games. A motor's margin in the first game is an upper bound of its margin in all
/// games, so only motors that can still win are evaluated in the other games.
struct OtherMotor {
  const motor::Motor* motor = nullptr;
  std::vector<Played> games;
};
OtherMotor best_other_motor(const Games& games, const robot::Robot& robot, const std::vector<std::vector<duty::WheelDemand>>& demands,
                            std::span<const motor::Motor* const> candidates, ChangeWork& work) {
  std::vector<Played> first(candidates.size());
  work.run(first.size(), ChangeWork::kEvaluation, [&](std::size_t i) { first[i] = games.result(robot, *candidates[i], demands.front()); });
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (first[i].passes) {
      order.push_back(i);
    }
  }
  std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t i) { return first[i].margin_K; });
  OtherMotor best;
  std::size_t place = 0;
  double most_K = -std::numeric_limits<double>::infinity();
  for (const std::size_t i : order) {
    if (first[i].margin_K < most_K) {
      break;
    }
    std::vector<Played> all(games.count(), first[i]);
    work.run(games.count() - 1, ChangeWork::kEvaluation,
             [&](std::size_t game) { all[game + 1] = games.result(robot, *candidates[i], demands[game + 1]); });
    const double margin_K = std::ranges::min(all, {}, &Played::margin_K).margin_K;
    // If motors are equally good, the first in the list wins, whatever the order of the games.
    const bool is_better = margin_K > most_K || (margin_K == most_K && best.motor && i < place);
    if (std::ranges::all_of(all, &Played::passes) && is_better) {
      best = {candidates[i], std::move(all)};
      place = i;
      most_K = margin_K;
    }
  }
  return best;
}

}  // namespace

std::vector<ChangeEffect> effects_of_changes(const robot::Robot& robot, const duty::Duty& duty, const motor::Motor& motor,
                                             std::span<const motor::Motor> others, std::uint64_t seed, int threads,
                                             const base::Progress& progress) {
  const Games games(duty, seed);
  const std::size_t count = games.count();
  const std::vector<Variant> variants = variants_of(robot, duty);
  robot::Robot own = robot;
  std::vector<const motor::Motor*> candidates;
  for (const motor::Motor& each : others) {
    if (each.id != motor.id) {
      candidates.push_back(&each);
    }
  }
  ChangeWork work(ChangeWork::units(variants.size(), count, candidates.size()), threads, progress);
  std::vector<std::vector<duty::WheelDemand>> demands(count);
  std::vector<Played> before(count);
  work.run(count, ChangeWork::kPlayedGame, [&](std::size_t game) {
    demands[game] = games.demand(robot, game);
    before[game] = games.result(robot, motor, demands[game]);
  });
  std::vector<std::vector<Played>> after(variants.size(), std::vector<Played>(count));
  work.run(variants.size() * count, ChangeWork::kPlayedGame, [&](std::size_t job) {
    const std::size_t game = job % count;
    const robot::Robot other = changed(robot, variants[job / count]);
    after[job / count][game] = games.result(other, motor, games.demand(other, game));
  });
  // Gear, pauses and motor do not change the wheels' loads, so the games need not be played again.
  const Variant gear = std::ranges::any_of(before, &Played::lacks_voltage) ? kLowerGear : kHigherGear;
  const robot::Robot geared = changed(robot, gear);
  std::vector<Played> after_gear(count);
  std::vector<Played> after_pauses(count);
  work.run(2 * count, ChangeWork::kEvaluation, [&](std::size_t job) {
    const std::size_t game = job / 2;
    if (job % 2 == 0) {
      after_gear[game] = games.result(geared, motor, demands[game]);
    } else {
      after_pauses[game] = games.result(robot, motor, with_longer_pauses(demands[game]));
    }
  });
  std::vector<ChangeEffect> effects;
  for (std::size_t i = 0; i < variants.size(); ++i) {
    effects.push_back(effect_of(variants[i].quantity, *variants[i].value(own), variants[i].factor, before, after[i]));
  }
  effects.push_back(effect_of(gear.quantity, *gear.value(own), gear.factor, before, after_gear));
  if (before.front().pause_s > 0.0) {
    effects.push_back(effect_of(ChangedQuantity::pauses, before.front().pause_s, kLongerPauses_ratio, before, after_pauses));
  }
  const OtherMotor best = best_other_motor(games, robot, demands, candidates, work);
  if (best.motor) {
    effects.push_back(effect_of(ChangedQuantity::motor, {}, 1.0, before, best.games));
    effects.back().other_motor = best.motor->id;
  }
  std::ranges::stable_sort(effects, std::ranges::greater(), [](const ChangeEffect& each) {
    return std::tuple(each.other_motor.empty(), each.is_deliverable, each.saved_K);
  });
  return effects;
}

double changes_work_s(const robot::Robot& robot, const duty::Duty& duty, std::size_t others) {
  return ChangeWork::kUnit_s * static_cast<double>(ChangeWork::units(variants_of(robot, duty).size(), Games(duty, 1).count(), others));
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

}  // namespace heatsoak::select
