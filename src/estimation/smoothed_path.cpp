#include "estimation/smoothed_path.h"

#include "base/parallel.h"
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

std::vector<FluxEstimate> smoothed_flux(const Posterior& fit, const std::vector<MeasuredRun>& runs,
                                        const std::vector<Eigen::VectorXd>& weights, const std::vector<int>& merged) {
  std::vector<FluxEstimate> all(fit.fitted.size());
  const std::vector<DesignRun> designs = design(fit.model.network, fit.fitted, runs, weights, merged, {});
  base::in_parallel(all.size(), 0, [&](std::size_t r) {
    all[r] = Whitening(designs[r].run, fit.flux, designs[r].noise).smoothed_flux(designs[r].run.residual_K);
  });
  return all;
}

Eigen::VectorXd rms_W(const std::vector<FluxEstimate>& runs) {
  Eigen::VectorXd squares_W2 = Eigen::VectorXd::Zero(runs.front().mean_W.rows());
  double count = 0.0;
  for (const FluxEstimate& run : runs) {
    squares_W2 += run.mean_W.rowwise().squaredNorm();
    count += static_cast<double>(run.mean_W.cols());
  }
  return (squares_W2 / count).cwiseSqrt();
}

}  // namespace heatsoak::estimation
