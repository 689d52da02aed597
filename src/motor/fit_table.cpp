#include "motor/fit_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <sstream>

#include "base/quantity.h"
#include "base/signals.h"

namespace heatsoak::motor {
namespace {

constexpr std::array<std::string_view, 2> kHeatedNodes{"winding", "stator"};
constexpr double kLargest_W = 1e6;
constexpr double kMostShare = 10.0;

Eigen::Map<const Eigen::MatrixXd> as_matrix(const Correlation& correlation) {
  const auto count = static_cast<Eigen::Index>(correlation.count());
  return {correlation.values().data(), count, count};
}

/// Reads the rows of a lower triangular matrix with a diagonal of 1: "1", "0.2 1", …
Correlation read_correlation(input::Reader& table, std::size_t count) {
  Correlation correlation(count);
  const std::vector<std::string> rows = table.texts("correlation", input::Need::required);
  if (rows.size() != count) {
    table.problem("correlation", fmt::format("has {} rows, expected {}: one per fitted parameter", rows.size(), count));
    return correlation;
  }
  for (std::size_t i = 0; i < count; ++i) {
    std::istringstream row(rows[i]);
    std::vector<double> values;
    for (std::string word; row >> word;) {
      const std::optional<double> value = base::parse_number(word);
      if (!value || !(*value >= -1.0 && *value <= 1.0)) {
        table.problem("correlation", fmt::format("'{}' in row {}: expected a number between -1 and 1", word, i + 1));
        return correlation;
      }
      values.push_back(*value);
    }
    if (values.size() != i + 1 || values.back() != 1.0) {
      table.problem("correlation", fmt::format("row {} has {} numbers, expected {}, the last one 1", i + 1, values.size(), i + 1));
      return correlation;
    }
    for (std::size_t j = 0; j < i; ++j) {
      correlation.set(i, j, values[j]);
    }
  }
  constexpr double kRounding = 1e-3;
  if (count > 0 && Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(as_matrix(correlation)).eigenvalues().minCoeff() < -kRounding) {
    table.problem("correlation", "is not a correlation matrix: it has a negative eigenvalue");
  }
  return correlation;
}

}  // namespace

namespace {

constexpr double kLargestInput = 1e5;

/// Values of `heat_input` in a motor file, in the order of the enumerators.
constexpr std::array<std::string_view, 4> kHeatInputNames{"current", "torque", "input_power", "power_balance"};

std::optional<HeatInput> read_heat_input(input::Reader& table) {
  const std::optional<std::string> name = table.text("heat_input", input::Need::optional);
  if (!name) {
    return std::nullopt;
  }
  const auto found = std::ranges::find(kHeatInputNames, *name);
  if (found == kHeatInputNames.end()) {
    const std::vector<std::string> known(kHeatInputNames.begin(), kHeatInputNames.end());
    table.problem("heat_input",
                  fmt::format("'{}' is unknown; expected one of {}{}", *name, fmt::join(known, ", "), base::did_you_mean(*name, known)));
    return std::nullopt;
  }
  return static_cast<HeatInput>(found - kHeatInputNames.begin());
}

/// Reads the sizes of the forecast's error band: all of them or none, because without one the band, and with it a safety factor, would be
/// too small.
std::optional<ForecastBand> read_band(input::Reader& table) {
  const std::vector<std::string> keys = table.keys();
  const bool is_stated = std::ranges::any_of(keys, [](const std::string& key) { return key.starts_with("forecast_"); });
  const auto size = [&](const base::ParameterSpec& spec) {
    return table.quantity(spec, is_stated ? input::Need::required : input::Need::optional);
  };
  const base::Range share = base::Range::between(0.0, kMostShare);
  const auto winding = size({"forecast_unknown_heat_winding", "", share, "rms of slow unknown heat per rms heat of a run"});
  const auto stator = size({"forecast_unknown_heat_stator", "", share, "rms of slow unknown heat per rms heat of a run"});
  const auto heat = size({"forecast_heat_factor", "", share, "standard deviation of the logarithm of a factor on all heat of a run"});
  const auto time_s = size({"forecast_time_scale", "s", base::Range::positive(), "correlation time of the unknown heat"});
  const auto width = size({"forecast_width", "", base::Range::between(0.01, 100.0), "factor on the width of the band"});
  if (!winding || !stator || !heat || !time_s || !width) {
    return std::nullopt;
  }
  return ForecastBand{{*winding, *stator}, *time_s, *heat, *width};
}

struct RangeKey {
  std::string_view key;
  std::string_view channel;
  std::string_view unit;
};
constexpr RangeKey range_key(std::string_view key, std::string_view signal) {
  const base::SignalRow& row = base::kSignals[base::signal_row(signal)];
  return {key, row.column, row.unit};
}
constexpr std::array kRangeKeys{range_key("trained_ambient", "ambient"), range_key("trained_speed", "speed"),
                                range_key("trained_current", "current")};

TrainingRange read_training(input::Reader& table) {
  TrainingRange range;
  for (const std::string& each : table.texts("trained_conditions", input::Need::optional)) {
    range.conditions.insert(each);
  }
  for (const RangeKey& each : kRangeKeys) {
    const std::vector<double> ends = table.quantities(
        {each.key, each.unit, base::Range::between(-kLargestInput, kLargestInput), "lowest and highest value in the fitted runs"},
        input::Need::optional);
    if (ends.size() == 2 && ends[0] <= ends[1]) {
      range.inputs.emplace(each.channel, InputRange{ends[0], ends[1]});
    } else if (!ends.empty()) {
      table.problem(each.key, "expected two values, the lowest and the highest of the fitted runs");
    }
  }
  return range;
}

std::string training_text(const TrainingRange& range) {
  std::string text = range.conditions.empty() ? "" : fmt::format("trained_conditions = [\"{}\"]\n", fmt::join(range.conditions, "\", \""));
  for (const RangeKey& each : kRangeKeys) {
    if (const auto found = range.inputs.find(std::string(each.channel)); found != range.inputs.end()) {
      text += fmt::format("{0} = [\"{1} {3}\", \"{2} {3}\"]\n", each.key, base::significant(found->second.low, 3),
                          base::significant(found->second.high, 3), each.unit);
    }
  }
  return text.empty() ? "" : "# conditions and ranges of the fitted runs: forecasts outside are extrapolations\n" + text;
}

/// Without the key, the speed is constant within a row.
constexpr std::array<std::string_view, 1> kSpeedsWithinRows{"linear"};
constexpr int kBandDigits = 2;

std::string band_text(const ForecastBand& band) {
  return fmt::format(
      "# for forecasts of other runs: rms of slow unknown heat per rms heat of the run, and a factor on all heat\n"
      "forecast_unknown_heat_winding = \"{}\"\nforecast_unknown_heat_stator = \"{}\"\nforecast_time_scale = \"{} s\"\n"
      "forecast_heat_factor = \"{}\"\nforecast_width = \"{}\"\n",
      base::significant(band.unknown_heat_share[0], kBandDigits), base::significant(band.unknown_heat_share[1], kBandDigits),
      base::significant(band.time_scale_s, kBandDigits), base::significant(band.heat_factor_sd, kBandDigits),
      base::significant(band.width_ratio, kBandDigits));
}

}  // namespace

ForecastBand rounded_as_in_file(const ForecastBand& band) {
  const auto written = [](double value) { return base::parse_number(base::significant(value, kBandDigits)).value_or(value); };
  return {{written(band.unknown_heat_share[0]), written(band.unknown_heat_share[1])},
          written(band.time_scale_s),
          written(band.heat_factor_sd),
          written(band.width_ratio)};
}

std::string_view name_of(HeatInput heat) { return kHeatInputNames[static_cast<std::size_t>(heat)]; }

Correlation::Correlation(std::size_t count) : count_(count), values_(count * count, 0.0) {
  for (std::size_t i = 0; i < count; ++i) {
    set(i, i, 1.0);
  }
}

Correlation::Correlation(std::span<const double> values)
    : count_(static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(values.size()))))), values_(values.begin(), values.end()) {}

MotorFit read_fit(input::Reader& table, std::span<const std::string> parameters) {
  MotorFit fit;
  fit.motor = table.text("motor", input::Need::required).value_or("");
  fit.runs = table.texts("runs", input::Need::optional);
  fit.parameters = table.texts("figures", input::Need::required);
  for (const std::string& each : fit.parameters) {
    if (std::ranges::find(parameters, each) == parameters.end()) {
      table.problem("figures", fmt::format("'{}' is not a parameter of this file{}", each, base::did_you_mean(each, parameters)));
    }
  }
  fit.correlation = read_correlation(table, fit.parameters.size());
  for (const std::string_view node : kHeatedNodes) {
    const std::string noise = fmt::format("noise_{}", node);
    if (const std::optional<double> noise_K = table.quantity(
            {noise, "K", base::Range::non_negative(), "standard deviation of the noise of one sample"}, input::Need::optional)) {
      fit.noise_K.emplace_back(node, *noise_K);
    }
    const std::string flux = fmt::format("latent_flux_{}", node);
    fit.latent_flux_W.push_back(
        table.quantity({flux, "W", base::Range::between(0.0, kLargest_W), "rms of the unknown heat"}, input::Need::optional).value_or(0.0));
  }
  fit.latent_flux_time_scale_s =
      table
          .quantity({"latent_flux_time_scale", "s", base::Range::positive(), "correlation time of the unknown heat"}, input::Need::optional)
          .value_or(0.0);
  fit.unmodelled_heat_share = table.quantity(
      {"unmodelled_heat", "", base::Range::between(0.0, kMostShare), "rms of the heat that the model lacks, per mean heat of the runs"},
      input::Need::optional);
  fit.free_run_error_K =
      table.quantity({"free_run_error", "K", base::Range::between(1e-3, 20.0), "rms error of the free runs that determined the values"},
                     input::Need::optional);
  fit.extensions = table.texts("extensions", input::Need::optional);
  fit.heat_input = read_heat_input(table);
  fit.is_speed_linear = table.choice("speed_within_rows", kSpeedsWithinRows, input::Need::optional).has_value();
  fit.training = read_training(table);
  fit.band = read_band(table);
  table.finish();
  return fit;
}

std::string to_toml(const MotorFit& fit) {
  std::string text = "\n[fit]\n";
  text += fmt::format("motor = \"{}\"\n", fit.motor);
  text += fmt::format("runs = [\"{}\"]\n", fmt::join(fit.runs, "\", \""));
  text += fmt::format("figures = [\"{}\"]\n", fmt::join(fit.parameters, "\", \""));
  text += "# of the parameters' logarithms: lower triangle\ncorrelation = [\n";
  for (std::size_t i = 0; i < fit.correlation.count(); ++i) {
    std::vector<std::string> row;
    for (std::size_t j = 0; j < i; ++j) {
      row.push_back(fmt::format("{:.5f}", fit.correlation(i, j)));
    }
    row.emplace_back("1");
    text += fmt::format("  \"{}\",\n", fmt::join(row, " "));
  }
  text += "]\n";
  for (const auto& [node, noise_K] : fit.noise_K) {
    text += fmt::format("noise_{} = \"{} K\"\n", node, base::significant(noise_K, 2));
  }
  for (std::size_t i = 0; i < std::min(kHeatedNodes.size(), fit.latent_flux_W.size()); ++i) {
    text += fmt::format("latent_flux_{} = \"{} W\"\n", kHeatedNodes[i], base::significant(fit.latent_flux_W[i], 2));
  }
  text += fmt::format("latent_flux_time_scale = \"{} s\"\n", base::significant(fit.latent_flux_time_scale_s, 2));
  if (fit.unmodelled_heat_share) {
    text += fmt::format("# the model lacks an effect: this share of the mean heat is not modelled\nunmodelled_heat = \"{}\"\n",
                        base::significant(*fit.unmodelled_heat_share, 2));
  }
  text += fit.extensions.empty()
              ? ""
              : fmt::format("# added for better forecasts, no diagnosis\nextensions = [\"{}\"]\n", fmt::join(fit.extensions, "\", \""));
  text += fit.free_run_error_K ? fmt::format("free_run_error = \"{} K\"\n", base::significant(*fit.free_run_error_K, 2)) : "";
  text += fit.heat_input
              ? fmt::format("# the thermal values hold for heat from this input of a log\nheat_input = \"{}\"\n", name_of(*fit.heat_input))
              : "";
  text += fit.is_speed_linear
              ? fmt::format("# in rows in which the motor may reverse, its speed changes linearly\nspeed_within_rows = \"{}\"\n",
                            kSpeedsWithinRows.front())
              : "";
  text += training_text(fit.training);
  return text + (fit.band ? band_text(*fit.band) : "");
}

double drawn_heat_factor(const ForecastBand& band, double uniform) {
  static const boost::math::normal kNormal;
  const double sd = band.width_ratio * std::hypot(band.heat_factor_sd, band.unknown_heat_share[0]);
  return std::exp(sd * boost::math::quantile(kNormal, uniform));
}

void correlate(const MotorFit& fit, std::span<double> uniforms) {
  static const boost::math::normal kNormal;
  // Square root of the matrix. Eigenvalues that rounding made negative are set to 0.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(as_matrix(fit.correlation));
  Eigen::VectorXd independent(solver.eigenvalues().size());
  for (Eigen::Index i = 0; i < independent.size(); ++i) {
    independent[i] = boost::math::quantile(kNormal, uniforms[static_cast<std::size_t>(i)]);
  }
  Eigen::MatrixXd root =
      solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() * solver.eigenvectors().transpose();
  root.array().colwise() /= root.rowwise().norm().array().eval();
  const Eigen::VectorXd dependent = root * independent;
  for (Eigen::Index i = 0; i < dependent.size(); ++i) {
    uniforms[static_cast<std::size_t>(i)] = boost::math::cdf(kNormal, dependent[i]);
  }
}

}  // namespace heatsoak::motor
