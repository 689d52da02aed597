#include "duty/match/behaviour.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace heatsoak::duty {
namespace {

/// Differences of a role from an attacker: factors on distances and duels, and its zone.
struct RoleShape {
  double distance_factor = 1.0;
  double duel_factor = 1.0;
  double zone_from = -0.5;  ///< start of the zone, as a share of the field length from the centre
  double zone_to = 0.5;     ///< end of the zone
  double zone_width = 1.0;  ///< share of the field width
};

RoleShape shape_of(Role role, const MatchValues& values) {
  switch (role) {
    case Role::keeper:
      return {0.5 * values.role_distance_share, 0.2 * values.role_duels_share, -0.5, -0.5 + 0.06 * values.role_zone_factor,
              std::min(1.0, 0.25 * values.role_zone_factor)};
    case Role::defender:
      return {values.role_distance_share, values.role_duels_share, -0.42, -0.42 + 0.32 * values.role_zone_factor,
              std::min(1.0, 0.6 * values.role_zone_factor)};
    case Role::attacker:
      return {};
  }
  return {};
}

MotionCommand stand(double duration_s) {
  MotionCommand command;
  command.duration_s = duration_s;
  command.stand = true;
  return command;
}

}  // namespace

Behaviour::Behaviour(const MatchInputs& inputs, const MatchValues& values, base::Random& random)
    : role_(inputs.role), values_(values), field_(field_of(inputs.division)), random_(random), next_duel_s_(until_next_duel_s()) {}

double Behaviour::exponential(double value) { return -value * std::log(random_.uniform()); }

double Behaviour::either_way(double most) { return most * (2.0 * random_.uniform() - 1.0); }

double Behaviour::until_next_duel_s() {
  const double per_min = values_.duels_per_min * shape_of(role_, values_).duel_factor;
  return per_min > 0.0 ? exponential(60.0 / per_min) : std::numeric_limits<double>::infinity();
}

FieldPose Behaviour::near(const FieldPose& now, double distance_m) {
  const RoleShape shape = shape_of(role_, values_);
  const double from_m = shape.zone_from * field_.length_m;
  const double to_m = shape.zone_to * field_.length_m;
  const double half_width_m = 0.5 * shape.zone_width * field_.width_m;
  double x_m = 0.0;
  double y_m = 0.0;
  // A direction that leaves the zone is replaced by another one, so that the drawn distance is kept if possible.
  constexpr int kMostDirections = 32;
  for (int i = 0; i < kMostDirections; ++i) {
    const double direction_rad = 2.0 * std::numbers::pi * random_.uniform();
    x_m = now.x_m + distance_m * std::cos(direction_rad);
    y_m = now.y_m + distance_m * std::sin(direction_rad);
    if (from_m <= x_m && x_m <= to_m && std::abs(y_m) <= half_width_m) {
      break;
    }
  }
  return {std::clamp(x_m, from_m, to_m), std::clamp(y_m, -half_width_m, half_width_m), now.yaw_rad + either_way(values_.turn_rad)};
}

MotionCommand Behaviour::walk(double left_s, const FieldPose& now, double distance_m, double speed_limit_m_per_s) {
  constexpr double kPace_m_per_s = 1.0;
  const double way_m = values_.outside_distance_factor * distance_m;
  const FieldPose target = near(now, way_m);
  return {.duration_s = std::min(left_s, exponential(values_.retarget_mean_s) + way_m / (values_.outside_speed_factor * kPace_m_per_s)),
          .stand = false,
          .x_m = target.x_m,
          .y_m = target.y_m,
          .yaw_rad = target.yaw_rad,
          .speed_limit_m_per_s = speed_limit_m_per_s};
}

MotionCommand Behaviour::play(double into_phase_s, double left_s, const FieldPose& now) {
  play_end_s_ += into_phase_s == 0.0 ? left_s : 0.0;
  if (next_duel_s_ <= play_end_s_ - left_s) {
    next_duel_s_ += until_next_duel_s();
    MotionCommand duel = stand(std::min(left_s, exponential(values_.duel_mean_s)));
    duel.duel = true;
    duel.push_direction_rad = now.yaw_rad + either_way(values_.duel_angle_rad);
    duel.push_share = values_.duel_push_share;
    return duel;
  }
  // The sum of twelve uniform numbers minus six is approximately normal and the same on every machine.
  double normal = -6.0;
  for (int i = 0; i < 12; ++i) {
    normal += random_.uniform();
  }
  const double median_m = values_.distance_median_m * shape_of(role_, values_).distance_factor;
  const FieldPose target = near(now, median_m * std::exp(values_.distance_spread_ratio * normal));
  return {.duration_s = std::min(left_s, exponential(values_.retarget_mean_s)),
          .stand = false,
          .x_m = target.x_m,
          .y_m = target.y_m,
          .yaw_rad = target.yaw_rad};
}

MotionCommand Behaviour::next(Phase phase, double into_phase_s, double left_s, const FieldPose& now) {
  const PhaseRule rule = rule_of(phase);
  const double brisk_m_per_s = 1.5 * values_.outside_speed_factor;
  const double calm_m_per_s = 1.0 * values_.outside_speed_factor;
  switch (phase) {
    case Phase::running:
      return play(into_phase_s, left_s, now);
    case Phase::free_kick:
      return walk(left_s, now, 0.3, rule.speed_limit_m_per_s);
    case Phase::kick_off_preparation:
      return walk(left_s, now, 1.0, brisk_m_per_s);
    case Phase::stop:
      return walk(left_s, now, 0.7, std::min(rule.speed_limit_m_per_s, brisk_m_per_s));
    case Phase::ball_placement:
      // The attacker carries the ball slowly; the others move 0.5 m out of its way.
      return role_ == Role::attacker ? walk(left_s, now, 2.0, calm_m_per_s) : walk(left_s, now, 0.5, brisk_m_per_s);
    case Phase::half_time:
      return into_phase_s == 0.0 ? walk(left_s, now, 0.5 * field_.length_m, calm_m_per_s) : stand(left_s);
    case Phase::halt:
    case Phase::timeout:
      return stand(left_s);
  }
  return stand(left_s);
}

}  // namespace heatsoak::duty
