// Generates the targets and duels of a role in a phase, independent of the robot's dynamics.
#pragma once

#include "duty/match/game.h"

namespace heatsoak::duty {

/// Command for `duration_s`: drive to the target, brake to standstill, or push against another robot at the target.
struct MotionCommand {
  double duration_s = 0.0;
  bool stand = false;  ///< brake and stay; the target is ignored
  double x_m = 0.0;    ///< field frame: centre of the field, x towards the opponents' goal
  double y_m = 0.0;
  double yaw_rad = 0.0;
  double speed_limit_m_per_s = std::numeric_limits<double>::infinity();
  bool duel = false;
  double push_direction_rad = 0.0;  ///< field frame
  double push_share = 0.0;          ///< share of the largest force that the robot can hold (largest_push_N)
};

struct FieldPose {
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;
};

class Behaviour {
 public:
  Behaviour(const MatchInputs& inputs, const MatchValues& values, base::Random& random);

  /// Returns the next command, `into_phase_s` after the start of the phase and `left_s` before its end. It is not longer than `left_s`.
  MotionCommand next(Phase phase, double into_phase_s, double left_s, const FieldPose& now);

 private:
  MotionCommand play(double into_phase_s, double left_s, const FieldPose& now);
  MotionCommand walk(double left_s, const FieldPose& now, double distance_m, double speed_limit_m_per_s);
  FieldPose near(const FieldPose& now, double distance_m);
  double exponential(double value);
  double either_way(double most);
  double until_next_duel_s();

  Role role_;
  MatchValues values_;
  FieldSize field_;
  base::Random& random_;
  double play_end_s_ = 0.0;  ///< end of the present segment of play, in time of play
  double next_duel_s_;       ///< start of the next duel, in time of play; the rate of duels does not depend on their duration
};

}  // namespace heatsoak::duty
