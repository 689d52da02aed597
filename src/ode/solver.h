// Common part of the CVODES and ARKODE solvers: state, callbacks, events and failures. Private to src/ode.
#pragma once

#include <nvector/nvector_serial.h>

#include <exception>
#include <memory>
#include <span>
#include <string>
#include <sundials/sundials_context.hpp>
#include <vector>

#include "ode/integrator.h"

namespace heatsoak::ode {

/// Owns a SUNDIALS object together with the function that frees it.
template <typename T>
using SundialsHandle = std::unique_ptr<T, void (*)(T*)>;

/// Base class of the solvers, one for each SUNDIALS package. A subclass implements the virtual functions and passes every return flag of
/// its package to check().
class OdeSolver {
 public:
  enum class Stride { one_step, until_stop };

  explicit OdeSolver(OdeSystem& system);
  virtual ~OdeSolver() = default;
  OdeSolver(const OdeSolver&) = delete;
  OdeSolver& operator=(const OdeSolver&) = delete;

  void start(double time_s, std::span<const double> y);
  OdeStep integrate(double stop_s, Stride stride);

  [[nodiscard]] std::span<const double> state() const { return values(y_.get()); }
  [[nodiscard]] double time_s() const { return time_s_; }
  [[nodiscard]] long derivative_count() const { return derivative_count_; }

 protected:
  enum class StepSize { guess, keep };

  /// Starts at time_s() with y(). With `keep` the package may start with its previous step size.
  virtual void restart(StepSize step_size) = 0;
  /// Time that the package has reached internally; after an event it is later than time_s().
  [[nodiscard]] virtual double internal_time_s() const = 0;
  /// Sets a time that the package must not step past.
  virtual void set_stop(double stop_s) = 0;
  /// Integrates and writes y() and `reached_s`. Returns true at an event.
  virtual bool evolve(double stop_s, Stride stride, double& reached_s) = 0;
  virtual void read_crossed(int* crossed) = 0;

  /// Rethrows an exception that the system threw during the call, or throws a Failure if `flag` reports one.
  void check(int flag);

  /// A system that needs more steps in one call of integrate() is stuck and would run for hours.
  static constexpr long kMaximumSteps = 10'000'000;

  [[nodiscard]] SUNContext context() { return context_; }
  /// User data of the callbacks. The conversion to void* must start from OdeSolver.
  [[nodiscard]] void* self() { return this; }
  [[nodiscard]] N_Vector y() { return y_.get(); }
  [[nodiscard]] int event_count() const { return static_cast<int>(crossed_.size()); }

  // All packages use the same callback signatures; `self` is the OdeSolver.
  static int derivative(realtype time_s, N_Vector y, N_Vector dydt, void* self);
  static int events(realtype time_s, N_Vector y, realtype* event_values, void* self);
  static void keep_reason(int code, const char* module, const char* function, char* message, void* self);

 private:
  static std::span<double> values(N_Vector v) { return {N_VGetArrayPointer(v), static_cast<std::size_t>(N_VGetLength(v))}; }
  template <typename Write>
  int shield(const char* what, double time_s, std::span<double> written, Write write);

  OdeSystem& system_;
  sundials::Context context_;
  SundialsHandle<_generic_N_Vector> y_;
  std::vector<int> crossed_;
  double time_s_ = 0.0;
  bool ready_ = false;
  long derivative_count_ = 0;
  std::exception_ptr thrown_;
  std::string reason_;
};

std::unique_ptr<OdeSolver> make_cvodes_solver(OdeSystem& system, OdeMethod method, OdeTolerances tolerances);
std::unique_ptr<OdeSolver> make_arkode_solver(OdeSystem& system, OdeTolerances tolerances);

}  // namespace heatsoak::ode
