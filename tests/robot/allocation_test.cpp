// Millions of steps: none of them may go to the heap.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <new>

#include "robot/inverse_dynamics.h"
#include "robot/plant.h"
#include "robots_for_tests.h"

namespace {
std::atomic<long> allocation_count = 0;
}  // namespace

void* operator new(std::size_t size) {
  ++allocation_count;
  if (void* memory = std::malloc(size)) {
    return memory;
  }
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace heatsoak {
namespace {

TEST(Allocation, no_step_takes_memory) {
  const PlantConfig plant = make_plant(lossy_robot(), lossy_motor(), 0.001);
  PlantState state = plant_at_rest(plant);
  PlantInput input;
  double sum_Nm = 0.0;
  const long before = allocation_count;
  for (int i = 0; i < 100; ++i) {
    input.command.fill({MotorCommand::Kind::voltage, i < 50 ? 3.0 : 100.0});
    step(plant, state, input);
    // Within the grip, beyond it, and with wheels off the ground.
    sum_Nm += inverse_dynamics(plant.body, {{1.0, 0.5, 2.0}, {0.15 * i, 0.0, 0.0}, {}, 0.0}).torque_Nm[0];
  }
  const long after = allocation_count;
  EXPECT_EQ(after, before);
  EXPECT_TRUE(std::isfinite(sum_Nm));
}

}  // namespace
}  // namespace heatsoak
