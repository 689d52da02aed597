#include "simulate/drive_script.h"

#include <algorithm>
#include <cmath>

#include "robot/inverse_dynamics.h"

namespace heatsoak::simulate {
namespace {

/// Computes the opponent's force on the robot. It acts against the push and only during contact.
class Duel {
 public:
  void begin(const duty::MotionCommand& command, const robot::Pose& at, const robot::BodyConfig& body) {
    x_share_ = std::cos(command.push_direction_rad);
    y_share_ = std::sin(command.push_direction_rad);
    force_N_ =
        command.push_share * robot::largest_push_N(body, command.push_direction_rad - at.yaw_rad, body.weight.center_of_gravity_height_m);
    wall_m_ = along(at.x_m, at.y_m);
    active_ = true;
  }
  void end() { active_ = false; }
  [[nodiscard]] bool active() const { return active_; }
  /// Returns the force with which the robot must push, global frame.
  [[nodiscard]] robot::Wrench push() const {
    return active_ ? robot::Wrench{force_N_ * x_share_, force_N_ * y_share_, 0.0} : robot::Wrench{};
  }
  /// Returns the opponent's reaction force, local frame.
  [[nodiscard]] robot::Wrench reaction(const SimulatedRobot& robot) const {
    if (!active_) {
      return {};
    }
    const robot::Pose& pose = robot.state().pose;
    const robot::BodyVelocity velocity = robot.velocity_global();
    const double into_m = along(pose.x_m, pose.y_m) - wall_m_;
    const double force_N = into_m > 0.0 ? std::max(0.0, opponent_.stiffness_N_per_m * into_m +
                                                            opponent_.damping_N_s_per_m * along(velocity.x_m_per_s, velocity.y_m_per_s))
                                        : 0.0;
    return robot::to_local(robot::Wrench{-force_N * x_share_, -force_N * y_share_, 0.0}, pose.yaw_rad);
  }

 private:
  [[nodiscard]] double along(double x, double y) const { return x * x_share_ + y * y_share_; }

  Opponent opponent_;
  double x_share_ = 1.0;
  double y_share_ = 0.0;
  double force_N_ = 0.0;
  double wall_m_ = 0.0;
  bool active_ = false;
};

class Loop {
 public:
  Loop(SimulatedRobot& robot, CoreDrive& drive, duty::Follower& plan, const LoopObserver& observer)
      : robot_(robot), drive_(drive), plan_(plan), observer_(observer) {}

  void run(std::span<const duty::ScheduledCommand> script, double end_s) {
    for (std::size_t i = 0; i < script.size(); ++i) {
      const std::int64_t until = periods(i + 1 < script.size() ? script[i + 1].time_s : end_s);
      if (now_ >= until) {
        continue;
      }
      plan_.take(script[i].command);
      for (duel_.end(); now_ < until;) {
        period(script[i], i);
      }
    }
  }

 private:
  static std::int64_t periods(double time_s) { return std::llround(time_s / SimulatedRobot::kPeriod_s); }

  void period(const duty::ScheduledCommand& scheduled, std::size_t index) {
    const bool at_rest = plan_.at_rest();
    if (scheduled.command.duel && at_rest && !duel_.active()) {
      duel_.begin(scheduled.command, robot_.state().pose, robot_.plant().body);
    }
    const std::array<robot::MotorCommand, robot::kMostWheels>& commands = drive_.advance(plan_, robot_, duel_.push());
    plan_.advance(SimulatedRobot::kPeriod_s);
    const robot::PlantOutput& out = robot_.advance(commands, duel_.reaction(robot_));
    drive_.follow(robot_, out);
    ++now_;
    observer_({static_cast<double>(now_) * SimulatedRobot::kPeriod_s, &scheduled, index, at_rest, duel_.active(), &plan_, &out, &robot_,
               &drive_});
  }

  SimulatedRobot& robot_;
  CoreDrive& drive_;
  duty::Follower& plan_;
  const LoopObserver& observer_;
  Duel duel_;
  std::int64_t now_ = 0;
};

}  // namespace

void drive_script(SimulatedRobot& robot, CoreDrive& drive, duty::Follower& plan, std::span<const duty::ScheduledCommand> script,
                  double end_s, const LoopObserver& observer) {
  Loop(robot, drive, plan, observer).run(script, end_s);
}

}  // namespace heatsoak::simulate
