// Left-out pieces: what a network is scored on, each piece predicted by a fit to the others.
#pragma once

#include <string>
#include <vector>

#include "identify/forecast/forecast_fit.h"

namespace heatsoak {

/// A run, or a block of a single run; the fit sees the rest.
struct Piece {
  std::size_t run = 0;
  RowMask seen;    ///< rows of its run that the fit sees; empty: the whole run is left out
  RowMask scored;  ///< rows of its run that are predicted
};

/// Runs, or four masked blocks of a single run. A piece counts only if the fitted base model moves the winding in it by a quarter of its
/// range over all runs: from fewer than three pieces no network can be chosen.
std::vector<Piece> pieces_of(const ForecastModel& model, const ForecastFit& base, std::span<const MeasuredRun> runs);
inline constexpr std::size_t kLeastPieces = 3;

/// A piece as predicted by a fit that has not seen it.
struct PredictedPiece {
  std::size_t run = 0;
  LinearisedRun path;          ///< heat factor 0; residual_K is NaN where a row is not scored
  Eigen::MatrixXd covariance;  ///< of θ
  std::vector<double> values;  ///< the network's parameters
};

struct PieceScore {
  double score_nats = 0.0;  ///< mean over pieces and sensors of ½·ln(mean square error + noise²)
  std::vector<PredictedPiece> pieces;
};

/// `rules` of the fits, which begin at `theta`; without rules the parameters are `theta`.
PieceScore score_pieces(const ForecastModel& model, std::span<const MeasuredRun> runs, std::span<const Piece> pieces,
                        const Eigen::VectorXd& theta, const ForecastRules* rules);

}  // namespace heatsoak
