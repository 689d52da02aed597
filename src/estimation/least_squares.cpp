#include "estimation/least_squares.h"

#include <ceres/ceres.h>
#include <glog/logging.h>

#include <limits>
#include <memory>

#include "base/diagnostic.h"
#include "base/parallel.h"
#include "estimation/linearised_run.h"

namespace heatsoak {
namespace {

/// Whitened residual and Jacobian of one run. Computed for all runs in parallel before Ceres evaluates the cost functions.
struct RunAnswer {
  Columns whitened;  ///< columns: ∂/∂θ, ∂/∂start, residual
  bool is_valid = false;
};

class AllRuns final : public ceres::EvaluationCallback {
 public:
  AllRuns(const LeastSquaresProblem& problem, const Eigen::VectorXd& theta, const std::vector<RunStart>& starts)
      : problem_(problem), theta_(theta), starts_(starts), answers_(problem.runs.size()) {
    for (const FreeParameter& parameter : problem.model->free) {
      wanted_.push_back(parameter.place);
    }
  }

  /// Always computes the Jacobians: they cost little more, and most points need them.
  void PrepareForEvaluation(bool /*with_jacobians*/, bool is_new_point) override {
    if (is_new_point) {
      in_parallel(answers_.size(), problem_.threads, [&](std::size_t r) { answers_[r] = answer(r); });
    }
  }
  [[nodiscard]] const RunAnswer& of(std::size_t run) const { return answers_[run]; }
  [[nodiscard]] const Eigen::VectorXd& theta() const { return theta_; }

 private:
  [[nodiscard]] RunAnswer answer(std::size_t r) const {
    const Model& model = *problem_.model;
    const std::vector<int> none;
    RunAnswer all;
    try {
      const std::vector<double> values = model.values_at(theta_);
      const Eigen::VectorXd& start_C = starts_[r].state_C;
      const LinearisedRun run =
          linearise(model.network, values, wanted_, none, {start_C.data(), static_cast<std::size_t>(start_C.size())}, problem_.runs[r]);
      const Eigen::Index free = model.free_count();
      all.whitened.resize(run.residual_K.size(), free + run.states + 1);
      all.whitened.leftCols(free) = by_theta(model, theta_, run.by_parameter);
      all.whitened.middleCols(free, run.states) = run.by_start;
      all.whitened.rightCols(1) = run.residual_K;
      if (problem_.whitening.empty()) {
        all.whitened /= problem_.white_noise_K;
        for (Eigen::Index row = 0; row < all.whitened.rows(); ++row) {
          if (std::isnan(run.residual_K[row])) {
            all.whitened.row(row).setZero();
          }
        }
      } else {
        problem_.whitening[r].apply(all.whitened);
      }
      all.is_valid = all.whitened.allFinite();
    } catch (const Failure&) {
      all.is_valid = false;
    }
    return all;
  }

  const LeastSquaresProblem& problem_;
  const Eigen::VectorXd& theta_;
  const std::vector<RunStart>& starts_;
  std::vector<int> wanted_;
  std::vector<RunAnswer> answers_;
};

using RowMajorMap = Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;

/// Whitened residuals of one run. The residual is measured − predicted, so the Jacobian is minus the sensitivity.
class RunCost final : public ceres::CostFunction {
 public:
  RunCost(const AllRuns& all, std::size_t run, Eigen::Index rows, Eigen::Index free, Eigen::Index states) : all_(all), run_(run) {
    set_num_residuals(static_cast<int>(rows));
    mutable_parameter_block_sizes()->assign({static_cast<int>(free), static_cast<int>(states)});
  }
  bool Evaluate(double const* const*, double* residuals, double** jacobians) const override {
    const RunAnswer& answer = all_.of(run_);
    if (!answer.is_valid) {
      return false;
    }
    const Eigen::Index rows = answer.whitened.rows();
    Eigen::Map<Eigen::VectorXd>(residuals, rows) = answer.whitened.rightCols(1);
    if (jacobians) {
      const Eigen::Index free = parameter_block_sizes()[0];
      const Eigen::Index states = parameter_block_sizes()[1];
      if (jacobians[0]) {
        RowMajorMap(jacobians[0], rows, free) = -answer.whitened.leftCols(free);
      }
      if (jacobians[1]) {
        RowMajorMap(jacobians[1], rows, states) = -answer.whitened.middleCols(free, states);
      }
    }
    return true;
  }

 private:
  const AllRuns& all_;
  std::size_t run_;
};

/// Gaussian prior with the residual root · (x − mean).
class PriorCost final : public ceres::CostFunction {
 public:
  PriorCost(Eigen::MatrixXd root, Eigen::VectorXd mean) : root_(std::move(root)), mean_(std::move(mean)) {
    set_num_residuals(static_cast<int>(root_.rows()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(mean_.size()));
  }
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Map<const Eigen::VectorXd> x(parameters[0], mean_.size());
    Eigen::Map<Eigen::VectorXd>(residuals, root_.rows()) = root_ * (x - mean_);
    if (jacobians && jacobians[0]) {
      RowMajorMap(jacobians[0], root_.rows(), root_.cols()) = root_;
    }
    return true;
  }

 private:
  Eigen::MatrixXd root_;
  Eigen::VectorXd mean_;
};

Eigen::MatrixXd root_of(const Eigen::MatrixXd& precision) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(precision);
  return solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() * solver.eigenvectors().transpose();
}

}  // namespace

LeastSquaresResult minimise(const LeastSquaresProblem& problem, Eigen::VectorXd& theta, std::vector<RunStart>& starts) {
  const Model& model = *problem.model;
  AllRuns all(problem, theta, starts);
  ceres::Problem::Options how;
  how.evaluation_callback = &all;
  ceres::Problem ceres_problem(how);
  ceres_problem.AddParameterBlock(theta.data(), static_cast<int>(theta.size()));
  for (std::size_t r = 0; r < problem.runs.size(); ++r) {
    const MeasuredRun& run = problem.runs[r];
    ceres_problem.AddResidualBlock(new RunCost(all, r, run.measured_C.size(), theta.size(), starts[r].state_C.size()), nullptr,
                                   theta.data(), starts[r].state_C.data());
    ceres_problem.AddResidualBlock(new PriorCost(starts[r].prior_sd_K.cwiseInverse().asDiagonal(), starts[r].prior_C), nullptr,
                                   starts[r].state_C.data());
  }
  ceres_problem.AddResidualBlock(new PriorCost(root_of(model.prior.precision), model.prior.mean), nullptr, theta.data());
  for (Eigen::Index i = 0; i < theta.size(); ++i) {
    const FreeParameter& parameter = model.free[static_cast<std::size_t>(i)];
    ceres_problem.SetParameterLowerBound(theta.data(), static_cast<int>(i), model.theta_of(i, parameter.low));
    ceres_problem.SetParameterUpperBound(theta.data(), static_cast<int>(i), model.theta_of(i, parameter.high));
  }
  if (problem.held >= 0 && theta.size() > 1) {
    ceres_problem.SetManifold(theta.data(), new ceres::SubsetManifold(static_cast<int>(theta.size()), {problem.held}));
  } else if (problem.held >= 0) {
    ceres_problem.SetParameterBlockConstant(theta.data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.max_num_iterations = problem.most_iterations;
  options.function_tolerance = 1e-7;
  options.parameter_tolerance = 1e-7;
  options.logging_type = ceres::SILENT;
  options.minimizer_progress_to_stdout = false;
  // A failed simulation is a valid result here; Ceres should not log it as an error.
  FLAGS_minloglevel = google::GLOG_FATAL;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &ceres_problem, &summary);
  if (summary.termination_type == ceres::FAILURE) {
    return {std::numeric_limits<double>::infinity(), false};
  }
  return {summary.final_cost, summary.termination_type == ceres::CONVERGENCE};
}

}  // namespace heatsoak
