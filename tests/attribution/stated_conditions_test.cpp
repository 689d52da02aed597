// Logs that state a condition with an effect of its own: a fan that is off, on, or fast. Synthetic motors with their own equations.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "calibration/calibrate.h"
#include "diagnosis/diagnosis_job.h"
#include "examination.h"
#include "scoring.h"

namespace heatsoak::attribution::truth {
namespace {

/// Conductance of the additional airflow by the stated value of the key "cooling".
const std::map<std::string, double> kAirflow_W_per_K{{"off", 0.0}, {"on", 0.3}, {"fast", 0.6}};

/// Records `runs` runs of the motor with that cooling. Different values of `first` give different loads.
std::vector<recording::Recording> with_cooling(std::uint64_t seed, const std::string& cooling, int first, int runs) {
  Case one;
  one.seed = seed;
  one.training_runs = first + runs;
  one.missing.heat.emplace_back([conductance_W_per_K = kAirflow_W_per_K.at(cooling)](const Moment& now, PerPart& heat) {
    heat[sleeve] -= conductance_W_per_K * (now.part_C[sleeve] - now.in.ambient_C);
  });
  std::vector<recording::Recording> logs;
  const Runs all = record(one);
  for (int r = first; r < first + runs; ++r) {
    logs.push_back(all.training[static_cast<std::size_t>(r)].log);
    logs.back().conditions = {{"cooling", cooling}};
  }
  return logs;
}

motor::Motor sheet_of_seed(std::uint64_t seed) {
  Case one;
  one.seed = seed;
  return sheet_of(record(one).make);
}

double conductance_in(const diagnosis::Diagnosis& found, const std::string& cooling) {
  for (const diagnosis::FoundEffect& each : found.effects) {
    if (each.id == "airflow" && each.condition == estimation::Condition{{"cooling", cooling}}) {
      return each.parameters.front().value;
    }
  }
  return 0.0;
}

/// With three values, the effects of two of them may be replaced by those of the others: one question with two answers.
class StatedConditions : public testing::TestWithParam<int> {};

TEST_P(StatedConditions, EachOfThreeValuesHasItsOwnAirflow) {
  const int runs = GetParam();
  const SeedRate rate = rate_over_seeds(kSeeds, [&](std::uint64_t seed, Claim& claim) {
    recording::NamedLogs logs;
    int first = 0;
    for (const char* cooling : {"off", "on", "fast"}) {
      std::ranges::move(with_cooling(seed, cooling, first, runs), std::back_inserter(logs.fitted));
      first += runs;
    }
    logs.held_out = with_cooling(seed, "fast", first, 1);
    const diagnosis::DiagnosisAnswer answer = diagnosis::run_diagnosis({sheet_of_seed(seed), logs});
    const double on_W_per_K = conductance_in(answer.diagnosis, "on");
    const double fast_W_per_K = conductance_in(answer.diagnosis, "fast");
    claim.expect(std::abs(on_W_per_K - 0.3) < 0.06 && std::abs(fast_W_per_K - 0.6) < 0.12,
                 fmt::format("{} and {} W/K {}", on_W_per_K, fast_W_per_K, account(answer.diagnosis)));
    claim.expect(answer.findings.end() ==
                     std::ranges::find_if(answer.findings,
                                          [](const auto& each) { return std::holds_alternative<calibration::ContradictingRun>(each); }),
                 "a run is left out");
  });
  EXPECT_GE(rate.right, kSeeds - 1) << rate.misses;
}
INSTANTIATE_TEST_SUITE_P(RunsPerValue, StatedConditions, testing::Values(1, 2));

/// If two keys always change together, neither is known to matter; the effect keeps the name of one and the answer lists the other.
TEST(ConditionsOfAFile, OfTwoKeysThatChangeTogetherBothAreReported) {
  recording::NamedLogs logs;
  logs.fitted = with_cooling(1, "off", 0, 2);
  std::ranges::move(with_cooling(1, "on", 2, 2), std::back_inserter(logs.fitted));
  for (recording::Recording& each : logs.fitted) {
    each.conditions["bench"] = each.conditions["cooling"] == "on" ? "new" : "old";
  }
  const diagnosis::DiagnosisAnswer answer = diagnosis::run_diagnosis({sheet_of_seed(1), logs});
  ASSERT_EQ(answer.diagnosis.effects.size(), 1U) << account(answer.diagnosis);
  const diagnosis::FoundEffect& effect = answer.diagnosis.effects.front();
  EXPECT_EQ(effect.condition, (estimation::Condition{{"bench", "new"}}));
  EXPECT_THAT(effect.same_conditions, testing::ElementsAre(estimation::Condition{{"cooling", "on"}}));
}

/// A later run with the fan must not change what the file states about the motor without it.
TEST(ConditionsOfAFile, ACalibrationKeepsTheEffectsOfItsFile) {
  const SeedRate rate = rate_over_seeds(kSeeds, [](std::uint64_t seed, Claim& claim) {
    recording::NamedLogs logs;
    logs.fitted = with_cooling(seed, "off", 0, 2);
    std::ranges::move(with_cooling(seed, "on", 2, 2), std::back_inserter(logs.fitted));
    const diagnosis::DiagnosisAnswer found = diagnosis::run_diagnosis({sheet_of_seed(seed), logs});
    motor::Motor file = read_back(found.motor);
    calibration::CalibrationOptions options;
    options.fit.threads = 1;
    for (const char* cooling : {"off", "on"}) {
      const std::vector<recording::Recording> later = with_cooling(seed, cooling, 4, 1);
      motor::Motor again = read_back(calibration::calibrated_motor(file, calibration::calibrate(file, later, {}, options)));
      for (const char* key : {"thermal_resistance_stator_ambient", "thermal_resistance_winding_stator"}) {
        const double ratio = motor::find_parameter(again, key)->value / motor::find_parameter(file, key)->value;
        claim.expect(std::abs(ratio - 1.0) < 0.1, fmt::format("{} {}: {}", cooling, key, ratio));
      }
    }
  });
  EXPECT_GE(rate.right, kSeeds - 1) << rate.misses;
}

}  // namespace
}  // namespace heatsoak::attribution::truth
