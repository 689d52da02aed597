// What a calibration knows besides values and intervals: how the figures hang together, and what was left unexplained.
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "input/reader.h"

namespace heatsoak {

/// How far forecasts of other runs may be off beside what the uncertainty of the parameters explains.
struct ForecastBand {
  std::array<double, 2> unknown_heat_share{};  ///< rms of slow unknown heat at winding and stator, per rms heat of the run
  double time_scale_s = 0.0;                   ///< over which that heat forgets
  double heat_factor_sd = 0.0;                 ///< of the logarithm of a factor on all heat of a run
  double width_ratio = 1.0;                    ///< the band as computed is widened by this
};

/// In the input's unit.
struct InputRange {
  double low = 0.0;
  double high = 0.0;
};

/// What the fitted runs had; empty in files that do not record it.
struct TrainingRange {
  std::set<std::string> conditions = {};          ///< "fan=on"
  std::map<std::string, InputRange> inputs = {};  ///< by channel: "ambient_C", "speed_rad_per_s", "current_A"
};

/// The [fit] table of a motor file that a calibration wrote.
struct MotorFit {
  std::string motor;                                    ///< id of the motor file that the fit began with
  std::vector<std::string> runs;                        ///< names, with what of them: "match_1 (5f0c31d2a7e94b68 0-1800 s)"
  std::vector<std::string> figures;                     ///< keys: "thermal_resistance_winding_stator", "effects.fan.conductance"
  Eigen::MatrixXd correlation;                          ///< of their logarithms, in that order
  std::vector<std::pair<std::string, double>> noise_K;  ///< per node with a sensor: standard deviation of one sample
  std::vector<double> latent_flux_W;                    ///< unknown heat of winding and stator: rms
  double latent_flux_time_scale_s = 0.0;
  /// Above 0: whole runs decided the figures, and the model that runs free follows them to this (rms); what follows the load at once
  /// asks for other figures, as in a motor of more parts than the model.
  double free_run_error_K = 0.0;
  TrainingRange training = {};
  std::optional<ForecastBand> band = {};  ///< of left-out runs, where a calibration has found it
};

/// Reads the table; `figures` are the keys that the file has. Problems go to the reader's diagnostics.
MotorFit read_fit(Reader& table, std::span<const std::string> figures);
std::string to_toml(const MotorFit& fit);

/// Factor on all heat of a run at `uniform` in (0, 1): the heat factor of the band, and the unknown heat at the winding as if it stayed the
/// same throughout, which is the worst that slow heat can do.
double drawn_heat_factor(const ForecastBand& band, double uniform);

/// Independent numbers in (0, 1), one per figure of the fit, become dependent ones with the fit's correlation (Gaussian copula).
void correlate(const MotorFit& fit, std::span<double> uniforms);

}  // namespace heatsoak
