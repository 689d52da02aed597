// Descriptions of directions that the runs leave undetermined, profile intervals, and the file that a calibration writes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <functional>

#include "base/diagnostic.h"
#include "calibration/profile.h"
#include "motor/write_motor.h"
#include "study.h"
#include "support/seed_rate.h"

namespace heatsoak::calibration::study {
namespace {

using testing::AnyOf;
using testing::Contains;
using testing::Field;
using testing::VariantWith;

const CalibratedParameter& parameter(const Calibration& calibration, std::string_view name) {
  return *std::ranges::find(calibration.parameters, name, &CalibratedParameter::name);
}

/// Drawn motors of each claim, and the share of all motors for which it is made. Claims with several fits of long logs are made for all of
/// a few motors.
constexpr int kSeeds = 8;
constexpr int kFewSeeds = 4;
constexpr double kClaimed_share = 0.95;

bool has_reason(const Calibration& calibration, OpenReason reason) {
  return std::ranges::find(calibration.open, reason, &OpenDirection::reason) != calibration.open.end();
}

Case short_case(std::uint64_t seed = 1) {
  Case one;
  one.seed = seed;
  one.making.duration_s = 1200.0;
  one.runs = 2;
  return one;
}

TEST(OpenDirections, NoneWhereBothNodesAreSensedAndTheResistanceIsKnown) {
  EXPECT_TRUE(holds_for_share(kClaimed_share, kSeeds,
                              [](std::uint64_t seed) { return calibrate_case({}, short_case(seed)).calibration.open.empty(); }));
}

TEST(OpenDirections, CommonScaleOfAllHeatDependsOnTheStatedResistance) {
  EXPECT_TRUE(holds_for_share(kClaimed_share, kSeeds, [](std::uint64_t seed) {
    const Calibration found = calibrate_case({.truth = {}, .resistance_spread = ", tolerance = \"10 %\""}, short_case(seed)).calibration;
    return has_reason(found, OpenReason::common_factor) && found.next_experiment == Remedy::four_wire_resistance &&
           !parameter(found, "terminal_resistance").is_identifiable && parameter(found, "thermal_time_constant_winding").is_identifiable;
  }));
}

// Longer logs of the stator determine the winding better. The reason stated for parameters that stay open is the missing winding sensor.
TEST(OpenDirections, WindingCapacityWhereOnlyTheStatorIsSensed) {
  const auto calibrated = [](std::uint64_t seed, int runs) {
    Case one = short_case(seed);
    one.runs = runs;
    one.making.winding_is_sensed = false;
    return calibrate_case({}, one).calibration;
  };
  EXPECT_TRUE(holds_for_share(kClaimed_share, kSeeds, [&](std::uint64_t seed) {
    const Calibration found = calibrated(seed, 1);
    return has_reason(found, OpenReason::only_stator_measured) && found.next_experiment == Remedy::winding_sensor &&
           !parameter(found, "winding_heat_capacity").is_identifiable &&
           parameter(found, "thermal_resistance_stator_ambient").is_identifiable;
  }));
  EXPECT_TRUE(holds_for_share(1.0, kSeeds, [&](std::uint64_t seed) {
    const Calibration found = calibrated(seed, 2);
    const auto width_ratio = [&](const char* name) { return parameter(found, name).high / parameter(found, name).low; };
    return found.open.empty() == !found.next_experiment.has_value() &&
           std::ranges::all_of(found.open, [](const OpenDirection& each) { return each.reason == OpenReason::only_stator_measured; }) &&
           width_ratio("winding_heat_capacity") > width_ratio("stator_heat_capacity");
  }));
}

/// A log of a motor with another resistance, with the voltage at its terminals.
TEST(OtherMotor, IsSuspectedFromTheVoltageAtItsTerminals) {
  const Folder folder;
  const Sheet sheet{.truth = {}, .resistance_spread = ", tolerance = \"5 %\""};
  const motor::Motor motor = sheet.motor(folder);
  const auto is_suspected = [&](double ratio, std::uint64_t seed) {
    estimation::TwoNodeTruth truth = sheet.truth;
    truth.resistance_25C_ohm *= ratio;
    estimation::LogMaking making;
    making.duration_s = 1200.0;
    recording::Recording log = estimation::generated_log(truth, making, seed, 0);
    std::vector<double> speed_rad_per_s, motor_V;
    const std::vector<double>& current_A = log.find("current_A")->values;
    const std::vector<double>& winding_C = log.find("winding_C")->values;
    for (std::size_t row = 0; row < log.rows(); ++row) {
      speed_rad_per_s.push_back(200.0 * std::sin(0.02 * static_cast<double>(row)));
      const double hot_ratio = 1.0 + truth.temperature_coefficient_per_K * (winding_C[row] - 25.0);
      motor_V.push_back(truth.resistance_25C_ohm * hot_ratio * current_A[row] + 0.034 * speed_rad_per_s.back());
    }
    log.channels.push_back({*recording::quantity_named("speed_rad_per_s"), std::move(speed_rad_per_s)});
    log.channels.push_back({*recording::quantity_named("motor_V"), std::move(motor_V)});
    const std::vector<recording::Recording> logs{read_log(write_log(log, folder.path() / "log.csv"))};
    return has_finding<ResistanceDiffers>(calibrate(motor, logs, {}, {}).findings);
  };
  for (const double ratio : {1.0, 0.7}) {
    EXPECT_TRUE(holds_for_share(kClaimed_share, kSeeds, [&](std::uint64_t seed) { return is_suspected(ratio, seed) == (ratio < 1.0); }))
        << ratio;
  }
}

/// Log of a motor that turns whenever current flows, which heats its stator by `drag_W`; `seed` is that of the sensors' noise.
recording::Recording log_of(const estimation::TwoNodeTruth& truth, double hot_C, double duration_s, double drag_W,
                            const std::function<double(double time_s)>& current_A, std::uint64_t seed = 1) {
  estimation::LogMaking making;
  making.duration_s = duration_s;
  recording::Recording log = estimation::generated_log(truth, making, seed, 0);
  double winding_C = 25.0 + hot_C;
  double stator_C = 25.0 + 0.8 * hot_C;
  base::Random random(seed, 9);
  for (std::size_t row = 0; row < log.rows(); ++row) {
    const double flows_A = current_A(log.time_s[row]);
    for (recording::Channel& channel : log.channels) {
      if (channel.quantity.key == "winding_C") {
        channel.values[row] = winding_C + 0.1 * estimation::standard_normal(random);
      } else if (channel.quantity.key == "stator_C") {
        channel.values[row] = stator_C + 0.1 * estimation::standard_normal(random);
      } else if (channel.quantity.key == "ambient_C") {
        channel.values[row] = 25.0;
      } else if (channel.quantity.key == "current_A") {
        channel.values[row] = flows_A;
      }
    }
    for (int part = 0; part < 100; ++part) {
      const double across_W = (winding_C - stator_C) / truth.winding_stator_K_per_W;
      const double copper_W =
          flows_A * flows_A * truth.resistance_25C_ohm * (1.0 + truth.temperature_coefficient_per_K * (winding_C - 25.0));
      winding_C += 0.01 * (copper_W - across_W) / truth.winding_J_per_K;
      const double away_W = (stator_C - 25.0) / truth.stator_ambient_K_per_W;
      stator_C += 0.01 * (across_W - away_W + (flows_A > 0.0 ? drag_W : 0.0)) / truth.stator_J_per_K;
    }
  }
  return log;
}

recording::Recording cool_down(std::uint64_t seed, const estimation::TwoNodeTruth& truth, double hot_C = 65.0, double duration_s = 1500.0) {
  return log_of(
      truth, hot_C, duration_s, 0.0, [](double) { return 0.0; }, seed);
}

TEST(SourcesOfAWrittenValue, AreListedOnce) {
  EXPECT_EQ(motor::joined_sources("", "calibration"), "calibration");
  EXPECT_EQ(motor::joined_sources("calibration", ""), "calibration");
  EXPECT_EQ(motor::joined_sources("diagnosis", "diagnosis, maxon"), "diagnosis, maxon");
  EXPECT_EQ(motor::joined_sources("maxon, calibration", "calibration"), "maxon, calibration");
}

// One minute of heating leaves single parameters open, a spread of the resistance a combination.
TEST(OpenDirections, NameEachParameterThatTheTableCallsNotIdentifiableAndNoOther) {
  const Folder folder;
  const Sheet sheet{.truth = {}, .resistance_spread = ", tolerance = \"10 %\"", .thermal_spread = ", tolerance = \"60 %\""};
  for (const double length_s : {60.0, 1200.0}) {
    const recording::Recording log = log_of(
        {}, 0.0, length_s, 0.0, [](double) { return 4.0; }, 3);
    const std::vector<recording::Recording> logs{read_log(write_log(log, folder.path() / "log.csv"))};
    const Calibration result = calibrate(sheet.motor(folder), logs, {}, {.fit = {}, .written = WrittenFit::innovations});
    std::vector<std::string> named;
    for (const OpenDirection& each : result.open) {
      named.insert(named.end(), each.parameters.begin(), each.parameters.end());
    }
    std::vector<std::string> open;
    for (const CalibratedParameter& each : result.parameters) {
      if (!each.is_identifiable) {
        open.push_back(each.name);
      }
    }
    std::erase(named, std::string(kLossAtUnloggedSpeed));
    EXPECT_THAT(named, testing::UnorderedElementsAreArray(open)) << length_s;
    EXPECT_FALSE(open.empty());
  }
}

void add_speed(recording::Recording& log, double speed_rad_per_s) {
  log.channels.push_back({*recording::quantity_named("speed_rad_per_s"), std::vector<double>(log.rows(), speed_rad_per_s)});
}

TEST(OpenDirections, CoolingDeterminesTimeConstantsButNoHeat) {
  const Folder folder;
  estimation::TwoNodeTruth truth;
  truth.stator_J_per_K *= 1.1;
  EXPECT_TRUE(holds_for_share(kClaimed_share, kSeeds, [&](std::uint64_t seed) {
    const std::vector<recording::Recording> logs{read_log(write_log(cool_down(seed, truth), folder.path() / "cooling.csv"))};
    const Calibration result = calibrate(Sheet{}.motor(folder), logs, {}, {});
    const CalibratedParameter& stator = parameter(result, "thermal_time_constant_stator");
    return has_reason(result, OpenReason::no_heat) && !parameter(result, "thermal_resistance_stator_ambient").is_identifiable &&
           result.next_experiment == Remedy::heated_run && stator.is_identifiable &&
           std::abs(stator.value - truth.stator_J_per_K * truth.stator_ambient_K_per_W) < 0.03 * stator.value;
  }));
}

TEST(OpenDirections, CoolingGivesNoHeatHoweverWellItDeterminesTimeConstants) {
  const Folder folder;
  const Sheet sheet{.truth = {}, .resistance_spread = ", tolerance = \"10 %\"", .no_load_current_A = 0.2};
  constexpr std::array kInWatts{"thermal_resistance_winding_stator",
                                "thermal_resistance_stator_ambient",
                                "winding_heat_capacity",
                                "stator_heat_capacity",
                                "terminal_resistance",
                                "no_load_current"};
  EXPECT_TRUE(holds_for_share(kClaimed_share, kSeeds, [&](std::uint64_t seed) {
    recording::Recording log = cool_down(seed, {}, 40.0, 900.0);
    add_speed(log, 0.0);
    const std::vector<recording::Recording> logs{read_log(write_log(log, folder.path() / "cooling.csv"))};
    const Calibration result = calibrate(sheet.motor(folder), logs, {}, {});
    return parameter(result, "thermal_time_constant_winding").is_identifiable && result.next_experiment == Remedy::heated_run &&
           std::ranges::none_of(kInWatts, [&](const char* name) { return parameter(result, name).is_identifiable; }) &&
           testing::Value(result.open, Contains(Field(&OpenDirection::parameters, Contains("no_load_current"))));
  }));
}

TEST(OpenDirections, UnidentifiableParameterHasAReasonAndAnExperiment) {
  // One minute of heating.
  const Folder folder;
  const Sheet sheet{.truth = {}, .resistance_spread = {}, .thermal_spread = ", tolerance = \"60 %\"", .no_load_current_A = 0.2};
  const auto names_resistance = Contains(
      AnyOf(Field(&OpenDirection::parameters, Contains(AnyOf("thermal_resistance_stator_ambient", "stator_ambient.thermal_resistance"))),
            Field(&OpenDirection::together, Contains(Field(&MovedParameter::name, "stator_ambient.thermal_resistance")))));
  EXPECT_TRUE(holds_for_share(kClaimed_share, kSeeds, [&](std::uint64_t seed) {
    recording::Recording log = log_of(
        {}, 0.0, 60.0, 0.0, [](double) { return 4.0; }, seed);
    add_speed(log, 0.0);
    const std::vector<recording::Recording> logs{read_log(write_log(log, folder.path() / "short.csv"))};
    const Calibration result = calibrate(sheet.motor(folder), logs, {}, {});
    return !parameter(result, "thermal_resistance_stator_ambient").is_identifiable && testing::Value(result.open, names_resistance) &&
           testing::Value(result.open, Contains(Field(&OpenDirection::parameters, Contains("no_load_current")))) &&
           result.next_experiment.has_value();
  }));
}

/// Half an hour with two currents and rests; `drag_W` heats the stator while current flows.
recording::Recording two_currents(double drag_W, std::uint64_t seed) {
  const auto current_A = [](double time_s) {
    const double within_s = std::fmod(time_s, 1200.0);
    return within_s < 300.0 ? 4.0 : within_s < 700.0 ? 2.5 : 0.0;
  };
  return log_of({}, 0.0, 2400.0, drag_W, current_A, seed);
}

/// Speed of the motor: three quarters of its no-load speed, or standstill.
class UnloggedSpeed : public testing::TestWithParam<double> {};

TEST_P(UnloggedSpeed, WidensTheStatorsIntervalsUntilTheyHoldTheTruth) {
  const Folder folder;
  const Sheet sheet{.truth = {}, .resistance_spread = {}, .no_load_current_A = 0.2};
  const double most_W = sheet.no_load_current_A * 24.0;
  const estimation::TwoNodeTruth truth;
  const auto calibrated = [&](const recording::Recording& log) {
    const std::vector<recording::Recording> logs{read_log(write_log(log, folder.path() / "log.csv"))};
    return calibrate(sheet.motor(folder), logs, {}, {});
  };
  const auto holds = [](const CalibratedParameter& each, double value) { return each.low < value && value < each.high; };
  EXPECT_TRUE(holds_for_share(1.0, kFewSeeds, [&](std::uint64_t seed) {
    const recording::Recording silent = two_currents(GetParam() * most_W, seed);
    const Calibration unlogged = calibrated(silent);
    const CalibratedParameter& open = parameter(unlogged, "thermal_resistance_stator_ambient");
    const bool is_right =
        holds(open, truth.stator_ambient_K_per_W) && holds(parameter(unlogged, "stator_heat_capacity"), truth.stator_J_per_K) &&
        holds(parameter(unlogged, "thermal_time_constant_stator"), truth.stator_J_per_K * truth.stator_ambient_K_per_W) &&
        parameter(unlogged, "thermal_time_constant_winding").is_identifiable && unlogged.next_experiment == Remedy::logged_speed;
    if (!is_right || GetParam() > 0.0) {
      return is_right;
    }
    recording::Recording still = silent;
    add_speed(still, 0.0);
    const Calibration stood_still = calibrated(still);
    const CalibratedParameter& narrowed = parameter(stood_still, "thermal_resistance_stator_ambient");
    return stood_still.next_experiment != Remedy::logged_speed && narrowed.high / narrowed.low < open.high / open.low;
  }));
}

INSTANTIATE_TEST_SUITE_P(StillAndTurning, UnloggedSpeed, testing::Values(0.0, 0.75));

/// The hold-out log's mean loss at speed equals the value that is assumed for logs without speed.
TEST(HeldOutLog, MayLackTheSpeedThatTheFittedOnesHave) {
  const Folder folder;
  const Sheet sheet{.truth = {}, .resistance_spread = {}, .no_load_current_A = 0.2};
  const auto calibrated = [&](const recording::Recording& fitted, const recording::Recording& held_out) {
    const std::vector<recording::Recording> logs{read_log(write_log(fitted, folder.path() / "log.csv"))};
    const std::vector<recording::Recording> others{read_log(write_log(held_out, folder.path() / "held_out.csv"))};
    return calibrate(sheet.motor(folder), logs, others, {});
  };
  const auto stator_K = [](const Calibration& found) {
    return std::ranges::find(found.holdout_error, "stator_C", &ErrorBeforeAfter::signal)->after.rmse_K;
  };
  const auto names_held_out = Contains(VariantWith<BandIncludesLossAtSpeed>(Field(&BandIncludesLossAtSpeed::recording, "held_out")));
  EXPECT_TRUE(holds_for_share(1.0, kFewSeeds, [&](std::uint64_t seed) {
    recording::Recording still = two_currents(0.0, seed);
    add_speed(still, 0.0);
    const recording::Recording silent = two_currents(0.5 * sheet.no_load_current_A * 24.0, seed);
    recording::Recording said_to_stand = silent;
    add_speed(said_to_stand, 0.0);
    const Calibration without_speed = calibrated(still, silent);
    const Calibration stands = calibrated(still, said_to_stand);
    return testing::Value(without_speed.findings, names_held_out) && !has_finding<BandIncludesLossAtSpeed>(stands.findings) &&
           !has_finding<LossAtSpeedUnknown>(stands.findings) && stator_K(without_speed) < 0.6 * stator_K(stands) &&
           parameter(without_speed, "stator_heat_capacity").value == parameter(stands, "stator_heat_capacity").value &&
           stator_K(calibrated(silent, still)) > 0.0;
  }));
}

testing::Matcher<CalibrationFinding> heat_share_held(bool has_loss_at_stator) {
  return VariantWith<HeldValue>(VariantWith<HeatShareHeld>(Field(&HeatShareHeld::has_loss_at_stator, has_loss_at_stator)));
}

/// At 529 rad/s the drag current of 0.2 A causes 3.6 W.
TEST(InputPower, LeavesTheNoLoadLossAtTheStator) {
  const Folder folder;
  const Sheet sheet{.truth = {}, .resistance_spread = {}, .no_load_current_A = 0.2};
  constexpr double kConstant_Nm_per_A = 0.034;
  constexpr double kTurning_rad_per_s = 3.6 / (kConstant_Nm_per_A * 0.2);
  const auto with_power = [&](std::uint64_t seed) {
    recording::Recording log = two_currents(3.6, seed);
    std::vector<double> power_W, torque_Nm, speed_rad_per_s;
    for (std::size_t row = 0; row < log.rows(); ++row) {
      const double flows_A = log.find("current_A")->values[row];
      const double hot_K = log.find("winding_C")->values[row] - 25.0;
      speed_rad_per_s.push_back(flows_A > 0.0 ? kTurning_rad_per_s : 0.0);
      torque_Nm.push_back(flows_A > 0.0 ? kConstant_Nm_per_A * (flows_A - 0.2) : 0.0);
      power_W.push_back(flows_A * flows_A * sheet.truth.resistance_25C_ohm * (1.0 + sheet.truth.temperature_coefficient_per_K * hot_K) +
                        kConstant_Nm_per_A * flows_A * speed_rad_per_s.back());
    }
    std::erase_if(log.channels, [](const recording::Channel& channel) { return channel.quantity.key == "current_A"; });
    log.channels.push_back({*recording::quantity_named("power_in_W"), std::move(power_W)});
    log.channels.push_back({*recording::quantity_named("torque_Nm"), std::move(torque_Nm)});
    log.channels.push_back({*recording::quantity_named("speed_rad_per_s"), std::move(speed_rad_per_s)});
    return std::vector{read_log(write_log(log, folder.path() / "power.csv"))};
  };
  motor::Motor guessed = sheet.motor(folder);
  guessed.parameters.find("no_load_current")->second.origin = base::Origin::estimated;
  EXPECT_TRUE(holds_for_share(1.0, kFewSeeds, [&](std::uint64_t seed) {
    const std::vector<recording::Recording> logs = with_power(seed);
    const Calibration found = calibrate(sheet.motor(folder), logs, {}, {});
    const auto is_near = [&](const char* name, double truth) {
      const CalibratedParameter& each = parameter(found, name);
      return each.low < truth && truth < each.high && std::abs(each.value - truth) < 0.05 * truth;
    };
    return testing::Value(found.findings, Contains(heat_share_held(true))) &&
           is_near("thermal_resistance_winding_stator", sheet.truth.winding_stator_K_per_W) &&
           is_near("winding_heat_capacity", sheet.truth.winding_J_per_K) &&
           std::abs(parameter(found, "no_load_current").value - 0.2) < 0.005 &&
           testing::Value(calibrate(guessed, logs, {}, {}).findings, Contains(heat_share_held(false))) &&
           testing::Value(calibrate(Sheet{}.motor(folder), logs, {}, {}).findings, Contains(heat_share_held(false)));
  }));
}

TEST(GuessedResistance, IsNoScaleToRelyOn) {
  for (const char* const origin : {"datasheet", "estimated"}) {
    EXPECT_TRUE(holds_for_share(kClaimed_share, kSeeds, [&](std::uint64_t seed) {
      const Calibration found =
          calibrate_case({.truth = {}, .resistance_spread = {}, .resistance_origin = origin}, short_case(seed)).calibration;
      const bool is_relied_on = std::string_view(origin) == "datasheet";
      const bool is_fixed =
          std::ranges::find(found.parameters, "terminal_resistance", &CalibratedParameter::name) == found.parameters.end();
      const CalibratedParameter& out = parameter(found, "thermal_resistance_stator_ambient");
      return is_fixed == is_relied_on && (out.high / out.low < 1.1) == is_relied_on;
    })) << origin;
  }
}

TEST(OpenDirections, WhereNothingIsLearnedTheAnswerIsThatAndTheExperiment) {
  // Two noisy minutes and a data sheet with an uncertainty of 1 %.
  EXPECT_TRUE(holds_for_share(kClaimed_share, kSeeds, [](std::uint64_t seed) {
    Case one = short_case(seed);
    one.runs = 1;
    one.making.duration_s = 120.0;
    one.making.noise_K = 0.5;
    try {
      calibrate_case({.truth = {}, .resistance_spread = {}, .thermal_spread = ", tolerance = \"1 %\""}, one);
      return false;
    } catch (const NothingLearned& failure) {
      return failure.code() == base::ExitCode::cannot_answer && !failure.open().empty();
    }
  }));
}

// A value may be known better than before and still not to a factor of two: such logs are an answer, not a refusal.
TEST(Identifiability, LearningNeedsLessThanAFactorOfTwo) {
  CalibratedValue value;
  value.prior_sd = 0.7;
  value.origin = base::Origin::datasheet;
  EXPECT_TRUE(is_learned(0.36, value));
  EXPECT_FALSE(is_identifiable(0.36, value));
  EXPECT_TRUE(is_identifiable(0.34, value));
  EXPECT_FALSE(is_learned(0.5, value));
}

TEST(Profile, IsTheCurvatureWhereThatHoldsAndLopsidedWhereItDoesNot) {
  Case quick = short_case();
  quick.written = WrittenFit::innovations;
  const CaseResult both = calibrate_case({}, quick);
  const Calibration& sharp = both.calibration;
  for (const int place : {0, 3}) {
    const auto [low, high] = profile_interval(sharp.motor_model.model, sharp.runs, sharp.fit, place);
    const double sd = std::sqrt(sharp.fit.covariance_at_flux(place, place));
    EXPECT_NEAR((sharp.fit.theta[place] - low) / (1.96 * sd), 1.0, 0.05) << place;
    EXPECT_NEAR((high - sharp.fit.theta[place]) / (1.96 * sd), 1.0, 0.05) << place;
  }
  Case one = quick;
  one.making.winding_is_sensed = false;
  const CaseResult stator_only = calibrate_case({}, one);
  const CalibratedParameter& capacity = parameter(stator_only.calibration, "winding_heat_capacity");
  EXPECT_TRUE(capacity.by_profile);
  EXPECT_LT(capacity.low, capacity.value);
  EXPECT_GT(capacity.high, capacity.value);
}

TEST(CalibratedMotor, IsReadBackAsItWasWritten) {
  const Folder folder;
  const motor::Motor motor = Sheet{.truth = {}, .resistance_spread = ", tolerance = \"10 %\""}.motor(folder);
  CaseResult result = calibrate_case({.truth = {}, .resistance_spread = ", tolerance = \"10 %\""}, short_case());
  result.calibration.fit.free_run_error_K = 0.45;
  const motor::Motor written = calibrated_motor(motor, result.calibration);
  const std::filesystem::path file = folder.path() / "model.toml";
  std::ofstream(file) << motor::to_toml(written);
  const motor::Motor read = motor::read_motor(file);
  ASSERT_TRUE(read.fit);
  EXPECT_EQ(read.fit->parameters, written.fit->parameters);
  EXPECT_EQ(read.fit->free_run_error_K, 0.45);
  ASSERT_EQ(read.fit->correlation.count(), written.fit->correlation.count());
  for (std::size_t k = 0; k < written.fit->correlation.values().size(); ++k) {
    EXPECT_NEAR(read.fit->correlation.values()[k], written.fit->correlation.values()[k], 1e-4);
  }
  for (const auto& [key, each] : written.parameters) {
    EXPECT_NEAR(read.parameters.at(key).value, each.value, 1e-5 * std::abs(each.value)) << key;
  }
  // Samples drawn from the file must have the correlations of the fit.
  double product = 0.0;
  double squares_a = 0.0;
  double squares_b = 0.0;
  const double mean_a = std::log(written.nominal.thermal_resistance_stator_ambient_K_per_W);
  const double mean_b = std::log(written.nominal.thermal_resistance_winding_stator_K_per_W);
  for (std::uint64_t seed = 1; seed <= 4000; ++seed) {
    base::Random random(seed, 0);
    const motor::MotorValues values = motor::draw_sample(read, random).values;
    const double a = std::log(values.thermal_resistance_stator_ambient_K_per_W) - mean_a;
    const double b = std::log(values.thermal_resistance_winding_stator_K_per_W) - mean_b;
    product += a * b;
    squares_a += a * a;
    squares_b += b * b;
  }
  const auto place = [&](const char* key) {
    return static_cast<std::size_t>(std::ranges::find(written.fit->parameters, key) - written.fit->parameters.begin());
  };
  const double expected = written.fit->correlation(place("thermal_resistance_stator_ambient"), place("thermal_resistance_winding_stator"));
  EXPECT_GT(expected, 0.8);
  EXPECT_NEAR(product / std::sqrt(squares_a * squares_b), expected, 0.08);
}

TEST(CalibratedMotor, IsTheSameWhateverTheNumberOfThreads) {
  Case one = short_case();
  const Folder folder;
  const motor::Motor motor = Sheet{}.motor(folder);
  const std::string with_one = motor::to_toml(calibrated_motor(motor, calibrate_case({}, one).calibration));
  one.threads = 5;
  EXPECT_EQ(motor::to_toml(calibrated_motor(motor, calibrate_case({}, one).calibration)), with_one);
}

}  // namespace
}  // namespace heatsoak::calibration::study
