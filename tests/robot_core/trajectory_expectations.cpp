#include "trajectory_expectations.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>

namespace robot_core::reference {

int problem_count() {
  const char* const asked = std::getenv("HEATSOAK_TRAJECTORY_PROBLEMS");
  return asked != nullptr ? std::atoi(asked) : 20'000;
}

std::string text(const Task& task) {
  std::ostringstream out;
  out.precision(17);
  const Limits& l = task.limits;
  out << "{{" << task.start.position << ", " << task.start.velocity << ", " << task.start.acceleration << "}, {" << task.target.position
      << ", " << task.target.velocity << ", " << task.target.acceleration << "}, {" << l.velocity_max << ", " << l.velocity_min << ", "
      << l.acceleration_max << ", " << l.acceleration_min << ", " << l.jerk_max << "}}";
  return out.str();
}

Motion planned(const Task& task) {
  Motion motion;
  EXPECT_EQ(plan_position(task.start, task.target, task.limits, motion), PlanResult::ok) << text(task);
  return motion;
}

double duration_s(const Task& task) { return planned(task).duration_s; }

void expect_flawless(const Motion& motion, const Task& task, double judged_from_s, double most) {
  const Flaws flaws = flaws_of(motion, task, judged_from_s);
  EXPECT_LE(flaws.end, most) << text(task);
  EXPECT_LE(flaws.gap, 1e-10) << text(task);
  EXPECT_LE(flaws.limit, most) << text(task);
  EXPECT_LE(flaws.jerk, 1e-12) << text(task);
  EXPECT_LE(flaws.order, 1e-14) << text(task);
}

namespace {

template <typename Plan>
Fleet together(std::vector<Task> tasks, const Plan& plan) {
  Fleet fleet{std::move(tasks), {}};
  std::vector<State> start;
  std::vector<State> target;
  std::vector<Limits> limits;
  for (const Task& task : fleet.tasks) {
    start.push_back(task.start);
    target.push_back(task.target);
    limits.push_back(task.limits);
  }
  fleet.motions.resize(fleet.tasks.size());
  EXPECT_EQ(plan(static_cast<int>(fleet.tasks.size()), start.data(), target.data(), limits.data(), fleet.motions.data()), PlanResult::ok);
  return fleet;
}

}  // namespace

Fleet synchronised(std::vector<Task> tasks) {
  return together(std::move(tasks), [](auto... arguments) { return plan_synchronised(arguments...); });
}

Fleet velocity_synchronised(std::vector<Task> tasks) {
  return together(std::move(tasks), [](auto... arguments) { return plan_velocity_synchronised(arguments...); });
}

}  // namespace robot_core::reference
