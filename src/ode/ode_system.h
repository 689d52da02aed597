// An initial value problem without physical meaning.
#pragma once

#include <span>

namespace heatsoak::ode {

/// dy/dt = f(t, y), with event functions whose zero crossings end a step. Implementations may throw; the integrator passes the exception
/// through the C solver.
class OdeSystem {
 public:
  virtual ~OdeSystem() = default;

  [[nodiscard]] virtual int size() const = 0;
  virtual void derivative(double time_s, std::span<const double> y, std::span<double> dydt) = 0;

  /// Returns the number of event functions; `events` writes one value for each.
  [[nodiscard]] virtual int event_count() const { return 0; }
  virtual void events(double /*time_s*/, std::span<const double> /*y*/, std::span<double> /*values*/) {}
};

}  // namespace heatsoak::ode
