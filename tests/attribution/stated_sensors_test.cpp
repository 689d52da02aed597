// The base model includes sensor faults that the motor's file states: no missing effect is reported for them. New sensor faults are written
// to the file.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "attribution/terms.h"
#include "diagnosis/diagnosis_job.h"
#include "examination.h"
#include "scoring.h"

namespace heatsoak::attribution::truth {
namespace {

Case with_late_stator(std::uint64_t seed = 1) {
  Case one;
  one.missing = std::ranges::find(subjects(), "sensor_lag_stator", &Subject::name)->make(1.0);
  one.seed = seed;
  return one;
}
constexpr double kLag_s = 10.0;

void state(std::vector<estimation::MeasuredRun>& runs, const std::vector<motor::SensorFault>& faults) {
  for (estimation::MeasuredRun& run : runs) {
    run.sensors[static_cast<std::size_t>(run.sensor_at("stator").value())].faults = faults;
  }
}

TEST(StatedSensors, AreNotMissing) {
  const SeedRate rate = rate_over_seeds(kSeeds, [](std::uint64_t seed, Claim& claim) {
    const Case one = with_late_stator(seed);
    const Runs runs = record(one);
    diagnosis::DiagnosisInput input = question(one, runs);
    const diagnosis::Diagnosis found = diagnosis::diagnose(input, {});
    claim.expect(found.effects.size() == 1U && found.effects.front().id == "sensor_lag_stator", account(found));
    std::vector<estimation::MeasuredRun> unseen = holdout(runs);
    const ErrorsOfModels found_score = errors_of_models(input, found, unseen);
    for (std::vector<estimation::MeasuredRun>* const some : {&input.train, &unseen}) {
      state(*some, {{motor::find_sensor_effect("sensor_lag_stator"), kLag_s}});
    }
    const diagnosis::Diagnosis stated = diagnosis::diagnose(input, {});
    claim.expect(stated.verdict == diagnosis::DiagnosisVerdict::nothing_missing && stated.effects.empty(), "stated " + account(stated));
    const ErrorsOfModels score = errors_of_models(input, stated, unseen);
    for (const auto& [signal, error] : found_score.after) {
      claim.expect(std::abs(score.after.at(signal).rmse_K - error.rmse_K) < 0.05, "error of " + signal);
    }
  });
  EXPECT_GE(rate.right, kSeeds - 2) << rate.misses;
}

// If the stated fault is wrong, the difference is found in addition to it.
TEST(StatedSensors, LeaveRoomForWhatTheyDoNotTell) {
  const SeedRate rate = rate_over_seeds(kSeeds, [](std::uint64_t seed, Claim& claim) {
    const Case one = with_late_stator(seed);
    diagnosis::DiagnosisInput input = question(one, record(one));
    state(input.train, {{motor::find_sensor_effect("sensor_offset_stator"), 3.0}});
    const diagnosis::Diagnosis found = diagnosis::diagnose(input, {});
    const auto is_near = [&](std::string_view id, double value, double error) {
      const auto effect = std::ranges::find(found.effects, id, &diagnosis::FoundEffect::id);
      return effect != found.effects.end() && std::abs(effect->parameters.front().value - value) < error;
    };
    claim.expect(is_near("sensor_lag_stator", kLag_s, 2.0), "lag " + account(found));
    claim.expect(is_near("sensor_offset_stator", -3.0, 1.0), "offset " + account(found));
  });
  EXPECT_GE(rate.right, kSeeds - 1) << rate.misses;
}

/// Candidate columns of sensors with stated faults, compared with differences of a model that contains a small amount of each candidate.
TEST(StatedSensors, CandidatesAreSeenThroughThem) {
  const Case one = with_late_stator();
  diagnosis::DiagnosisInput input = question(one, record(one));
  state(input.train, {{motor::find_sensor_effect("sensor_lag_stator"), 40.0}});
  const estimation::MeasuredRun& run = input.train.front();
  const estimation::LinearisedRun here = estimation::linearise(input.model, std::vector<double>{30.0, 28.0}, run);
  const std::vector<Candidate> all = candidates_for(input.model, input.train).candidates;
  for (const char* const id : {"iron_loss_eddy", "speed_dependent_convection", "sensor_offset_stator"}) {
    const auto candidate = std::ranges::find(all, id, &Candidate::id);
    ASSERT_NE(candidate, all.end()) << id;
    const estimation::Columns column = candidate_columns({*candidate}, input.model, here, run);
    constexpr double kLittle_share = 1e-3;
    const estimation::LinearisedRun with =
        estimation::linearise(with_candidate(input.model, *candidate, kLittle_share), std::vector<double>{30.0, 28.0}, run);
    const Eigen::MatrixXd expected = (with.sensor_C - here.sensor_C) / kLittle_share;
    const Eigen::Index sensor = run.sensor_at("stator").value();
    double worst = 0.0;
    for (Eigen::Index k = 0; k < run.samples(); ++k) {
      worst = std::max(worst, std::abs(column(k * run.measured_C.cols() + sensor, 0) - expected(k, sensor)));
    }
    EXPECT_LT(worst, 0.02 * expected.col(sensor).cwiseAbs().maxCoeff()) << id;
  }
}

TEST(StatedSensors, AreWrittenWhereTheyWereFoundAndThenNothingIsMissing) {
  const Case one = with_late_stator();
  const Runs runs = record(one);
  std::vector<recording::Recording> logs;
  for (const TrueRun& run : runs.training) {
    logs.push_back(run.log);
  }
  const motor::Motor motor = sheet_of(runs.make);
  recording::NamedLogs named_logs;
  named_logs.fitted = logs;
  const diagnosis::DiagnosisAnswer first = diagnosis::run_diagnosis({motor, named_logs});
  ASSERT_EQ(first.diagnosis.verdict, diagnosis::DiagnosisVerdict::effect_found) << account(first.diagnosis);
  const motor::Motor again = read_back(first.motor);
  ASSERT_EQ(again.sensors.size(), 1U) << account(first.diagnosis);
  const motor::MotorSensor& sensor = again.sensors.front();
  EXPECT_EQ(sensor.name, "sensor_lag_stator");
  EXPECT_NEAR(sensor.size.value, kLag_s, 2.0);
  EXPECT_EQ(sensor.size.origin, base::Origin::measured);
  ASSERT_TRUE(sensor.size.spread);
  EXPECT_LT(sensor.size.spread->low, kLag_s);
  EXPECT_GT(sensor.size.spread->high, kLag_s);
  EXPECT_TRUE(again.notes.empty());

  const diagnosis::DiagnosisAnswer second = diagnosis::run_diagnosis({again, named_logs});
  EXPECT_EQ(second.diagnosis.verdict, diagnosis::DiagnosisVerdict::nothing_missing) << account(second.diagnosis);
  EXPECT_THAT(second.findings, testing::Contains(testing::VariantWith<calibration::HeldValue>(testing::VariantWith<calibration::SensorHeld>(
                                   testing::AllOf(testing::Field(&calibration::SensorHeld::sensor, "sensor_lag_stator"),
                                                  testing::Field(&calibration::SensorHeld::parameter, "time_constant"))))));

  // Entries that the file already contains keep their names.
  motor::Motor named = motor;
  named.sensors.push_back({"sensor_lag_stator", motor::find_sensor_effect("sensor_offset_winding"), {}});
  const motor::Motor both = diagnosis::extended_motor(named, diagnosis::model_of_logs(motor, logs), first.diagnosis);
  ASSERT_EQ(both.sensors.size(), 2U);
  EXPECT_EQ(both.sensors[0].type->name, "sensor_offset_winding");
  EXPECT_EQ(both.sensors[0].name, "sensor_lag_stator");
  EXPECT_EQ(both.sensors[1].name, "sensor_lag_stator_2");
}

/// The second diagnosis starts from the file of the first and reads the same logs.
TEST(EffectsOfTheFile, AreNotMoreCertainAfterTheSameLogsAgain) {
  Case one;
  one.missing = std::ranges::find(subjects(), "windage", &Subject::name)->make(1.0);
  const Runs runs = record(one);
  recording::NamedLogs logs;
  for (const TrueRun& run : runs.training) {
    logs.fitted.push_back(run.log);
  }
  const diagnosis::DiagnosisAnswer first = diagnosis::run_diagnosis({sheet_of(runs.make), logs});
  ASSERT_EQ(first.motor.effects.size(), 1U) << account(first.diagnosis);
  const diagnosis::DiagnosisAnswer second = diagnosis::run_diagnosis({read_back(first.motor), logs});
  const auto width_of = [](const diagnosis::DiagnosisAnswer& answer) {
    const base::Spread& spread = *answer.motor.effects.front().parameters.front().spread;
    return std::log(spread.high / spread.low);
  };
  ASSERT_EQ(second.motor.effects.size(), 1U) << account(second.diagnosis);
  EXPECT_GT(width_of(second), 0.9 * width_of(first));
}

}  // namespace
}  // namespace heatsoak::attribution::truth
