// The scenario of the shipped example reports/soak, with other seeds: a chassis behind the stator absorbs heat.
#include "soak_scenario.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "diagnosis/diagnosis_job.h"
#include "scoring.h"
#include "support/source_folder.h"

namespace heatsoak::attribution::truth {
namespace {

/// The runs do not show whether copper loss also reaches the chassis directly, so either effect may be the named one.
TEST(SoakScenario, TheChassisIsNamedAndHelpsOnAnUnseenMatch) {
  const motor::Motor motor = motor::read_motor(kSource / fmt::format("motor_db/{}.toml", kSoakMotor));
  const SeedRate rate = rate_over_seeds(kSeeds, [&](std::uint64_t seed, Claim& claim) {
    const std::vector<TrueRun> runs = soak_runs(1000 * seed);
    recording::NamedLogs logs;
    logs.fitted = {runs[0].log, runs[1].log, runs[3].log};
    logs.held_out = {runs[2].log};
    const diagnosis::DiagnosisAnswer answer = diagnosis::run_diagnosis({motor, logs});
    const std::vector<diagnosis::FoundEffect>& effects = answer.diagnosis.effects;
    if (!claim.expect(answer.diagnosis.verdict == diagnosis::DiagnosisVerdict::effect_found && effects.size() == 1U,
                      account(answer.diagnosis))) {
      return;
    }
    const diagnosis::FoundEffect& effect = effects.front();
    claim.expect(effect.id == "enclosure_warm_up" || effect.id == "third_node", effect.id);
    claim.expect(effect.node == "stator", "node " + effect.node);
    claim.expect(effect.probability > 0.95, fmt::format("probability {}", effect.probability));
    for (const auto& [signal, error] : answer.score.after) {
      claim.expect(error.rmse_K < 0.6 * answer.score.before.at(signal).rmse_K, "error of " + signal);
    }
  });
  EXPECT_EQ(rate.right, kSeeds) << rate.misses;
}

}  // namespace
}  // namespace heatsoak::attribution::truth
