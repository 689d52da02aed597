// A short form of the examination; heatsoak_attribution_table runs the long one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "scoring.h"

namespace heatsoak::truth {
namespace {

Case sealed(const Missing& missing, std::uint64_t seed) {
  Case one;
  one.missing = missing;
  one.seed = seed;
  return one;
}

const Subject& subject(std::string_view name) { return *std::ranges::find(subjects(), name, &Subject::name); }

TEST(Examination, NothingMissingIsSaidToBeNothing) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Answer answer = examine(sealed({}, seed));
    EXPECT_THAT(answer.named, testing::IsEmpty()) << account(answer);
    EXPECT_FALSE(answer.selection.open_curve) << account(answer);
  }
}

class TypicalEffect : public testing::TestWithParam<std::string_view> {};

TEST_P(TypicalEffect, IsNamedAndHelpsOnUnseenRuns) {
  const Answer answer = examine(sealed(subject(GetParam()).make(1.0), 11));
  EXPECT_TRUE(names_only(answer.named, {&subject(GetParam())})) << account(answer);
  EXPECT_LT(answer.after_K, 0.7 * answer.before_K) << account(answer);
}

INSTANTIATE_TEST_SUITE_P(Some, TypicalEffect, testing::Values("iron_loss_eddy", "speed_dependent_convection"),
                         [](const auto& instance) { return std::string(instance.param); });

TEST(Examination, OrderOfRunsChangesNothing) {
  const Case one = sealed(subject("iron_loss_eddy").make(0.8), 12);
  const Runs runs = record(one);
  SelectionInput forwards, backwards;
  forwards.model = backwards.model = model_before(runs.make, one.seed);
  forwards.scans_drivers = backwards.scans_drivers = false;
  for (const TrueRun& run : runs.training) {
    forwards.runs.push_back(measured(run));
    backwards.runs.insert(backwards.runs.begin(), measured(run));
  }
  const Selection a = select_effects(forwards, {}), b = select_effects(backwards, {});
  ASSERT_EQ(a.terms.size(), b.terms.size());
  EXPECT_NEAR(a.after.evidence_nats, b.after.evidence_nats, 1e-3 * std::abs(a.after.evidence_nats));
  EXPECT_EQ(a.terms.front().candidate->id, b.terms.front().candidate->id);
}

}  // namespace
}  // namespace heatsoak::truth
