#include "estimation/model_screening.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "estimation/smoothed_path.h"
#include "estimation/thresholds.h"
#include "estimation/whitening.h"

namespace heatsoak::estimation {
namespace {

/// Sequence of equal readings of one sensor; `samples` are indices in the run.
struct EqualReadings {
  Eigen::Index sensor = 0;
  std::vector<Eigen::Index> samples;
};

std::vector<EqualReadings> equal_readings(const MeasuredRun& run) {
  // Averages of equal values may differ by rounding.
  constexpr double kEqual_K = 1e-9;
  std::vector<EqualReadings> all;
  for (Eigen::Index sensor = 0; sensor < run.measured_C.cols(); ++sensor) {
    EqualReadings now{sensor, {}};
    double value_C = 0.0;
    const auto close = [&] {
      if (static_cast<double>(now.samples.size()) >= thresholds().least_equal_count) {
        all.push_back(now);
      }
      now.samples.clear();
    };
    for (Eigen::Index k = 0; k < run.samples(); ++k) {
      const double reading_C = run.measured_C(k, sensor);
      if (std::isnan(reading_C)) {
        continue;
      }
      if (!now.samples.empty() && std::abs(reading_C - value_C) > kEqual_K) {
        close();
      }
      value_C = reading_C;
      now.samples.push_back(k);
    }
    close();
  }
  return all;
}

/// Expected readings (n × s, in °C): those of the free run, shifted by the smoother's correction of their nodes.
Eigen::MatrixXd smoothed_C(const LinearisedRun& run, const LatentFlux& flux, const SensorNoise& noise) {
  const Eigen::MatrixXd path_C = smoothed_path_C(run, flux, noise);
  Eigen::MatrixXd sensor_C = run.sensor_C;
  for (Eigen::Index sensor = 0; sensor < run.sensors(); ++sensor) {
    const int node = run.sensor_node[static_cast<std::size_t>(sensor)];
    sensor_C.col(sensor) += (path_C.row(node) - run.state_C.row(node)).transpose();
  }
  return sensor_C;
}

double log_normal_between(double low, double high) {
  constexpr double kLeast = 1e-300;
  const double root = std::sqrt(0.5);
  // Use the nearer tail to avoid cancellation.
  const double probability =
      low > 0.0 ? 0.5 * (std::erfc(low * root) - std::erfc(high * root)) : 0.5 * (std::erfc(-high * root) - std::erfc(-low * root));
  return std::log(std::max(kLeast, probability));
}

/// ln P that all these readings are one value, maximised over a shift of the prediction with standard deviation `shift_sd_K`.
double equal_nats(const EqualReadings& equal, const MeasuredRun& run, const Eigen::MatrixXd& sensor_C, double shift_sd_K) {
  constexpr double kSmallest_K = 1e-3;
  constexpr int kShifts = 30;
  constexpr double kFarthest_sd = 3.0;
  const Sensor& sensor = run.sensors[static_cast<std::size_t>(equal.sensor)];
  const double step_K = std::max(kSmallest_K, sensor.step_K);
  const double white_K = std::sqrt(std::max(0.01 * step_K * step_K, sensor.noise_K * sensor.noise_K - step_K * step_K / 12.0));
  double best_nats = -std::numeric_limits<double>::infinity();
  for (int i = -kShifts; i <= kShifts; ++i) {
    const double shift_K = kFarthest_sd * shift_sd_K * i / kShifts;
    double nats = -0.5 * shift_K * shift_K / (shift_sd_K * shift_sd_K);
    for (const Eigen::Index k : equal.samples) {
      const double off_K = run.measured_C(k, equal.sensor) - sensor_C(k, equal.sensor) - shift_K;
      nats += log_normal_between((off_K - 0.5 * step_K) / white_K, (off_K + 0.5 * step_K) / white_K);
    }
    best_nats = std::max(best_nats, nats);
  }
  return best_nats;
}

void hide(const EqualReadings& equal, Eigen::Index sensors, double weight, Eigen::VectorXd& weights) {
  for (const Eigen::Index k : equal.samples) {
    weights[k * sensors + equal.sensor] = weight;
  }
}

/// Returns the row of the sensor's next accepted sample, or of the one before if none follows; −1 if there is neither.
Eigen::Index neighbour(Eigen::Index row, const Eigen::VectorXd& residual_K, Eigen::Index sensors, const Eigen::VectorXd& weight) {
  for (const Eigen::Index step : {sensors, -sensors}) {
    Eigen::Index other = row + step;
    while (other >= 0 && other < residual_K.size() && (std::isnan(residual_K[other]) || weight[other] == 0.0)) {
      other += step;
    }
    if (other >= 0 && other < residual_K.size()) {
      return other;
    }
  }
  return -1;
}

/// Sets the weight of outliers to 0: samples beyond the gate of the filter that their neighbour does not confirm. An outlier spoils the
/// predictions of all sensors until the filter has forgotten the heat that it implied, so the samples of the next `spoilt_s` wait for
/// another pass. Returns false if there is no outlier.
bool hide_outliers(const LinearisedRun& fitted, const MeasuredRun& run, const LatentFlux& loose, double spoilt_s, SensorNoise& noise) {
  const Innovations innovations = Whitening(fitted, loose, noise).innovations(fitted.residual_K);
  const double most_sd = rejected_sd();
  const Eigen::Index sensors = fitted.sensors();
  bool is_found = false;
  double spoilt_to_s = -std::numeric_limits<double>::infinity();
  for (Eigen::Index k = 0; k < run.samples(); ++k) {
    const double time_s = run.time_s[static_cast<std::size_t>(k)];
    if (time_s <= spoilt_to_s) {
      continue;
    }
    for (Eigen::Index sensor = 0; sensor < sensors; ++sensor) {
      const double noise_K = noise.noise_K[static_cast<std::size_t>(sensor)];
      const Eigen::Index row = k * sensors + sensor;
      const double off = innovations.standardised[row];
      if (std::isnan(off) || std::abs(off) < most_sd || noise.weight[row] == 0.0) {
        continue;
      }
      const double off_K = std::abs(off) * noise_K / std::sqrt(innovations.noise_share[row]);
      const Eigen::Index other = neighbour(row, fitted.residual_K, sensors, noise.weight);
      // Residuals instead of readings, which differ by the slope, too.
      const bool is_confirmed =
          other >= 0 && std::abs(fitted.residual_K[other] - fitted.residual_K[row]) < thresholds().confirms_share * off_K;
      if (!is_confirmed) {
        noise.weight[row] = 0.0;
        is_found = true;
        spoilt_to_s = time_s + spoilt_s;
        break;
      }
    }
  }
  return is_found;
}

/// Hides outliers one after the other. Of very many that follow each other closely, the last ones are hidden in one pass, and possibly good
/// samples with them.
void hide_all_outliers(const LinearisedRun& fitted, const MeasuredRun& run, const LatentFlux& loose, SensorNoise& noise) {
  constexpr int kMostPasses = 40;
  int pass = 0;
  while (pass < kMostPasses && hide_outliers(fitted, run, loose, loose.time_scale_s, noise)) {
    ++pass;
  }
  if (pass == kMostPasses) {
    hide_outliers(fitted, run, loose, 0.0, noise);
  }
}

}  // namespace

std::vector<Eigen::VectorXd> weights_by_model(const std::vector<LinearisedRun>& fitted, const std::vector<MeasuredRun>& runs,
                                              double unknown_W, const ModelScreeningRules& rules) {
  std::vector<Eigen::VectorXd> all(runs.size());
  base::in_parallel(runs.size(), 0, [&](std::size_t r) {
    const MeasuredRun& run = runs[r];
    const LinearisedRun& path = fitted[r];
    const auto fluxes = static_cast<std::size_t>(path.fluxes);
    SensorNoise noise;
    for (const Sensor& sensor : run.sensors) {
      noise.noise_K.push_back(sensor.noise_K);
    }
    noise.weight = Eigen::VectorXd::Ones(path.residual_K.size());
    const std::vector<EqualReadings> equal = equal_readings(run);
    for (const EqualReadings& each : equal) {
      hide(each, path.sensors(), 0.0, noise.weight);
    }
    if (!equal.empty()) {
      const Eigen::MatrixXd sensor_C = smoothed_C(path, {std::vector<double>(fluxes, unknown_W), rules.smooth_time_scale_s}, noise);
      for (const EqualReadings& each : equal) {
        if (equal_nats(each, run, sensor_C, rules.shift_sd_K) >= std::log(thresholds().wrong_rejection_share)) {
          hide(each, path.sensors(), 1.0, noise.weight);
        }
      }
    }
    const LatentFlux loose{std::vector<double>(fluxes, rules.loose_ratio * unknown_W), rules.loose_time_scale_s};
    hide_all_outliers(path, run, loose, noise);
    for (Eigen::Index sensor = 0; sensor < path.sensors(); ++sensor) {
      auto of_sensor = noise.weight(Eigen::seq(sensor, noise.weight.size() - 1, path.sensors()));
      if (of_sensor.sum() < (1.0 - thresholds().most_rejected_share) * static_cast<double>(of_sensor.size())) {
        of_sensor.setOnes();
      }
    }
    all[r] = std::move(noise.weight);
  });
  return all;
}

}  // namespace heatsoak::estimation
