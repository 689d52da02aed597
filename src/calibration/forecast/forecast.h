// Finds the model that forecasts other runs of a motor best: parameters from free runs, network selected by left-out pieces, error band.
#pragma once

#include <string>
#include <vector>

#include "base/job_progress.h"
#include "calibration/forecast/band.h"
#include "calibration/forecast/forecast_setup.h"
#include "calibration/forecast/forecast_work.h"

namespace heatsoak::calibration {

/// Origin of a forecast's parameters. `ordinary` is the simple alternative: least squares of free runs without extensions. `innovations`
/// explains the response within seconds; Forecast::source is never that.
enum class ForecastSource { file, ordinary, tempered, innovations };

struct AcceptedExtension {
  std::string name;
  double gain_nats = 0.0;  ///< decrease of the score of the left-out pieces
};

/// Error per signal, root of the mean square over the pieces.
using SignalErrors = std::vector<std::pair<std::string, double>>;

/// Score of one alternative.
struct RivalScore {
  ForecastSource source = ForecastSource::file;
  double score_nats = 0.0;       ///< expected for a fit to all runs, see left_out_weight(); smaller is better
  SignalErrors rmse_K;           ///< errors in the left-out pieces
  SignalErrors expected_K = {};  ///< expected for a fit to all runs
};

struct Forecast {
  ForecastSetup setup;  ///< includes the accepted extensions
  ForecastSource source = ForecastSource::tempered;
  ForecastFit fit;
  std::vector<AcceptedExtension> accepted;
  std::vector<Piece> pieces;       ///< left-out pieces; fewer than kLeastPieces select no network
  std::vector<RivalScore> rivals;  ///< empty if there are too few pieces
  motor::ForecastBand band;

  [[nodiscard]] ForecastModel model() const { return setup.model(); }
};

/// Scores an alternative by the left-out pieces. If they are whole runs, the expected score also includes those of the fit to all runs.
RivalScore rival_score(ForecastSource source, const PieceScore& left_out, const PieceScore& fitted,
                       std::span<const estimation::MeasuredRun> runs);

/// Decrease of the score per parameter from which one model counts as better: 5 % of the RMS error.
inline constexpr double kLeastGain_nats = 0.05;

/// Returns the phases of a calibration. `threads`: 0 for all cores.
std::vector<base::JobPhase> calibration_work(std::span<const estimation::MeasuredRun> runs, int threads);

/// Finds the best forecast model. `hints` are additional starting points in θ of the setup's model. Deterministic.
Forecast forecast_of(ForecastSetup setup, std::span<const estimation::MeasuredRun> runs, std::span<const Eigen::VectorXd> hints,
                     int threads, const base::JobProgress& progress = {});

}  // namespace heatsoak::calibration
