// Cross-validation: networks are scored on left-out pieces, each predicted by a fit to the other data.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "calibration/forecast/forecast_fit.h"
#include "calibration/forecast/forecast_work.h"

namespace heatsoak::calibration {

/// Left-out piece: a run, or a block of a single run. The fit uses the rest.
struct Piece {
  std::size_t run = 0;
  RowMask seen;    ///< rows of its run that the fit uses; empty: the whole run is left out
  RowMask scored;  ///< rows of its run that are predicted
};

/// Returns the pieces: all runs, or four blocks of a single run. A piece counts only if the predicted winding temperature varies in it by
/// at least a quarter of its range over all runs.
std::vector<Piece> pieces_of(const ForecastModel& model, const ForecastFit& base, std::span<const estimation::MeasuredRun> runs);
/// Number of blocks of a single run.
inline constexpr std::size_t kBlocks = 4;
/// Smallest number of pieces that can select a network, and that can compare fits of the same network.
inline constexpr std::size_t kLeastPieces = 3;
inline constexpr std::size_t kLeastToCompare = 2;

/// Returns the weight of the left-out error in the expected error of a fit to all of `count` runs; the other part is the error of that fit
/// in its own runs. The error due to the parameters falls as 1/n with n runs. It lowers the error of the fitted runs as much as it raises
/// that of other runs (Akaike 1970). A left-out run is predicted from n − 1 runs, so its error alone would favour stiff models.
constexpr double left_out_weight(std::size_t count) {
  const auto n = static_cast<double>(count);
  return 2.0 * (n - 1.0) / (2.0 * n - 1.0);
}

/// Prediction of a piece by a fit that did not use it.
struct PredictedPiece {
  std::size_t run = 0;
  estimation::LinearisedRun path;  ///< with logarithm 0 of the heat factor; residual_K is NaN in rows that are not scored
  Eigen::MatrixXd covariance;      ///< covariance of θ
  double heat_W = 0.0;             ///< RMS heat of the run in the model that predicts it, from rms_heat_W()
};

/// Predicts a run, whose index is `index`, from given temperatures. `covariance` is that of θ.
PredictedPiece predicted_from(const ForecastModel& model, const Eigen::VectorXd& theta, const Eigen::MatrixXd& covariance,
                              const estimation::MeasuredRun& run, std::size_t index, const Eigen::VectorXd& start_C);

/// Predicts a run, whose index is `index`, from its first temperatures. `covariance` is that of θ.
PredictedPiece predicted_run(const ForecastModel& model, const Eigen::VectorXd& theta, const Eigen::MatrixXd& covariance,
                             const estimation::MeasuredRun& run, std::size_t index);

struct PieceScore {
  double score_nats = 0.0;  ///< mean over pieces and sensors of ½·ln(mean square error + noise²)
  std::vector<PredictedPiece> pieces;
};

/// Returns the parameters, found without a piece, that predict it. `starts` may be empty if the piece is a whole run. Throws Failure
/// (numerics_failed or cannot_answer) if there are none.
using FitWithout = std::function<ForecastFit(const Piece& piece)>;

/// Scores the prediction of each piece. The score is infinite if a fit or a simulation fails. `after_piece` is called
/// for each one; it may be empty.
PieceScore score_pieces(const ForecastModel& model, std::span<const estimation::MeasuredRun> runs, std::span<const Piece> pieces,
                        const FitWithout& fit_without, const std::function<void()>& after_piece = {});
/// Fits the forecast model without each piece, starting at `theta`. If `rules` is null, nothing is fitted and the parameters are `theta`.
/// `counter`, if given, counts the fits.
PieceScore score_pieces(const ForecastModel& model, std::span<const estimation::MeasuredRun> runs, std::span<const Piece> pieces,
                        const Eigen::VectorXd& theta, const ForecastRules* rules, FitCounter* counter = nullptr);

/// Returns the runs without the piece: without its run, or with its samples not measured.
std::vector<estimation::MeasuredRun> runs_without(std::span<const estimation::MeasuredRun> runs, const Piece& piece);

}  // namespace heatsoak::calibration
