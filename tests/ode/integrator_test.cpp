// Accuracy, stops and cost of the integrators.
#include "ode/integrator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "integrator_cases.h"
#include "support/allocation_counter.h"

namespace heatsoak::ode {
namespace {

// --- accuracy ---------------------------------------------------------------------------------------------

TEST_P(IntegratorTest, decay_follows_the_exponential) {
  TestSystem system(1, [](double, State y, Values dydt) { dydt[0] = -0.8 * y[0]; });
  Integrator integrator(system, method(), {.relative = 1e-9, .absolute = 1e-12});
  integrator.start(2.0, std::array{3.0});

  for (const double time_s : {2.5, 4.0, 7.0}) {
    const OdeStep reached = integrator.advance(time_s);

    EXPECT_EQ(reached.time_s, time_s);
    EXPECT_FALSE(reached.at_event);
    const double exact = 3.0 * std::exp(-0.8 * (time_s - 2.0));
    EXPECT_NEAR(integrator.state()[0] / exact, 1.0, 1e-7) << time_s;
  }
}

TEST_P(IntegratorTest, oscillator_keeps_phase_and_amplitude) {
  TestSystem system(2, oscillate);
  Integrator integrator(system, method(), {.relative = 1e-10, .absolute = 1e-10});
  integrator.start(0.0, std::array{0.0, 1.0});

  integrator.advance(5.0);

  EXPECT_NEAR(integrator.state()[0], std::sin(5.0 * kAngular_rad_per_s), 1e-7);
  EXPECT_NEAR(integrator.state()[1], std::cos(5.0 * kAngular_rad_per_s), 1e-7);
}

TEST_P(IntegratorTest, stepping_arrives_where_advancing_does) {
  TestSystem system(2, oscillate);
  Integrator integrator(system, method(), {.relative = 1e-10, .absolute = 1e-10});
  integrator.start(0.0, std::array{0.0, 1.0});

  int steps = 0;
  for (double before_s = 0.0; integrator.time_s() < 1.0; before_s = integrator.time_s(), ++steps) {
    ASSERT_GT(integrator.step(1.0).time_s, before_s);
    ASSERT_NEAR(integrator.state()[0], std::sin(integrator.time_s() * kAngular_rad_per_s), 1e-7);
  }

  EXPECT_EQ(integrator.time_s(), 1.0);
  EXPECT_GT(steps, 10);
}

TEST_P(IntegratorTest, jumping_input_agrees_with_the_matrix_exponential) {
  TwoBody bodies;
  TestSystem system(2, [&](double, State y, Values dydt) { bodies.derivative(y, dydt); });
  Integrator integrator(system, method(), {.relative = 1e-13, .absolute = 1e-13});
  std::array<double, 2> exact{40.0, 10.0};
  integrator.start(0.0, exact);

  for (int piece = 0; piece < 500; ++piece) {
    bodies.heat_W = heat_of_piece_W(piece);
    exact = bodies.exact(exact, 0.1 * (piece + 1) - 0.1 * piece);
    integrator.start(0.1 * piece, std::vector<double>(integrator.state().begin(), integrator.state().end()));
    integrator.advance(0.1 * (piece + 1));

    ASSERT_NEAR(integrator.state()[0] / exact[0], 1.0, 1e-9) << piece;
    ASSERT_NEAR(integrator.state()[1] / exact[1], 1.0, 1e-9) << piece;
  }
}

TEST_P(IntegratorTest, error_falls_with_the_tolerance) {
  TestSystem system(2, oscillate);
  std::vector<double> error;
  for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
    Integrator integrator(system, method(), {.relative = tolerance, .absolute = tolerance});
    integrator.start(0.0, std::array{0.0, 1.0});
    integrator.advance(3.0);
    error.push_back(
        std::hypot(integrator.state()[0] - std::sin(3.0 * kAngular_rad_per_s), integrator.state()[1] - std::cos(3.0 * kAngular_rad_per_s)));
    EXPECT_LT(error.back(), 1e3 * tolerance);
  }
  for (std::size_t i = 1; i < error.size(); ++i) {
    EXPECT_LT(error[i], 0.1 * error[i - 1]) << i;
  }
}

TEST(ArkodeTest, work_grows_with_the_fifth_root_of_the_tolerance) {
  TestSystem system(2, oscillate);
  std::vector<double> calls;
  for (const double tolerance : {1e-6, 1e-11}) {
    Integrator integrator(system, OdeMethod::arkode_erk, {.relative = tolerance, .absolute = tolerance});
    integrator.start(0.0, std::array{0.0, 1.0});
    integrator.advance(20.0);
    calls.push_back(static_cast<double>(integrator.derivative_count()));
  }

  // The ratio is 10^(5/5) = 10 at order five; order four would give 17.8, order six 6.8.
  EXPECT_NEAR(calls[1] / calls[0], 10.0, 2.0);
}

TEST_P(IntegratorTest, restart_at_a_jump_is_not_less_accurate_than_going_on) {
  TwoBody bodies;
  bodies.heat_W = 30.0;
  const TwoBody idle;
  const auto error_K = [&](bool restarts) {
    TestSystem system(2, [&](double time_s, State y, Values dydt) { (time_s < 1.0 ? bodies : idle).derivative(y, dydt); });
    Integrator integrator(system, method(), {.relative = 1e-7, .absolute = 1e-7});
    integrator.start(0.0, std::array{0.0, 0.0});
    if (restarts) {
      integrator.advance(std::nextafter(1.0, 0.0));
      const std::array y{integrator.state()[0], integrator.state()[1]};
      integrator.start(1.0, y);
    }
    integrator.advance(2.0);
    const std::array<double, 2> exact = idle.exact(bodies.exact({0.0, 0.0}, 1.0), 1.0);
    return std::abs(integrator.state()[0] - exact[0]) + std::abs(integrator.state()[1] - exact[1]);
  };

  EXPECT_LE(error_K(true), error_K(false));
  EXPECT_LT(error_K(true), 1e-5);
}

TEST_P(IntegratorTest, linear_invariant_is_kept_to_rounding) {
  // Heat is only exchanged, so the sum of the states must stay constant at any tolerance.
  TestSystem system(3, [](double, State y, Values dydt) {
    const double first_W = 3.0 * (y[0] - y[1]), second_W = 0.2 * (y[1] - y[2]), third_W = 40.0 * (y[2] - y[0]);
    dydt[0] = third_W - first_W;
    dydt[1] = first_W - second_W;
    dydt[2] = second_W - third_W;
  });
  Integrator integrator(system, method(), {.relative = 1e-6, .absolute = 1e-6});
  std::array y{150.0, 25.0, 90.0};

  for (int piece = 0; piece < 100; ++piece) {
    integrator.start(0.1 * piece, y);
    integrator.advance(0.1 * (piece + 1));
    std::ranges::copy(integrator.state(), y.begin());
    ASSERT_NEAR((y[0] + y[1] + y[2]) / 265.0, 1.0, 1e-12) << piece;
  }
  EXPECT_NEAR(y[0], 265.0 / 3.0, 1e-3);
}

// --- stops ------------------------------------------------------------------------------------------------

TEST_P(IntegratorTest, system_is_never_asked_past_the_stop) {
  TestSystem system(2, oscillate);
  Integrator integrator(system, method(), {});
  std::array y{0.0, 1.0};

  for (const auto& [begin_s, end_s] : {std::pair{0.0, 1e-9}, {1e-9, 0.001}, {0.001, 0.3}, {0.3, 0.3001}}) {
    system.latest_s = begin_s;
    integrator.start(begin_s, y);
    while (integrator.time_s() < end_s) {
      integrator.step(end_s);
    }
    std::ranges::copy(integrator.state(), y.begin());

    EXPECT_EQ(integrator.time_s(), end_s);
    EXPECT_LE(system.latest_s, end_s);
    EXPECT_GT(system.latest_s, begin_s);
  }
  EXPECT_NEAR(y[0], std::sin(0.3001 * kAngular_rad_per_s), 1e-6);
}

TEST_P(IntegratorTest, stop_at_the_current_time_returns_at_once) {
  TestSystem system(1, run_as_clock);
  Integrator integrator(system, method(), {});
  integrator.start(0.3, std::array{7.0});

  EXPECT_EQ(integrator.step(0.3).time_s, 0.3);
  EXPECT_EQ(integrator.advance(0.3).time_s, 0.3);

  EXPECT_EQ(integrator.state()[0], 7.0);
  EXPECT_EQ(integrator.derivative_count(), 0);
}

TEST_P(IntegratorTest, stop_may_be_rounding_away_from_the_current_time) {
  TestSystem system(1, run_as_clock);
  Integrator integrator(system, method(), {});
  for (const double start_s : {0.1 + 0.2, 2399.9, 0.0}) {
    integrator.start(start_s, std::array{start_s});
    for (const double stop_s : {std::nextafter(start_s, 1e9), start_s * (1.0 + 1e-15), start_s * (1.0 - 1e-15)}) {
      EXPECT_EQ(integrator.step(stop_s).time_s, stop_s);
      EXPECT_EQ(integrator.advance(stop_s).time_s, stop_s);
    }
    // Slightly more than rounding, so the integrator must take a step.
    const double near_s = start_s * (1.0 + 1e-13) + 1e-20;
    const long before = integrator.derivative_count();
    EXPECT_EQ(integrator.advance(near_s).time_s, near_s);
    EXPECT_GT(integrator.derivative_count(), before);
    integrator.advance(start_s + 1.0);
    EXPECT_NEAR(integrator.state()[0], start_s + 1.0, 1e-9);
  }
}

TEST_P(IntegratorTest, stop_before_the_current_time_is_a_bug_of_the_caller) {
  TestSystem system(1, run_as_clock);
  Integrator integrator(system, method(), {});
  EXPECT_THROW(integrator.step(1.0), base::Failure);  // no start() yet
  integrator.start(1.0, std::array{0.0});

  EXPECT_THROW(integrator.advance(0.9), base::Failure);
  EXPECT_THROW(integrator.advance(std::numeric_limits<double>::quiet_NaN()), base::Failure);
  EXPECT_THROW(integrator.start(1.0, std::array{0.0, 0.0}), base::Failure);
}

// --- cost -------------------------------------------------------------------------------------------------

TEST_P(IntegratorTest, nothing_is_allocated_after_the_first_step) {
  if (!allocations_are_counted()) {
    GTEST_SKIP() << "malloc cannot be counted here";
  }
  TestSystem system(2, oscillate, 1, [](double, State y, Values values) { values[0] = y[0] - 0.3; });
  Integrator integrator(system, method(), {});
  integrator.start(0.0, std::array{0.0, 1.0});
  integrator.step(0.1);
  const long before = allocation_count();
  ASSERT_GT(before, 0);

  int found = 0;
  std::array y{0.0, 1.0};
  for (int piece = 0; piece < 100; ++piece) {
    integrator.start(0.1 * piece, y);
    while (integrator.time_s() < 0.1 * (piece + 1)) {
      found += integrator.advance(0.1 * (piece + 1)).at_event ? 1 : 0;
    }
    std::ranges::copy(integrator.state(), y.begin());
  }

  // SUNDIALS' difference quotient clones an empty vector, which takes three small blocks. Here each piece has at most two Jacobians.
  EXPECT_LE(allocation_count() - before, method() == OdeMethod::cvodes_bdf ? 100 * 6 : 0);
  EXPECT_EQ(found, 23);  // 70 rad are 11 turns and the twelfth rise, at 69.42 rad
}

TEST(ArkodeTest, a_short_piece_is_one_step) {
  TwoBody bodies;
  TestSystem system(2, [&](double, State y, Values dydt) { bodies.derivative(y, dydt); });
  Integrator integrator(system, OdeMethod::arkode_erk, {});
  std::array y{40.0, 10.0};
  const auto run_piece = [&](int piece, double duration_s) {
    const long before = integrator.derivative_count();
    bodies.heat_W = heat_of_piece_W(piece);
    integrator.start(0.1 * piece, y);
    integrator.advance(0.1 * piece + duration_s);
    std::ranges::copy(integrator.state(), y.begin());
    return integrator.derivative_count() - before;
  };
  run_piece(0, 0.1);  // includes the search for the first step size

  // Dormand-Prince needs six new stages, and a seventh after a restart.
  for (int piece = 1; piece < 100; ++piece) {
    ASSERT_EQ(run_piece(piece, 0.1), 7) << piece;
  }
  // A tiny piece must not leave a tiny step size: a growth of 20 per step recovers quickly.
  run_piece(100, 1e-7);
  EXPECT_LE(run_piece(101, 0.1), 7 + 6 * 6);
  EXPECT_EQ(run_piece(102, 0.1), 7);
}

INSTANTIATE_TEST_SUITE_P(methods, IntegratorTest, testing::Values(OdeMethod::cvodes_bdf, OdeMethod::cvodes_adams, OdeMethod::arkode_erk),
                         [](const testing::TestParamInfo<OdeMethod>& each) -> std::string {
                           switch (each.param) {
                             case OdeMethod::cvodes_bdf:
                               return "cvodes_bdf";
                             case OdeMethod::cvodes_adams:
                               return "cvodes_adams";
                             case OdeMethod::arkode_erk:
                               return "arkode_erk";
                           }
                           return "?";
                         });

}  // namespace
}  // namespace heatsoak::ode
