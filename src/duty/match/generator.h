// Plays a game: computes the demand of each wheel from phases, role, planner and the robot's dynamics.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "duty/demand.h"
#include "duty/match/behaviour.h"
#include "robot/inverse_dynamics.h"

namespace heatsoak::duty {

/// Interface that converts motion commands to body motion over time. The ideal tracker implements it.
class Follower {
 public:
  virtual ~Follower() = default;
  /// Starts to execute the command from the present state.
  virtual void take(const MotionCommand& command) = 0;
  /// Advances by `step_s`.
  virtual void advance(double step_s) = 0;
  [[nodiscard]] virtual robot::Pose pose() const = 0;
  [[nodiscard]] virtual robot::BodyVelocity velocity_global() const = 0;
  [[nodiscard]] virtual robot::BodyAcceleration acceleration_global() const = 0;
  /// Returns true if nothing moves until the next command.
  [[nodiscard]] virtual bool at_rest() const = 0;
};

enum class Planner { jerk_limited, bang_bang };
std::string_view to_string(Planner planner);

/// Returns a follower that tracks the plan exactly. It plans at every command from the present state. `aggressiveness` scales the robot's
/// limits.
std::unique_ptr<Follower> ideal_tracking(const robot::Robot& robot, double aggressiveness, Planner planner);

/// One step of the game for one robot.
struct MatchMoment {
  double time_s = 0.0;
  double step_s = 0.0;
  Phase phase = Phase::halt;
  bool duel = false;
  robot::Pose pose;
  robot::BodyVelocity velocity_global;
  const robot::WheelDemands* wheels = nullptr;
};

/// Command with the time and phase at which the game gives it.
struct ScheduledCommand {
  double time_s = 0.0;
  Phase phase = Phase::halt;
  MotionCommand command;
};

/// Load in one phase, for the table of heat by phase.
struct PhaseLoad {
  double time_s = 0.0;
  double duel_s = 0.0;
  robot::PerWheel torque_squared_Nm2_s{};  ///< ∫M²dt per wheel: copper heat is this times R/K_t²
  double duel_torque_squared_Nm2_s = 0.0;  ///< ∫M²dt in duels, sum of all wheels
  double slip_s = 0.0;                     ///< time in which the ground cannot transmit the demanded forces
};

struct MatchLoad {
  std::vector<WheelDemand> wheels;
  std::array<PhaseLoad, kPhaseNames.size()> phases{};
  std::vector<ScheduledCommand> script;  ///< commands of the game, for driving it with other methods; ends at duration_s
  double duration_s = 0.0;
  double play_s = 0.0;
  double distance_m = 0.0;
};

using MatchObserver = std::function<void(const MatchMoment&)>;

/// Step of a single game.
inline constexpr double kGameStep_s = 1e-3;
/// Step of a drawn game. It is longer because games take nearly all of the time of a verdict. Rounded times change the course of a game,
/// but not its mean copper heat.
inline constexpr double kDrawnGameStep_s = 4e-3;

/// Plays one game in steps of `step_s` and returns its load in bins of `bin_s`. The rotor inertia is omitted, so the demand is the same for
/// every motor. Throws Failure (bad_input) if the robot's file lacks values for motion.
MatchLoad play_match(const MatchInputs& inputs, const MatchValues& values, const robot::Robot& robot, std::uint64_t seed, Planner planner,
                     double bin_s = kBin_s, const MatchObserver& observer = {}, double step_s = kGameStep_s);

/// Plays the game with nominal inputs and the jerk-limited planner.
inline MatchLoad play_nominal(const MatchInputs& inputs, const robot::Robot& robot, std::uint64_t seed) {
  return play_match(inputs, inputs.nominal(), robot, seed, Planner::jerk_limited);
}

/// Returns the demand of the wheel with the largest ∫M²dt of the same game; faster than play_match().
WheelDemand hardest_wheel_of_match(const MatchInputs& inputs, const MatchValues& values, const robot::Robot& robot, std::uint64_t seed,
                                   Planner planner, double bin_s, double step_s);

}  // namespace heatsoak::duty
