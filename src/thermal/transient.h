// The reference: one network over one sequence of intervals, through SUNDIALS.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "ode/integrator.h"
#include "thermal/network.h"

namespace heatsoak {

/// A stretch of time with a constant operating point.
struct Interval {
  double duration_s = 0.0;
  OperatingPoint<double> at;
};

struct NodeLimit {
  int node = 0;
  double limit_C = 0.0;
};

/// Above this nothing of a motor is left: the run ends there and says so.
inline constexpr double kDestroyed_C = 1000.0;

struct TransientOptions {
  OdeMethod method = OdeMethod::arkode_erk;
  OdeTolerances tolerances;
  std::vector<NodeLimit> limits;
  std::vector<double> start_C;  ///< one per state node; empty: ambient of the first interval
  bool with_ledger = false;     ///< integrate the heat of every effect too
};

/// What an observer sees at every step of the solver; both ends of an interval are always among them.
struct TransientMoment {
  double time_s = 0.0;
  std::size_t interval = 0;
  bool begins_interval = false;  ///< the first look at this interval; the same time as the end of the one before
  std::span<const double> state_C;
};

struct TransientResult {
  std::vector<double> end_C;                           ///< per state node
  std::vector<double> peak_C;                          ///< per state node, between the steps too; at most kDestroyed_C
  std::vector<double> peak_time_s;                     ///< per state node
  std::vector<std::optional<double>> time_to_limit_s;  ///< per limit: first crossing from below, located by the solver
  bool destroyed = false;                              ///< a node passed kDestroyed_C at end_s and the rest was not run
  double end_s = 0.0;
  /// With a ledger: heat in J that effect e booked into node n at [e · node_count + n].
  std::vector<double> heat_J;
  long derivative_count = 0;
};

using TransientObserver = std::function<void(const TransientMoment&)>;

/// Throws Failure (numerics_failed) where the solver gives up.
TransientResult run_transient(const Network& network, std::span<const double> parameters, std::span<const Interval> intervals,
                              const TransientOptions& options, const TransientObserver& observer = {});

}  // namespace heatsoak
