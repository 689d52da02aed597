// A sensor that was moved between the runs of one motor is reported with the run. Runs that agree are in unchanged_motor_test.cpp.
#include "diagnosis/contradicting_run.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "examination.h"
#include "scoring.h"

namespace heatsoak::attribution::truth {
namespace {

constexpr std::size_t kMovedIn = 1;

TEST(ContradictingRun, AMovedSensorIsReportedWithItsRun) {
  const SeedRate rate = rate_over_seeds(kSeeds, [](std::uint64_t seed, Claim& claim) {
    Case one;
    one.seed = seed;
    Runs runs = record(one);
    // The winding's sensor reads between winding and stator.
    std::vector<recording::Channel>& channels = runs.training[kMovedIn].log.channels;
    for (std::size_t row = 0; row < channels[0].values.size(); ++row) {
      channels[0].values[row] += 0.7 * (channels[1].values[row] - channels[0].values[row]);
    }
    const diagnosis::DiagnosisInput input = question(one, runs);
    const auto run = contradiction(input, diagnosis::diagnose(input, {}).selection);
    claim.expect(run && run->run == "run2" && run->signal == "winding_C" && run->by_others_K > 3.0 * run->alone_K,
                 run ? fmt::format("{} {} {} {}", run->run, run->signal, run->by_others_K, run->alone_K) : "nothing is reported");
  });
  EXPECT_GE(rate.right, kSeeds - 2) << rate.misses;
}

}  // namespace
}  // namespace heatsoak::attribution::truth
