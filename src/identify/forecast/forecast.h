// The model that forecasts other runs of a motor best: parameters by free runs, network by left-out pieces, and how far it may be off.
#pragma once

#include <string>
#include <vector>

#include "identify/forecast/band.h"
#include "identify/forecast/forecast_setup.h"

namespace heatsoak {

/// Where the parameters of a forecast come from. `ordinary` is the simple rival: least squares of free runs, no extension.
enum class ForecastSource { file, ordinary, tempered };

struct AcceptedExtension {
  std::string name;
  double gain_nats = 0.0;  ///< by which the score of the left-out pieces fell
};

/// What the left-out pieces say of a rival.
struct RivalScore {
  ForecastSource source = ForecastSource::file;
  double score_nats = 0.0;                             ///< the smaller the better
  std::vector<std::pair<std::string, double>> rmse_K;  ///< per signal, mean square over the pieces
};

struct Forecast {
  ForecastSetup setup;  ///< with the accepted extensions
  ForecastSource source = ForecastSource::tempered;
  ForecastFit fit;
  std::vector<AcceptedExtension> accepted;
  std::size_t pieces = 0;          ///< that could be left out; fewer than kLeastPieces choose nothing
  std::vector<RivalScore> rivals;  ///< empty: too few pieces
  ForecastBand band;

  [[nodiscard]] ForecastModel model() const { return setup.model(); }
};

/// `hints`: more parameters of the setup's model to begin at. Deterministic.
Forecast forecast_of(ForecastSetup setup, std::span<const MeasuredRun> runs, std::span<const Eigen::VectorXd> hints, int threads);

}  // namespace heatsoak
