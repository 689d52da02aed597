#include "duty/match/behaviour.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace heatsoak {
namespace {

/// How a role differs from an attacker: shorter ways, fewer duels, a zone of its own.
struct RoleShape {
  double distance_factor = 1.0;
  double duel_factor = 1.0;
  double zone_from = -0.5;  ///< part of the field's length, from the centre
  double zone_to = 0.5;
  double zone_width = 1.0;  ///< part of the field's width
};

RoleShape shape_of(Role role) {
  switch (role) {
    case Role::keeper:
      return {0.25, 0.1, -0.5, -0.44, 0.25};
    case Role::defender:
      return {0.5, 0.5, -0.42, -0.1, 0.6};
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

/// Spread of the distances to a new target: a factor of two either way for two thirds of them.
constexpr double kLogSpread = 0.7;

}  // namespace

Behaviour::Behaviour(const MatchInputs& inputs, const MatchValues& values, Random& random)
    : role_(inputs.role), values_(values), field_(field_of(inputs.division)), random_(random) {}

double Behaviour::exponential(double value) { return -value * std::log(random_.uniform()); }

FieldPose Behaviour::near(const FieldPose& now, double distance_m) {
  const RoleShape shape = shape_of(role_);
  const double direction_rad = 2.0 * std::numbers::pi * random_.uniform();
  const double x_m = now.x_m + distance_m * std::cos(direction_rad);
  const double y_m = now.y_m + distance_m * std::sin(direction_rad);
  const double half_width_m = 0.5 * shape.zone_width * field_.width_m;
  // A target beyond the zone is mirrored back into it, so that its distance stays what was drawn.
  const auto mirrored = [](double value, double low, double high) {
    const double back = value > high ? 2.0 * high - value : value < low ? 2.0 * low - value : value;
    return std::clamp(back, low, high);
  };
  return {mirrored(x_m, shape.zone_from * field_.length_m, shape.zone_to * field_.length_m), mirrored(y_m, -half_width_m, half_width_m),
          now.yaw_rad + std::numbers::pi * (random_.uniform() - 0.5)};
}

MotionCommand Behaviour::walk(double left_s, const FieldPose& now, double distance_m, double speed_limit_m_per_s) {
  const FieldPose target = near(now, distance_m);
  return {.duration_s = std::min(left_s, exponential(values_.retarget_mean_s) + distance_m),
          .stand = false,
          .x_m = target.x_m,
          .y_m = target.y_m,
          .yaw_rad = target.yaw_rad,
          .speed_limit_m_per_s = speed_limit_m_per_s};
}

MotionCommand Behaviour::play(double left_s, const FieldPose& now) {
  const RoleShape shape = shape_of(role_);
  const double duels_per_command = values_.duels_per_min / 60.0 * shape.duel_factor * values_.retarget_mean_s;
  if (random_.uniform() < duels_per_command) {
    MotionCommand duel = stand(std::min(left_s, exponential(values_.duel_mean_s)));
    duel.duel = true;
    duel.push_direction_rad = now.yaw_rad + 0.5 * std::numbers::pi * (random_.uniform() - 0.5);
    duel.push_share = values_.duel_push_share;
    return duel;
  }
  // Sum of twelve uniform numbers, less six: normal enough, and the same on every machine.
  double normal = -6.0;
  for (int i = 0; i < 12; ++i) {
    normal += random_.uniform();
  }
  const FieldPose target = near(now, values_.distance_median_m * shape.distance_factor * std::exp(kLogSpread * normal));
  return {.duration_s = std::min(left_s, exponential(values_.retarget_mean_s)),
          .stand = false,
          .x_m = target.x_m,
          .y_m = target.y_m,
          .yaw_rad = target.yaw_rad};
}

MotionCommand Behaviour::next(Phase phase, double into_phase_s, double left_s, const FieldPose& now) {
  const PhaseRule rule = rule_of(phase);
  switch (phase) {
    case Phase::running:
      return play(left_s, now);
    case Phase::free_kick:
      return walk(left_s, now, 0.3, rule.speed_limit_m_per_s);
    case Phase::kick_off_preparation:
      return walk(left_s, now, 1.0, 1.5);
    case Phase::stop:
      return walk(left_s, now, 0.7, rule.speed_limit_m_per_s);
    case Phase::ball_placement:
      // The attacker carries the ball, slowly; the others keep half a metre off its way.
      return role_ == Role::attacker ? walk(left_s, now, 2.0, 1.0) : walk(left_s, now, 0.5, 1.5);
    case Phase::half_time:
      return into_phase_s == 0.0 ? walk(left_s, now, 0.5 * field_.length_m, 1.0) : stand(left_s);
    case Phase::halt:
    case Phase::timeout:
      return stand(left_s);
  }
  return stand(left_s);
}

}  // namespace heatsoak
