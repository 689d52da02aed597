// A sensor that was moved between the runs of one motor is reported with the run. Runs that agree are in unchanged_motor_test.cpp.
#include "calibration/contradicting_run.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <variant>

#include "calibration/calibrate.h"
#include "diagnosis/diagnosis_job.h"
#include "examination.h"
#include "motor/write_motor.h"
#include "scoring.h"

namespace heatsoak::attribution::truth {
namespace {

constexpr std::size_t kMovedIn = 1;

/// Lets the winding's sensor read between winding and stator.
void move_sensor(recording::Recording& log) {
  std::vector<recording::Channel>& channels = log.channels;
  for (std::size_t row = 0; row < channels[0].values.size(); ++row) {
    channels[0].values[row] += 0.7 * (channels[1].values[row] - channels[0].values[row]);
  }
}

TEST(ContradictingRun, AMovedSensorIsReportedWithItsRun) {
  const SeedRate rate = rate_over_seeds(kSeeds, [](std::uint64_t seed, Claim& claim) {
    Case one;
    one.seed = seed;
    Runs runs = record(one);
    move_sensor(runs.training[kMovedIn].log);
    const diagnosis::DiagnosisInput input = question(one, runs);
    const auto run = contradiction(input, diagnosis::diagnose(input, {}).selection);
    claim.expect(run && run->run == "run2" && run->signal == "winding_C" && run->by_others_K > 3.0 * run->alone_K,
                 run ? fmt::format("{} {} {} {}", run->run, run->signal, run->by_others_K, run->alone_K) : "nothing is reported");
  });
  EXPECT_GE(rate.right, kSeeds - 2) << rate.misses;
}

/// A sensor of one run with another place or an offset. No parameters of the motor follow such a run.
struct Move {
  const char* name;
  std::size_t sensor;  ///< 0: winding, 1: stator
  double to_other_share, offset_K;
};
class MovedSensors : public testing::TestWithParam<Move> {};

TEST_P(MovedSensors, AreReportedWithTheirMove) {
  const Move& move = GetParam();
  const SeedRate rate = rate_over_seeds(kSeeds, [&](std::uint64_t seed, Claim& claim) {
    Case one;
    one.seed = seed;
    Runs runs = record(one);
    std::vector<recording::Channel>& channels = runs.training[kMovedIn].log.channels;
    for (std::size_t row = 0; row < channels[0].values.size(); ++row) {
      double& reading_C = channels[move.sensor].values[row];
      reading_C += move.to_other_share * (channels[1 - move.sensor].values[row] - reading_C) + move.offset_K;
    }
    recording::NamedLogs logs;
    std::ranges::transform(runs.training, std::back_inserter(logs.fitted), &TrueRun::log);
    const diagnosis::DiagnosisAnswer answer = diagnosis::run_diagnosis({sheet_of(runs.make), logs});
    const calibration::ContradictingRun* run = nullptr;
    for (const diagnosis::DiagnosisFinding& each : answer.findings) {
      run = std::holds_alternative<calibration::ContradictingRun>(each) ? &std::get<calibration::ContradictingRun>(each) : run;
    }
    claim.expect(run && run->run == "run2" && run->moved && run->moved->signal == channels[move.sensor].quantity.key &&
                     std::abs(run->moved->to_other_share - move.to_other_share) < 0.1 &&
                     std::abs(run->moved->offset_K - move.offset_K) < 1.0,
                 !run          ? "nothing is reported"
                 : !run->moved ? fmt::format("{} {}", run->run, run->signal)
                               : fmt::format("{} {} {} {} {}", run->run, run->moved->signal, run->moved->to_other_share,
                                             run->moved->to_ambient_share, run->moved->offset_K));
  });
  EXPECT_GE(rate.right, kSeeds - 2) << rate.misses;
}
INSTANTIATE_TEST_SUITE_P(Synthetic, MovedSensors,
                         testing::Values(Move{"StatorTowardsWinding", 1, 0.3, 0.0}, Move{"StatorOffset", 1, 0.0, 6.0},
                                         Move{"WindingOffset", 0, 0.0, 8.0}),
                         [](const auto& instance) { return instance.param.name; });

// A fan that blows in one run only is an effect of that run, not a contradiction.
TEST(ContradictingRun, IsNoneWithAnEffectOfItsOwn) {
  const SeedRate rate = rate_over_seeds(kSeeds, [](std::uint64_t seed, Claim& claim) {
    Case one;
    one.seed = seed;
    Runs runs = record(one);
    Case with_fan = one;
    with_fan.missing.heat.emplace_back([](const Moment& now, PerPart& heat) {
      constexpr double kFan_W_per_K = 0.4;
      heat[sleeve] -= kFan_W_per_K * (now.part_C[sleeve] - now.in.ambient_C);
    });
    runs.training[kMovedIn] = record(with_fan).training[kMovedIn];
    recording::NamedLogs logs;
    std::ranges::transform(runs.training, std::back_inserter(logs.fitted), &TrueRun::log);
    const diagnosis::DiagnosisAnswer answer = diagnosis::run_diagnosis({sheet_of(runs.make), logs});
    claim.expect(
        std::ranges::none_of(answer.findings, [](const auto& each) { return std::holds_alternative<calibration::ContradictingRun>(each); }),
        "the run is left out");
    claim.expect(std::ranges::any_of(answer.diagnosis.effects, [](const auto& each) { return !each.condition.empty(); }),
                 account(answer.diagnosis));
  });
  EXPECT_GE(rate.right, kSeeds - 2) << rate.misses;
}

// A calibration keeps the run: another effect in it may be the cause, which only a diagnosis searches for.
TEST(ContradictingRun, IsReportedByACalibration) {
  const SeedRate rate = rate_over_seeds(kSeeds, [](std::uint64_t seed, Claim& claim) {
    Case one;
    one.seed = seed;
    Runs runs = record(one);
    const auto reported = [&] {
      std::vector<recording::Recording> logs;
      std::ranges::transform(runs.training, std::back_inserter(logs), &TrueRun::log);
      calibration::CalibrationOptions options;
      options.fit.threads = 1;
      std::vector<std::string> found;
      for (const calibration::CalibrationFinding& each : calibration::calibrate(sheet_of(runs.make), logs, {}, options).findings) {
        if (const auto* const odd = std::get_if<calibration::ContradictingRun>(&each)) {
          found.push_back(odd->run);
        }
      }
      return found;
    };
    const std::vector<std::string> before = reported();
    move_sensor(runs.training[kMovedIn].log);
    const std::vector<std::string> now = reported();
    claim.expect(before.empty() && now == std::vector<std::string>{"run2"}, fmt::format("before {}, now {}", before.size(), now.size()));
  });
  EXPECT_GE(rate.right, kSeeds - 2) << rate.misses;
}

// The written file is that of the other runs alone.
TEST(ContradictingRun, IsLeftOutOfTheFit) {
  Case one;
  one.seed = 3;
  Runs runs = record(one);
  const motor::Motor motor = sheet_of(runs.make);
  const auto answer_to = [&](bool has_moved) {
    recording::NamedLogs logs;
    for (std::size_t r = 0; r < runs.training.size(); ++r) {
      if (has_moved || r != kMovedIn) {
        logs.fitted.push_back(runs.training[r].log);
      }
    }
    return diagnosis::run_diagnosis({motor, logs});
  };
  const std::string others = motor::to_toml(answer_to(false).motor);
  move_sensor(runs.training[kMovedIn].log);
  const diagnosis::DiagnosisAnswer answer = answer_to(true);
  EXPECT_EQ(motor::to_toml(answer.motor), others);
  ASSERT_FALSE(answer.findings.empty());
  const auto* const odd = std::get_if<calibration::ContradictingRun>(&answer.findings.front());
  ASSERT_NE(odd, nullptr);
  EXPECT_EQ(odd->run, "run2");
}

}  // namespace
}  // namespace heatsoak::attribution::truth
