// The generator against physics: energy balance, closed forms, meaning of a row, faults of sensors.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "motor_case.h"

namespace heatsoak::suite {
namespace {

double stored_J(const Network& network, const std::vector<double>& from_C, const std::vector<double>& to_C) {
  double sum_J = 0.0;
  for (std::size_t i = 0; i < network.bodies.size(); ++i) {
    sum_J += network.bodies[i].capacity_J_per_K * (to_C[i] - from_C[i]);
  }
  return sum_J;
}

/// Drives a motor for ten minutes and compares heat input with stored and lost heat.
double imbalance_share(const Motor& motor) {
  const std::vector<double> start_C(motor.network.bodies.size(), 24.0);
  State state{.temperature_C = start_C};
  Inputs inputs = wheel_run(motor, 1.0, 3);
  inputs.resize(600 * kStepsPerRow);
  for (const Instant& now : inputs) {
    advance(motor.network, now, kStep_s, state);
  }
  EXPECT_GT(state.heat_in_J, 100.0 * motor.nominal.scale);
  return std::abs(state.heat_in_J - state.heat_lost_J - stored_J(motor.network, start_C, state.temperature_C)) / state.heat_in_J;
}

TEST(Generator, EightBodiesStoreOrLoseTheirHeat) {
  for (const Family* family : {&small_family(), &large_family()}) {
    EXPECT_LT(imbalance_share(eight_body_motor(*family, Random(1, "balance"))), 1e-6);
  }
}

TEST(Generator, EveryEffectKeepsTheEnergyBalance) {
  for (const auto& kinds : {catalogue_effects(), outside_effects()}) {
    for (const EffectKind& kind : kinds) {
      Motor motor = eight_body_motor(small_family(), Random(2, "balance"));
      kind.add(motor, 1.0);
      EXPECT_LT(imbalance_share(motor), 1e-6) << kind.id;
    }
  }
}

TEST(Generator, HeatInputOfEightBodiesIsCopperLossAndDrag) {
  const Motor motor = eight_body_motor(small_family(), Random(3, "input"));
  const Instant now{.current_A = 4.0, .speed_rad_per_s = -200.0, .ambient_C = 20.0};
  State state{.temperature_C = std::vector<double>(8, 30.0)};
  double expected_J = 0.0;
  for (int i = 0; i < 5000; ++i) {
    const std::vector<double> before_C = state.temperature_C;
    advance(motor.network, now, kStep_s, state);
    expected_J += motor.torque_constant_Nm_per_A * motor.no_load_current_A * 200.0 * kStep_s;
    for (const std::size_t copper : {0U, 1U}) {  // slot and end turns
      const double share = copper == 0 ? motor.winding[0].share : 1.0 - motor.winding[0].share;
      const double mean_C = 0.5 * (before_C[copper] + state.temperature_C[copper]);
      expected_J += share * 16.0 * motor.resistance_25C_ohm * (1.0 + 0.0039 * (mean_C - 25.0)) * kStep_s;
    }
  }
  EXPECT_NEAR(state.heat_in_J / expected_J, 1.0, 1e-6);
}

struct TwoBodies {
  double winding_J_per_K;
  double stator_J_per_K;
  double contact_K_per_W;
  double air_K_per_W;
};

TwoBodies values_of(const Motor& motor) {
  return {motor.network.bodies[0].capacity_J_per_K, motor.network.bodies[1].capacity_J_per_K,
          1.0 / motor.network.links[0].conductance_W_per_K, 1.0 / motor.network.air_links[0].conductance_W_per_K};
}

TEST(Generator, SteadyStateOfTwoBodiesIsTheClosedForm) {
  for (const Family* family : {&small_family(), &large_family()}) {
    const Motor motor = two_body_motor(*family, Random(4, "steady"));
    const TwoBodies values = values_of(motor);
    const Instant now{.current_A = -0.8 * family->nominal_current_A, .speed_rad_per_s = 150.0, .ambient_C = 21.0};
    State state{.temperature_C = {21.0, 21.0}};
    for (int i = 0; i < 20000; ++i) {
      advance(motor.network, now, 0.5, state);
    }
    const double cold_W = motor.resistance_25C_ohm * now.current_A * now.current_A;
    const double drag_W = motor.torque_constant_Nm_per_A * motor.no_load_current_A * 150.0;
    const double copper_power_W = cold_W * (1.0 + 0.0039 * (21.0 + values.air_K_per_W * drag_W - 25.0)) /
                                  (1.0 - cold_W * 0.0039 * (values.air_K_per_W + values.contact_K_per_W));
    const double stator_C = 21.0 + values.air_K_per_W * (copper_power_W + drag_W);
    EXPECT_NEAR(state.temperature_C[1], stator_C, 1e-6);
    EXPECT_NEAR(state.temperature_C[0], stator_C + values.contact_K_per_W * copper_power_W, 1e-6);
  }
}

TEST(Generator, CoolDownOfTwoBodiesIsTheClosedForm) {
  const Motor motor = two_body_motor(small_family(), Random(5, "cool"));
  const TwoBodies values = values_of(motor);
  // Rates are symmetric in temperatures times the square root of the capacity.
  const Eigen::Vector2d roots = Eigen::Vector2d(values.winding_J_per_K, values.stator_J_per_K).cwiseSqrt();
  const double contact_W_per_K = 1.0 / values.contact_K_per_W;
  Eigen::Matrix2d conductances_W_per_K;
  conductances_W_per_K << contact_W_per_K, -contact_W_per_K, -contact_W_per_K, contact_W_per_K + 1.0 / values.air_K_per_W;
  const Eigen::Matrix2d rates_per_s = roots.cwiseInverse().asDiagonal() * conductances_W_per_K * roots.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> modes(rates_per_s);
  const Eigen::Vector2d decays = (-100.0 * modes.eigenvalues()).array().exp();
  const Eigen::Vector2d scaled = modes.eigenvectors().transpose() * roots.cwiseProduct(Eigen::Vector2d(60.0, 30.0));
  const Eigen::Vector2d rise_K = roots.cwiseInverse().cwiseProduct(modes.eigenvectors() * decays.cwiseProduct(scaled));
  State state{.temperature_C = {80.0, 50.0}};
  for (int i = 0; i < 100 * kStepsPerRow; ++i) {
    advance(motor.network, {.ambient_C = 20.0}, kStep_s, state);
  }
  EXPECT_NEAR(state.temperature_C[0], 20.0 + rise_K[0], 1e-8);
  EXPECT_NEAR(state.temperature_C[1], 20.0 + rise_K[1], 1e-8);
}

TEST(Generator, StepIsSmallEnough) {
  const Motor motor = eight_body_motor(small_family(), Random(13, "step"));
  State coarse{.temperature_C = std::vector<double>(8, 25.0)};
  State fine = coarse;
  for (const Instant& now : wheel_run(motor, 1.0, 4)) {
    advance(motor.network, now, kStep_s, coarse);
    for (int part = 0; part < 4; ++part) {
      advance(motor.network, now, kStep_s / 4.0, fine);
    }
  }
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(coarse.temperature_C[i], fine.temperature_C[i], 1e-6);
  }
}

TEST(Generator, MotorsAreWithinTheTolerancesOfTheirStartFile) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Family& family = seed % 2 == 0 ? small_family() : large_family();
    const Motor motor = two_body_motor(family, Random(seed, "tolerance"));
    const TwoBodies values = values_of(motor);
    EXPECT_NEAR(values.contact_K_per_W / family.contact_K_per_W, 1.0, 0.25);
    EXPECT_NEAR(values.air_K_per_W / family.air_K_per_W, 1.0, 0.25);
    EXPECT_NEAR(values.contact_K_per_W * values.winding_J_per_K / (family.contact_K_per_W * family.winding_J_per_K), 1.0, 0.25);
    EXPECT_NEAR(values.air_K_per_W * values.stator_J_per_K / (family.air_K_per_W * family.stator_J_per_K), 1.0, 0.25);
    EXPECT_GT(motor.no_load_current_A, 0.7 * family.no_load_current_A);
    EXPECT_LT(motor.no_load_current_A, 1.5 * family.no_load_current_A);
  }
}

/// Heat of an effect at one instant, per body.
std::vector<double> heat_of_effect_W(const EffectKind& kind, const Instant& now) {
  Motor motor = two_body_motor(small_family(), Random(6, "effect"));
  const std::size_t laws = motor.network.laws.size();
  kind.add(motor, 1.0);
  std::vector<double> heat_W(motor.network.bodies.size(), 0.0);
  HeatBook book(heat_W);
  const std::vector<double> temperature_C(motor.network.bodies.size(), 50.0);
  std::vector<double> at_C = temperature_C;
  at_C[0] = 80.0;
  for (std::size_t i = laws; i < motor.network.laws.size(); ++i) {
    motor.network.laws[i](now, at_C, book);
  }
  return heat_W;
}

TEST(Generator, EffectsActAtTheirNodeWithTheirSign) {
  const Instant now{.current_A = 5.0,
                    .speed_rad_per_s = 300.0,
                    .bus_V = 24.0,
                    .modulation_ratio = 0.5,
                    .ambient_C = 25.0,
                    .vehicle_speed_m_per_s = 2.5,
                    .fan_ratio = 1.0,
                    .neighbour_C = 70.0};
  const auto at = [&](const std::string& id) {
    for (const EffectKind& kind : catalogue_effects()) {
      if (kind.id == id) {
        return heat_of_effect_W(kind, now);
      }
    }
    return std::vector<double>{};
  };
  for (const char* loss : {"iron_loss_hysteresis", "iron_loss_eddy", "bearing_friction", "windage", "driver_heat", "connection_resistance",
                           "load_friction", "armature_iron_loss", "neighbour_coupling"}) {
    EXPECT_GT(at(loss)[1], 0.05) << loss;
    EXPECT_EQ(at(loss)[0], 0.0) << loss;
  }
  for (const char* loss : {"ac_copper_loss", "pwm_ripple_loss", "saturation"}) {
    EXPECT_GT(at(loss)[0], 0.05) << loss;
    EXPECT_EQ(at(loss)[1], 0.0) << loss;
  }
  for (const char* cooling : {"speed_dependent_convection", "vehicle_airflow", "radiation"}) {
    EXPECT_LT(at(cooling)[1], -0.05) << cooling;
    EXPECT_EQ(at(cooling)[0], 0.0) << cooling;
  }
  EXPECT_LT(at("winding_through_flow")[0], -0.05);
  for (const char* exchange : {"air_gap_stirring", "contact_temperature_dependence"}) {
    EXPECT_LT(at(exchange)[0], -0.05) << exchange;
    EXPECT_EQ(at(exchange)[0], -at(exchange)[1]) << exchange;
  }
}

TEST(Generator, RowsAreRmsCurrentWithTheSignOfTheMeanAndMeanSpeed) {
  Inputs inputs(2 * kStepsPerRow);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const bool is_first_row = i < kStepsPerRow;
    // Row 0: 5 of 25 steps at +2 A, 20 at -1 A: mean square (20 + 20) / 25, mean -0.4 A.
    inputs[i].current_A = is_first_row ? (i < 5 ? 2.0 : -1.0) : 3.0;
    inputs[i].speed_rad_per_s = is_first_row ? static_cast<double>(i) : -7.0;
    inputs[i].neighbour_C = static_cast<double>(i);
  }
  const Log log = rows_of(inputs);
  ASSERT_EQ(log.size(), 2U);
  EXPECT_NEAR(log[0].current_A, -std::sqrt(1.6), 1e-12);
  EXPECT_NEAR(log[0].speed_rad_per_s, 12.0, 1e-12);
  EXPECT_NEAR(log[1].current_A, 3.0, 1e-12);
  EXPECT_NEAR(log[1].speed_rad_per_s, -7.0, 1e-12);
  EXPECT_EQ(log[1].neighbour_C, 25.0);  // a temperature is that of the row's time
  EXPECT_EQ(log[1].time_s, 1.0);
}

TEST(Generator, TemperaturesAreThoseOfTheRowsTime) {
  const Motor motor = two_body_motor(small_family(), Random(7, "rows"));
  const Inputs inputs(3 * kStepsPerRow, Instant{.current_A = 5.0});
  const UnknownHeats none{std::vector<double>(inputs.size(), 0.0), std::vector<double>(inputs.size(), 0.0)};
  const std::vector<Temperatures> rows = simulate(motor, inputs, none, {25.0, 25.0});
  State state{.temperature_C = {25.0, 25.0}};
  for (const Temperatures& row : rows) {
    EXPECT_NEAR(row.winding_C, state.temperature_C[0], 1e-9);
    for (int i = 0; i < kStepsPerRow; ++i) {
      advance(motor.network, inputs[0], kStep_s, state);
    }
  }
}

TEST(Generator, ASensorWithLagFollowsARampByItsTimeConstant) {
  Motor motor = two_body_motor(small_family(), Random(8, "lag"));
  motor.sensors.lag_stator_s = 10.0;
  motor.network.laws.clear();
  motor.network.links.clear();
  motor.network.air_links.clear();
  motor.network.laws.emplace_back([&](const Instant&, std::span<const double>, HeatBook& book) {
    book.source(1, 0.1 * motor.network.bodies[1].capacity_J_per_K);  // 0.1 K/s
  });
  const Inputs inputs(200 * kStepsPerRow);
  const UnknownHeats none{std::vector<double>(inputs.size(), 0.0), std::vector<double>(inputs.size(), 0.0)};
  EXPECT_NEAR(simulate(motor, inputs, none, {20.0, 20.0})[150].stator_C, 20.0 + 0.1 * (150.0 - 10.0), 0.01);
}

TEST(Generator, SamplesThatAreGoodAreNearTheTruth) {
  const SensorNoise noise{.winding_K = 0.1, .stator_K = 0.2, .winding_step_K = 0.0625, .stator_step_K = 0.25};
  Log rows(20000);
  std::vector<Temperatures> truth(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].time_s = static_cast<double>(i);
    truth[i] = {60.0 + 20.0 * std::sin(static_cast<double>(i) / 100.0), 50.0};
  }
  const Log log = measured(rows, truth, noise, Random(9, "sensors"));
  double square_K2 = 0.0;
  int good = 0;
  int outliers = 0;
  for (const Row& row : log) {
    const auto at = static_cast<std::size_t>(row.time_s);
    const double winding_error_K = row.winding_C - truth[at].winding_C;
    if (row.winding_is_good) {
      EXPECT_LT(std::abs(winding_error_K), 0.7);
      square_K2 += winding_error_K * winding_error_K;
      ++good;
    } else if (row.has_winding && std::abs(winding_error_K) > 3.0) {
      ++outliers;
    }
    EXPECT_TRUE(!row.stator_is_good || std::abs(row.stator_C - 50.0) < 1.4);
  }
  EXPECT_NEAR(std::sqrt(square_K2 / good), std::sqrt(0.01 + 0.0625 * 0.0625 / 12.0), 0.003);
  EXPECT_NEAR(outliers, 60, 30);  // 0.3 %
  EXPECT_LT(log.size(), rows.size());
  EXPECT_GT(log.size(), rows.size() * 99 / 100);
}

TEST(Generator, AThirdOfTheRunsHasAStuckReading) {
  Log rows(1500);
  std::vector<Temperatures> truth(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].time_s = static_cast<double>(i);
    truth[i] = {0.05 * static_cast<double>(i), 0.05 * static_cast<double>(i)};
  }
  int stuck_runs = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    int longest = 0;
    for (const auto& [value_C, has] : {std::pair(&Row::winding_C, &Row::has_winding), std::pair(&Row::stator_C, &Row::has_stator)}) {
      int equal = 1;
      const Log log = measured(rows, truth, {}, Random(seed, "stuck"));
      for (std::size_t i = 1; i < log.size(); ++i) {
        equal = log[i].*value_C == log[i - 1].*value_C ? equal + 1 : 1;
        longest = std::max(longest, equal);
      }
    }
    stuck_runs += longest >= 14 ? 1 : 0;
    EXPECT_LT(longest, 46);
  }
  EXPECT_NEAR(stuck_runs, 100, 25);
}

TEST(Generator, UnknownHeatHasItsSizeAndKind) {
  constexpr std::size_t kSteps = 2000000;
  const std::vector<double> heat_W = unknown_heat_W(UnknownHeat::kOrnsteinUhlenbeck, 0.1, kSteps, 1.0, Random(10, "heat"));
  const double mean_square_W2 = Eigen::Map<const Eigen::VectorXd>(heat_W.data(), kSteps).squaredNorm() / kSteps;
  EXPECT_NEAR(std::sqrt(mean_square_W2), 0.1, 0.01);
  for (const UnknownHeat kind : {UnknownHeat::kSteps, UnknownHeat::kSines, UnknownHeat::kDrift}) {
    const std::vector<double> other_W = unknown_heat_W(kind, 0.1, 50000, 0.04, Random(11, name_of(kind)));
    const double rms_W = std::sqrt(Eigen::Map<const Eigen::VectorXd>(other_W.data(), 50000).squaredNorm() / 50000);
    EXPECT_GT(rms_W, 0.04) << name_of(kind);
    EXPECT_LT(rms_W, 0.25) << name_of(kind);
  }
}

TEST(Generator, TheFitFindsTheParametersOfAMotorWithoutNoise) {
  Motor motor = two_body_motor(small_family(), Random(12, "fit"));
  const TwoBodies values = values_of(motor);
  motor.network.laws.clear();
  motor.resistance_25C_ohm = motor.nominal.resistance_25C_ohm;  // a common factor of heat and conductances cannot be found
  motor.torque_constant_Nm_per_A = motor.nominal.torque_constant_Nm_per_A;
  motor.no_load_current_A = 1.2 * motor.nominal.no_load_current_A;
  add_losses(motor);
  std::vector<Log> logs;
  for (const Inputs& inputs : {bench_run(motor, 1.0, 1), wheel_run(motor, 1.0, 2)}) {
    const UnknownHeats none{std::vector<double>(inputs.size(), 0.0), std::vector<double>(inputs.size(), 0.0)};
    const std::vector<Temperatures> truth = simulate(motor, inputs, none, {35.0, 30.0});
    Log log = rows_of(inputs);
    for (std::size_t i = 0; i < log.size(); ++i) {
      log[i].winding_C = truth[i].winding_C;
      log[i].stator_C = truth[i].stator_C;
    }
    log[100].winding_C += 50.0;  // an outlier that the fit knows
    log[100].winding_is_good = false;
    logs.push_back(log);
  }
  const TwoBodyFit fit = fit_two_bodies(small_family(), logs);
  EXPECT_NEAR(fit.winding_J_per_K / values.winding_J_per_K, 1.0, 0.005);
  EXPECT_NEAR(fit.contact_K_per_W / values.contact_K_per_W, 1.0, 0.005);
  EXPECT_NEAR(fit.stator_J_per_K / values.stator_J_per_K, 1.0, 0.005);
  EXPECT_NEAR(fit.air_K_per_W / values.air_K_per_W, 1.0, 0.005);
  EXPECT_NEAR(fit.no_load_current_A / motor.no_load_current_A, 1.0, 0.02);
  EXPECT_LT(fit.winding_rmse_K, 0.05);
}

TEST(Generator, PlanHasTheGroupsOfTheSuite) {
  std::map<std::string, int> counts;
  int eight_with_effect = 0;
  int others_than_ornstein_uhlenbeck = 0;
  int large = 0;
  const std::vector<CasePlan> cases = planned_cases(1);
  for (const CasePlan& plan : cases) {
    ++counts[plan.group];
    eight_with_effect += plan.has_eight_bodies && !plan.effects.empty() ? 1 : 0;
    others_than_ornstein_uhlenbeck += plan.unknown_heat != UnknownHeat::kOrnsteinUhlenbeck ? 1 : 0;
    large += plan.family == &large_family() ? 1 : 0;
    EXPECT_EQ(plan.effects.size(), plan.group == "null"    ? 0U
                                   : plan.group == "pair"  ? 2U
                                   : plan.group == "eight" ? plan.effects.size()
                                                           : 1U);
  }
  EXPECT_EQ(counts, (std::map<std::string, int>{{"null", 40}, {"single", 53}, {"pair", 16}, {"outside", 16}, {"eight", 40}}));
  EXPECT_EQ(eight_with_effect, 10);
  EXPECT_NEAR(others_than_ornstein_uhlenbeck, static_cast<double>(cases.size()) / 2.0, 5.0);
  EXPECT_NEAR(large, static_cast<double>(cases.size()) / 2.0, 5.0);
}

std::string bytes_of(const std::string& id, std::uint64_t seed) {
  for (const CasePlan& plan : planned_cases(seed)) {
    if (plan.id == id) {
      const MotorCase made = make_case(plan, seed);
      std::string text = truth_of(made, seed).dump() + csv_of(made.holdout[1]);
      for (const Log& log : made.train) {
        text += csv_of(log);
      }
      return text;
    }
  }
  return "";
}

TEST(Generator, FolderHasTheFilesOfItsMotorOnly) {
  const std::filesystem::path out = std::filesystem::path(testing::TempDir()) / "suite_folder";
  std::filesystem::create_directories(out / "test");
  std::ofstream(out / "test" / "train_9.csv") << "from another seed";
  const CasePlan plan{.id = "test", .group = "null", .family = &large_family()};
  const MotorCase made = make_case(plan, 6);
  write_case(made, 6, out);
  std::set<std::string> expected{"holdout_1.csv", "holdout_2.csv", "start.toml", "train_1.csv", "train_2.csv", "train_3.csv", "truth.json"};
  if (made.train.size() == 4) {
    expected.insert("train_4.csv");
  }
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(out / "test")) {
    names.insert(entry.path().filename().string());
  }
  EXPECT_EQ(names, expected);
  std::filesystem::remove_all(out);
}

TEST(Generator, SameSeedMakesTheSameBytes) {
  const std::string first = bytes_of("single_05", 8);
  EXPECT_GT(first.size(), 100000U);
  EXPECT_EQ(first, bytes_of("single_05", 8));
  EXPECT_NE(first, bytes_of("single_05", 9));
}

TEST(Generator, RandomNumbersAreThoseOfTheStandardEngine) {
  // First output of the standard's mt19937_64 with its default seed: 14514284786278117030.
  Random random(5489);
  EXPECT_DOUBLE_EQ(random.uniform(), static_cast<double>(14514284786278117030ULL >> 11) * 0x1.0p-53);
  double sum = 0.0;
  double square = 0.0;
  for (int i = 0; i < 100000; ++i) {
    const double number = random.normal();
    sum += number;
    square += number * number;
  }
  EXPECT_NEAR(sum / 100000, 0.0, 0.015);
  EXPECT_NEAR(square / 100000, 1.0, 0.02);
}

TEST(Generator, AStrongEffectIsVisibleAndATinyOneIsNot) {
  const EffectKind* eddy = &catalogue_effects()[1];
  ASSERT_EQ(eddy->id, "iron_loss_eddy");
  for (const auto& [strength, is_visible] : {std::pair(6.0, true), std::pair(0.01, false)}) {
    const CasePlan plan{.id = "test", .group = "single", .family = &small_family(), .effects = {{eddy, strength}}};
    const nlohmann::ordered_json truth = truth_of(make_case(plan, 5), 5);
    EXPECT_EQ(truth["effects"][0]["visible"], is_visible) << truth["effects"][0]["error_ratio"];
  }
}

}  // namespace
}  // namespace heatsoak::suite
