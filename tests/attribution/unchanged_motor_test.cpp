// Motors without a missing effect: their diagnosis, and what follows if their file or their runs change afterwards. The tests share one
// diagnosis per motor, which takes a second.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <ranges>

#include "calibration/calibrate.h"
#include "diagnosis/diagnosis_job.h"
#include "diagnosis/model_file.h"
#include "estimation/fit.h"
#include "estimation/turning_rows.h"
#include "examination.h"
#include "scoring.h"

namespace heatsoak::attribution::truth {
namespace {

/// A motor without a missing effect, with its diagnosis.
struct Question {
  Case sealed;
  Runs runs;
  diagnosis::DiagnosisInput input;
  bool is_speed_linear = false;
  diagnosis::Diagnosis diagnosis;
};

const Question& of_unchanged_motor(std::uint64_t seed) {
  static std::map<std::uint64_t, Question> known;
  if (const auto found = known.find(seed); found != known.end()) {
    return found->second;
  }
  Question asked;
  asked.sealed.seed = seed;
  asked.runs = record(asked.sealed);
  asked.input = question(asked.sealed, asked.runs);
  asked.is_speed_linear = estimation::settle_turning_rows(asked.input.model, asked.input.train).value_or(false);
  asked.diagnosis = diagnosis::diagnose(asked.input, {});
  return known.emplace(seed, std::move(asked)).first->second;
}

/// Returns the model fitted to the runs, with a standard deviation of sd_share for every parameter.
estimation::Model known_to(double sd_share, const Question& asked) {
  estimation::Model known = asked.diagnosis.selection.before.model;
  const Eigen::Index count = known.network_count();
  known.prior = {known.theta(), Eigen::MatrixXd::Identity(count, count) / (sd_share * sd_share)};
  return known;
}

TEST(UnchangedMotor, LacksNothing) {
  const SeedRate rate = rate_over_seeds(kSeeds, [&](std::uint64_t seed, Claim& claim) {
    const diagnosis::Diagnosis& found = of_unchanged_motor(seed).diagnosis;
    claim.expect(found.selection.terms.empty(), account(found));
    claim.expect(found.verdict == diagnosis::DiagnosisVerdict::nothing_missing, "verdict");
  });
  EXPECT_EQ(rate.right, kSeeds) << rate.misses;
}

/// All thermal resistances and capacities of the file are wrong by a factor of two, and the file states this uncertainty.
TEST(UnchangedMotor, LacksNothingIfTheFileStatesThatItsValuesAreGuesses) {
  constexpr double kGuess_sd = 0.56;  // a factor of 2.5 at 1.645 standard deviations
  for (const double by : {0.5, 2.0}) {
    const SeedRate rate = rate_over_seeds(kSeeds, [&](std::uint64_t seed, Claim& claim) {
      diagnosis::DiagnosisInput input = of_unchanged_motor(seed).input;
      estimation::Model& model = input.model;
      for (Eigen::Index i = 0; i < model.network_count(); ++i) {
        if (const std::string& name = model.name(i); name.ends_with("thermal_resistance") || name.ends_with("heat_capacity")) {
          model.values[static_cast<std::size_t>(model.free[static_cast<std::size_t>(i)].place)] *= by;
          model.prior.precision.row(i).setZero();
          model.prior.precision.col(i).setZero();
          model.prior.precision(i, i) = 1.0 / (kGuess_sd * kGuess_sd);
        }
      }
      model.prior.mean = model.theta();
      const diagnosis::Diagnosis found = diagnosis::diagnose(input, {});
      claim.expect(found.selection.terms.empty(), account(found));
      claim.expect(found.verdict == diagnosis::DiagnosisVerdict::nothing_missing, "verdict");
    });
    EXPECT_GE(rate.right, kSeeds - 1) << by << rate.misses;
  }
}

/// The file declares a resistance to the air that is 1.35 times the true one, to 5 %.
TEST(UnchangedMotor, AFittedValueOutsideItsDeclaredRangeIsReported) {
  constexpr std::string_view kKey = "thermal_resistance_stator_ambient";
  Case one;
  one.training_runs = 1;
  const Runs runs = record(one);
  motor::Motor motor = sheet_of(runs.make);
  base::ParameterValue& declared = *motor::find_parameter(motor, kKey);
  declared.value = 1.35 * runs.make.iron_to_air_K_per_W;
  declared.spread = base::Spread{base::Spread::Kind::range, 0.95 * declared.value, 1.05 * declared.value, true};
  motor::refresh_values(motor);
  recording::NamedLogs logs;
  logs.fitted = {runs.training.front().log};
  const diagnosis::DiagnosisAnswer answer = diagnosis::run_diagnosis({motor, logs});
  const double fitted = motor::find_parameter(motor = answer.motor, kKey)->value;
  EXPECT_LT(fitted, 0.95 * 1.35 * runs.make.iron_to_air_K_per_W);
  EXPECT_THAT(answer.findings, testing::Contains(testing::VariantWith<calibration::OutsideDeclaredRange>(
                                   testing::AllOf(testing::Field(&calibration::OutsideDeclaredRange::parameter, kKey),
                                                  testing::Field(&calibration::OutsideDeclaredRange::value, fitted)))));
}

/// The file has a body of 140 J/K as an effect, but with a guess of 1.5 J/K: its value is decided by the runs, not by a search bound.
TEST(UnchangedMotor, ABadGuessOfAnEffectIsNoBound) {
  Case one;
  one.training_runs = 2;
  one.missing = std::ranges::find(subjects(), "third_node", &Subject::name)->make(1.5);
  const Runs runs = record(one);
  motor::Motor motor = sheet_of(runs.make);
  const auto guess = [](double value) {
    base::ParameterValue parameter;
    parameter.value = value;
    parameter.origin = base::Origin::estimated;
    parameter.spread = base::Spread{base::Spread::Kind::range, value / 10.0, value * 10.0, true};
    return parameter;
  };
  constexpr double kGuess_J_per_K = 1.5;
  motor.effects.push_back({"third_node",
                           thermal::find_effect("third_node"),
                           {"stator", "third_node", "ambient"},
                           {guess(0.2), guess(0.4), guess(kGuess_J_per_K)}});
  motor::refresh_values(motor);
  std::vector<recording::Recording> logs;
  std::ranges::transform(runs.training, std::back_inserter(logs), &TrueRun::log);
  const estimation::Model model = diagnosis::model_of_logs(motor, logs).model;
  const estimation::Model fitted = estimation::first_fit(model, question(one, runs).train, {.starts = 0}).fit.model;
  const auto capacity = static_cast<std::size_t>(fitted.network.capacity_index(fitted.network.node("third_node")));
  EXPECT_GT(fitted.values[capacity], 45.0 * kGuess_J_per_K);
  EXPECT_LT(fitted.values[capacity], 2.0 * 140.0);
}

/// The file is a forecast fit to the first run. The other runs agree with it, so its values stay as they are.
TEST(UnchangedMotor, KeepsAFileThatWasFittedToAnotherRun) {
  const SeedRate rate = rate_over_seeds(kSeeds, [](std::uint64_t seed, Claim& claim) {
    Case one;
    one.seed = seed;
    const Runs runs = record(one);
    const motor::Motor sheet = sheet_of(runs.make);
    calibration::CalibrationOptions options;
    options.fit.threads = 1;
    const motor::Motor fitted =
        read_back(calibration::calibrated_motor(sheet, calibration::calibrate(sheet, std::vector{runs.training.front().log}, {}, options)));
    recording::NamedLogs logs;
    std::ranges::transform(runs.training | std::views::drop(1), std::back_inserter(logs.fitted), &TrueRun::log);
    std::ranges::transform(runs.unseen, std::back_inserter(logs.held_out), &TrueRun::log);
    const diagnosis::DiagnosisAnswer answer = diagnosis::run_diagnosis({fitted, logs});
    claim.expect(answer.diagnosis.effects.empty(), account(answer.diagnosis));
    EXPECT_EQ(read_back(answer.motor).id, read_back(fitted).id);
  });
  EXPECT_GE(rate.right, kSeeds - 1) << rate.misses;
}

TEST(UnchangedMotor, HasRunsThatAgree) {
  const SeedRate rate = rate_over_seeds(kSeeds, [](std::uint64_t seed, Claim& claim) {
    const Question& asked = of_unchanged_motor(seed);
    const auto run = contradiction(asked.input, asked.diagnosis.selection);
    claim.expect(!run, run ? run->run : "");
  });
  EXPECT_GE(rate.right, kSeeds - 1) << rate.misses;
}

/// The motor's file states 1.4 times the true resistance to the air with an uncertainty of 2 %, as if the motor had been mounted elsewhere.
/// It never becomes an effect, and the refit follows the unseen runs. The parameter itself is reported in two of eight motors only.
TEST(UnchangedMotor, AnOutdatedParameterIsRefittedAndIsNoEffect) {
  int reported = 0;
  const SeedRate rate = rate_over_seeds(kSeeds, [&reported](std::uint64_t seed, Claim& claim) {
    const Question& asked = of_unchanged_motor(seed);
    diagnosis::DiagnosisInput input = asked.input;
    input.model = known_to(0.02, asked);
    estimation::Model& known = input.model;
    claim.expect(diagnosis::diagnose(input, {}).changed.empty(), "a change of a correct parameter");
    Eigen::Index coordinate = 0;
    while (known.name(coordinate) != "stator_ambient.thermal_resistance") {
      ++coordinate;
    }
    double& out_K_per_W = known.values[static_cast<std::size_t>(known.free[static_cast<std::size_t>(coordinate)].place)];
    const double true_K_per_W = out_K_per_W;
    out_K_per_W *= 1.4;
    known.prior.mean = known.theta();
    const diagnosis::Diagnosis found = diagnosis::diagnose(input, {});
    claim.expect(found.verdict == diagnosis::DiagnosisVerdict::not_identifiable && found.effects.empty(), account(found));
    const ErrorsOfModels score = errors_of_models(input, found, holdout(asked.runs, asked.is_speed_linear));
    claim.expect(estimation::rms_K(score.after) < estimation::rms_K(score.before) / 3.0, "error after");
    for (const diagnosis::ChangedParameter& changed : found.changed) {
      claim.expect(changed.name == known.name(coordinate), "changed " + account(found));
      EXPECT_NEAR(changed.before, 1.4 * true_K_per_W, 1e-9);
      claim.expect(std::abs(changed.value - true_K_per_W) < 0.05 * true_K_per_W, "value");
      claim.expect(changed.low < true_K_per_W && true_K_per_W < changed.high, "interval");
    }
    reported += found.changed.empty() ? 0 : 1;
  });
  EXPECT_GE(rate.right, kSeeds - 1) << rate.misses;
  EXPECT_GE(reported, 1);
}

/// The conductance from winding to iron now rises by a seventh in 30 K, while the file has 1 % uncertainty for a constant resistance. The
/// law has no effect at 25 °C, but the file's value is right at 45 °C.
TEST(UnchangedMotor, LawIsFoundDespiteANarrowPriorOfACorrelatedParameter) {
  const SeedRate rate = rate_over_seeds(kSeeds, [](std::uint64_t seed, Claim& claim) {
    const Question& asked = of_unchanged_motor(seed);
    diagnosis::DiagnosisInput input = asked.input;
    input.model = known_to(0.01, asked);
    const double nothing_missing_K =
        estimation::rms_K(errors_of_models(input, diagnosis::diagnose(input, {}), holdout(asked.runs, asked.is_speed_linear)).after);
    Case one = asked.sealed;
    one.missing.heat.push_back([](const Moment& now, PerPart& heat_W) {
      const double more_W = 0.14 / 1.6 * (0.5 * (now.copper_C + now.iron_C) - 45.0) / 30.0 * (now.copper_C - now.iron_C);
      heat_W[slot] -= more_W;
      heat_W[tooth] += more_W;
    });
    const Runs runs = record(one);
    input.train = question(one, runs).train;
    const diagnosis::Diagnosis found = diagnosis::diagnose(input, {});
    claim.expect(found.verdict == diagnosis::DiagnosisVerdict::effect_found && found.effects.size() == 1U &&
                     found.effects.front().id == "contact_temperature_dependence",
                 account(found));
    // At 25 °C the resistance is larger than at 45 °C.
    claim.expect(found.changed.size() == 1U && found.changed.front().name == "winding_stator.thermal_resistance" &&
                     found.changed.front().value > 1.02 * found.changed.front().before,
                 "changed " + account(found));
    claim.expect(estimation::rms_K(errors_of_models(input, found, holdout(runs, asked.is_speed_linear)).after) < 1.1 * nothing_missing_K,
                 "error after " + account(found));
  });
  EXPECT_GE(rate.right, kSeeds - 1) << rate.misses;
}

}  // namespace
}  // namespace heatsoak::attribution::truth
