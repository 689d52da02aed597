// Logs with shaft torque and speed, without a current: the current follows from the torque and the drag, which is fitted.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/diagnosis_job.h"
#include "examination.h"
#include "scoring.h"
#include "support/seed_rate.h"

namespace heatsoak::attribution::truth {
namespace {

constexpr double kTorque_Nm_per_A = 0.034;
constexpr double kNoLoad_A = 0.35;
constexpr int kSeeds = 6;

/// Returns the log of a shaft that gives the rest of the torque, after the drag of 0.35 A.
recording::Recording by_torque(recording::Recording log) {
  const std::vector<double>& current_A = log.find("current_A")->values;
  const std::vector<double>& speed_rad_per_s = log.find("speed_rad_per_s")->values;
  std::vector<double> torque_Nm;
  for (std::size_t k = 0; k < log.rows(); ++k) {
    const double drag_A = speed_rad_per_s[k] == 0.0 ? 0.0 : std::copysign(kNoLoad_A, speed_rad_per_s[k]);
    torque_Nm.push_back(kTorque_Nm_per_A * (current_A[k] - drag_A));
  }
  std::erase_if(log.channels,
                [](const recording::Channel& each) { return each.quantity.key == "current_A" || each.quantity.key == "torque_Nm"; });
  log.channels.push_back({*recording::quantity_named("torque_Nm"), std::move(torque_Nm)});
  return log;
}

recording::Recording by_current(recording::Recording log) {
  std::erase_if(log.channels, [](const recording::Channel& each) { return each.quantity.key == "torque_Nm"; });
  return log;
}

using Form = recording::Recording (*)(recording::Recording log);

/// Returns the diagnosis of a motor whose file states two thirds of the true no-load current, with a range that contains it.
diagnosis::DiagnosisAnswer answer_of(const Runs& runs, Form form) {
  motor::Motor motor = sheet_of(runs.make);
  base::ParameterValue& no_load = *motor::find_parameter(motor, "no_load_current");
  no_load.value = kNoLoad_A / 1.5;
  no_load.spread = base::Spread{base::Spread::Kind::range, 0.5 * no_load.value, 2.0 * no_load.value, true};
  motor::refresh_values(motor);
  recording::NamedLogs logs;
  const auto as = [&](const std::vector<TrueRun>& from, std::vector<recording::Recording>& to) {
    std::ranges::transform(from, std::back_inserter(to), [&](const TrueRun& run) { return form(run.log); });
  };
  as(runs.training, logs.fitted);
  as(runs.unseen, logs.held_out);
  return diagnosis::run_diagnosis({motor, logs});
}

double worst_K(const diagnosis::HoldoutScore& score) {
  double worst = 0.0;
  for (const diagnosis::ErrorInRun& each : score.errors) {
    worst = std::max(worst, each.after.rmse_K);
  }
  return worst;
}

/// Returns a log with input power and shaft torque, of a torque sensor that reads 2 mN m too little.
recording::Recording by_power(recording::Recording log) {
  constexpr double kError_Nm = 0.002;
  const std::vector<double> current_A = log.find("current_A")->values;
  const std::vector<double> winding_C = log.find("winding_C")->values;
  const std::vector<double> speed_rad_per_s = log.find("speed_rad_per_s")->values;
  log = by_torque(std::move(log));
  std::vector<double> power_W;
  for (std::size_t k = 0; k < log.rows(); ++k) {
    const double hot_C = std::isnan(winding_C[k]) ? 60.0 : winding_C[k];
    power_W.push_back(0.45 * (1.0 + 0.0039 * (hot_C - 25.0)) * current_A[k] * current_A[k] +
                      kTorque_Nm_per_A * current_A[k] * speed_rad_per_s[k]);
  }
  for (recording::Channel& each : log.channels) {
    if (each.quantity.key == "torque_Nm") {
      for (std::size_t k = 0; k < log.rows(); ++k) {
        each.values[k] -= speed_rad_per_s[k] == 0.0 ? 0.0 : std::copysign(kError_Nm, speed_rad_per_s[k]);
      }
    }
  }
  log.channels.push_back({*recording::quantity_named("power_in_W"), std::move(power_W)});
  return log;
}

// Linear evidence alone would name losses that the fit of the whole model sets to 0 W.
TEST(TorqueLogs, WithAWrongTorqueNameNoLossOfZero) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Case one;
    one.seed = seed;
    one.missing.heat.emplace_back(
        [](const Moment& now, PerPart& heat) { heat[yoke] += kTorque_Nm_per_A * kNoLoad_A * std::abs(now.in.speed_rad_per_s); });
    const diagnosis::DiagnosisAnswer answer = answer_of(record(one), by_power);
    for (const diagnosis::FoundEffect& each : answer.diagnosis.effects) {
      EXPECT_TRUE(!each.has_heat || each.peak_W > 0.0) << seed << " " << each.id << account(answer.diagnosis);
    }
  }
}

// The motor lacks nothing but the right drag. The written file reads the unseen torques with the drag of the fit.
TEST(TorqueLogs, OfAMotorWithMoreDragThanItsFileShowNoEffect) {
  const SeedRate rate = rate_over_seeds(kSeeds, [](std::uint64_t seed, Claim& claim) {
    Case one;
    one.seed = seed;
    one.missing.heat.emplace_back(
        [](const Moment& now, PerPart& heat) { heat[yoke] += kTorque_Nm_per_A * kNoLoad_A * std::abs(now.in.speed_rad_per_s); });
    const Runs runs = record(one);
    const diagnosis::DiagnosisAnswer torque = answer_of(runs, by_torque);
    const diagnosis::DiagnosisAnswer current = answer_of(runs, by_current);
    claim.expect(torque.diagnosis.effects.empty(), account(torque.diagnosis));
    claim.expect(worst_K(torque.score) < 1.1 * worst_K(current.score) + 0.05,
                 fmt::format("{:.2f} K, by current {:.2f} K", worst_K(torque.score), worst_K(current.score)));
  });
  EXPECT_GE(rate.right, kSeeds - 1) << rate.misses;
}

}  // namespace
}  // namespace heatsoak::attribution::truth
