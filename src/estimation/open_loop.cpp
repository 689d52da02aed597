#include "estimation/open_loop.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "estimation/thresholds.h"
#include "motor/datasheet_network.h"

namespace heatsoak::estimation {

namespace {

/// True for a body of an effect if the winding has a sensor, so that no part of the motor is much warmer than the sensors.
bool is_bounded_body(Eigen::Index node, const MeasuredRun& run) { return node >= motor::states::first_own && run.sensor_at("winding"); }

}  // namespace

RunStart start_of(const thermal::Network& network, const MeasuredRun& run) {
  const Eigen::Index states = network.state_count();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kSensed_K = 5.0;
  constexpr double kBody_K = 2.0;  // difference between parts of a motor at rest
  const double ambient_C = run.at.front().ambient_C;
  RunStart start{Eigen::VectorXd::Constant(states, nan), {}, Eigen::VectorXd::Constant(states, kSensed_K)};
  double sum_C = 0.0;
  int seen = 0;
  for (std::size_t sensor = 0; sensor < run.sensors.size(); ++sensor) {
    const auto sensor_C = run.measured_C.col(static_cast<Eigen::Index>(sensor));
    const auto first = std::ranges::find_if(sensor_C, [](double value_C) { return !std::isnan(value_C); });
    if (const std::optional<int> node = network.find_node(run.sensors[sensor].node); node && *node < states && first != sensor_C.end()) {
      const double true_C = motor::true_at_rest_C(run.sensors[sensor].faults, *first);
      start.state_C[*node] = true_C;
      sum_C += true_C;
      ++seen;
    }
  }
  for (Eigen::Index node = 0; node < states; ++node) {
    if (std::isnan(start.state_C[node])) {
      const double sensors_C = seen > 0 ? sum_C / seen : ambient_C;
      const double above_K = std::abs(sensors_C - ambient_C);
      // The motor may just have been used. If the winding, its warmest part, has a sensor, a body of an effect is between it and ambient.
      const bool is_body = is_bounded_body(node, run);
      start.state_C[node] = is_body ? 0.5 * (sensors_C + ambient_C) : sensors_C;
      start.prior_sd_K[node] = is_body ? kBody_K + above_K / std::sqrt(12.0) : kSensed_K + above_K;
    }
  }
  start.prior_C = start.state_C;
  return start;
}

namespace {

constexpr Eigen::Index kFew = 5;  ///< samples that determine the start of nodes with a sensor

/// Returns the number of samples that determine the start: kFew, or more if a state node has no sensor, since its temperature shows later.
Eigen::Index deciding_samples(const thermal::Network& network, const MeasuredRun& run) {
  bool all_are_sensed = true;
  for (int node = 0; node < network.state_count(); ++node) {
    all_are_sensed = all_are_sensed && run.sensor_at(network.node_name(node));
  }
  if (all_are_sensed) {
    return kFew;
  }
  constexpr double kMost_share = 0.1;
  const double until_s = run.time_s.front() + std::min(thresholds().slow_s, kMost_share * (run.time_s.back() - run.time_s.front()));
  return std::max<Eigen::Index>(kFew, std::ranges::upper_bound(run.time_s, until_s) - run.time_s.begin());
}

MeasuredRun beginning_of(const MeasuredRun& run, Eigen::Index samples) {
  MeasuredRun part = run;
  part.time_s.resize(static_cast<std::size_t>(samples));
  part.at.resize(static_cast<std::size_t>(samples - 1));
  part.measured_C = run.measured_C.topRows(samples);
  return part;
}

}  // namespace

namespace {

struct Estimate {
  Eigen::VectorXd value;
  Eigen::MatrixXd covariance;
};

/// Linear least squares with a normal prior of mean `expected` and the given precision. Rows of weight 0 do not count.
Estimate least_squares(const Eigen::MatrixXd& columns, const Eigen::VectorXd& residual, const Eigen::VectorXd& weights,
                       const Eigen::VectorXd& expected, const Eigen::VectorXd& precision) {
  const Eigen::MatrixXd weighted = weights.asDiagonal() * columns;
  Eigen::MatrixXd normal = columns.transpose() * weighted;
  normal.diagonal() += precision;
  Estimate estimate;
  estimate.covariance = normal.ldlt().solve(Eigen::MatrixXd::Identity(normal.rows(), normal.cols()));
  estimate.value = estimate.covariance * (weighted.transpose() * residual + precision.cwiseProduct(expected));
  return estimate;
}

/// Returns the sum over the samples for each sensor. `rows` has the values of all sensors at the first sample, then at the second.
Eigen::VectorXd sum_by_sensor(const Eigen::VectorXd& rows, Eigen::Index sensors) {
  return rows.reshaped(sensors, rows.size() / sensors).rowwise().sum();
}

/// Returns the change of each predicted reading since the first sample: in the column of its sensor, with 0 in the other columns.
Eigen::MatrixXd changes_K(const LinearisedRun& path) {
  Eigen::MatrixXd changes = Eigen::MatrixXd::Zero(path.residual_K.size(), path.sensors());
  for (Eigen::Index row = 0; row < changes.rows(); ++row) {
    const Eigen::Index sensor = row % path.sensors();
    changes(row, sensor) = path.sensor_C(row / path.sensors(), sensor) - path.sensor_C(0, sensor);
  }
  return changes;
}

}  // namespace

DecidedStart decided_start(const thermal::Network& network, const RunStart& start, const MeasuredRun& run, const RunFrom& along) {
  // No model predicts the first seconds better than this; with less noise, its error would distort unmeasured nodes.
  constexpr double kLeastNoise_K = 0.3;
  const MeasuredRun beginning = beginning_of(run, std::min(run.samples(), deciding_samples(network, run)));
  const LinearisedRun path = along({start.state_C.data(), static_cast<std::size_t>(start.state_C.size())}, beginning);
  const Eigen::VectorXd known = path.residual_K.array().isNaN().select(Eigen::VectorXd::Zero(path.residual_K.size()), 1.0);
  const Eigen::VectorXd residual_K = path.residual_K.array().isNaN().select(0.0, path.residual_K);
  Eigen::VectorXd noise_K2(path.sensors());
  for (Eigen::Index sensor = 0; sensor < path.sensors(); ++sensor) {
    noise_K2[sensor] = std::pow(std::max(kLeastNoise_K, run.sensors[static_cast<std::size_t>(sensor)].noise_K), 2);
  }
  const auto weights = [&](const Eigen::VectorXd& variance_K2) {
    return Eigen::VectorXd(known.cwiseQuotient(variance_K2.replicate(beginning.samples(), 1)));
  };
  const Eigen::VectorXd expected_K = start.prior_C - start.state_C;
  const Eigen::VectorXd precision = start.prior_sd_K.cwiseAbs2().cwiseInverse();
  const Estimate independent = least_squares(path.by_start, residual_K, weights(noise_K2), expected_K, precision);
  if (!is_bounded_body(network.state_count() - 1, run)) {
    return {start.state_C + independent.value, independent.covariance};
  }
  // The start of a body must not compensate for errors of the model. A misfit beyond the noise is correlated in time, so all readings of a
  // sensor together have the weight of five. The factor on the predicted change represents errors that leave no misfit.
  constexpr double kChange_sd = 0.1;  // losses are rarely known to better than 10 %
  const Eigen::VectorXd left_K = residual_K - path.by_start * independent.value;
  const Eigen::VectorXd readings = sum_by_sensor(known, path.sensors()).cwiseMax(1.0);
  const Eigen::VectorXd mean_square_K2 = sum_by_sensor(left_K.cwiseAbs2().cwiseProduct(known), path.sensors()).cwiseQuotient(readings);
  const Eigen::VectorXd per_few = (readings / static_cast<double>(kFew)).cwiseMax(1.0);
  const Eigen::VectorXd variance_K2 = noise_K2 + (mean_square_K2 - noise_K2).cwiseMax(0.0).cwiseProduct(per_few);
  const Eigen::Index states = start.state_C.size();
  Eigen::MatrixXd columns(residual_K.size(), states + path.sensors());
  columns << path.by_start, changes_K(path);
  Eigen::VectorXd expected(columns.cols());
  expected << expected_K, Eigen::VectorXd::Zero(path.sensors());
  Eigen::VectorXd all_precision(columns.cols());
  all_precision << precision, Eigen::VectorXd::Constant(path.sensors(), 1.0 / (kChange_sd * kChange_sd));
  const Estimate found = least_squares(columns, residual_K, weights(variance_K2), expected, all_precision);
  return {start.state_C + found.value.head(states), found.covariance.topLeftCorner(states, states)};
}

Eigen::VectorXd decided_start_C(const thermal::Network& network, const RunStart& start, const MeasuredRun& run, const RunFrom& along) {
  return decided_start(network, start, run, along).state_C;
}

Eigen::MatrixXd open_loop_C(const thermal::Network& network, std::span<const double> parameters, const MeasuredRun& run) {
  const std::vector<int> none;
  const RunFrom along = [&](std::span<const double> start_C, const MeasuredRun& part) {
    return linearise(network, parameters, none, none, start_C, part);
  };
  const Eigen::VectorXd start_C = decided_start_C(network, start_of(network, run), run, along);
  return along({start_C.data(), static_cast<std::size_t>(start_C.size())}, run).sensor_C;
}

double standard_deviation_K(std::span<const MeasuredRun> runs, std::string_view signal) {
  double sum_C = 0.0;
  double squares_C2 = 0.0;
  double count = 0.0;
  for (const MeasuredRun& run : runs) {
    const auto sensor = std::ranges::find(run.sensors, signal, &Sensor::signal);
    if (sensor == run.sensors.end()) {
      continue;
    }
    for (const double each_C : run.measured_C.col(sensor - run.sensors.begin())) {
      if (!std::isnan(each_C)) {
        sum_C += each_C;
        squares_C2 += each_C * each_C;
        count += 1.0;
      }
    }
  }
  return std::sqrt(std::max(0.0, squares_C2 / count - sum_C * sum_C / (count * count)));
}

}  // namespace heatsoak::estimation
