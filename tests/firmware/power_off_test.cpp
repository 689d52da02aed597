// Restore of the drive core's guards with the motor's own law, compared with the solver.
#include <gtest/gtest.h>

#include <algorithm>

#include "derate/powered_off_motor.h"
#include "firmware/host_guard.h"
#include "robot_core/guard_memory.h"

namespace heatsoak::firmware {
namespace {

TEST(PowerOff, NoNodeOfTheCoresGuardIsColderThanTheNetwork) {
  for (const derate::PoweredOffCase& each : derate::powered_off_cases()) {
    const derate::PoweredOffMotor motor(each);
    const HostGuard guard(motor.derating);
    derate::expect_safe_and_useful(motor, [&](const std::vector<double>& saved_C, double elapsed_s) {
      robot_core::GuardState saved;
      robot_core::start_guard(guard.model(), saved, 40.0F);
      std::ranges::transform(saved_C, saved.state_C, [](double node_C) { return static_cast<float>(node_C); });
      robot_core::seal(saved);
      robot_core::GuardState after;
      EXPECT_NE(robot_core::restore_guard(guard.model(), after, saved, static_cast<float>(elapsed_s), 0.0F), robot_core::Restored::nothing);
      return std::vector<double>(after.state_C, after.state_C + motor.nodes());
    });
  }
}

}  // namespace
}  // namespace heatsoak::firmware
