// SUNDIALS behind one face: start at a discontinuity, advance to the next one.
#pragma once

#include <memory>
#include <span>

#include "ode/ode_system.h"

namespace heatsoak {

/// cvodes_bdf: stiff networks. cvodes_adams: smooth ones. arkode_erk: an explicit one-step method, which
/// loses nothing at a restart and so is the fastest on inputs that jump (Dormand-Prince 5(4)).
enum class OdeMethod { cvodes_bdf, cvodes_adams, arkode_erk };

struct OdeTolerances {
  double relative = 1e-9;
  double absolute = 1e-9;  ///< in the unit of the state
};

/// Where a step ended. `crossed` holds the events that crossed zero there: +1 rising, -1 falling, 0 not;
/// it is empty unless `at_event`, and valid until the next call.
struct OdeStep {
  double time_s = 0.0;
  bool at_event = false;
  std::span<const int> crossed;
};

class OdeSolver;

/// Integrates one system, which outlives the integrator. After the first step no memory is allocated, but for
/// cvodes_bdf, where SUNDIALS allocates a vector without data for each Jacobian.
/// Failures of the solver are thrown as Failure (numerics_failed) that say the time and the solver's reason;
/// what the system throws arrives as thrown. After either, start() is needed before the next step.
class Integrator {
 public:
  Integrator(OdeSystem& system, OdeMethod method, OdeTolerances tolerances);
  ~Integrator();
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;

  /// Begins, or begins again, at `time_s` with `y`: call it at every jump of the inputs. arkode_erk goes on with the
  /// step size it had reached, so a second run may differ from the first one within the tolerances.
  void start(double time_s, std::span<const double> y);

  /// One internal step of the solver's own choosing, never past `stop_s` (an input may jump there).
  OdeStep step(double stop_s);

  /// Steps until `stop_s` or the next event, whichever is first.
  OdeStep advance(double stop_s);

  [[nodiscard]] std::span<const double> state() const;
  [[nodiscard]] double time_s() const;
  /// Calls of OdeSystem::derivative so far, for benchmarks and tests.
  [[nodiscard]] long derivative_count() const;

 private:
  std::unique_ptr<OdeSolver> solver_;
};

}  // namespace heatsoak
