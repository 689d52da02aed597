// Reference simulation of one network over a sequence of intervals, solved by SUNDIALS.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "ode/integrator.h"
#include "thermal/network.h"

namespace heatsoak::thermal {

/// A time interval with a constant operating point.
struct Interval {
  double duration_s = 0.0;
  OperatingPoint<double> at;
};

struct NodeLimit {
  int node = 0;
  double limit_C = 0.0;
};

/// Above this temperature the motor counts as destroyed: the run ends and reports it.
inline constexpr double kDestroyed_C = 1000.0;

struct TransientOptions {
  ode::OdeMethod method = ode::OdeMethod::arkode_erk;
  ode::OdeTolerances tolerances;
  std::vector<NodeLimit> limits;
  std::vector<double> start_C;  ///< one per state node; empty: ambient of the first interval
  bool with_ledger = false;     ///< also integrate the heat of every effect
};

/// The state at one step of the solver. Both ends of every interval are among the observed moments.
struct TransientMoment {
  double time_s = 0.0;
  std::size_t interval = 0;
  bool begins_interval = false;  ///< first moment of this interval; same time as the end of the previous one
  std::span<const double> state_C;
};

struct TransientResult {
  std::vector<double> end_C;                           ///< per state node
  std::vector<double> peak_C;                          ///< per state node, including maxima between steps; at most kDestroyed_C
  std::vector<double> peak_time_s;                     ///< per state node
  std::vector<std::optional<double>> time_to_limit_s;  ///< per limit: first upward crossing; 0 if over at the start; empty if never
  bool destroyed = false;                              ///< a node exceeded kDestroyed_C at end_s; later intervals were not simulated
  double end_s = 0.0;
  /// Heat in J that effect e booked into node n, at [e · node_count + n]; empty without a ledger.
  std::vector<double> heat_J;
  long derivative_count = 0;
};

using TransientObserver = std::function<void(const TransientMoment&)>;

/// Simulates the intervals one after the other. Throws Failure (numerics_failed) if the solver fails.
TransientResult run_transient(const Network& network, std::span<const double> parameters, std::span<const Interval> intervals,
                              const TransientOptions& options, const TransientObserver& observer = {});

}  // namespace heatsoak::thermal
