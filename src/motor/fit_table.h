// The [fit] table of a motor file: correlations of the fitted parameters, and the uncertainty of forecasts.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "input/reader.h"

namespace heatsoak::motor {

/// Uncertainty of a forecast beyond that of the parameters.
struct ForecastBand {
  std::array<double, 2> unknown_heat_share{};  ///< rms of slow unknown heat at winding and stator, per rms heat of the run
  double time_scale_s = 0.0;                   ///< correlation time of the unknown heat
  double heat_factor_sd = 0.0;                 ///< standard deviation of the logarithm of a factor on all heat of a run
  double width_ratio = 1.0;                    ///< factor by which the computed band is widened
};

/// Signal from which the heat of a model is computed.
enum class HeatInput {
  current,      ///< copper loss of the logged current, and no-load loss
  torque,       ///< the same with the current for torque and drag; the logged current is not used
  input_power,  ///< input power − shaft power; the logged current is not used
  power_balance  ///< copper loss of the logged current; all other loss is input power − shaft power − copper loss (effect remaining_loss)
};
/// Returns the name in files: "current", "torque", "input_power" or "power_balance".
std::string_view name_of(HeatInput heat);

/// Range of an input signal, in the unit of its channel.
struct InputRange {
  double low = 0.0;
  double high = 0.0;
};

/// Conditions and input ranges of the fitted runs; empty if the file does not record them.
struct TrainingRange {
  std::set<std::string> conditions = {};          ///< such as "fan=on"
  std::map<std::string, InputRange> inputs = {};  ///< by channel: "ambient_C", "speed_rad_per_s", "current_A"
};

/// Symmetric matrix of correlations with a diagonal of 1.
class Correlation {
 public:
  /// No correlation between `count` parameters.
  Correlation() = default;
  explicit Correlation(std::size_t count);
  /// `values` are all elements; their number is a square.
  explicit Correlation(std::span<const double> values);

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] double operator()(std::size_t i, std::size_t j) const { return values_[i * count_ + j]; }
  void set(std::size_t i, std::size_t j, double value) { values_[i * count_ + j] = values_[j * count_ + i] = value; }
  [[nodiscard]] std::span<const double> values() const { return values_; }

 private:
  std::size_t count_ = 0;
  std::vector<double> values_;
};

/// The [fit] table, which a calibration writes.
struct MotorFit {
  std::string motor;                    ///< id of the motor file that the fit started from
  std::vector<std::string> runs;        ///< names with the used part: "match_1 (5f0c31d2a7e94b68 0-1800 s)"
  std::vector<std::string> parameters;  ///< keys of the fitted parameters: "thermal_resistance_winding_stator", "effects.fan.conductance"
  Correlation correlation;              ///< correlation of the logarithms of these parameters, in that order
  std::vector<std::pair<std::string, double>> noise_K;  ///< per node with a sensor: standard deviation of the noise of one sample
  std::vector<double> latent_flux_W;                    ///< rms of the unknown heat flux into winding and stator
  double latent_flux_time_scale_s = 0.0;
  /// Present if the runs contain much heat that the model lacks: its rms per mean heat of the runs, > 0. Predictions are then doubtful.
  std::optional<double> unmodelled_heat_share = {};
  /// Rms error of whole simulated runs, if the parameters were fitted to these. Short-term predictions would then ask for other parameters,
  /// as in a motor with more thermal bodies than the model.
  std::optional<double> free_run_error_K = {};
  /// Names of effects and sensor errors of the file that were added for better forecasts: they are no diagnosis.
  std::vector<std::string> extensions = {};
  /// Heat input of the fitted runs. The thermal parameters hold for it, so it is also that of forecasts. Absent in older files.
  std::optional<HeatInput> heat_input = {};
  /// In rows in which the motor may reverse, the speed changes linearly instead of being constant. The values hold for this assumption.
  bool is_speed_linear = false;
  TrainingRange training = {};
  std::optional<ForecastBand> band = {};  ///< estimated by the calibration from left-out runs; may be absent
};

/// Reads the table; `parameters` are the keys of the file. Adds problems to the reader's diagnostics.
MotorFit read_fit(input::Reader& table, std::span<const std::string> parameters);
std::string to_toml(const MotorFit& fit);

/// Returns the band with the digits that a file states, so that a forecast from memory equals one from the file.
ForecastBand rounded_as_in_file(const ForecastBand& band);

/// Returns the factor on all heat of a run at the quantile `uniform` in (0, 1). It combines the heat factor of the band with the unknown
/// heat at the winding, which is assumed constant over the run as the worst case of slow heat.
double drawn_heat_factor(const ForecastBand& band, double uniform);

/// Converts independent uniform numbers in (0, 1), one per fitted parameter, to numbers with the correlation of the fit (Gaussian copula).
void correlate(const MotorFit& fit, std::span<double> uniforms);

}  // namespace heatsoak::motor
