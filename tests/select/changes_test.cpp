// Changes of a robot, compared with the physically expected results.
#include "select/changes.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/shipped.h"
#include "support/source_folder.h"

namespace heatsoak {
namespace {

const ChangeEffect& of(const std::vector<ChangeEffect>& all, ChangedQuantity quantity) {
  return *std::ranges::find(all, quantity, &ChangeEffect::quantity);
}

class Changes : public testing::Test {
 protected:
  Robot robot_ = read_robot(kSource / "robot_core/robots/roboteam_twente_v2024.toml");
  Motor motor_ = read_motor(kSource / "motor_db/maxon_ec45_flat_70w_24v.toml");
};

// Copper loss at steady state is proportional to the square of the torque. A gear of 1.25 reduces it, and its temperature rise, to 0.64.
TEST_F(Changes, gear_alone_acts_on_a_fixed_load) {
  const Duty duty = read_duty(kSource / "duty_profiles/paper_intermittent.toml");
  const std::vector<ChangeEffect> all = effects_of_changes(robot_, duty, motor_, 1, 0);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].quantity, ChangedQuantity::gear_ratio);
  EXPECT_GT(all[0].saved_K, 0.3 * 55.0);
  EXPECT_LT(all[0].saved_K, 0.5 * 55.0);
}

TEST_F(Changes, a_match_heats_less_with_less_mass_jerk_and_wheel) {
  const Duty duty = read_duty(kSource / "duty_profiles/division_b_match.toml");
  const std::vector<ChangeEffect> all = effects_of_changes(robot_, duty, motor_, 1, 0);
  EXPECT_EQ(all.size(), 7U);
  for (const ChangedQuantity each : {ChangedQuantity::mass, ChangedQuantity::wheel_radius, ChangedQuantity::gear_ratio}) {
    EXPECT_GT(of(all, each).saved_K, 0.0) << name_of(each);
  }
  for (std::size_t i = 1; i < all.size(); ++i) {
    if (all[i].is_deliverable == all[i - 1].is_deliverable) {
      EXPECT_LE(all[i].saved_K, all[i - 1].saved_K);
    }
  }
  const std::vector<ChangeEffect> again = effects_of_changes(robot_, duty, motor_, 1, 1);
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i].saved_K, again[i].saved_K) << "does not depend on threads";
  }
}

}  // namespace
}  // namespace heatsoak
