// Linear algebra of an attribution. Products are compared with the matrix decomposition of the fit, linearised equations with free runs.
#include "estimation/design.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "estimation/flux_grid.h"
#include "estimation/smoothed_path.h"
#include "runs_for_tests.h"

namespace heatsoak::estimation {
namespace {

MeasuredRun run_of(std::uint64_t seed, int samples) {
  base::Random random(seed, 0);
  MeasuredRun run;
  run.name = "random";
  run.sensors = {{"winding_C", "winding", 0.15, 0.0}, {"stator_C", "stator", 0.1, 0.0}};
  run.signals = {thermal::Signal::current};
  run.measured_C.resize(samples, 2);
  for (int k = 0; k < samples; ++k) {
    run.time_s.push_back(k);
    if (k + 1 < samples) {
      run.at.emplace_back().current_rms_A = (k / 25) % 3 * 4.0 * random.uniform();
    }
    for (int sensor = 0; sensor < 2; ++sensor) {
      run.measured_C(k, sensor) = random.uniform() < 0.1 ? std::nan("") : 25.0 + 5.0 * random.uniform();
    }
  }
  return run;
}

TEST(Design, ProductsAreTheSquareOfTheTrianglesThatFitsUse) {
  const Model model = two_node_model({}, 1.0);
  const std::vector<MeasuredRun> runs{run_of(1, 200), run_of(2, 150)};
  std::vector<LinearisedRun> fitted;
  std::vector<Columns> extra;
  for (const MeasuredRun& run : runs) {
    fitted.push_back(linearise(model, std::vector<double>{25.0, 26.0}, run));
    extra.emplace_back(fitted.back().by_parameter.cwiseAbs2());
  }
  const std::vector<DesignRun> designs = design(model.network, fitted, runs, {}, {}, extra);
  const LatentFlux flux{{0.2, 0.3}, 100.0};
  const Products products = products_of(designs, flux, {});
  std::vector<RunEvidence> each;
  double log_determinant = 0.0;
  for (const DesignRun& one : designs) {
    each.push_back(run_evidence(one.run, one.columns, Whitening(one.run, flux, one.noise), one.start));
    log_determinant += each.back().log_determinant;
  }
  const Eigen::MatrixXd triangle = stacked(each);
  const Eigen::MatrixXd expected = triangle.transpose() * triangle;
  EXPECT_LT((products.square - expected).cwiseAbs().maxCoeff(), 1e-9 * expected.cwiseAbs().maxCoeff());
  EXPECT_NEAR(products.log_determinant, log_determinant, 1e-9 * std::abs(log_determinant));
  // A subset of columns in another order must give the same products.
  const Products few = products_of(designs, flux, {3, 0});
  const Eigen::Index last = products.square.cols() - 1;
  EXPECT_NEAR(few.square(0, 1), products.square(3, 0), 1e-9 * std::abs(products.square(3, 0)));
  EXPECT_NEAR(few.square(2, 1), products.square(last, 0), 1e-9 * std::abs(products.square(last, 0)));
}

/// Without added effects the evidence of the base model equals the evidence of the linear least-squares fit, up to a constant.
TEST(Design, EvidenceOfTheBaseIsThatOfItsLinearFit) {
  const Model model = two_node_model({}, 1.0);
  const std::vector<MeasuredRun> runs{run_of(3, 200)};
  const std::vector<LinearisedRun> fitted{linearise(model, std::vector<double>{25.0, 26.0}, runs.front())};
  const std::vector<DesignRun> designs = design(model.network, fitted, runs, {}, {}, {});
  const ThetaPrior prior = prior_here(model);
  std::vector<double> difference_nats;
  for (const double flux_W : {0.02, 0.3, 2.0}) {
    const LatentFlux flux{{flux_W, flux_W}, 200.0};
    const DesignRun& one = designs.front();
    const std::vector<RunEvidence> evidence{run_evidence(one.run, one.columns, Whitening(one.run, flux, one.noise), one.start)};
    const LinearFit fit = linear_fit(evidence, prior.mean, prior.precision);
    const Reduced base = reduced(products_of(designs, flux, {}), prior);
    difference_nats.push_back(base.base_nats - fit.log_evidence);
    EXPECT_LT((base.theta - fit.coefficients).norm(), 1e-5 * (1.0 + fit.coefficients.norm()));
  }
  EXPECT_NEAR(difference_nats[0], difference_nats[1], 1e-4);
  EXPECT_NEAR(difference_nats[0], difference_nats[2], 1e-4);
}

TEST(Design, EquationsAboutTheFreeRunAreTheFreeRun) {
  const Model model = two_node_model({}, 1.0);
  const MeasuredRun run = run_of(4, 200);
  const LinearisedRun freely = linearise(model, std::vector<double>{25.0, 26.0}, run);
  const LinearisedRun along = linearise_along(model, freely.state_C, run);
  EXPECT_LT((along.sensor_C - freely.sensor_C).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((along.by_parameter - freely.by_parameter).cwiseAbs().maxCoeff(), 1e-9 * freely.by_parameter.cwiseAbs().maxCoeff());
}

/// Equations linearised about a path with error e predict the free run from the path's start. Their error is of order e², because copper
/// loss is slightly non-linear.
TEST(Design, EquationsAboutAnotherPathPredictTheFreeRun) {
  const Model model = two_node_model({}, 1.0);
  const MeasuredRun run = run_of(5, 300);
  const LinearisedRun freely = linearise(model, std::vector<double>{25.0, 26.0}, run);
  std::vector<double> off_K;
  for (const double size_K : {4.0, 2.0}) {
    Eigen::MatrixXd path_C = freely.state_C;
    for (Eigen::Index k = 1; k < path_C.cols(); ++k) {
      path_C.col(k).array() += size_K * std::sin(0.05 * static_cast<double>(k));
    }
    off_K.push_back((linearise_along(model, path_C, run).sensor_C - freely.sensor_C).cwiseAbs().maxCoeff());
  }
  EXPECT_LT(off_K[0], 0.02);
  EXPECT_LT(off_K[1], 0.3 * off_K[0] + 1e-6);
}

/// 2 W of unmodelled heat for 100 of 300 s: the smoothed path must follow the true temperatures.
TEST(Design, SmoothedPathFollowsUnknownHeat) {
  const Model model = two_node_model({}, 1.0);
  Model truth = model;
  truth.network.add_effect("lamp", *thermal::find_effect("constant_heat"), std::vector<std::string>{"stator"}, std::vector<double>{2.0});
  truth.values = truth.network.values();
  truth.free.clear();
  truth.prior = {Eigen::VectorXd(0), Eigen::MatrixXd(0, 0)};
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    MeasuredRun run = run_of(seed, 300);
    const LinearisedRun real = linearise(truth, std::vector<double>{25.0, 26.0}, run);
    base::Random random(seed, 1);
    for (Eigen::Index k = 0; k < run.samples(); ++k) {
      for (Eigen::Index sensor = 0; sensor < 2; ++sensor) {
        run.measured_C(k, sensor) = real.sensor_C(k, sensor) + 0.2 * (random.uniform() - 0.5);
      }
    }
    const LinearisedRun freely = linearise(model, std::vector<double>{25.0, 26.0}, run);
    const double far_K = (freely.state_C - real.state_C).cwiseAbs().maxCoeff();
    const double near_K = (smoothed_path_C(freely, {{0.5, 2.0}, 400.0}, {{0.1, 0.1}, {}}) - real.state_C).cwiseAbs().maxCoeff();
    EXPECT_GT(far_K, 2.0) << seed;
    EXPECT_LT(near_K, 0.15) << seed;
  }
}

TEST(FluxGrid, AscentEndsWhereNoNeighbourIsHigher) {
  const FluxGrid grid = flux_grid(0.5, 50.0, 2);
  const FluxPlace top{1, 4, 2, 2, 0};
  const auto nats = [&](const FluxPlace& place) {
    double sum = 0.0;
    for (std::size_t axis = 0; axis < place.size(); ++axis) {
      sum -= std::pow(place[axis] - top[axis], 2);
    }
    return sum;
  };
  EXPECT_EQ(most_probable(grid, grid.middle(), nats), top);
  EXPECT_EQ(most_probable(grid, {0, 0, 0, 0, 1}, nats), top);
}

}  // namespace
}  // namespace heatsoak::estimation
