// No step of a long simulation may allocate memory.
#include <gtest/gtest.h>

#include <cmath>

#include "robot/inverse_dynamics.h"
#include "robot/plant.h"
#include "robots_for_tests.h"
#include "support/allocation_counter.h"

namespace heatsoak::robot {
namespace {

TEST(Allocation, no_step_takes_memory) {
  if (!allocations_are_counted()) {
    GTEST_SKIP() << "malloc cannot be counted here";
  }
  const PlantConfig plant = make_plant(lossy_robot(), lossy_motor(), 0.001);
  PlantState state = plant_at_rest(plant);
  PlantInput input;
  double sum_Nm = 0.0;
  const long before = allocation_count();
  for (int i = 0; i < 100; ++i) {
    input.command.fill({MotorCommand::Kind::voltage, i < 50 ? 3.0 : 100.0});
    step(plant, state, input);
    // The accelerations are within the grip, beyond it, and so high that wheels lift off.
    sum_Nm += inverse_dynamics(plant.body, {{1.0, 0.5, 2.0}, {0.15 * i, 0.0, 0.0}, {}, 0.0}).torque_Nm[0];
  }
  const long after = allocation_count();
  EXPECT_EQ(after, before);
  EXPECT_TRUE(std::isfinite(sum_Nm));
}

}  // namespace
}  // namespace heatsoak::robot
