#include "ode/integrator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "support/allocation_counter.h"

namespace heatsoak::ode {
namespace {

using State = std::span<const double>;
using Values = std::span<double>;

/// A system defined by lambdas; it records the latest time of evaluation.
class TestSystem final : public OdeSystem {
 public:
  using Function = std::function<void(double, State, Values)>;

  TestSystem(int size, Function derivative, int event_count = 0, Function events = {})
      : size_(size), derivative_(std::move(derivative)), event_count_(event_count), events_(std::move(events)) {}

  int size() const override { return size_; }
  void derivative(double time_s, State y, Values dydt) override {
    latest_s = std::max(latest_s, time_s);
    derivative_(time_s, y, dydt);
  }
  int event_count() const override { return event_count_; }
  void events(double time_s, State y, Values values) override { events_(time_s, y, values); }

  double latest_s = -std::numeric_limits<double>::infinity();

 private:
  int size_;
  Function derivative_;
  int event_count_;
  Function events_;
};

constexpr double kAngular_rad_per_s = 7.0;

void oscillate(double /*time_s*/, State y, Values dydt) {
  dydt[0] = kAngular_rad_per_s * y[1];
  dydt[1] = -kAngular_rad_per_s * y[0];
}

/// y' = 1 makes the state equal to the time, so that an event at a value is an event at a time.
void run_as_clock(double /*time_s*/, State /*y*/, Values dydt) { dydt[0] = 1.0; }

/// Winding and stator above an ambient of 0. The solution of C y' = heat input and conduction uses exp(A t).
struct TwoBody {
  double capacity_winding_J_per_K = 5.0, capacity_stator_J_per_K = 80.0;
  double resistance_winding_stator_K_per_W = 2.0, resistance_stator_ambient_K_per_W = 3.0;
  double heat_W = 0.0;

  void derivative(State y, Values dydt) const {
    const double inner_W = (y[0] - y[1]) / resistance_winding_stator_K_per_W;
    dydt[0] = (heat_W - inner_W) / capacity_winding_J_per_K;
    dydt[1] = (inner_W - y[1] / resistance_stator_ambient_K_per_W) / capacity_stator_J_per_K;
  }

  /// exp(A t) = e^(m t) (cosh(q t) I + sinh(q t)/q (A - m I)) with m = tr A / 2, q² = m² - det A.
  std::array<double, 2> exact(std::array<double, 2> y, double duration_s) const {
    const double g = 1.0 / resistance_winding_stator_K_per_W, h = 1.0 / resistance_stator_ambient_K_per_W;
    const double a = -g / capacity_winding_J_per_K, b = g / capacity_winding_J_per_K;
    const double c = g / capacity_stator_J_per_K, d = -(g + h) / capacity_stator_J_per_K;
    const double m = 0.5 * (a + d), q = std::sqrt(m * m - (a * d - b * c));
    const double ch = std::exp(m * duration_s) * std::cosh(q * duration_s);
    const double sh = std::exp(m * duration_s) * std::sinh(q * duration_s) / q;
    const std::array<double, 2> rest{heat_W / g + heat_W / h, heat_W / h};
    const double u = y[0] - rest[0], v = y[1] - rest[1];
    return {rest[0] + ch * u + sh * ((a - m) * u + b * v), rest[1] + ch * v + sh * (c * u + (d - m) * v)};
  }
};

/// Pieces of 0.1 s whose heat jumps between 0 and 36 W.
double heat_of_piece_W(int piece) { return 6.0 * ((piece * 5) % 7); }

class IntegratorTest : public testing::TestWithParam<OdeMethod> {
 protected:
  static OdeMethod method() { return GetParam(); }
  static bool is_one_step() { return method() == OdeMethod::arkode_erk; }
};

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

// --- events -----------------------------------------------------------------------------------------------

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

// --- failures ---------------------------------------------------------------------------------------------

struct Thrown : std::logic_error {
  using std::logic_error::logic_error;
  int payload = 42;
};

TEST_P(IntegratorTest, exception_of_the_system_arrives_as_thrown) {
  bool in_derivative = true, armed = true;
  int thrown_count = 0;
  const auto throw_at = [&](double time_s, bool here) {
    if (armed && here && time_s > 0.5) {
      ++thrown_count;
      throw Thrown("no such winding");
    }
  };
  TestSystem system(
      1,
      [&](double time_s, State, Values dydt) {
        throw_at(time_s, in_derivative);
        dydt[0] = std::cos(time_s);
      },
      1,
      [&](double time_s, State, Values values) {
        throw_at(time_s, !in_derivative);
        values[0] = 1.0;
      });
  for (const bool where : {true, false}) {
    in_derivative = where;
    armed = true;
    thrown_count = 0;
    Integrator integrator(system, method(), {});
    integrator.start(0.0, std::array{0.0});
    try {
      integrator.advance(1.0);
      FAIL() << "nothing thrown";
    } catch (const Thrown& thrown) {
      EXPECT_STREQ(thrown.what(), "no such winding");
      EXPECT_EQ(thrown.payload, 42);
    }
    EXPECT_EQ(thrown_count, 1);                            // SUNDIALS may retry, but must not call the system again
    EXPECT_THROW(integrator.advance(1.0), base::Failure);  // requires a new start()

    armed = false;
    integrator.start(0.0, std::array{0.0});
    integrator.advance(1.0);
    EXPECT_NEAR(integrator.state()[0], std::sin(1.0), 1e-6);
  }
}

/// Returns the message of the Failure (numerics_failed) that advance(stop_s) must throw. Nothing may be printed.
std::string failure_of(Integrator& integrator, double stop_s) {
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  std::string message;
  try {
    integrator.advance(stop_s);
    ADD_FAILURE() << "no failure up to " << integrator.time_s() << " s";
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::numerics_failed);
    message = failure.message();
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  return message;
}

TEST_P(IntegratorTest, not_a_number_in_the_derivative_says_when_and_where) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double from_s : {0.0, 0.25}) {
    bool healthy = false;
    TestSystem system(2, [&](double time_s, State, Values dydt) {
      dydt[0] = 1.0;
      dydt[1] = !healthy && time_s >= from_s ? nan : 1.0;
    });
    Integrator integrator(system, method(), {});
    integrator.start(0.0, std::array{0.0, 0.0});

    const std::string message = failure_of(integrator, 0.3);

    EXPECT_NE(message.find("derivative 1 is nan"), std::string::npos) << message;
    EXPECT_NE(message.find(from_s == 0.0 ? "at 0 s" : "at 0.2"), std::string::npos) << message;
    healthy = true;
    integrator.start(0.0, std::array{0.0, 0.0});
    integrator.advance(1.0);
    EXPECT_NEAR(integrator.state()[1], 1.0, 1e-9);
  }
}

TEST_P(IntegratorTest, not_a_number_in_an_event_is_a_failure) {
  TestSystem system(1, run_as_clock, 1, [](double, State y, Values values) { values[0] = std::sqrt(0.5 - y[0]); });
  Integrator integrator(system, method(), {});
  integrator.start(0.0, std::array{0.0});

  const std::string message = failure_of(integrator, 1.0);

  EXPECT_NE(message.find("event 0 is"), std::string::npos) << message;
}

TEST_P(IntegratorTest, solution_that_ends_in_finite_time_is_a_failure) {
  // y' = y² with y(0) = 1 has no solution beyond 1 s.
  TestSystem system(1, [](double, State y, Values dydt) { dydt[0] = y[0] * y[0]; });
  Integrator integrator(system, method(), {});
  integrator.start(0.0, std::array{1.0});

  const std::string message = failure_of(integrator, 2.0);

  EXPECT_TRUE(message.find("0.999") != std::string::npos || message.find("at 1") != std::string::npos) << message;
}

TEST_P(IntegratorTest, start_after_a_failure_keeps_nothing_of_the_failed_run) {
  bool explodes = true;
  TestSystem system(1, [&](double, State y, Values dydt) { dydt[0] = explodes ? y[0] * y[0] : -y[0]; });
  Integrator failed(system, method(), {}), fresh(system, method(), {});
  failed.start(0.0, std::array{1.0});
  failure_of(failed, 2.0);
  explodes = false;
  const long before = failed.derivative_count();

  for (Integrator* each : {&failed, &fresh}) {
    each->start(0.0, std::array{1.0});
    each->advance(1.0);
  }

  EXPECT_EQ(failed.state()[0], fresh.state()[0]);
  EXPECT_EQ(failed.derivative_count() - before, fresh.derivative_count());
}

TEST_P(IntegratorTest, impossible_tolerance_says_so) {
  TestSystem system(1, [](double, State y, Values dydt) { dydt[0] = -y[0]; });
  Integrator integrator(system, method(), {.relative = 1e-18, .absolute = 1e-20});
  integrator.start(0.0, std::array{1.0});

  const std::string message = failure_of(integrator, 1.0);

  EXPECT_NE(message.find("accuracy"), std::string::npos) << message;
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
