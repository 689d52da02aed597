#include "estimation/smoothed_path.h"

#include "estimation/evidence.h"

namespace heatsoak::estimation {

Eigen::MatrixXd smoothed_path_C(const LinearisedRun& run, const LatentFlux& flux, const SensorNoise& noise) {
  constexpr double kStart_K = 5.0;
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Whitening whitening(run, flux, noise);
  const StartPrior start{Eigen::VectorXd::Zero(run.states), Eigen::VectorXd::Constant(run.states, kStart_K)};
  Eigen::VectorXd off_K = start_correction_K(run, Columns(run.residual_K.size(), 0), Eigen::VectorXd(0), whitening, start);
  const Eigen::MatrixXd heat_W = whitening.smoothed_flux(run.residual_K - run.by_start * off_K).mean_W;
  Eigen::MatrixXd path_C = run.state_C;
  for (Eigen::Index k = 0; k < run.samples(); ++k) {
    path_C.col(k) += off_K;
    if (k + 1 < run.samples()) {
      const Eigen::Map<const RowMajor> transition(run.transition.data() + k * run.states * run.states, run.states, run.states);
      const Eigen::Map<const RowMajor> injection(run.injection.data() + k * run.states * run.fluxes, run.states, run.fluxes);
      off_K = transition * off_K.eval() + injection * heat_W.col(k);
    }
  }
  return path_C;
}

}  // namespace heatsoak::estimation
