// Events of the integrators.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "integrator_cases.h"
#include "ode/integrator.h"

namespace heatsoak::ode {
namespace {

TEST_P(IntegratorTest, each_crossing_is_found_once_at_its_time) {
  TestSystem system(2, oscillate, 1, [](double, State y, Values values) { values[0] = y[0] - 0.3; });
  for (const bool by_step : {false, true}) {
    Integrator integrator(system, method(), {.relative = 1e-11, .absolute = 1e-11});
    integrator.start(0.0, std::array{0.0, 1.0});
    int found = 0;
    while (integrator.time_s() < 5.0) {
      const OdeStep reached = by_step ? integrator.step(5.0) : integrator.advance(5.0);
      if (reached.at_event) {
        const bool rises = found % 2 == 0;
        const int turns = found / 2;
        const double turn_rad = 2.0 * std::numbers::pi * turns;
        const double phase_rad = turn_rad + (rises ? std::asin(0.3) : std::numbers::pi - std::asin(0.3));
        EXPECT_NEAR(reached.time_s, phase_rad / kAngular_rad_per_s, 1e-6);
        EXPECT_EQ(reached.time_s, integrator.time_s());
        EXPECT_NEAR(integrator.state()[0], 0.3, 1e-6);
        ASSERT_EQ(reached.crossed.size(), 1U);
        EXPECT_EQ(reached.crossed[0], rises ? 1 : -1);
        ++found;
      } else {
        EXPECT_TRUE(reached.crossed.empty());
      }
    }
    EXPECT_EQ(found, 12);  // five turns and the crossings of the sixth: 5.0 s * 7 rad/s = 5.57 turns
    EXPECT_NEAR(integrator.state()[0], std::sin(5.0 * kAngular_rad_per_s), 1e-7);
  }
}

/// The clock system with events at 0.3, 0.6 (falling) and, twice, 0.7.
TestSystem clock_with_events() {
  return TestSystem(1, run_as_clock, 4, [](double, State y, Values values) {
    values[0] = y[0] - 0.3;
    values[1] = 0.6 - y[0];
    values[2] = y[0] - 0.7;
    values[3] = 2.0 * (y[0] - 0.7);
  });
}

TEST_P(IntegratorTest, several_events_in_one_step_come_in_order) {
  TestSystem system = clock_with_events();
  for (const bool by_step : {false, true}) {
    Integrator integrator(system, method(), {});
    integrator.start(0.0, std::array{0.0});
    std::vector<double> time_s;
    std::vector<std::vector<int>> crossed;
    while (integrator.time_s() < 100.0) {
      const OdeStep reached = by_step ? integrator.step(100.0) : integrator.advance(100.0);
      if (reached.at_event) {
        time_s.push_back(reached.time_s);
        crossed.emplace_back(reached.crossed.begin(), reached.crossed.end());
      }
    }

    EXPECT_EQ(crossed, (std::vector<std::vector<int>>{{1, 0, 0, 0}, {0, -1, 0, 0}, {0, 0, 1, 1}}));
    ASSERT_EQ(time_s.size(), 3U);
    EXPECT_NEAR(time_s[0], 0.3, 1e-9);
    EXPECT_NEAR(time_s[1], 0.6, 1e-9);
    EXPECT_NEAR(time_s[2], 0.7, 1e-9);
    EXPECT_NEAR(integrator.state()[0], 100.0, 1e-7);
  }
}

TEST_P(IntegratorTest, stop_may_come_nearer_behind_an_event) {
  // The step that found the event at 0.3 may have continued to 100. A stop inside it must still apply.
  TestSystem system = clock_with_events();
  Integrator integrator(system, method(), {});
  integrator.start(0.0, std::array{0.0});
  ASSERT_TRUE(integrator.advance(100.0).at_event);

  const OdeStep between = integrator.step(0.5);
  const OdeStep event = integrator.advance(0.65);
  const OdeStep after = integrator.advance(0.65);

  EXPECT_EQ(between.time_s, 0.5);
  EXPECT_FALSE(between.at_event);
  EXPECT_TRUE(event.at_event);
  EXPECT_NEAR(event.time_s, 0.6, 1e-9);
  EXPECT_EQ(after.time_s, 0.65);
  EXPECT_FALSE(after.at_event);
  EXPECT_NEAR(integrator.state()[0], 0.65, 1e-9);
}

TEST_P(IntegratorTest, start_at_an_event_does_not_find_it_again) {
  TestSystem system(1, run_as_clock, 1, [](double, State y, Values values) { values[0] = y[0] - 0.3; });
  Integrator integrator(system, method(), {});
  integrator.start(0.0, std::array{0.0});
  ASSERT_TRUE(integrator.advance(1.0).at_event);

  const std::array y{integrator.state()[0]};
  integrator.start(integrator.time_s(), y);

  EXPECT_FALSE(integrator.advance(1.0).at_event);
  EXPECT_EQ(integrator.time_s(), 1.0);
}

TEST_P(IntegratorTest, event_on_the_stop_is_not_lost_by_a_restart) {
  TestSystem system(1, run_as_clock, 1, [](double, State y, Values values) { values[0] = y[0] - 1.0; });
  for (const double piece_s : {0.1, 0.25, 1.0}) {
    Integrator integrator(system, method(), {});
    std::array y{0.0};
    int found = 0;
    for (int piece = 0; piece * piece_s < 2.0; ++piece) {
      integrator.start(piece * piece_s, y);
      while (integrator.time_s() < (piece + 1) * piece_s) {
        found += integrator.advance((piece + 1) * piece_s).at_event ? 1 : 0;
      }
      y[0] = integrator.state()[0];
    }
    EXPECT_EQ(found, 1) << piece_s;
  }
}

}  // namespace
}  // namespace heatsoak::ode
