#include "calibration/forecast/pieces.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/diagnostic.h"

namespace heatsoak::calibration {
namespace {

constexpr double kExcited_share = 0.25;

/// Index of the winding's sensor, or 0 if there is none.
Eigen::Index watched_sensor(const estimation::MeasuredRun& run) { return run.sensor_at("winding").value_or(0); }

/// Range of the predicted readings of samples [from, to). Predicted readings have no missing samples.
std::pair<double, double> range_of(const Eigen::MatrixXd& sensor_C, Eigen::Index sensor, Eigen::Index from, Eigen::Index to) {
  const auto part = sensor_C.col(sensor).segment(from, to - from);
  return {part.minCoeff(), part.maxCoeff()};
}

Piece block_of(const estimation::MeasuredRun& run, Eigen::Index from, Eigen::Index to) {
  const auto sensors = static_cast<Eigen::Index>(run.sensors.size());
  Piece piece;
  piece.seen.assign(static_cast<std::size_t>(run.samples() * sensors), 1);
  piece.scored.assign(piece.seen.size(), 0);
  for (Eigen::Index row = from * sensors; row < to * sensors; ++row) {
    piece.seen[static_cast<std::size_t>(row)] = 0;
    piece.scored[static_cast<std::size_t>(row)] = 1;
  }
  return piece;
}

/// Parameters `theta` with the covariance of the prior: nothing is fitted.
ForecastFit unfitted(const ForecastModel& model, const Eigen::VectorXd& theta) {
  ForecastFit fit;
  fit.theta = theta;
  fit.covariance = model.prior().precision.ldlt().solve(Eigen::MatrixXd::Identity(theta.size(), theta.size()));
  return fit;
}

ForecastFit fitted_without(const ForecastModel& model, std::span<const estimation::MeasuredRun> runs, const Piece& piece,
                           const Eigen::VectorXd& theta, const ForecastRules& rules) {
  ForecastFit fit = piece.seen.empty() ? fit_forecast(model, runs_without(runs, piece), {}, theta, rules)
                                       : fit_forecast(model, runs, std::vector<RowMask>{piece.seen}, theta, rules);
  if (!std::isfinite(fit.cost_nats)) {
    throw base::Failure(base::ExitCode::numerics_failed, "the model cannot be simulated over the other pieces");
  }
  return fit;
}

PredictedPiece predicted(const ForecastModel& model, std::span<const estimation::MeasuredRun> runs, const Piece& piece,
                         const ForecastFit& fit) {
  const estimation::MeasuredRun& run = runs[piece.run];
  PredictedPiece out = piece.seen.empty() || fit.starts.empty()
                           ? predicted_run(model, fit.theta, fit.covariance, run, piece.run)
                           : predicted_from(model, fit.theta, fit.covariance, run, piece.run, fit.starts.front().state_C);
  for (std::size_t row = 0; row < piece.scored.size(); ++row) {
    if (piece.scored[row] == 0) {
      out.path.residual_K[static_cast<Eigen::Index>(row)] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  return out;
}

}  // namespace

PredictedPiece predicted_from(const ForecastModel& model, const Eigen::VectorXd& theta, const Eigen::MatrixXd& covariance,
                              const estimation::MeasuredRun& run, std::size_t index, const Eigen::VectorXd& start_C) {
  estimation::LinearisedRun path = model.along(run, theta, 0.0, {start_C.data(), static_cast<std::size_t>(start_C.size())});
  const double heat_W = rms_heat_W(model.network(), model.values_in(run, theta, 0.0), run, path.state_C);
  return {index, std::move(path), covariance, heat_W};
}

PredictedPiece predicted_run(const ForecastModel& model, const Eigen::VectorXd& theta, const Eigen::MatrixXd& covariance,
                             const estimation::MeasuredRun& run, std::size_t index) {
  return predicted_from(model, theta, covariance, run, index, model.decided_start(run, theta).state_C);
}

std::vector<Piece> pieces_of(const ForecastModel& model, const ForecastFit& base, std::span<const estimation::MeasuredRun> runs) {
  std::vector<Eigen::MatrixXd> sensor_C;
  double low_C = std::numeric_limits<double>::infinity();
  double high_C = -low_C;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const Eigen::VectorXd& start_C = base.starts[r].state_C;
    sensor_C.push_back(model
                           .along(runs[r], base.theta, base.heat_log[static_cast<Eigen::Index>(r)],
                                  {start_C.data(), static_cast<std::size_t>(start_C.size())})
                           .sensor_C);
    const auto [low, high] = range_of(sensor_C.back(), watched_sensor(runs[r]), 0, runs[r].samples());
    low_C = std::min(low_C, low);
    high_C = std::max(high_C, high);
  }
  std::vector<Piece> pieces;
  const auto add = [&](std::size_t r, Eigen::Index from, Eigen::Index to, Piece piece) {
    const auto [low, high] = range_of(sensor_C[r], watched_sensor(runs[r]), from, to);
    piece.run = r;
    if (high - low >= kExcited_share * (high_C - low_C)) {
      pieces.push_back(std::move(piece));
    }
  };
  if (runs.size() > 1) {
    for (std::size_t r = 0; r < runs.size(); ++r) {
      add(r, 0, runs[r].samples(), {});
    }
    return pieces;
  }
  const estimation::MeasuredRun& run = runs.front();
  for (std::size_t b = 0; b < kBlocks; ++b) {
    const auto edge = [&](std::size_t block) { return static_cast<Eigen::Index>(block * run.time_s.size() / kBlocks); };
    add(0, edge(b), edge(b + 1), block_of(run, edge(b), edge(b + 1)));
  }
  return pieces;
}

std::vector<estimation::MeasuredRun> runs_without(std::span<const estimation::MeasuredRun> runs, const Piece& piece) {
  std::vector<estimation::MeasuredRun> others(runs.begin(), runs.end());
  if (piece.seen.empty()) {
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(piece.run));
    return others;
  }
  Eigen::MatrixXd& measured_C = others[piece.run].measured_C;
  for (Eigen::Index row = 0; row < measured_C.size(); ++row) {
    if (piece.seen[static_cast<std::size_t>(row)] == 0) {
      measured_C(row / measured_C.cols(), row % measured_C.cols()) = std::numeric_limits<double>::quiet_NaN();
    }
  }
  return others;
}

PieceScore score_pieces(const ForecastModel& model, std::span<const estimation::MeasuredRun> runs, std::span<const Piece> pieces,
                        const Eigen::VectorXd& theta, const ForecastRules* rules, FitCounter* counter) {
  if (rules == nullptr) {
    return score_pieces(model, runs, pieces, [&](const Piece&) { return unfitted(model, theta); });
  }
  ForecastRules counted = *rules;
  std::function<void()> after_piece;
  if (counter != nullptr) {
    counted.on_simulation = [counter] { counter->simulated_without_piece(); };
    after_piece = [counter] { counter->fitted_without_piece(); };
  }
  return score_pieces(
      model, runs, pieces, [&](const Piece& piece) { return fitted_without(model, runs, piece, theta, counted); }, after_piece);
}

PieceScore score_pieces(const ForecastModel& model, std::span<const estimation::MeasuredRun> runs, std::span<const Piece> pieces,
                        const FitWithout& fit_without, const std::function<void()>& after_piece) {
  PieceScore score;
  double count = 0.0;
  for (const Piece& piece : pieces) {
    try {
      score.pieces.push_back(predicted(model, runs, piece, fit_without(piece)));
      if (after_piece) {
        after_piece();
      }
    } catch (const base::Failure& failure) {
      if (failure.code() != base::ExitCode::numerics_failed && failure.code() != base::ExitCode::cannot_answer) {
        throw;
      }
      score.score_nats = std::numeric_limits<double>::infinity();
      return score;
    }
    const estimation::LinearisedRun& path = score.pieces.back().path;
    for (Eigen::Index sensor = 0; sensor < path.sensors(); ++sensor) {
      double squares_K2 = 0.0;
      double rows = 0.0;
      for (Eigen::Index row = sensor; row < path.residual_K.size(); row += path.sensors()) {
        squares_K2 += std::isnan(path.residual_K[row]) ? 0.0 : path.residual_K[row] * path.residual_K[row];
        rows += std::isnan(path.residual_K[row]) ? 0.0 : 1.0;
      }
      const double noise_K = runs[piece.run].sensors[static_cast<std::size_t>(sensor)].noise_K;
      score.score_nats += rows > 0.0 ? 0.5 * std::log(squares_K2 / rows + noise_K * noise_K) : 0.0;
      count += rows > 0.0 ? 1.0 : 0.0;
    }
  }
  score.score_nats /= std::max(1.0, count);
  return score;
}

}  // namespace heatsoak::calibration
