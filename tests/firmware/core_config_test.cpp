#include "firmware/core_config.h"

#include <gtest/gtest.h>

#include "support/shipped.h"
namespace heatsoak {
namespace {
TEST(CoreConfig, OfShippedRobotStartsTheCore) {
  const robot_core::Config config = make_core_config(twente(), ecx_32().nominal, {});
  robot_core::State state;
  EXPECT_TRUE(robot_core::start(config, state, {.is_rested = true, .body_C = 25.0F}));
}
}  // namespace
}  // namespace heatsoak
