// Checks of a log before any fit. All logs in this file are synthetic.
#include "recording/quality.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "base/diagnostic.h"
#include "read_log.h"
#include "recording/noise.h"
#include "support/seed_rate.h"

namespace heatsoak::recording {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::IsEmpty;
using ::testing::VariantWith;

class Resolution : public testing::TestWithParam<double> {};

TEST_P(Resolution, SoundLogKeepsItsSamplesAndRaisesNoSuspicion) {
  // Chance may produce what a check looks for: each of the ten or so checks is made for about one false alarm in 1000 logs.
  EXPECT_TRUE(holds_for_share(0.99, 40, [&](std::uint64_t seed) {
    SyntheticLog log;
    log.seed = seed;
    log.step_K = GetParam();
    const Read result = read_text(log.csv());
    std::size_t left_out = 0;
    for (const auto& [what, entry] : result.report.left_out) {
      left_out += entry.count;
    }
    constexpr std::size_t kFew = 4;  // of 3600 samples
    return left_out <= kFew && result.quality.suspicions.empty() && result.quality.thermal.is_good();
  }));
}
INSTANTIATE_TEST_SUITE_P(Synthetic, Resolution, testing::Values(0.0, 0.1, 0.25, 1.0));

/// Second differences of white noise have six times its variance; a slope contributes nothing.
TEST(Noise, WhiteNoiseOnASlope) {
  std::vector<double> values(20000);
  const std::vector<std::pair<std::size_t, std::size_t>> runs{{0, values.size()}};
  // The standard error of the estimate is about 0.9 % of the noise, so the tolerance of 3 % is exceeded in about one of 1000 cases.
  EXPECT_TRUE(holds_for_share(0.99, 40, [&](std::uint64_t seed) {
    base::Random random(seed, 0);
    for (std::size_t i = 0; i < values.size(); ++i) {
      double normal = -6.0;
      for (int k = 0; k < 12; ++k) {
        normal += random.uniform();
      }
      values[i] = 20.0 + 0.01 * static_cast<double>(i) + 0.2 * normal;
    }
    const double noise = noise_level(values, runs).noise;
    for (double& value : values) {
      value = 0.5 * std::round(value / 0.5);
    }
    return std::abs(noise - 0.2) <= 0.006 && std::abs(noise_level(values, runs).step - 0.5) <= 1e-9;
  }));
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = 0.5 * std::floor(1e-3 * static_cast<double>(i));
  }
  EXPECT_NEAR(noise_level(values, runs).noise, 0.5 / std::sqrt(12.0), 1e-9) << "no noise is seen below the resolution";
}

/// A fifth of the samples has random values. The encoder's resolution must still be found.
TEST(Noise, ResolutionAmongBadSamples) {
  // The method counts equal distances between values; random values may form a finer grid by chance.
  EXPECT_TRUE(holds_for_share(0.99, 100, [](std::uint64_t seed) {
    base::Random random(seed, 0);
    std::vector<double> values;
    for (int i = 0; i < 5000; ++i) {
      values.push_back(random.uniform() < 0.2 ? 400.0 * random.uniform() - 200.0 : 0.0767 * std::round(200.0 * random.uniform()));
    }
    const double resolution = resolution_of(values);
    for (double& value : values) {
      value = random.uniform();
    }
    return std::abs(resolution - 0.0767) <= 1e-9 && resolution_of(values) == 0.0;
  }));
}

TEST(ClockOffsets, DelayOfTheTemperaturesIsFound) {
  for (const double delay_s : {0.0, 2.5, 6.0}) {
    SyntheticLog log;
    log.delay_s = delay_s;
    const Read result = read_text(log.csv());
    ASSERT_EQ(result.quality.clock_offsets.size(), 2U);
    const ClockOffset& offset = result.quality.clock_offsets[0];
    ASSERT_TRUE(offset.delay_s) << testing::PrintToString(offset.why_not);
    EXPECT_NEAR(*offset.delay_s, delay_s, 3.0 * offset.delay_uncertainty_s);
    EXPECT_LT(offset.delay_uncertainty_s, 1.0);
  }
}

/// Loggers that were started by hand one after the other. A current that repeats soon would match at several delays.
TEST(ClockOffsets, AMinuteIsFoundWhereTheCurrentDoesNotRepeatItself) {
  for (const double delay_s : {-60.0, 25.0, 60.0}) {
    // Three standard errors hold for more than 99 % of the loads.
    EXPECT_TRUE(holds_for_share(0.99, 3, [delay_s](std::uint64_t seed) {
      SyntheticLog log;
      log.seed = seed;
      log.delay_s = delay_s;
      log.current_A = [seed](double t) {
        base::Random random(static_cast<std::uint64_t>(t / 20.0), seed);
        return random.uniform() < 0.4 ? 0.0 : 6.0 * random.uniform();
      };
      const ClockOffset offset = read_text(log.csv()).quality.clock_offsets[0];
      return offset.delay_s && std::abs(*offset.delay_s - delay_s) < 3.0 * offset.delay_uncertainty_s && offset.delay_uncertainty_s < 2.0;
    })) << delay_s;
  }
}

/// A delay of a minute or less becomes hours in a log whose milliseconds are read as seconds. The wrong unit must be reported first.
TEST(ClockOffsets, OfALogInMillisecondsFollowTheWrongUnit) {
  // The delay is an estimate with a 95 % interval, and is reported only if that excludes 0.
  EXPECT_TRUE(holds_for_share(0.95, 20, [](std::uint64_t seed) {
    SyntheticLog log;
    log.seed = seed;
    log.delay_s = -5.0;
    const DataQuality found = read_text(changed(log, [](int, auto& cells) { cells[time] *= 1000.0; })).quality;
    const auto lasts_for_days = VariantWith<LastsForDays>(testing::_);
    return testing::Matches(ElementsAre(lasts_for_days, VariantWith<RespondsEarly>(testing::_)))(found.suspicions) &&
           found.blocking.size() == 2U && testing::Matches(ElementsAre(lasts_for_days))(found.blocking_for_wheels);
  }));
}

TEST(ClockOffsets, SteadyHeatTellsNothing) {
  SyntheticLog log;
  log.current_A = [](double t) { return 5.0 + 1e-3 * std::sin(t / 400.0); };
  const Read result = read_text(log.csv());
  EXPECT_FALSE(result.quality.clock_offsets[0].delay_s);
  EXPECT_TRUE(result.quality.clock_offsets[0].why_not);
}

/// Matches any suspicion that winding and stator are swapped.
testing::Matcher<Suspicion> swapped() {
  return testing::AnyOf(VariantWith<StatorRespondsFaster>(testing::_), VariantWith<StatorHotterAtRest>(testing::_),
                        VariantWith<StatorWarmsFirst>(testing::_));
}

struct Fault {
  const char* name;
  std::function<void(int, std::vector<double>&)> change;
  testing::Matcher<Suspicion> found;
};
class FaultyLog : public testing::TestWithParam<Fault> {};

testing::Matcher<Suspicion> starts_in(TemperatureScale scale, const char* channel, const testing::Matcher<double>& converted_C) {
  return VariantWith<StartsInOtherScale>(AllOf(Field(&StartsInOtherScale::channel, channel), Field(&StartsInOtherScale::suspected, scale),
                                               Field(&StartsInOtherScale::converted_C, converted_C)));
}
testing::Matcher<Suspicion> motor_starts_in_fahrenheit() {
  return VariantWith<MotorStartsInFahrenheit>(Field(&MotorStartsInFahrenheit::converted_C, testing::DoubleNear(22.0, 0.5)));
}

TEST_P(FaultyLog, IsReportedAndNothingIsChanged) {
  const Read sound = read_text(SyntheticLog{}.csv());
  const Read faulty = read_text(changed({}, GetParam().change));
  EXPECT_THAT(faulty.quality.suspicions, testing::Contains(GetParam().found));
  EXPECT_EQ(faulty.recording.rows(), sound.recording.rows());
}
INSTANTIATE_TEST_SUITE_P(Synthetic, FaultyLog,
                         testing::Values(Fault{"fahrenheit_winding", [](int, auto& cells) { cells[winding] = 32.0 + 1.8 * cells[winding]; },
                                               starts_in(TemperatureScale::fahrenheit, "winding_C", testing::_)},
                                         Fault{"fahrenheit_ambient", [](int, auto& cells) { cells[ambient] = 32.0 + 1.8 * cells[ambient]; },
                                               starts_in(TemperatureScale::fahrenheit, "ambient_C", testing::DoubleNear(22.0, 0.05))},
                                         Fault{"fahrenheit_all",
                                               [](int, auto& cells) {
                                                 for (const Column each : {winding, stator, ambient}) {
                                                   cells[each] = 32.0 + 1.8 * cells[each];
                                                 }
                                               },
                                               starts_in(TemperatureScale::fahrenheit, "stator_C", testing::_)},
                                         Fault{"fahrenheit_motor",
                                               [](int, auto& cells) {
                                                 for (const Column each : {winding, stator}) {
                                                   cells[each] = 32.0 + 1.8 * cells[each];
                                                 }
                                               },
                                               motor_starts_in_fahrenheit()},
                                         Fault{"fahrenheit_motor_that_starts_warm",
                                               [](int, auto& cells) {
                                                 cells[winding] = 32.0 + 1.8 * cells[winding];
                                                 cells[stator] = 32.0 + 1.8 * (cells[stator] + 3.0);
                                               },
                                               motor_starts_in_fahrenheit()},
                                         Fault{"tenths",
                                               [](int, auto& cells) {
                                                 cells[winding] *= 10.0;
                                                 cells[stator] *= 10.0;
                                               },
                                               starts_in(TemperatureScale::tenths_of_degrees, "stator_C", testing::DoubleNear(22.0, 0.5))},
                                         Fault{"constant", [](int, auto& cells) { cells[winding] = 25.0; },
                                               VariantWith<ConstantSensor>(AllOf(Field(&ConstantSensor::channel, "winding_C"),
                                                                                 Field(&ConstantSensor::value_C, 25.0),
                                                                                 Field(&ConstantSensor::moving, "stator_C")))},
                                         Fault{"constant_current", [](int, auto& cells) { cells[current] = 3.0; },
                                               VariantWith<ConstantHeatInput>(Field(&ConstantHeatInput::channel, "current_A"))},
                                         Fault{"microseconds", [](int, auto& cells) { cells[time] *= 1e6; },
                                               VariantWith<LastsForDays>(Field(&LastsForDays::suspected, TimeUnit::microseconds))},
                                         Fault{"kelvin", [](int, auto& cells) { cells[stator] += 273.15; },
                                               starts_in(TemperatureScale::kelvin, "stator_C", testing::_)},
                                         Fault{"milliampere", [](int, auto& cells) { cells[current] *= 1000.0; },
                                               VariantWith<CurrentTooLarge>(Field(&CurrentTooLarge::channel, "current_A"))},
                                         Fault{"milliseconds", [](int, auto& cells) { cells[time] *= 1000.0; },
                                               VariantWith<LastsForDays>(Field(&LastsForDays::suspected, TimeUnit::milliseconds))},
                                         Fault{"swapped", [](int, auto& cells) { std::swap(cells[winding], cells[stator]); }, swapped()},
                                         Fault{"hot_ambient", [](int, auto& cells) { cells[ambient] += 60.0; },
                                               VariantWith<AmbientAboveMotor>(testing::_)},
                                         Fault{"upside_down", [](int, auto& cells) { cells[winding] = 120.0 - cells[winding]; },
                                               VariantWith<FallsWhileHeated>(Field(&FallsWhileHeated::channel, "winding_C"))}),
                         [](const auto& instance) { return instance.param.name; });

/// Returns a run with other columns than SyntheticLog writes; `row` gives the cells after the time.
std::string run_of(const std::string& columns, std::size_t first, const std::vector<std::pair<double, double>>& rows_C,
                   const std::function<std::string(double winding_C, double stator_C, std::size_t row)>& cells) {
  std::string text = "time_s," + columns + "\n";
  for (std::size_t row = first; row < rows_C.size(); ++row) {
    text += fmt::format("{},{}\n", row, cells(rows_C[row].first, rows_C[row].second, row));
  }
  return text;
}

/// Returns a cool-down after `heated_s` of heating; `columns` sets the order of winding and stator.
std::string cool_down(const char* columns, double heated_s, int rest_s, double stator_offset_K = 0.0) {
  SyntheticLog log;
  log.rows = static_cast<int>(heated_s) + 1 + rest_s;
  log.current_A = [heated_s](double time_s) { return time_s < heated_s ? 8.0 : 0.0; };
  return run_of(fmt::format("{},ambient_C,current_A", columns), static_cast<std::size_t>(heated_s) + 1, log.temperatures_C(),
                [=](double winding_C, double stator_C, std::size_t) {
                  return fmt::format("{:.3f},{:.3f},22,0", winding_C, stator_C + stator_offset_K);
                });
}

class CoolDown : public testing::TestWithParam<std::tuple<double, int, double>> {};

TEST_P(CoolDown, IsSwappedOrNotHoweverLongItsTail) {
  const auto& [heated_s, rest_s, offset_K] = GetParam();
  EXPECT_THAT(read_text(cool_down("stator_C,winding_C", heated_s, rest_s, offset_K)).quality.suspicions, testing::Contains(swapped()));
  EXPECT_THAT(read_text(cool_down("winding_C,stator_C", heated_s, rest_s, offset_K)).quality.suspicions, IsEmpty());
}
INSTANTIATE_TEST_SUITE_P(Synthetic, CoolDown,
                         testing::Combine(testing::Values(60.0, 1500.0), testing::Values(400, 1100, 3000), testing::Values(0.0, 2.0)));

/// The resistance rises with the temperature, and so does the power. During the warm-up the heating rate falls while the power rises, and
/// this must not look like a wrong sign.
TEST(Suspicions, NoneInAWarmUpAtConstantCurrent) {
  SyntheticLog log;
  log.current_A = [](double) { return 6.0; };
  for (const int rows : {240, 900, 1800}) {
    log.rows = rows;
    EXPECT_THAT(read_text(run_of("winding_C,stator_C,ambient_C,power_in_W", 0, log.temperatures_C(),
                                 [](double winding_C, double stator_C, std::size_t) {
                                   return fmt::format("{:.3f},{:.3f},22,{:.3f}", winding_C, stator_C,
                                                      16.2 * (1.0 + 0.0039 * (winding_C - 25.0)));
                                 }))
                    .quality.suspicions,
                IsEmpty())
        << rows;
    EXPECT_THAT(read_text(run_of("winding_C,stator_C,ambient_C,current_A", 0, log.temperatures_C(),
                                 [rows](double winding_C, double stator_C, std::size_t row) {
                                   return fmt::format("{:.3f},{:.3f},22,{:.4f}", winding_C, stator_C,
                                                      6.0 * (1.0 + 0.01 * static_cast<double>(row) / rows));
                                 }))
                    .quality.suspicions,
                IsEmpty())
        << rows;
  }
}

/// Without load the iron is heated, and the stator responds first, to the speed or to a current that correlates with it. The network is
/// mirrored: the part with 60 J/K is heated, the part with 12 J/K follows.
TEST(Suspicions, NoneWhereTheIronIsHeated) {
  for (const int period_s : {40, 80, 150, 300, 600}) {
    const auto turns = [period_s](std::size_t row) {
      return row % static_cast<std::size_t>(period_s) < static_cast<std::size_t>(period_s) / 2;
    };
    std::vector<std::pair<double, double>> rows_C;
    double winding_C = 22.0;
    double stator_C = 22.0;
    base::Random random(5, 0);
    for (std::size_t row = 0; row < 600; ++row) {
      rows_C.emplace_back(winding_C + 0.1 * random.uniform(), stator_C + 0.1 * random.uniform());
      for (int i = 0; i < 100; ++i) {
        const double flow_W = (winding_C - stator_C) / 3.0;
        winding_C -= 0.01 * flow_W / 12.0;
        stator_C += 0.01 * ((turns(row) ? 8.0 : 0.0) + flow_W - (stator_C - 22.0) / 4.0) / 60.0;
      }
    }
    for (const auto& [current_turning_A, current_resting_A] : {std::pair(0.0, 0.0), std::pair(0.3, 0.3), std::pair(0.3, 0.0)}) {
      const double turning_A = current_turning_A;
      const double resting_A = current_resting_A;
      EXPECT_THAT(read_text(run_of("winding_C,stator_C,ambient_C,current_A,speed_rad_per_s", 0, rows_C,
                                   [=](double of_winding_C, double of_stator_C, std::size_t row) {
                                     return fmt::format("{:.3f},{:.3f},22,{},{}", of_winding_C, of_stator_C,
                                                        turns(row) ? turning_A : resting_A, turns(row) ? 500 : 0);
                                   }))
                      .quality.suspicions,
                  IsEmpty())
          << period_s << " s, " << turning_A << " A";
    }
  }
}

/// The temperature has fallen to a room temperature in degrees Fahrenheit when the log starts. A motor at air temperature cannot fall.
TEST(Suspicions, NoneWhereOneSensorStartsWarm) {
  SyntheticLog log;
  log.current_A = [](double time_s) { return time_s < 900.0 ? 8.0 : 0.0; };
  const auto rows_C = log.temperatures_C();
  std::size_t first = 910;
  while (rows_C[first].second > 73.0) {
    ++first;
  }
  for (const bool of_winding : {false, true}) {
    EXPECT_THAT(read_text(run_of(of_winding ? "winding_C,ambient_C,current_A" : "stator_C,ambient_C,current_A", first, rows_C,
                                 [of_winding](double winding_C, double stator_C, std::size_t) {
                                   return fmt::format("{:.3f},22,0", of_winding ? winding_C : stator_C);
                                 }))
                    .quality.suspicions,
                IsEmpty());
  }
}

/// A constant current that no sensor measures must not enter a fit.
TEST(Suspicions, ConstantCurrentBesideAWindingThatRisesAndFallsPreventsAFit) {
  const Read result = read_text(changed({}, [](int, std::vector<double>& cells) { cells[current] = 0.0; }));
  EXPECT_THAT(result.quality.blocking, ElementsAre(VariantWith<ConstantHeatInput>(Field(&ConstantHeatInput::value, 0.0))));
}

/// A warm-up with a commanded current, after which the motor is disconnected, and single wrong samples of the winding.
TEST(Suspicions, NoneAtAConstantCurrentWithOneRiseAndOneFall) {
  SyntheticLog log;
  log.current_A = [](double time_s) { return time_s < 900.0 ? 6.0 : 0.0; };
  EXPECT_THAT(read_text(run_of("winding_C,stator_C,ambient_C,current_A", 0, log.temperatures_C(),
                               [](double winding_C, double stator_C, std::size_t row) {
                                 return fmt::format("{:.3f},{:.3f},22,6", winding_C + (row % 200 == 100 ? 40.0 : 0.0), stator_C);
                               }))
                  .quality.blocking,
              IsEmpty());
}

/// A locked rotor with a constant current, and a fan that is switched: the resistance of the copper changes the difference by a part only.
TEST(Suspicions, NoneAtAConstantCurrentWithAFanThatIsSwitched) {
  std::vector<std::pair<double, double>> rows_C;
  double winding_C = 22.0;
  double stator_C = 22.0;
  for (int row = 0; row < 6000; ++row) {
    rows_C.emplace_back(winding_C, stator_C);
    for (int i = 0; i < 100; ++i) {
      const double flow_W = (winding_C - stator_C) / 4.0;
      winding_C += 0.01 * (0.6 * 16.0 * (1.0 + 0.0039 * (winding_C - 25.0)) - flow_W) / 7.0;
      stator_C += 0.01 * (flow_W - (stator_C - 22.0) * (0.25 + (row % 1200 < 600 ? 0.0 : 0.9))) / 52.0;
    }
  }
  EXPECT_THAT(read_text(run_of("winding_C,stator_C,ambient_C,current_A", 0, rows_C,
                               [](double of_winding_C, double of_stator_C, std::size_t) {
                                 return fmt::format("{:.3f},{:.3f},22,4", of_winding_C, of_stator_C);
                               }))
                  .quality.blocking,
              IsEmpty());
}

/// The motor starts 15 K colder than its surrounding air.
TEST(Suspicions, NoneOfAMotorBroughtInCold) {
  SyntheticLog log;
  log.current_A = [](double time_s) { return time_s < 60.0 ? 0.0 : 1.0; };
  log.rows = 600;
  EXPECT_THAT(read_text(run_of("winding_C,stator_C,ambient_C,current_A", 0, log.temperatures_C(),
                               [&log](double winding_C, double stator_C, std::size_t row) {
                                 const auto time_s = static_cast<double>(row);
                                 const double below_K = 15.0 * std::exp(-time_s / 300.0);
                                 return fmt::format("{:.3f},{:.3f},22,{}", winding_C - below_K, stator_C - below_K, log.current_A(time_s));
                               }))
                  .quality.suspicions,
              IsEmpty());
}

TEST(Suspicions, PowerThatCannotBe) {
  std::string text = "time_s,winding_C,torque_Nm,speed_rad_per_s,power_in_W,bus_V,bus_A\n";
  for (int i = 0; i < 200; ++i) {
    const double power_W = 20.0 + i % 50;
    // 80 % of the power reaches the shaft. The speed is written in rpm, the supply's current in mA.
    text += fmt::format("{},{},{:.4f},{:.3f},{},24,{:.2f}\n", i, 25.0 + 0.1 * i, 0.8 * power_W / 300.0, 300.0 * 9.5493, power_W,
                        1000.0 * power_W / 24.0);
  }
  const Read result = read_text(text);
  EXPECT_THAT(
      result.quality.suspicions,
      testing::Contains(VariantWith<ShaftPowerExceedsInput>(Field(&ShaftPowerExceedsInput::ratio, testing::DoubleNear(7.64, 0.005)))));
  EXPECT_THAT(result.quality.suspicions,
              testing::Contains(VariantWith<PowerDiffersFromBus>(Field(&PowerDiffersFromBus::ratio, testing::DoubleNear(0.001, 5e-7)))));
}

std::vector<Lack> lacks_of(const std::string& text) {
  const Read result = read_text(text);
  EXPECT_EQ(result.quality.thermal.is_good(), result.quality.thermal.lacks.empty());
  return result.quality.thermal.lacks;
}

TEST(Fitness, LogsThatTellNothingAboutHeat) {
  EXPECT_THAT(lacks_of(changed({}, [](int, auto& cells) { cells[winding] = cells[stator] = 25.0; })),
              ElementsAre(VariantWith<TemperatureIsConstant>(
                  AllOf(Field(&TemperatureIsConstant::channel, "winding_C"), Field(&TemperatureIsConstant::value_C, 25.0)))));
  SyntheticLog off;
  off.current_A = [](double) { return 0.0; };
  EXPECT_THAT(lacks_of(off.csv()), testing::Contains(VariantWith<HeatInputIsZero>(Field(&HeatInputIsZero::channel, "current_A"))));
  SyntheticLog shortened;
  shortened.rows = 12;
  EXPECT_THAT(lacks_of(shortened.csv()),
              testing::Contains(VariantWith<TooFewRows>(AllOf(Field(&TooFewRows::rows, 12U), Field(&TooFewRows::needed, 20U)))));
  EXPECT_THAT(lacks_of("time_s,ambient_C,bus_V\n0,20,24\n1,20,24.1\n"), testing::Contains(VariantWith<NoTemperature>(testing::_)));
}

TEST(Suspicions, HaveOneSubjectIfOnlyTheirNumbersDiffer) {
  const Suspicion current = CurrentTooLarge{"current_A", 5010.0};
  EXPECT_TRUE(have_one_subject(current, CurrentTooLarge{"current_A", 4990.0}));
  EXPECT_FALSE(have_one_subject(current, CurrentTooLarge{"bus_A", 5010.0}));
  EXPECT_FALSE(have_one_subject(current, SpeedTooLarge{"current_A", 5010.0}));
  const Suspicion sign = FallsWhileHeated{"winding_C", "current_A"};
  EXPECT_TRUE(have_one_subject(sign, sign));
  EXPECT_FALSE(have_one_subject(sign, FallsWhileHeated{"winding_C", "torque_Nm"}));
  EXPECT_TRUE(have_one_subject(PowerOppositeToBus{}, PowerOppositeToBus{}));
}

/// A stalled motor with constant current from cold, with logged speed.
std::string standing_run(double current_A, bool is_swapped, double speed_rad_per_s, double winding_offset_K) {
  SyntheticLog log;
  log.current_A = [=](double) { return current_A; };
  std::string text = "time_s,winding_C,stator_C,ambient_C,current_A,speed_rad_per_s\n";
  double time_s = 0.0;
  for (const auto& [winding_C, stator_C] : log.temperatures_C()) {
    const double sensor_C = winding_C + winding_offset_K;
    text += fmt::format("{},{:.3f},{:.3f},22,{},{}\n", time_s, is_swapped ? stator_C : sensor_C, is_swapped ? sensor_C : stator_C,
                        current_A, speed_rad_per_s);
    time_s += log.period_s;
  }
  return text;
}

TEST(Suspicions, SwappedAtStandstillUnderOneCurrent) {
  for (const double current_A : {4.0, 5.0, 6.0}) {
    EXPECT_THAT(read_text(standing_run(current_A, true, 0.0, 0.0)).quality.blocking, ElementsAre(swapped()));
    EXPECT_THAT(read_text(standing_run(current_A, false, 0.0, 0.0)).quality.suspicions, IsEmpty());
    // The offset exists from the start. If the motor turns, the iron may heat the stator first.
    EXPECT_THAT(read_text(standing_run(current_A, false, 0.0, -9.0)).quality.suspicions, IsEmpty());
    EXPECT_THAT(read_text(standing_run(current_A, true, 200.0, 0.0)).quality.suspicions, IsEmpty());
  }
}

/// A warm-up of the winding alone, in Celsius or Fahrenheit, with a room temperature stated by the user.
TEST(Suspicions, FahrenheitBesideAStatedRoom) {
  for (const auto& [is_fahrenheit, room_C] :
       {std::pair(true, 22.0), std::pair(true, 18.5), std::pair(false, 22.0), std::pair(false, 40.0)}) {
    std::string text = "time_s,winding_C,current_A\n";
    const SyntheticLog log;
    double time_s = 0.0;
    for (const auto& [winding_C, stator_C] : log.temperatures_C()) {
      text += fmt::format("{},{:.3f},{}\n", time_s, is_fahrenheit ? 1.8 * winding_C + 32.0 : winding_C, log.current_A(time_s));
      time_s += log.period_s;
    }
    const Read result = read_text(text);
    EXPECT_THAT(result.quality.suspicions, IsEmpty()) << "without the room it may be a warm motor";
    const DataQuality beside_room = assess(result.recording, result.report, room_C);
    EXPECT_EQ(beside_room.blocking.size(), is_fahrenheit ? 1U : 0U) << room_C;
  }
}

/// 85 °C would be a room temperature in degrees Fahrenheit.
TEST(Suspicions, ConstantSensorIsNotAskedForItsScale) {
  const Read result = read_text(changed({}, [](int, std::vector<double>& cells) { cells[winding] = 85.0; }));
  EXPECT_THAT(result.quality.suspicions, ElementsAre(VariantWith<ConstantSensor>(Field(&ConstantSensor::channel, "winding_C"))));
  EXPECT_THAT(result.quality.blocking, IsEmpty());
}

/// A log at 60 Hz must not be mistaken for a log in minutes.
TEST(Suspicions, MinutesByRowsThatNoMotorFollows) {
  SyntheticLog fast;
  fast.period_s = 1.0 / 60.0;
  fast.rows = 6000;
  EXPECT_THAT(read_text(changed(fast, [&](int row, std::vector<double>& cells) { cells[time] = row / 60.0; })).quality.suspicions,
              IsEmpty());
  for (const auto& [unit, in_s] : {std::pair(TimeUnit::minutes, 60.0), std::pair(TimeUnit::hours, 3600.0)}) {
    const Read result = read_text(changed({}, [in_s = in_s](int row, std::vector<double>& cells) { cells[time] = row / in_s; }));
    EXPECT_THAT(result.quality.suspicions, ElementsAre(VariantWith<FallsTooFast>(Field(&FallsTooFast::suspected, unit))));
    EXPECT_THAT(result.quality.blocking, IsEmpty());
  }
}

}  // namespace
}  // namespace heatsoak::recording
