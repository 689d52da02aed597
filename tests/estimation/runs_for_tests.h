// Runs with a known truth. Equations and integration method are implemented here independently and share no code with the analysers under
// test.
#pragma once

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "base/random.h"
#include "estimation/measured_run.h"
#include "estimation/model.h"

namespace heatsoak::estimation {

struct TwoNodeTruth {
  double winding_J_per_K = 18.0;
  double winding_stator_K_per_W = 1.6;
  double stator_J_per_K = 95.0;
  double stator_ambient_K_per_W = 5.5;
  double resistance_25C_ohm = 0.447;
  double temperature_coefficient_per_K = 0.0039;
  double contact_change_per_K = 0.0;  ///< change of the conductance between winding and stator per K of mean temperature above 60 °C
};

/// Rules for making a log from the truth.
struct LogMaking {
  double duration_s = 1800.0;
  double period_s = 1.0;
  double noise_K = 0.15;
  double resolution_K = 0.1;  ///< 0 means no rounding
  double flux_rms_W = 0.06;   ///< unmodelled heat at each node
  double flux_time_scale_s = 180.0;
  double outlier_share = 0.003;
  double dropout_share = 0.01;
  double lost_row_share = 0.0;
  double largest_current_A = 9.0;
  int rows_per_load = 1;  ///< rows with the same load
  bool winding_is_sensed = true;
  double ambient_swing_K = 0.5;
};

inline double standard_normal(base::Random& random) { return boost::math::quantile(boost::math::normal(), random.uniform()); }

/// Returns the current of a robot: bursts and rests of some seconds, grouped into minutes of high and low load.
inline std::vector<double> robot_current_A(base::Random& random, int rows, double largest_A) {
  std::vector<double> current_A;
  double level_ratio = 0.5;
  while (static_cast<int>(current_A.size()) < rows) {
    if (random.uniform() < 0.06) {
      level_ratio = std::pow(random.uniform(), 0.7);
    }
    const int length = 1 + static_cast<int>(12.0 * random.uniform());
    const double burst_A = random.uniform() < 0.3 ? 0.0 : largest_A * level_ratio * random.uniform();
    for (int i = 0; i < length; ++i) {
      current_A.push_back(burst_A * (0.85 + 0.15 * random.uniform()));
    }
  }
  current_A.resize(static_cast<std::size_t>(rows));
  return current_A;
}

/// Removes rows at random, like rows that were lost in transmission.
inline void lose_rows(recording::Recording& log, double share, base::Random random) {
  std::vector<bool> is_lost(log.rows());
  for (std::size_t row = 1; row < is_lost.size(); ++row) {
    is_lost[row] = random.uniform() < share;
  }
  const auto thin_out = [&](std::vector<double>& values) {
    std::size_t row = 0;
    std::erase_if(values, [&](double) { return is_lost[row++]; });
  };
  thin_out(log.time_s);
  for (recording::Channel& channel : log.channels) {
    thin_out(channel.values);
  }
}

/// Simulates a log by Heun's method with steps of 1/20 of a row. The unknown heat changes with every step.
inline recording::Recording generated_log(const TwoNodeTruth& truth, const LogMaking& making, std::uint64_t seed, std::uint64_t stream) {
  base::Random random(seed, stream);
  const int rows = static_cast<int>(making.duration_s / making.period_s);
  const std::vector<double> load_A = robot_current_A(random, (rows - 1) / making.rows_per_load + 1, making.largest_current_A);
  std::vector<double> current_A;
  for (int row = 0; row < rows; ++row) {
    current_A.push_back(load_A[static_cast<std::size_t>(row / making.rows_per_load)]);
  }
  constexpr int kParts = 20;
  const double step_s = making.period_s / kParts;
  const double kept_ratio = std::exp(-step_s / making.flux_time_scale_s);
  const double kick_W = making.flux_rms_W * std::sqrt(1.0 - kept_ratio * kept_ratio);
  double winding_flux_W = making.flux_rms_W * standard_normal(random);
  double stator_flux_W = making.flux_rms_W * standard_normal(random);
  double winding_C = 25.0 + 8.0 * random.uniform();
  double stator_C = 25.0 + 6.0 * random.uniform();
  const double phase_rad = 6.28 * random.uniform();
  const auto sensor_C = [&](double true_C) {
    if (random.uniform() < making.dropout_share) {
      return std::nan("");
    }
    const double outlier_K = random.uniform() < making.outlier_share ? 30.0 * (random.uniform() - 0.5) : 0.0;
    const double noisy_C = true_C + making.noise_K * standard_normal(random) + outlier_K;
    return making.resolution_K > 0.0 ? making.resolution_K * std::round(noisy_C / making.resolution_K) : noisy_C;
  };
  std::vector<double> time_s, shown_winding_C, shown_stator_C, ambient_C;
  for (int row = 0; row < rows; ++row) {
    time_s.push_back(row * making.period_s);
    ambient_C.push_back(25.0 + making.ambient_swing_K * std::sin(phase_rad + row * making.period_s / 500.0));
    shown_winding_C.push_back(sensor_C(winding_C));
    shown_stator_C.push_back(sensor_C(stator_C));
    const double square_A2 = current_A[static_cast<std::size_t>(row)] * current_A[static_cast<std::size_t>(row)];
    const auto slope = [&](double w_C, double s_C) {
      const double ohm = truth.resistance_25C_ohm + truth.resistance_25C_ohm * truth.temperature_coefficient_per_K * (w_C - 25.0);
      const double contact_ratio = 1.0 + truth.contact_change_per_K * (0.5 * (w_C + s_C) - 60.0);
      const double across_W = contact_ratio * (w_C - s_C) / truth.winding_stator_K_per_W;
      const double out_W = (s_C - ambient_C.back()) / truth.stator_ambient_K_per_W;
      return std::pair((square_A2 * ohm - across_W + winding_flux_W) / truth.winding_J_per_K,
                       (across_W - out_W + stator_flux_W) / truth.stator_J_per_K);
    };
    for (int part = 0; part < kParts; ++part) {
      const auto [w1, s1] = slope(winding_C, stator_C);
      const auto [w2, s2] = slope(winding_C + step_s * w1, stator_C + step_s * s1);
      winding_C += 0.5 * step_s * (w1 + w2);
      stator_C += 0.5 * step_s * (s1 + s2);
      winding_flux_W = kept_ratio * winding_flux_W + kick_W * standard_normal(random);
      stator_flux_W = kept_ratio * stator_flux_W + kick_W * standard_normal(random);
    }
  }
  recording::Recording log;
  log.name = "generated";
  log.file = "generated.csv";
  log.time_s = std::move(time_s);
  log.run_begins = {0};
  const auto add = [&](const char* key, std::vector<double> values) {
    log.channels.push_back({*recording::quantity_named(key), std::move(values)});
  };
  add("current_A", current_A);
  add("ambient_C", std::move(ambient_C));
  if (making.winding_is_sensed) {
    add("winding_C", std::move(shown_winding_C));
  }
  add("stator_C", std::move(shown_stator_C));
  if (making.lost_row_share > 0.0) {
    lose_rows(log, making.lost_row_share, base::Random(seed, stream + 1000));
  }
  return log;
}

inline MeasuredRun generated_run(const TwoNodeTruth& truth, const LogMaking& making, std::uint64_t seed, std::uint64_t stream) {
  const recording::Recording log = generated_log(truth, making, seed, stream);
  return measured_runs(log, {.longest_step_s = 2.0, .needed = {thermal::Signal::current}}).runs.front();
}

inline thermal::Network two_node_network(const TwoNodeTruth& truth) {
  thermal::Network network;
  network.add_node("winding", truth.winding_J_per_K);
  network.add_node("stator", truth.stator_J_per_K);
  const auto add = [&](const char* name, const char* type, std::vector<std::string> nodes, std::vector<double> parameters) {
    network.add_effect(name, *thermal::find_effect(type), nodes, parameters);
  };
  add("copper_loss", "copper_loss", {"winding"}, {truth.resistance_25C_ohm, truth.temperature_coefficient_per_K});
  add("winding_stator", "conduction", {"winding", "stator"}, {truth.winding_stator_K_per_W});
  add("stator_ambient", "conduction", {"stator", "ambient"}, {truth.stator_ambient_K_per_W});
  network.limit_current_by("copper_loss");
  return network;
}

/// Model with four free network parameters, whose logarithms have the prior standard deviation `prior_sd`. Unknown heat may enter both
/// nodes.
inline Model two_node_model(const TwoNodeTruth& start, double prior_sd) {
  Model model{two_node_network(start), {}, {}, {}, {0, 1}};
  model.values = model.network.values();
  for (const char* name :
       {"winding.heat_capacity", "winding_stator.thermal_resistance", "stator.heat_capacity", "stator_ambient.thermal_resistance"}) {
    const auto parameters = model.network.parameters();
    const auto place = std::ranges::find(parameters, name, &thermal::NetworkParameter::name) - parameters.begin();
    model.set_free({.place = static_cast<int>(place), .by_log = true, .scale = 1.0, .low = 1e-3, .high = 1e6}, prior_sd);
  }
  return model;
}

}  // namespace heatsoak::estimation
