// Compares the guard's search over the candidate values of an unknown signal with a search over many values.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <random>
#include <vector>

#include "derate/guarded_motor.h"
#include "firmware/host_guard.h"

namespace heatsoak::firmware {
namespace {

constexpr int kSearched = 33;

class Uniform {
 public:
  explicit Uniform(unsigned seed) : engine_(seed) {}
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }

 private:
  std::mt19937_64 engine_;
};

/// Returns random inputs of the observer's formula: signals, then temperatures.
std::vector<float> random_place(const derate::Observer& observer, const derate::BarrierRules& rules, Uniform& uniform) {
  std::vector<float> place;
  for (const auto& [low, high] : std::initializer_list<std::pair<double, double>>{{-rules.most_current_A, rules.most_current_A},
                                                                                  {-rules.most_speed_rad_per_s, rules.most_speed_rad_per_s},
                                                                                  {0.0, 60.0},
                                                                                  {0.0, rules.most_vehicle_speed_m_per_s},
                                                                                  {20.0, 160.0},
                                                                                  {0.0, 10000.0},
                                                                                  {0.0, 5000.0}}) {
    place.push_back(static_cast<float>(uniform.between(low, high)));
  }
  for (std::size_t node = 0; node < observer.state_count(); ++node) {
    place.push_back(static_cast<float>(uniform.between(0.0, rules.limits.winding_C + 10.0)));
  }
  return place;
}

/// Returns the highest rate of each node over the values.
std::vector<float> hottest(thermal::FormulaRun<float>& run, std::vector<float> place, derate::observed::Signal signal,
                           const std::vector<double>& values, std::size_t nodes) {
  std::vector<float> most(nodes, -std::numeric_limits<float>::infinity());
  std::vector<float> rate(nodes);
  for (const double value : values) {
    place[signal] = static_cast<float>(value);
    run.run(place, rate);
    std::ranges::transform(most, rate, most.begin(), [](float a, float b) { return std::max(a, b); });
  }
  return most;
}

void expect_as_hot(const derate::Observer& observer, const derate::BarrierRules& rules, const std::string& text) {
  thermal::FormulaRun<float> run(observer.formula(), observer.rate_steps());
  Uniform uniform(5);
  for (const derate::observed::Signal signal : {derate::observed::current, derate::observed::speed}) {
    const double most = signal == derate::observed::current ? rules.most_current_A : rules.most_speed_rad_per_s;
    const std::vector<double> few = derate::values_if_unknown(observer, rules, signal);
    for (int i = 0; i < 4000; ++i) {
      const std::vector<float> place = random_place(observer, rules, uniform);
      const std::vector<float> found = hottest(run, place, signal, few, observer.state_count());
      const std::vector<float> searched = hottest(run, place, signal, derate::evenly(-most, most, kSearched), observer.state_count());
      for (std::size_t node = 0; node < found.size(); ++node) {
        ASSERT_GE(found[node], searched[node]) << text << ", " << derate::observed::signals()[signal].name << ", node " << node;
      }
    }
  }
}

TEST(UnknownSignal, HeatsEveryShippedMotorAsMuchAsAnyValueOfALongSearch) {
  for (const auto& entry : std::filesystem::directory_iterator(kSource / "motor_db")) {
    if (entry.path().extension() != ".toml") {
      continue;
    }
    const motor::Motor motor = motor::read_motor(entry.path());
    const thermal::Network network = motor::datasheet_network(motor, motor::nominal_sample(motor));
    expect_as_hot(derate::Observer(network, motor.nominal, twente(), 1.5), derate::rules_for(motor), entry.path().stem().string());
  }
}

TEST(UnknownSignal, HeatsAsMuchIfTheHottestSpeedDependsOnTheTemperature) {
  const motor::Motor motor =
      derate::ecx_32_with(derate::hump("driver = \"speed\"\nhot = \"stator\"\n"
                                       "first_knot = { value = \"0 rad/s\", origin = \"estimated\", derivation = \"a test\" }\n"
                                       "last_knot = { value = \"400 rad/s\", origin = \"estimated\", derivation = \"a test\" }\n",
                                       1.0) +
                          "[effects.fan]\ntype = \"speed_dependent_convection\"\n"
                          "conductance = { value = \"0.04 W/K\", origin = \"estimated\", derivation = \"a test\" }\n"
                          "exponent = { value = \"0.5\", origin = \"estimated\", derivation = \"a test\" }\n");
  const thermal::Network network = motor::datasheet_network(motor, motor::nominal_sample(motor));
  const derate::Observer observer(network, motor.nominal, twente(), 1.5);
  EXPECT_GT(derate::values_if_unknown(observer, derate::rules_for(motor), derate::observed::speed).size(), 2U);
  expect_as_hot(observer, derate::rules_for(motor), "hump");
}

// The flow to the air reverses with the temperatures, so no single speed heats every node most. Both ends of the range together do.
TEST(UnknownSignal, OfACoolingWindLeavesItsTwoEnds) {
  const motor::Motor motor = derate::ecx_32_with(
      "[effects.wind]\ntype = \"vehicle_airflow\"\n"
      "conductance = { value = \"0.03 W/K\", origin = \"estimated\", derivation = \"a test\" }\n"
      "exponent = { value = \"0.5\", origin = \"estimated\", derivation = \"a test\" }\n");
  const thermal::Network network = motor::datasheet_network(motor, motor::nominal_sample(motor));
  const derate::Observer observer(network, motor.nominal, twente(), 1.5);
  const derate::BarrierRules rules = derate::rules_for(motor);
  ASSERT_TRUE(observer.uses(derate::observed::vehicle_speed));
  const std::vector<double> few = derate::values_if_unknown(observer, rules, derate::observed::vehicle_speed);
  EXPECT_EQ(few, (std::vector<double>{0.0, rules.most_vehicle_speed_m_per_s}));
  thermal::FormulaRun<float> run(observer.formula(), observer.rate_steps());
  Uniform uniform(7);
  for (int i = 0; i < 4000; ++i) {
    const std::vector<float> place = random_place(observer, rules, uniform);
    const auto most = [&](const std::vector<double>& values) {
      return hottest(run, place, derate::observed::vehicle_speed, values, observer.state_count());
    };
    EXPECT_EQ(most(few), most(derate::evenly(0.0, rules.most_vehicle_speed_m_per_s, kSearched))) << i;
  }
}

// The drive core's own search: never a higher current than with all values.
TEST(UnknownSignal, GuardAllowsNoMoreCurrentThanWithALongSearch) {
  const derate::GuardedMotor guarded(ecx_32(), derate::rules_for(ecx_32()), 1.5);
  const HostGuard guard(derate::derating_of(guarded));
  EXPECT_EQ(guard.model().plausible_range[robot_core::guard_speed_rad_per_s].possible_count, 1);
  robot_core::GuardModel searching = guard.model();
  std::vector<float> currents;
  std::vector<float> speeds;
  for (const double share : derate::evenly(-1.0, 1.0, kSearched)) {
    currents.push_back(static_cast<float>(share * guarded.rules.most_current_A));
    speeds.push_back(static_cast<float>(share * guarded.rules.most_speed_rad_per_s));
  }
  const auto search = [&](int signal, const std::vector<float>& values) {
    searching.plausible_range[signal].possible = values.data();
    searching.plausible_range[signal].possible_count = static_cast<int>(values.size());
  };
  search(robot_core::guard_current_A, currents);
  search(robot_core::guard_speed_rad_per_s, speeds);
  robot_core::GuardState few;
  robot_core::GuardState all;
  robot_core::start_guard(guard.model(), few, 30.0F);
  robot_core::start_guard(searching, all, 30.0F);
  Uniform uniform(6);
  for (int step = 0; step < 100000; ++step) {
    const double unknown = uniform.between(0.0, 1.0);
    float signal[robot_core::kGuardSignals] = {};
    signal[robot_core::guard_current_A] = static_cast<float>(unknown < 0.002 ? NAN : uniform.between(-6.0, 6.0));
    signal[robot_core::guard_speed_rad_per_s] = static_cast<float>(unknown < 0.3 ? NAN : uniform.between(-400.0, 400.0));
    signal[robot_core::guard_ambient_C] = static_cast<float>(unknown < 0.1 ? NAN : 25.0);
    const robot_core::GuardOutput found = robot_core::step_guard(guard.model(), few, signal, 2.0F);
    const robot_core::GuardOutput searched = robot_core::step_guard(searching, all, signal, 2.0F);
    ASSERT_LE(found.allowed_A, searched.allowed_A) << step;
    ASSERT_GE(few.state_C[0], all.state_C[0]) << step;
    ASSERT_GE(few.state_C[1], all.state_C[1]) << step;
  }
}

}  // namespace
}  // namespace heatsoak::firmware
