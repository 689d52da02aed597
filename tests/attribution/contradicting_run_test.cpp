// A sensor that was moved between the runs of one motor is reported with the run, and nothing is reported for runs that agree.
#include "diagnosis/contradicting_run.h"

#include <gtest/gtest.h>

#include "estimation/log_columns.h"
#include "examination.h"

namespace heatsoak::attribution::truth {
namespace {

constexpr std::size_t kMovedIn = 1;

/// Returns the run that contradicts the others after a diagnosis. With `moved_share` the winding's sensor of one run reads between winding
/// and stator.
std::optional<diagnosis::ContradictingRun> contradiction(std::uint64_t seed, double moved_share) {
  Case one;
  one.seed = seed;
  Runs runs = record(one);
  std::vector<recording::Channel>& channels = runs.training[kMovedIn].log.channels;
  for (std::size_t row = 0; row < channels[0].values.size(); ++row) {
    channels[0].values[row] += moved_share * (channels[1].values[row] - channels[0].values[row]);
  }
  const diagnosis::DiagnosisInput input = question(one, runs);
  const Selection selection = diagnosis::diagnose(input, {}).selection;
  std::vector<estimation::MeasuredRun> train = input.train;
  estimation::set_columns(train, selection.after.model.columns);
  estimation::PosteriorOptions plain = estimation::least_squares_options(selection.after.model, 20);
  plain.weights = selection.weights;
  return diagnosis::contradicting_run(selection.after.model, train, selection.after.start_C, plain);
}

TEST(ContradictingRun, AMovedSensorIsReportedWithItsRun) {
  for (std::uint64_t seed = 90000; seed < 90004; ++seed) {
    const auto run = contradiction(seed, 0.7);
    ASSERT_TRUE(run) << seed;
    EXPECT_EQ(run->run, "run2") << seed;
    EXPECT_EQ(run->signal, "winding_C") << seed;
    EXPECT_GT(run->by_others_K, 3.0 * run->alone_K) << seed;
  }
}

TEST(ContradictingRun, RunsOfAnUnchangedMotorAgree) {
  for (std::uint64_t seed = 90000; seed < 90004; ++seed) {
    EXPECT_FALSE(contradiction(seed, 0.0)) << seed;
  }
}

}  // namespace
}  // namespace heatsoak::attribution::truth
