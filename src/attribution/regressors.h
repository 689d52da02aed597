// Signals that an unknown heat might follow, along the intervals of every run.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "estimation/linearised_run.h"
#include "estimation/model.h"

namespace heatsoak {

/// What a driver is to the rest of the tool: what every operating point has, a temperature, or what only logs have.
enum class DriverKind { operating_point, node_temperature, log_only };

struct Regressor {
  std::string name;  ///< "speed", "stator_excess", "time", "thrust_N"
  std::string unit;  ///< UDUNITS text, "" for pure numbers
  DriverKind kind = DriverKind::operating_point;
  std::vector<Eigen::VectorXd> values;  ///< per run one per interval, in the driver's unit; NaN: not known there
  double low = 0.0;                     ///< 1 % of the time is below
  double high = 0.0;                    ///< 1 % of the time is above
  struct Range {
    double low = 0.0;
    double high = 0.0;
  };
  std::vector<Range> inner;  ///< where it is in the middle 80 % and 50 % of the time: a curve may need its knots there
  std::string choice;        ///< what the effect `tabulated` calls it; empty where it cannot follow it
  std::string watched;       ///< node that a temperature is of
  std::string reference;     ///< node that it is above
};

/// Seconds since a run's begin.
inline constexpr std::string_view kTimeDriver = "time";

/// What varies enough to be described from a constant, without copies of each other.
std::vector<Regressor> drivers_of(const Model& model, const std::vector<LinearisedRun>& fitted, const std::vector<MeasuredRun>& runs);

}  // namespace heatsoak
