#include "calibration/forecast/band.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "base/confidence.h"
#include "calibration/forecast/forecast_setup.h"

namespace heatsoak::calibration {
namespace {

constexpr Eigen::Index kSlots = 20;
constexpr Eigen::Index kSamples = 30;
constexpr double kUsual_share = 0.03;

/// Sensor response in K to 1 W into a flux node during one time slot of the run: per flux node, rows × slots.
std::vector<Eigen::MatrixXd> responses_K_per_W(const estimation::LinearisedRun& path, const estimation::MeasuredRun& run) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Index x = path.states;
  const Eigen::Index rows = path.residual_K.size();
  const double begin_s = run.time_s.front();
  const double slot_s = (run.time_s.back() - begin_s) / static_cast<double>(kSlots);
  std::vector<Eigen::MatrixXd> all(static_cast<std::size_t>(path.fluxes), Eigen::MatrixXd::Zero(rows, kSlots));
  for (Eigen::Index flux = 0; flux < path.fluxes; ++flux) {
    Eigen::MatrixXd state = Eigen::MatrixXd::Zero(x, kSlots);
    for (Eigen::Index k = 0; k + 1 < path.samples(); ++k) {
      const Eigen::Map<const RowMajor> transition(path.transition.data() + k * x * x, x, x);
      const Eigen::Map<const RowMajor> injection(path.injection.data() + k * x * path.fluxes, x, path.fluxes);
      state = (transition * state).eval();
      const auto slot = static_cast<Eigen::Index>((run.time_s[static_cast<std::size_t>(k)] - begin_s) / slot_s);
      state.col(std::min(slot, kSlots - 1)) += injection.col(flux);
      for (Eigen::Index sensor = 0; sensor < path.sensors(); ++sensor) {
        all[static_cast<std::size_t>(flux)].row((k + 1) * path.sensors() + sensor) =
            state.row(path.sensor_node[static_cast<std::size_t>(sensor)]);
      }
    }
  }
  return all;
}

/// Correlation matrix of the unknown heat between time slots.
Eigen::MatrixXd slot_correlation(double slot_s, double time_scale_s) {
  Eigen::MatrixXd all(kSlots, kSlots);
  for (Eigen::Index i = 0; i < kSlots; ++i) {
    for (Eigen::Index j = 0; j < kSlots; ++j) {
      all(i, j) = std::exp(-slot_s * static_cast<double>(std::abs(i - j)) / time_scale_s);
    }
  }
  return all;
}

double duration_s(const estimation::MeasuredRun& run) { return run.time_s.back() - run.time_s.front(); }

/// Contributions to the covariance of a piece's errors, for a subset of its rows.
struct Sampled {
  Eigen::VectorXd error_K;
  Eigen::MatrixXd of_parameters_K2;
  Eigen::VectorXd by_heat_K;
  std::vector<Eigen::MatrixXd> by_flux_K;  ///< per flux node: rows × slots, response to the run's RMS heat
  Eigen::VectorXd noise_K;
  double slot_s = 0.0;
};

Sampled sampled(const estimation::MeasuredRun& run, const PredictedPiece& piece) {
  const estimation::LinearisedRun& path = piece.path;
  std::vector<Eigen::Index> known;
  for (Eigen::Index row = 0; row < path.residual_K.size(); ++row) {
    if (!std::isnan(path.residual_K[row])) {
      known.push_back(row);
    }
  }
  const auto most = kSamples * path.sensors();
  std::vector<Eigen::Index> rows;
  const auto stride = std::max<std::size_t>(1, known.size() / static_cast<std::size_t>(most));
  // An odd stride alternates between the rows of two sensors.
  for (std::size_t i = 0; i < known.size(); i += stride % 2 == 0 ? stride + 1 : stride) {
    rows.push_back(known[i]);
  }
  Sampled out;
  const estimation::Columns by_theta = path.by_parameter(rows, Eigen::seq(0, path.by_parameter.cols() - 2));
  out.error_K = path.residual_K(rows);
  out.of_parameters_K2 = by_theta * piece.covariance * by_theta.transpose();
  out.by_heat_K = path.by_parameter(rows, path.by_parameter.cols() - 1);
  for (const Eigen::MatrixXd& response : responses_K_per_W(path, run)) {
    out.by_flux_K.emplace_back(piece.heat_W * response(rows, Eigen::all));
  }
  out.noise_K.resize(static_cast<Eigen::Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    out.noise_K[static_cast<Eigen::Index>(i)] = run.sensors[static_cast<std::size_t>(rows[i] % path.sensors())].noise_K;
  }
  out.slot_s = duration_s(run) / static_cast<double>(kSlots);
  return out;
}

/// Logarithms of: share of unknown heat at each of the two flux nodes, its time scale in s, standard deviation of the heat factor.
using Coordinates = std::array<double, 4>;

struct KnownBefore {
  Coordinates mean{};
  Coordinates sd{1.0, 1.0, 0.5, 0.7};
};

/// Covariance of the errors of a piece.
Eigen::MatrixXd covariance_K2(const Sampled& piece, const Coordinates& at) {
  Eigen::MatrixXd covariance = piece.of_parameters_K2 + std::exp(2.0 * at[3]) * piece.by_heat_K * piece.by_heat_K.transpose();
  const Eigen::MatrixXd correlation = slot_correlation(piece.slot_s, std::exp(at[2]));
  for (std::size_t flux = 0; flux < piece.by_flux_K.size(); ++flux) {
    covariance += std::exp(2.0 * at[flux]) * piece.by_flux_K[flux] * correlation * piece.by_flux_K[flux].transpose();
  }
  covariance.diagonal() += piece.noise_K.cwiseAbs2();
  return covariance;
}

double log_posterior(const std::vector<Sampled>& pieces, const Coordinates& at, const KnownBefore& before) {
  double nats = 0.0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    nats -= 0.5 * std::pow((at[i] - before.mean[i]) / before.sd[i], 2);
  }
  for (const Sampled& piece : pieces) {
    const Eigen::LDLT<Eigen::MatrixXd> solver(covariance_K2(piece, at));
    nats -= 0.5 * (solver.vectorD().array().max(1e-12).log().sum() + piece.error_K.dot(solver.solve(piece.error_K)));
  }
  return nats;
}

/// Returns the number of independent errors whose mean square varies as much as that of the pieces (Satterthwaite 1946).
double independent_errors(const std::vector<Sampled>& pieces, const Coordinates& at) {
  double count = 0.0;
  double shared = 0.0;
  for (const Sampled& piece : pieces) {
    const Eigen::MatrixXd covariance = covariance_K2(piece, at);
    const Eigen::VectorXd per_sd = covariance.diagonal().cwiseSqrt().cwiseInverse();
    count += static_cast<double>(per_sd.size());
    shared += (per_sd.asDiagonal() * covariance * per_sd.asDiagonal()).squaredNorm();
  }
  return count > 0.0 ? count * count / shared : 1.0;
}

/// Maximises the posterior by coordinate search; halves the step when no coordinate improves.
Coordinates most_probable(const std::vector<Sampled>& pieces, const KnownBefore& before) {
  Coordinates at = before.mean;
  double best = log_posterior(pieces, at, before);
  for (double step = 1.0; step > 0.05; step *= 0.5) {
    for (bool moved = true; moved;) {
      moved = false;
      for (std::size_t i = 0; i < at.size(); ++i) {
        for (const double way : {step, -step}) {
          Coordinates other = at;
          other[i] += way;
          if (const double there = log_posterior(pieces, other, before); there > best + 1e-6) {
            best = there;
            at = other;
            moved = true;
          }
        }
      }
    }
  }
  return at;
}

}  // namespace

Eigen::VectorXd forecast_sd_K(const estimation::LinearisedRun& path, const estimation::MeasuredRun& run, const Eigen::MatrixXd& covariance,
                              const Eigen::MatrixXd& start_K2, double heat_W, const motor::ForecastBand& band) {
  const Eigen::Index rows = path.residual_K.size();
  const Eigen::Index count = path.by_parameter.cols() - 1;
  const auto by_theta = path.by_parameter.leftCols(count);
  Eigen::VectorXd variance_K2 = (by_theta * covariance).cwiseProduct(by_theta).rowwise().sum();
  variance_K2 += (path.by_start * start_K2).cwiseProduct(path.by_start).rowwise().sum();
  variance_K2 += band.heat_factor_sd * band.heat_factor_sd * path.by_parameter.col(count).cwiseAbs2();
  const std::vector<Eigen::MatrixXd> responses = responses_K_per_W(path, run);
  const Eigen::MatrixXd correlation = slot_correlation(duration_s(run) / static_cast<double>(kSlots), band.time_scale_s);
  for (std::size_t flux = 0; flux < responses.size(); ++flux) {
    const double unknown_W = band.unknown_heat_share[flux] * heat_W;
    variance_K2 += unknown_W * unknown_W * (responses[flux] * correlation).cwiseProduct(responses[flux]).rowwise().sum();
  }
  for (Eigen::Index row = 0; row < rows; ++row) {
    const double noise_K = run.sensors[static_cast<std::size_t>(row % path.sensors())].noise_K;
    variance_K2[row] += noise_K * noise_K;
  }
  return band.width_ratio * variance_K2.cwiseMax(0.0).cwiseSqrt();
}

motor::ForecastBand usual_band(double duration_s) { return {{kUsual_share, kUsual_share}, duration_s / 3.0, kUsual_share, 1.0}; }

motor::ForecastBand fit_band(std::span<const estimation::MeasuredRun> runs, std::span<const PredictedPiece> pieces,
                             std::optional<std::size_t> dependent_pieces) {
  double longest_s = 0.0;
  for (const estimation::MeasuredRun& run : runs) {
    longest_s = std::max(longest_s, duration_s(run));
  }
  const KnownBefore before{{std::log(kUsual_share), std::log(kUsual_share), std::log(longest_s / 3.0), std::log(kUsual_share)}};
  std::vector<Sampled> all;
  std::ranges::transform(pieces, std::back_inserter(all), [&](const PredictedPiece& each) { return sampled(runs[each.run], each); });
  const Coordinates at = most_probable(all, before);
  motor::ForecastBand band{{std::exp(at[0]), std::exp(at[1])}, std::exp(at[2]), std::exp(at[3]), 1.0};
  double ratio = 0.0;
  for (const PredictedPiece& piece : pieces) {
    const estimation::MeasuredRun& run = runs[piece.run];
    const Eigen::VectorXd sd_K =
        forecast_sd_K(piece.path, run, piece.covariance, Eigen::MatrixXd::Zero(piece.path.states, piece.path.states), piece.heat_W, band);
    std::vector<double> sizes;
    for (Eigen::Index row = 0; row < sd_K.size(); ++row) {
      if (!std::isnan(piece.path.residual_K[row])) {
        sizes.push_back(std::abs(piece.path.residual_K[row]) / sd_K[row]);
      }
    }
    if (sizes.empty()) {
      continue;
    }
    const auto at_band = sizes.begin() + static_cast<std::ptrdiff_t>(base::kBand_share * static_cast<double>(sizes.size()));
    std::nth_element(sizes.begin(), at_band, sizes.end());
    ratio += *at_band / kBand_sd / static_cast<double>(pieces.size());
  }
  // With few errors the spread of the next run's error is uncertain.
  const boost::math::students_t student(dependent_pieces ? static_cast<double>(*dependent_pieces) : independent_errors(all, at));
  band.width_ratio = ratio * boost::math::quantile(student, 0.5 * (1.0 + base::kBand_share)) / kBand_sd;
  return band;
}

}  // namespace heatsoak::calibration
