// A game, played: phases and roles through the planner and the robot's dynamics to what each wheel has to do.
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

/// How the robot gets from target to target. The seam where the drive core takes its place: anything that turns a
/// motion command into body motion over time fits here.
class Follower {
 public:
  virtual ~Follower() = default;
  /// From now on go for the command's target (or stand and push).
  virtual void take(const MotionCommand& command) = 0;
  /// Advance by `step_s`.
  virtual void advance(double step_s) = 0;
  [[nodiscard]] virtual robot::Pose pose() const = 0;
  [[nodiscard]] virtual robot::BodyVelocity velocity_global() const = 0;
  [[nodiscard]] virtual robot::BodyAcceleration acceleration_global() const = 0;
  /// Nothing moves and nothing will until the next command.
  [[nodiscard]] virtual bool at_rest() const = 0;
};

enum class Planner { jerk_limited, bang_bang };
std::string_view to_string(Planner planner);

/// Follows the planner exactly: re-planned at every command from the state of the moment.
std::unique_ptr<Follower> ideal_tracking(const robot::Robot& robot, double aggressiveness, Planner planner);

/// One step of the game at one robot. Torques and speeds as in WheelDemands.
struct MatchMoment {
  double time_s = 0.0;
  double step_s = 0.0;
  Phase phase = Phase::halt;
  bool duel = false;
  robot::Pose pose;
  robot::BodyVelocity velocity_global;
  const robot::WheelDemands* wheels = nullptr;
};

/// A command and when the game gave it.
struct ScheduledCommand {
  double time_s = 0.0;
  Phase phase = Phase::halt;
  MotionCommand command;
};

/// What the phases ask, for the table of where heat comes from.
struct PhaseLoad {
  double time_s = 0.0;
  double duel_s = 0.0;
  robot::PerWheel torque_squared_Nm2_s{};  ///< ∫M²dt per wheel: copper heat is this times R/K_t²
  double duel_torque_squared_Nm2_s = 0.0;  ///< part of it, all wheels, that comes from duels
  double slip_s = 0.0;                     ///< time in which the ground cannot pass on what is demanded
};

struct MatchLoad {
  std::vector<WheelDemand> wheels;
  std::array<PhaseLoad, kPhaseNames.size()> phases{};
  std::vector<ScheduledCommand> script;  ///< so that another way of driving can be asked the same; ends at duration_s
  double duration_s = 0.0;
  double play_s = 0.0;
  double distance_m = 0.0;
};

using MatchObserver = std::function<void(const MatchMoment&)>;

/// Step of a single game.
inline constexpr double kGameStep_s = 1e-3;
/// Step of a game that is one of many draws, because playing games takes nearly all of the time of a verdict. Rounded times let the game
/// take another course than in steps of 1 ms; its mean copper heat is the same.
inline constexpr double kDrawnGameStep_s = 4e-3;

/// Runs one game in steps of `step_s` into bins of `bin_s`. The rotor's inertia is left out, so that the
/// demand is the same for every motor. Throws Failure (bad_input) where the robot's file lacks what motion needs.
MatchLoad play_match(const MatchInputs& inputs, const MatchValues& values, const robot::Robot& robot, std::uint64_t seed, Planner planner,
                     double bin_s = kBin_s, const MatchObserver& observer = {}, double step_s = kGameStep_s);

/// The demand of the wheel with the largest ∫M²dt of the same game, in less time.
WheelDemand hardest_wheel_of_match(const MatchInputs& inputs, const MatchValues& values, const robot::Robot& robot, std::uint64_t seed,
                                   Planner planner, double bin_s, double step_s);

}  // namespace heatsoak::duty
