// What a role does in a phase: a stream of targets and duels, with no notion of how the robot gets there.
#pragma once

#include "duty/match/game.h"

namespace heatsoak::duty {

/// Hold for `duration_s`: go to the target, come to a stand where braking ends, or push against another robot there.
struct MotionCommand {
  double duration_s = 0.0;
  bool stand = false;  ///< brake and stay: the target plays no part
  double x_m = 0.0;    ///< field frame: centre of the field, x towards the opponents' goal
  double y_m = 0.0;
  double yaw_rad = 0.0;
  double speed_limit_m_per_s = std::numeric_limits<double>::infinity();
  bool duel = false;
  double push_direction_rad = 0.0;  ///< field frame
  double push_share = 0.0;          ///< of the largest force that the robot can hold there (largest_push_N)
};

struct FieldPose {
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;
};

class Behaviour {
 public:
  Behaviour(const MatchInputs& inputs, const MatchValues& values, base::Random& random);

  /// The next command, `into_phase_s` after the phase began with `left_s` still to go; never longer than `left_s`.
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
  double play_end_s_ = 0.0;  ///< end of the present segment, in time of play
  double next_duel_s_;       ///< counted likewise: duels come by the minute of play, whatever time they take of it
};

}  // namespace heatsoak::duty
