#include "ode/solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/diagnostic.h"

namespace heatsoak::ode {

OdeSolver::OdeSolver(OdeSystem& system)
    : system_(system), y_(N_VNew_Serial(system.size(), context_), N_VDestroy), crossed_(static_cast<std::size_t>(system.event_count())) {
  N_VConst(0.0, y_.get());
  // The packages clone this vector; fused operations then sum a stage in one pass instead of one per term.
  N_VEnableFusedOps_Serial(y_.get(), SUNTRUE);
}

void OdeSolver::start(double time_s, std::span<const double> y) {
  if (y.size() != state().size()) {
    throw base::Failure(base::ExitCode::bug, fmt::format("start: {} values for {} states", y.size(), state().size()));
  }
  time_s_ = time_s;
  std::ranges::copy(y, values(y_.get()).begin());
  // After a failed run the step size is meaningless for the next one.
  restart(std::exchange(ready_, false) ? StepSize::keep : StepSize::guess);
  ready_ = true;
}

OdeStep OdeSolver::integrate(double stop_s, Stride stride) {
  if (!ready_) {
    throw base::Failure(base::ExitCode::bug, "integrator: start() has to come before a step");
  }
  // Equal times may differ by rounding if they were summed in different orders; no package accepts such a short step.
  constexpr double kShortest_s = 1e-15;
  const double rounding_s = 100.0 * std::numeric_limits<double>::epsilon() * std::max({std::abs(time_s_), std::abs(stop_s), kShortest_s});
  if (!(stop_s > time_s_ + rounding_s)) {
    if (!(stop_s >= time_s_ - rounding_s)) {
      throw base::Failure(base::ExitCode::bug, fmt::format("integrator: stop {} s lies before {} s", stop_s, time_s_));
    }
    time_s_ = stop_s;
    return {.time_s = time_s_, .at_event = false, .crossed = {}};
  }
  ready_ = false;
  // After an event the package may already be past the stop; it then interpolates to the stop.
  const bool to_step = stop_s > internal_time_s();
  if (to_step) {
    set_stop(stop_s);
  }
  const bool at_event = evolve(stop_s, to_step ? stride : Stride::until_stop, time_s_);
  if (at_event) {
    read_crossed(crossed_.data());
  }
  ready_ = true;
  return {.time_s = time_s_, .at_event = at_event, .crossed = at_event ? crossed_ : std::span<const int>()};
}

void OdeSolver::check(int flag) {
  if (thrown_) {
    reason_.clear();
    std::rethrow_exception(std::exchange(thrown_, nullptr));
  }
  if (flag < 0) {
    const std::string reason = reason_.empty() ? fmt::format("SUNDIALS code {}", flag) : reason_;
    reason_.clear();
    throw base::Failure(base::ExitCode::numerics_failed, fmt::format("integration from {} s failed: {}", time_s_, reason));
  }
}

/// Runs `write` and stores an exception for check(), because it must not propagate through C code. A non-finite value counts as one.
template <typename Write>
int OdeSolver::shield(const char* what, double time_s, std::span<double> written, Write write) {
  if (!thrown_) {
    try {
      write();
      for (std::size_t i = 0; i < written.size(); ++i) {
        if (!std::isfinite(written[i])) {
          throw base::Failure(base::ExitCode::numerics_failed,
                              fmt::format("integration failed at {} s: {} {} is {}", time_s, what, i, written[i]));
        }
      }
      return 0;
    } catch (...) {
      thrown_ = std::current_exception();
    }
  }
  // CVODES' fixed-point iteration does not stop at a failed call but retries smaller steps without end (seen in 6.4.1). NaN values fail
  // every convergence test.
  std::ranges::fill(written, std::numeric_limits<double>::quiet_NaN());
  return -1;
}

int OdeSolver::derivative(realtype time_s, N_Vector y, N_Vector dydt, void* self) {
  auto& solver = *static_cast<OdeSolver*>(self);
  ++solver.derivative_count_;
  const std::span<double> written = values(dydt);
  return solver.shield("derivative", time_s, written, [&] { solver.system_.derivative(time_s, values(y), written); });
}

int OdeSolver::events(realtype time_s, N_Vector y, realtype* event_values, void* self) {
  auto& solver = *static_cast<OdeSolver*>(self);
  const std::span<double> written(event_values, solver.crossed_.size());
  return solver.shield("event", time_s, written, [&] { solver.system_.events(time_s, values(y), written); });
}

void OdeSolver::keep_reason(int code, const char* /*module*/, const char* /*function*/, char* message, void* self) {
  auto& solver = *static_cast<OdeSolver*>(self);
  // Positive codes are warnings. The first error is the cause, later ones are its consequences.
  if (code < 0 && solver.reason_.empty()) {
    solver.reason_ = message;
  }
}

}  // namespace heatsoak::ode
