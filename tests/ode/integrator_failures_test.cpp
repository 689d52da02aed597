// Failures of the integrators.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "base/diagnostic.h"
#include "integrator_cases.h"
#include "ode/integrator.h"

namespace heatsoak::ode {
namespace {

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

}  // namespace
}  // namespace heatsoak::ode
