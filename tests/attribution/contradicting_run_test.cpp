// A sensor that was moved between the runs of one motor is reported with the run, and nothing is reported for runs that agree.
#include "diagnosis/contradicting_run.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "estimation/log_columns.h"
#include "examination.h"
#include "scoring.h"

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
  const SeedRate rate = rate_over_seeds(kSeeds, [](std::uint64_t seed, Claim& claim) {
    const auto run = contradiction(seed, 0.7);
    claim.expect(run && run->run == "run2" && run->signal == "winding_C" && run->by_others_K > 3.0 * run->alone_K,
                 run ? fmt::format("{} {} {} {}", run->run, run->signal, run->by_others_K, run->alone_K) : "nothing is reported");
  });
  EXPECT_GE(rate.right, kSeeds - 2) << rate.misses;
}

TEST(ContradictingRun, RunsOfAnUnchangedMotorAgree) {
  const SeedRate rate = rate_over_seeds(kSeeds, [](std::uint64_t seed, Claim& claim) {
    const auto run = contradiction(seed, 0.0);
    claim.expect(!run, run ? run->run : "");
  });
  EXPECT_GE(rate.right, kSeeds - 1) << rate.misses;
}

}  // namespace
}  // namespace heatsoak::attribution::truth
