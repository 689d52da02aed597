#include "estimation/design.h"

#include <Eigen/Dense>
#include <algorithm>

#include "base/parallel.h"
#include "estimation/averaged_run.h"
#include "estimation/open_loop.h"

namespace heatsoak::estimation {
namespace {

std::vector<Eigen::Index> nonzero_columns(const Columns& columns) {
  const Eigen::Array<bool, 1, Eigen::Dynamic> is_active = (columns.array() != 0.0).colwise().any();
  std::vector<Eigen::Index> active;
  for (Eigen::Index i = 0; i < is_active.size(); ++i) {
    if (is_active[i]) {
      active.push_back(i);
    }
  }
  return active;
}

/// Whitened products of one run without its start temperatures.
struct RunProducts {
  Eigen::MatrixXd square;
  double log_determinant = 0.0;
};

RunProducts without_starts(const Eigen::MatrixXd& square, const DesignRun& design, const Whitening& whitening) {
  const Eigen::Index x = design.run.states;
  const Eigen::Index rest = square.cols() - x;
  const Eigen::LLT<Eigen::MatrixXd> start(square.topLeftCorner(x, x));
  const Eigen::MatrixXd across = square.topRightCorner(x, rest);
  return {
      square.bottomRightCorner(rest, rest) - across.transpose() * start.solve(across),
      whitening.log_determinant() + 2.0 * start.matrixLLT().diagonal().array().log().sum() + 2.0 * design.start.sd_K.array().log().sum()};
}

}  // namespace

std::vector<DesignRun> design(const thermal::Network& network, const std::vector<LinearisedRun>& fitted,
                              const std::vector<MeasuredRun>& runs, const std::vector<Eigen::VectorXd>& weights,
                              const std::vector<int>& merged, const std::vector<Columns>& extra) {
  std::vector<DesignRun> all(runs.size());
  base::in_parallel(runs.size(), 0, [&](std::size_t r) {
    DesignRun& one = all[r];
    const Averaging averaging(fitted[r], weights.empty() ? Eigen::VectorXd() : weights[r], merged.empty() ? 1 : merged[r]);
    one.run = averaging.run();
    one.noise.weight = averaging.weight();
    one.interval_of = averaging.interval_of();
    for (const Sensor& sensor : runs[r].sensors) {
      one.noise.noise_K.push_back(sensor.noise_K);
    }
    const RunStart start = start_of(network, runs[r]);
    one.start = {start.prior_C - fitted[r].state_C.col(0), start.prior_sd_K};
    const Eigen::Index inner = fitted[r].by_parameter.cols();
    one.columns.resize(one.run.residual_K.size(), inner + (extra.empty() ? 0 : extra[r].cols()));
    one.columns.leftCols(inner) = averaging.average(fitted[r].by_parameter);
    if (!extra.empty()) {
      one.columns.rightCols(extra[r].cols()) = averaging.average(extra[r]);
    }
    one.active = nonzero_columns(one.columns);
  });
  return all;
}

ThetaPrior prior_here(const Model& model) {
  const Prior prior = model.full_prior();
  return {prior.precision, prior.mean - model.theta()};
}

std::vector<double> measured_start_C(const thermal::Network& network, const MeasuredRun& run) {
  const Eigen::VectorXd start_C = start_of(network, run).state_C;
  return {start_C.begin(), start_C.end()};
}

void add_start_prior(const StartPrior& start, Eigen::MatrixXd& square) {
  const Eigen::Index x = start.sd_K.size();
  const Eigen::VectorXd precision = start.sd_K.cwiseAbs2().cwiseInverse();
  const Eigen::VectorXd pull = precision.cwiseProduct(start.mean_K);
  square.topLeftCorner(x, x).diagonal() += precision;
  square.topRightCorner(x, 1) += pull;
  square.bottomLeftCorner(1, x) += pull.transpose();
  square.bottomRightCorner<1, 1>()(0, 0) += start.mean_K.dot(pull);
}

void add_without_starts(const Eigen::MatrixXd& square, const DesignRun& design, const Whitening& whitening, Products& sum) {
  const RunProducts left = without_starts(square, design, whitening);
  sum.square = sum.square.size() == 0 ? left.square : Eigen::MatrixXd(sum.square + left.square);
  sum.log_determinant += left.log_determinant;
}

Products products_of(std::span<const DesignRun> runs, const LatentFlux& flux, const std::vector<Eigen::Index>& columns) {
  Products out;
  for (const DesignRun& design : runs) {
    const Whitening whitening(design.run, flux, design.noise);
    const Eigen::Index x = design.run.states;
    const Eigen::Index count = columns.empty() ? design.columns.cols() : static_cast<Eigen::Index>(columns.size());
    // Effects of some runs only are zero in all others: half of the columns, and three quarters of the products.
    std::vector<Eigen::Index> taken, places;
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Index column = columns.empty() ? i : columns[static_cast<std::size_t>(i)];
      if (std::ranges::binary_search(design.active, column)) {
        taken.push_back(column);
        places.push_back(i);
      }
    }
    places.push_back(count);
    const auto active = static_cast<Eigen::Index>(taken.size());
    Columns tall(design.columns.rows(), x + active + 1);
    tall.leftCols(x) = design.run.by_start;
    tall.middleCols(x, active) = design.columns(Eigen::all, taken);
    tall.rightCols<1>() = design.run.residual_K;
    whitening.apply(tall);
    Eigen::MatrixXd square = Eigen::MatrixXd::Zero(tall.cols(), tall.cols());
    square.selfadjointView<Eigen::Lower>().rankUpdate(tall.transpose());
    square.triangularView<Eigen::StrictlyUpper>() = square.transpose();
    add_start_prior(design.start, square);
    const RunProducts left = without_starts(square, design, whitening);
    if (out.square.size() == 0) {
      out.square.setZero(count + 1, count + 1);
    }
    out.square(places, places) += left.square;
    out.log_determinant += left.log_determinant;
  }
  return out;
}

Reduced reduced(const Products& products, const ThetaPrior& prior) {
  const Eigen::Index t = prior.mean.size();
  const Eigen::Index e = products.square.cols() - 1 - t;
  const Eigen::MatrixXd& square = products.square;
  const Eigen::VectorXd pull = prior.precision * prior.mean;
  Eigen::MatrixXd normal = square.topLeftCorner(t, t) + prior.precision;
  // Keeps a parameter at its present value if neither the runs nor the prior determine it.
  normal.diagonal().array() += 1e-9;
  const Eigen::LDLT<Eigen::MatrixXd> theta(normal);
  const Eigen::VectorXd right = square.topRightCorner(t, 1) + pull;
  Reduced out;
  out.theta = theta.solve(right);
  out.theta_by_size = theta.solve(square.block(0, t, t, e));
  out.products = square.block(t, t, e, e) - square.block(t, 0, e, t) * out.theta_by_size;
  out.right = square.block(t, t + e, e, 1) - square.block(t, 0, e, t) * out.theta;
  out.whole = square.block(t, t, e, e).diagonal();
  const double misfit = square(t + e, t + e) + prior.mean.dot(pull) - right.dot(out.theta);
  out.base_nats = -0.5 * (misfit + products.log_determinant + theta.vectorD().array().log().sum());
  return out;
}

}  // namespace heatsoak::estimation
