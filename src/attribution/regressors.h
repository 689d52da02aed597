// Signals that unknown heat may follow, one value per interval of every run.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "estimation/linearised_run.h"
#include "estimation/model.h"

namespace heatsoak::attribution {

enum class RegressorKind {
  operating_point,   ///< quantity of thermal::OperatingPoint
  node_temperature,  ///< simulated temperature of a node
  log_only           ///< other column of the log, or time
};

/// A signal that a curve may depend on.
struct Regressor {
  std::string name;  ///< "speed", "stator_excess", "time", "thrust_N"
  std::string unit;  ///< UDUNITS text; "" for pure numbers
  RegressorKind kind = RegressorKind::operating_point;
  std::vector<Eigen::VectorXd> values;  ///< per run, one value per interval; NaN: not known
  double low = 0.0;                     ///< 1st percentile of the values
  double high = 0.0;                    ///< 99th percentile of the values
  struct Range {
    double low = 0.0;
    double high = 0.0;
  };
  std::vector<Range> inner;  ///< ranges of the middle 80 % and 50 % of the values, if clearly narrower: a curve may need its knots there
  std::string choice;        ///< name of the signal in the effect `tabulated`; empty: not available there
  std::string watched;       ///< node whose temperature it is
  std::string reference;     ///< node that the temperature is relative to
};

/// Name of the signal "time since the start of the recording", in s.
inline constexpr std::string_view kTimeRegressor = "time";

/// Returns the signals that vary over all runs together (1st to 99th percentile) and are not copies of each other.
std::vector<Regressor> regressors_of(const estimation::Model& model, const std::vector<estimation::LinearisedRun>& fitted,
                                     const std::vector<estimation::MeasuredRun>& runs);

}  // namespace heatsoak::attribution
