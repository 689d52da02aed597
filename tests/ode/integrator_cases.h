// Systems with known solutions, for every method of integration.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "ode/integrator.h"

namespace heatsoak::ode {

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

inline constexpr double kAngular_rad_per_s = 7.0;

inline void oscillate(double /*time_s*/, State y, Values dydt) {
  dydt[0] = kAngular_rad_per_s * y[1];
  dydt[1] = -kAngular_rad_per_s * y[0];
}

/// y' = 1 makes the state equal to the time, so that an event at a value is an event at a time.
inline void run_as_clock(double /*time_s*/, State /*y*/, Values dydt) { dydt[0] = 1.0; }

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
inline double heat_of_piece_W(int piece) { return 6.0 * ((piece * 5) % 7); }

class IntegratorTest : public testing::TestWithParam<OdeMethod> {
 protected:
  static OdeMethod method() { return GetParam(); }
  static bool is_one_step() { return method() == OdeMethod::arkode_erk; }
};

}  // namespace heatsoak::ode
