// Drawn motors keep their limits during driving that the search has not used, simulated by the reference solver.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <limits>
#include <set>
#include <span>

#include "base/diagnostic.h"
#include "derate/barrier.h"
#include "derate/exporter.h"
#include "derate/motor_verdicts.h"
#include "guarded_motor.h"
#include "thermal/transient.h"

namespace heatsoak::derate {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// Ten minutes of random driving, limited by the firmware, as inputs of a network.
std::vector<thermal::Interval> random_driving(const Derating& derating, unsigned seed) {
  std::vector<thermal::Interval> intervals;
  RandomLoad driver(seed);
  ObserverRun<float> run(derating.observer, 0.01F, 40.0F);
  for (int i = 0; i < 6000; ++i) {
    double current2_A2 = 0.0;
    double speed_rad_per_s = 0.0;
    constexpr int kPeriods = 10;
    const RandomLoad::Wish wish = driver.after(0.01 * kPeriods);
    for (int k = 0; k < kPeriods; ++k) {
      speed_rad_per_s = wish.speed_share * derating.rules.most_speed_rad_per_s;
      const float current_A = static_cast<float>(wish.current_share) *
                              derating.table.allowed_A(static_cast<float>(speed_rad_per_s), run.hottest_body_C(), run.state_C()[0]);
      run.step(std::array<float, observed::kSignalCount>{current_A, static_cast<float>(speed_rad_per_s), 40.0F, 0.0F, 40.0F, 0.0F, 0.0F});
      current2_A2 += static_cast<double>(current_A) * static_cast<double>(current_A) / kPeriods;
    }
    thermal::OperatingPoint<double> at;
    at.current_rms_A = std::sqrt(current2_A2);
    at.speed_mean_rad_per_s = at.speed_rms_rad_per_s = speed_rad_per_s;
    at.ambient_C = 40.0;
    intervals.push_back({0.01 * kPeriods, at});
  }
  return intervals;
}

// The search infers whether a motor exceeds a limit from its results at other safety factors. The count must equal that of a check of all
// motors in all uses, in any order of the factors.
TEST(MotorVerdicts, CountIsThatOfACheckOfAllMotorsAndUses) {
  const std::string iron =
      "[effects.iron]\ntype = \"iron_loss_eddy\"\nloss = { value = \"2 W\", origin = \"estimated\", derivation = \"a test\" }\n"
      "exponent = { value = \"2\", origin = \"estimated\", derivation = \"a test\" }\n";
  for (const motor::Motor& motor : {ecx_32(), ecx_32_with(iron)}) {
    const BarrierRules rules = rules_for(motor);
    const GuaranteeOptions options{.samples = 48};
    MotorVerdicts verdicts(motor, rules.limits, options, 0);
    std::set<int> counts;
    for (const double safety_factor : {1.0, 2.0, 1.5, 1.3, 1.4, 1.7, 1.2}) {
      const GuardedMotor guarded(motor, rules, safety_factor);
      const std::vector<LoadPattern> patterns = hardest_patterns(guarded.observer, rules);
      std::vector<UsePlayed> uses;
      for (const LoadPattern& each : patterns) {
        uses.push_back(play(guarded.observer, guarded.table, rules, motor, twente(), std::span(&each, 1), 0.05).front());
      }
      const int over = check(motor, rules.limits, uses, options, 0).over;
      EXPECT_EQ(verdicts.count_over(safety_factor, patterns, [&](std::size_t i) -> const UsePlayed& { return uses[i]; }), over)
          << safety_factor;
      counts.insert(over);
    }
    EXPECT_GT(counts.size(), 3U);  // the safety factors give different counts
  }
}

TEST(Play, UsesTogetherHaveTheBitsOfEachAlone) {
  const motor::Motor motor = ecx_32();
  const BarrierRules rules = rules_for(motor);
  const GuardedMotor guarded(motor, rules, 1.7);
  std::vector<LoadPattern> patterns = hardest_patterns(guarded.observer, rules);
  patterns.resize(base::kLanes);
  const std::vector<UsePlayed> together = play(guarded.observer, guarded.table, rules, motor, twente(), patterns, 0.05);
  ASSERT_EQ(together.size(), patterns.size());
  for (std::size_t i = 0; i < patterns.size(); ++i) {
    const UsePlayed alone = play(guarded.observer, guarded.table, rules, motor, twente(), std::span(&patterns[i], 1), 0.05).front();
    EXPECT_TRUE(together[i].use == patterns[i]) << i;
    EXPECT_EQ(together[i].time_s, alone.time_s) << i;
    EXPECT_EQ(together[i].current_A, alone.current_A) << i;
    EXPECT_EQ(together[i].winding_peak_C, alone.winding_peak_C) << i;
    EXPECT_EQ(together[i].stator_peak_C, alone.stator_peak_C) << i;
  }
}

TEST(ObserverRun, LanesHaveTheBitsOfSinglePrecision) {
  const motor::Motor motor = ecx_32();
  const GuardedMotor guarded(motor, rules_for(motor), 1.7);
  ObserverRun<thermal::SingleLanes> lanes(guarded.observer, thermal::SingleLanes::Constant(0.01F), thermal::SingleLanes::Constant(40.0F));
  std::vector<ObserverRun<float>> scalars(base::kLanes, ObserverRun<float>(guarded.observer, 0.01F, 40.0F));
  base::Random random(11, 0);
  for (int period = 0; period < 2000; ++period) {
    std::array<thermal::SingleLanes, observed::kSignalCount> all;
    for (int lane = 0; lane < base::kLanes; ++lane) {
      std::array<float, observed::kSignalCount> one{};
      for (std::size_t signal = 0; signal < one.size(); ++signal) {
        all[signal][lane] = one[signal] = static_cast<float>(40.0 * random.uniform() - 10.0);
      }
      scalars[static_cast<std::size_t>(lane)].step(one);
    }
    lanes.step(all);
  }
  for (int lane = 0; lane < base::kLanes; ++lane) {
    const ObserverRun<float>& one = scalars[static_cast<std::size_t>(lane)];
    EXPECT_EQ(lanes.hottest_body_C()[lane], one.hottest_body_C()) << lane;
    for (std::size_t state = 0; state < one.state_C().size(); ++state) {
      EXPECT_EQ(lanes.state_C()[state][lane], one.state_C()[state]) << lane;
    }
  }
}

TEST(Derate, DrawnMotorsKeepTheirLimitInDrivingThatTheSearchNeverSaw) {
  const motor::Motor motor = ecx_32();
  const Derating derating = derate(motor, twente(), {});
  EXPECT_LE(derating.guarantee.over, 20) << "of 400";
  int over = 0;
  constexpr int kMotors = 60;
  for (int i = 0; i < kMotors; ++i) {
    base::Random random(4711, static_cast<std::uint64_t>(i));
    const thermal::Network real = motor::datasheet_network(motor, motor::draw_sample(motor, random));
    const thermal::TransientResult result =
        thermal::run_transient(real, real.values(), random_driving(derating, static_cast<unsigned>(i)), {});
    over += result.peak_C[motor::states::winding] > motor.nominal.winding_limit_C ? 1 : 0;
  }
  // Five in a hundred of 60 would be three. Nine or more have a probability of 1/400.
  EXPECT_LE(over, 8);
}

TEST(Derate, NominalParametersAloneAreNotEnough) {
  const motor::Motor motor = ecx_32();
  const Derating derating = derate(motor, twente(), {});
  EXPECT_GT(derating.observer.heat_safety_factor(), 1.2);
  const GuardedMotor bare(motor, derating.rules, 1.0);
  std::vector<UsePlayed> uses;
  for (const LoadPattern& use : hardest_patterns(bare.observer, bare.rules)) {
    uses.push_back(play(bare.observer, bare.table, bare.rules, motor, twente(), std::span(&use, 1), 0.01).front());
  }
  EXPECT_GT(check(motor, derating.rules.limits, uses, {}, 0).over, 100) << "of 400";
}

TEST(Derate, MoreConfidenceAllowsLess) {
  DerateOptions careful;
  careful.guarantee.required_share = 0.99;
  DerateOptions bold;
  bold.guarantee.required_share = 0.7;
  const double more_A = derate(ecx_32(), twente(), bold).table.allowed_A(0.0, 60.0, 140.0);
  const double usual_A = derate(ecx_32(), twente(), {}).table.allowed_A(0.0, 60.0, 140.0);
  const double less_A = derate(ecx_32(), twente(), careful).table.allowed_A(0.0, 60.0, 140.0);
  EXPECT_GT(more_A, 1.05 * usual_A);
  EXPECT_GT(usual_A, 1.05 * less_A);
}

TEST(Derate, SameSeedSameBytesOnAnyNumberOfThreads) {
  DerateOptions one;
  one.guarantee.threads = 1;
  const std::string with_one = all_exporters().front().write(derate(ecx_32(), twente(), one));
  EXPECT_EQ(all_exporters().front().write(derate(ecx_32(), twente(), {})), with_one);
}

TEST(Derate, EffectThatWasFoundActsInObserverAndTable) {
  const motor::Motor plain = ecx_32();
  const motor::Motor soaked = ecx_32_with(R"([effects.chassis]
type = "third_node"
heat_capacity = { value = "60 J/K", origin = "estimated", derivation = "a test" }
conductance = { value = "0.3 W/K", origin = "estimated", derivation = "a test" }
leak_ratio = { value = "0.2", origin = "estimated", derivation = "a test" }
)");
  const GuardedMotor bare(plain, rules_for(plain), 1.0);
  const GuardedMotor with_chassis(soaked, rules_for(soaked), 1.0);
  EXPECT_EQ(bare.observer.state_count(), 2U);
  EXPECT_THAT(std::vector<std::string>(with_chassis.observer.state_names().begin(), with_chassis.observer.state_names().end()),
              ElementsAre("winding", "stator", "chassis"));
  const motor::Motor lossy = ecx_32_with(R"([effects.eddy]
type = "iron_loss_eddy"
loss = { value = "8 W", origin = "estimated", derivation = "a test" }
exponent = { value = "2", origin = "estimated", derivation = "a test" }
)");
  const GuardedMotor with_loss(lossy, rules_for(lossy), 1.0);
  EXPECT_NEAR(barrier_current_A(with_loss.observer, with_loss.rules, 0.0, 120.0, 153.0),
              barrier_current_A(bare.observer, bare.rules, 0.0, 120.0, 153.0), 1e-3);
  const auto lasting_A = [](const GuardedMotor& guarded) {
    ObserverRun<float> run(guarded.observer, 0.01F, 40.0F);
    float allowed_A = 0.0F;
    for (int i = 0; i < 200'000; ++i) {
      allowed_A = guarded.table.allowed_A(300.0F, run.hottest_body_C(), run.state_C()[0]);
      run.step(std::array<float, observed::kSignalCount>{allowed_A, 300.0F, 40.0F, 0.0F, 40.0F, 0.0F, 0.0F});
    }
    return allowed_A;
  };
  EXPECT_LT(lasting_A(with_loss), 0.97F * lasting_A(bare));
}

TEST(Derate, FirmwareIsAskedForWhatALawLooksAt) {
  const motor::Motor plain = ecx_32();
  const motor::Motor blown = ecx_32_with(R"([effects.drive_wind]
type = "vehicle_airflow"
conductance = { value = "0.2 W/K", origin = "estimated", derivation = "a test" }
exponent = { value = "0.5", origin = "estimated", derivation = "a test" }
)");
  const thermal::Network network = motor::datasheet_network(blown, motor::nominal_sample(blown));
  const Observer observer(network, blown.nominal, twente(), 1.0);
  EXPECT_TRUE(observer.uses(observed::vehicle_speed));
  EXPECT_FALSE(observer.uses(observed::age));
  const thermal::Network bare = motor::datasheet_network(plain, motor::nominal_sample(plain));
  EXPECT_FALSE(Observer(bare, plain.nominal, twente(), 1.0).uses(observed::vehicle_speed));
  // The table must not rely on cooling by air flow, because no air flow is guaranteed.
  const GuardedMotor with_wind(blown, rules_for(blown), 1.0);
  const GuardedMotor without(plain, rules_for(plain), 1.0);
  EXPECT_NEAR(barrier_current_A(with_wind.observer, with_wind.rules, 100.0, 100.0, 150.0),
              barrier_current_A(without.observer, without.rules, 100.0, 100.0, 150.0), 1e-3);
}

// Effects that appear only when braking, with a hot neighbour or with an aged contact must have their own cases.
/// The observer has every input, so no law may take one as unknown.
TEST(Derate, ObserverKnowsEveryOptionalInput) {
  const std::array<double, observed::kSignalCount> signals{1.0, 100.0, 30.0, 1.0, 60.0, 10.0, 5.0};
  const thermal::OperatingPoint<double> at = operating_point<double>(ecx_32().nominal, twente(), signals);
  for (std::size_t i = 0; i < observed::kSignalCount; ++i) {
    const thermal::QuantitySet bit = thermal::known_bit(observed::kRows[i]);
    EXPECT_TRUE(at.knows(bit)) << observed::signals()[i].name;
  }
  EXPECT_EQ(at.neighbour_C, 60.0);
}

TEST(Derate, UsesCoverEveryCaseThatALawDistinguishes) {
  const auto cases_of = [](const std::string& lines) {
    const motor::Motor motor = lines.empty() ? ecx_32() : ecx_32_with(lines);
    const GuardedMotor guarded(motor, rules_for(motor), 1.0);
    return hot_cases(guarded.observer, guarded.rules);
  };
  EXPECT_EQ(cases_of("").size(), 1U);
  const std::vector<HotCase> brake = cases_of(R"([effects.brake]
type = "braking_heat"
share = { value = "0.3", origin = "estimated", derivation = "a test" }
)");
  EXPECT_TRUE(std::ranges::any_of(brake, [](const HotCase& each) { return each.current_sign * each.speed_sign < 0.0; }));
  const std::vector<HotCase> neighbour = cases_of(R"([effects.next]
type = "neighbour_coupling"
conductance = { value = "0.1 W/K", origin = "estimated", derivation = "a test" }
)");
  EXPECT_TRUE(std::ranges::any_of(neighbour, [](const HotCase& each) { return each.held[observed::neighbour] == 155.0; }));
  const std::vector<HotCase> hump = cases_of(R"([effects.hump]
type = "tabulated"
driver = "acceleration"
form = "heat"
first_knot = { value = "0 rad/s2", origin = "estimated", derivation = "a test" }
last_knot = { value = "600 rad/s2", origin = "estimated", derivation = "a test" }
value_1 = { value = "0 W", origin = "estimated", derivation = "a test" }
value_2 = { value = "0 W", origin = "estimated", derivation = "a test" }
value_3 = { value = "0 W", origin = "estimated", derivation = "a test" }
value_4 = { value = "5 W", origin = "estimated", derivation = "a test" }
value_5 = { value = "0 W", origin = "estimated", derivation = "a test" }
value_6 = { value = "0 W", origin = "estimated", derivation = "a test" }
value_7 = { value = "0 W", origin = "estimated", derivation = "a test" }
)");
  EXPECT_TRUE(std::ranges::any_of(hump, [](const HotCase& each) { return std::abs(each.held[observed::acceleration] - 300.0) < 20.0; }));
}

// A safety factor for driving alone would let a braking motor exceed its limit.
TEST(Derate, BrakingThatHeatsNeedsMoreOfAReserve) {
  const std::string range = R"(range = ["0.1", "0.8"])";
  const motor::Motor braking = ecx_32_with(fmt::format(R"([effects.brake]
type = "braking_heat"
heated = "winding"
share = {{ value = "0.3", origin = "estimated", derivation = "a test", {} }}
)",
                                                       range));
  const Derating derating = derate(braking, twente(), {});
  const auto braked = std::ranges::find_if(
      derating.uses, [](const UsePlayed& each) { return each.use.hot_case.current_sign < 0.0 && each.use.speed_share > 0.5; });
  ASSERT_NE(braked, derating.uses.end());
  int over = 0;
  constexpr int kMotors = 60;
  for (int i = 0; i < kMotors; ++i) {
    base::Random random(99, static_cast<std::uint64_t>(i));
    const thermal::Network real = motor::datasheet_network(braking, motor::draw_sample(braking, random));
    over += thermal::run_transient(real, real.values(), braked->intervals, {}).peak_C[motor::states::winding] > 155.0 ? 1 : 0;
  }
  EXPECT_LE(over, 8);
}

TEST(Derate, SaysBeyondWhichSpeedNoTableHelps) {
  const motor::Motor windy = ecx_32_with(R"([effects.fan]
type = "windage"
loss = { value = "70 W", origin = "estimated", derivation = "a test" }
)");
  const Derating derating = derate(windy, twente(), {});
  EXPECT_LT(derating.rules.most_speed_rad_per_s, derating.reachable_speed_rad_per_s);
  EXPECT_GT(derating.rules.most_speed_rad_per_s, 0.5 * derating.reachable_speed_rad_per_s);
  for (const UsePlayed& each : derating.uses) {
    EXPECT_LE(each.winding_peak_C, 155.01);
  }
}

// A sufficiently hot body cools again. Before that, its own heat takes the winding over the limit without any current.
TEST(Derate, GuardsNoMotorThatHeatsItselfOnTheWay) {
  const std::string law = hump(R"(driver = "temperature"
hot = "winding"
watched = "stator"
first_knot = { value = "20 degC", origin = "estimated", derivation = "a test" }
last_knot = { value = "155 degC", origin = "estimated", derivation = "a test" }
)",
                               20.0);
  try {
    derate(ecx_32_with(law), twente(), {});
    FAIL() << "no failure";
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::limit_exceeded) << failure.what();
  }
}

TEST(Derate, SaysWhereNoCurrentIsLittleEnough) {
  DerateOptions hot;
  hot.hottest_ambient_C = 154.0;
  motor::Motor motor = ecx_32_with(R"([effects.standby]
type = "constant_heat"
power = { value = "20 W", origin = "estimated", derivation = "a test" }
)");
  try {
    derate(motor, twente(), hot);
    FAIL() << "no failure";
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::limit_exceeded) << failure.what();
    EXPECT_THAT(failure.what(), HasSubstr("155"));
  }
}

TEST(Derate, RefusesAPeriodThatIsTooLongForTheMotor) {
  DerateOptions slow;
  slow.period_s = 0.4;
  EXPECT_THROW(derate(ecx_32(), twente(), slow), base::Failure);
}

// Without a limit of the driver the current that the battery can drive counts; the message must name it, not the period only.
TEST(Derate, NamesTheCurrentThatMakesAPeriodTooLong) {
  motor::Motor motor = ecx_32();
  motor.nominal.terminal_resistance_ohm = 0.05;
  robot::Robot robot = twente();
  robot.drive.current_limit_A.reset();
  try {
    derate(motor, robot, {});
    FAIL() << "no failure";
  } catch (const base::Failure& failure) {
    EXPECT_THAT(failure.what(), HasSubstr("too long"));
    EXPECT_THAT(failure.what(), HasSubstr("The robot has no current_limit, and its battery can drive"));
  }
}

// With a longer approach a hotter winding would be allowed more current.
TEST(Derating, RefusesAnApproachThatIsSlowerThanTheWinding) {
  DerateOptions options;
  options.approach_s = 1.01 * ecx_32().nominal.thermal_time_constant_winding_s;
  EXPECT_THROW(derate(ecx_32(), twente(), options), base::Failure);
}

}  // namespace
}  // namespace heatsoak::derate
