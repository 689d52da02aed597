// The call behind `steady`: the network under an on/off current against the equations for the RMS current.
#include "motor/on_off_load.h"

#include <gtest/gtest.h>

#include "motor/datasheet_network.h"
#include "support/shipped.h"

namespace heatsoak::motor {
namespace {

// With cycles far shorter than the winding's time constant the ripple vanishes: mean and peak approach the RMS result.
TEST(OnOffLoad, short_cycles_approach_the_equations) {
  const OnOffAnswer answer = under_on_off_current(shipped_motor("maxon_ec45_flat_70w_24v"), {6.0, 4e-3, 6e-3, 25.0});
  ASSERT_TRUE(answer.is_of_the_equations);
  ASSERT_FALSE(answer.is_runaway());
  EXPECT_NEAR(answer.periodic.mean_C[states::winding], answer.under_rms.winding_C, 0.01);
  EXPECT_NEAR(answer.periodic.peak_C[states::winding], answer.under_rms.winding_C, 0.05);
  EXPECT_NEAR(answer.periodic.mean_C[states::stator], answer.under_rms.stator_C, 0.01);
}

TEST(OnOffLoad, limit_counts_for_the_peak) {
  const Motor motor = shipped_motor("maxon_ec45_flat_70w_24v");
  const OnOffAnswer mild = under_on_off_current(motor, {6.0, 4.0, 6.0, 25.0});
  EXPECT_GT(mild.periodic.peak_C[states::winding], mild.periodic.mean_C[states::winding]);
  Motor strict = motor;
  strict.nominal.winding_limit_C = 0.5 * (mild.periodic.peak_C[states::winding] + mild.periodic.mean_C[states::winding]);
  EXPECT_TRUE(under_on_off_current(strict, mild.current).is_over_limit);
  strict.nominal.winding_limit_C = mild.periodic.peak_C[states::winding] + 1.0;
  EXPECT_FALSE(under_on_off_current(strict, mild.current).is_over_limit);
}

TEST(OnOffLoad, runaway_is_over_the_limit) {
  const OnOffAnswer answer = under_on_off_current(ecx_32(), {60.0, 1.0, 0.0, 25.0});
  EXPECT_TRUE(answer.is_runaway());
  EXPECT_TRUE(answer.is_over_limit);
}

}  // namespace
}  // namespace heatsoak::motor
