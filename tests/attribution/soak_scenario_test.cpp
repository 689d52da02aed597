// The scenario of the shipped example reports/soak, with other seeds: a chassis behind the stator absorbs heat.
#include "soak_scenario.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "diagnosis/diagnosis_job.h"
#include "recording/named_logs.h"
#include "scoring.h"
#include "support/source_folder.h"

namespace heatsoak::attribution::truth {
namespace {

/// The runs do not show whether copper loss also reaches the chassis directly, so either effect may be the named one, and the answer has
/// to say so. Holds for 7 of 8 motors.
TEST(SoakScenario, TheChassisIsNamedAndHelpsOnAnUnseenMatch) {
  const motor::Motor motor = motor::read_motor(kSource / fmt::format("motor_db/{}.toml", kSoakMotor));
  const SeedRate rate = rate_over_seeds(kSeeds, [&](std::uint64_t seed, Claim& claim) {
    const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / fmt::format("soak_{}_{}", getpid(), seed);
    write_soak_logs(1000 * seed, folder);
    const auto log = [&](const char* name) { return (folder / name).string(); };
    const recording::NamedLogs logs =
        recording::read_usable_logs({log("match_1.csv"), log("match_2.csv"), log("bench.csv")}, {log("match_3.csv")}, {});
    std::filesystem::remove_all(folder);
    const diagnosis::DiagnosisAnswer answer = diagnosis::run_diagnosis({motor, logs});
    const std::vector<diagnosis::FoundEffect>& effects = answer.diagnosis.effects;
    if (!claim.expect(answer.diagnosis.verdict == diagnosis::DiagnosisVerdict::effect_found && effects.size() == 1U,
                      account(answer.diagnosis))) {
      return;
    }
    const diagnosis::FoundEffect& effect = effects.front();
    const std::vector<std::string> bodies{"enclosure_warm_up", "third_node"};
    claim.expect(std::ranges::find(bodies, effect.id) != bodies.end(), effect.id);
    claim.expect(effect.confusable_with.size() == 1U && std::ranges::find(bodies, effect.confusable_with.front()) != bodies.end(),
                 fmt::format("{} or {}", effect.id, fmt::join(effect.confusable_with, ", ")));
    claim.expect(effect.node == "stator", "node " + effect.node);
    claim.expect(effect.probability > 0.95, fmt::format("probability {}", effect.probability));
    for (const diagnosis::ErrorInRun& each : answer.score.errors) {
      claim.expect(each.after.rmse_K < 0.6 * each.before.rmse_K, "error of " + each.signal + " in " + each.run);
    }
  });
  EXPECT_GE(rate.right, kSeeds - 1) << rate.misses;
}

}  // namespace
}  // namespace heatsoak::attribution::truth
