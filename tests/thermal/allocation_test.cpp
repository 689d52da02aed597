// The inner loops must not allocate memory, because the same code must be able to run for hours.
#include <gtest/gtest.h>

#include "support/allocation_counter.h"
#include "thermal/ensemble.h"
#include "two_node.h"

namespace heatsoak::thermal {
namespace {

const TwoNode kPlainMotor;

TEST(Allocation, is_seen_at_all) {
  if (!allocations_are_counted()) {
    GTEST_SKIP() << "malloc cannot be counted here";
  }
  const long before = allocation_count();
  const std::vector<double> some(100);
  const std::vector<Lanes> aligned(100);
  EXPECT_EQ(allocation_count(), before + 2) << some.size() << aligned.size();
}

TEST(Allocation, none_in_the_rate_of_a_network) {
  const Network network = kPlainMotor.network();
  const std::vector<double> values = network.values();
  std::vector<double> temperature_C{80.0, 50.0, 25.0};
  std::vector<double> rate(2);
  std::vector<double> balance(12);
  const long before = allocation_count();
  for (int i = 0; i < 100; ++i) {
    network.rate_K_per_s<double>(current_point(3.0), values, temperature_C, rate);
    network.balance_W(current_point(3.0), values, rate, balance);
  }
  EXPECT_EQ(allocation_count(), before);
}

TEST(Allocation, none_in_the_rate_of_lanes_and_in_the_ensemble_run) {
  const Network network = kPlainMotor.network();
  std::vector<Lanes> values;
  for (const double value : network.values()) {
    values.emplace_back(Lanes::Constant(value));
  }
  std::vector<Lanes> temperature_C(3, Lanes::Constant(30.0));
  std::vector<Lanes> rate(2);
  OperatingPoint<Lanes> at;
  at.current_rms_A = Lanes::LinSpaced(0.0, 7.0);
  at.speed_mean_rad_per_s = at.speed_rms_rad_per_s = Lanes::Constant(100.0);
  at.ambient_C = Lanes::Constant(25.0);
  EnsembleRun run(network, values, std::vector<Lanes>(2, Lanes::Constant(25.0)));
  const long before = allocation_count();
  for (int i = 0; i < 100; ++i) {
    network.rate_K_per_s<Lanes>(at, values, temperature_C, rate);
    run.over(10.0, at, 0.1);
  }
  EXPECT_EQ(allocation_count(), before);
}

/// No allocation from the second interval on, with limits and with the ledger.
class TransientAllocation : public testing::TestWithParam<std::tuple<ode::OdeMethod, bool>> {};
INSTANTIATE_TEST_SUITE_P(Methods, TransientAllocation,
                         testing::Combine(testing::Values(ode::OdeMethod::cvodes_adams, ode::OdeMethod::arkode_erk), testing::Bool()));

TEST_P(TransientAllocation, none_after_the_first_interval) {
  const Network network = kPlainMotor.network();
  const std::vector<double> values = network.values();
  const std::vector<Interval> duty = on_off(3.0, 4.0, 6.0, 100);
  TransientOptions options;
  options.method = std::get<0>(GetParam());
  options.with_ledger = std::get<1>(GetParam());
  options.limits = {{0, 48.0}, {1, 34.0}};
  long first = -1;
  long last = -1;
  const TransientResult result = run_transient(network, values, duty, options, [&](const TransientMoment& moment) {
    if (first < 0 && moment.interval == 1) {
      first = allocation_count();
    }
    last = allocation_count();
  });
  EXPECT_EQ(last, first);
  EXPECT_TRUE(result.time_to_limit_s[0].has_value()) << "an event should be among what was run";
}

}  // namespace
}  // namespace heatsoak::thermal
