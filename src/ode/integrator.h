// Common interface to the SUNDIALS solvers: start at a discontinuity, then advance to the next one.
#pragma once

#include <memory>
#include <span>

#include "ode/ode_system.h"

namespace heatsoak::ode {

/// cvodes_bdf: for stiff networks. cvodes_adams: for smooth inputs. arkode_erk: an explicit one-step method, Dormand-Prince 5(4). It loses
/// nothing at a restart and is therefore the fastest for inputs with jumps.
enum class OdeMethod { cvodes_bdf, cvodes_adams, arkode_erk };

struct OdeTolerances {
  double relative = 1e-9;
  double absolute = 1e-9;  ///< in the unit of the state
};

/// End of a step. `crossed` has one entry per event: +1 for a rising zero crossing, -1 for a falling one, 0 for none. It is empty unless
/// `at_event`, and valid until the next call.
struct OdeStep {
  double time_s = 0.0;
  bool at_event = false;
  std::span<const int> crossed;
};

class OdeSolver;

/// Integrates one system, which must outlive the integrator. No memory is allocated after the first step, except by cvodes_bdf: SUNDIALS
/// allocates an empty vector for each Jacobian. Throws Failure (numerics_failed) with the time and the solver's reason. Exceptions of the
/// system are passed on unchanged. After either, call start() before the next step.
class Integrator {
 public:
  Integrator(OdeSystem& system, OdeMethod method, OdeTolerances tolerances);
  ~Integrator();
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;

  /// Starts or restarts at `time_s` with the state `y`; call it at every jump of the inputs. arkode_erk keeps its step size, so that a
  /// second run may differ from the first within the tolerances.
  void start(double time_s, std::span<const double> y);

  /// Takes one internal step of a size that the solver chooses, never past `stop_s` (an input may jump there).
  OdeStep step(double stop_s);

  /// Integrates until `stop_s` or the next event, whichever comes first.
  OdeStep advance(double stop_s);

  [[nodiscard]] std::span<const double> state() const;
  [[nodiscard]] double time_s() const;
  /// Returns the number of calls of OdeSystem::derivative so far, for benchmarks and tests.
  [[nodiscard]] long derivative_count() const;

 private:
  std::unique_ptr<OdeSolver> solver_;
};

}  // namespace heatsoak::ode
