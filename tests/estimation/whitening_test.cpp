#include "estimation/whitening.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "estimation/averaged_run.h"
#include "estimation/evidence.h"
#include "runs_for_tests.h"

namespace heatsoak::estimation {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Returns a run of random numbers, which is sufficient to test linear algebra.
MeasuredRun random_run(std::uint64_t seed, int samples) {
  base::Random random(seed, 0);
  MeasuredRun run;
  run.name = "random";
  run.sensors = {{"winding_C", "winding", 0.15, 0.0}, {"stator_C", "stator", 0.1, 0.0}};
  run.signals = {thermal::Signal::current};
  run.measured_C.resize(samples, 2);
  double time_s = 0.0;
  for (int k = 0; k < samples; ++k) {
    run.time_s.push_back(time_s);
    time_s += 0.5 + 1.5 * random.uniform();
    if (k + 1 < samples) {
      thermal::OperatingPoint<double> at;
      at.current_rms_A = (k / 20) % 3 * 4.0 * random.uniform();
      run.at.push_back(at);
      if (k % 17 == 11) {
        at.current_rms_A += 6.0;
        run.unknown_inputs.push_back({k, at});
      }
    }
    for (int sensor = 0; sensor < 2; ++sensor) {
      run.measured_C(k, sensor) = random.uniform() < 0.1 ? kNan : 25.0 + 5.0 * random.uniform();
    }
  }
  return run;
}

LinearisedRun linearised(const Model& model, const MeasuredRun& run) {
  std::vector<int> wanted;
  for (const FreeParameter& parameter : model.free) {
    wanted.push_back(parameter.place);
  }
  return linearise(model.network, model.values, wanted, model.flux_nodes, std::vector<double>{25.0, 25.0}, run);
}

/// Returns the sensors' response, row by row, to an impulse on the state at the end of interval `j`.
Eigen::VectorXd response_to(const LinearisedRun& run, Eigen::Index j, Eigen::VectorXd state) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::VectorXd response = Eigen::VectorXd::Zero(run.residual_K.size());
  for (Eigen::Index k = j + 1; k < run.samples(); ++k) {
    for (Eigen::Index sensor = 0; sensor < run.sensors(); ++sensor) {
      response[k * run.sensors() + sensor] = state[run.sensor_node[static_cast<std::size_t>(sensor)]];
    }
    if (k + 1 < run.samples()) {
      state = Eigen::Map<const RowMajor>(run.transition.data() + k * run.states * run.states, run.states, run.states) * state.eval();
    }
  }
  return response;
}

/// Covariance of the sensors' samples as a dense matrix: noise on the diagonal, and the responses to every moment of the flux and to
/// unlogged inputs.
Eigen::MatrixXd dense_covariance(const LinearisedRun& run, const LatentFlux& flux, const SensorNoise& noise) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Index samples = run.samples();
  const Eigen::Index rows = samples * run.sensors();
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(rows, rows);
  for (Eigen::Index f = 0; f < run.fluxes; ++f) {
    Eigen::MatrixXd response = Eigen::MatrixXd::Zero(rows, samples - 1);
    Eigen::MatrixXd memory(samples - 1, samples - 1);
    double moment_s = 0.0;
    std::vector<double> begin_s;
    for (Eigen::Index j = 0; j + 1 < samples; ++j) {
      begin_s.push_back(moment_s);
      moment_s += run.duration_s[static_cast<std::size_t>(j)];
      response.col(j) = response_to(
          run, j, Eigen::Map<const RowMajor>(run.injection.data() + j * run.states * run.fluxes, run.states, run.fluxes).col(f));
    }
    for (Eigen::Index i = 0; i + 1 < samples; ++i) {
      for (Eigen::Index j = 0; j + 1 < samples; ++j) {
        memory(i, j) = std::pow(flux.rms_W[static_cast<std::size_t>(f)], 2) *
                       std::exp(-std::abs(begin_s[static_cast<std::size_t>(i)] - begin_s[static_cast<std::size_t>(j)]) / flux.time_scale_s);
      }
    }
    covariance += response * memory * response.transpose();
  }
  for (const StateUncertainty& uncertainty : run.state_uncertainties) {
    // The covariance has rank one: the difference between two possible courses of the inputs.
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(uncertainty.covariance_K2);
    const Eigen::VectorXd response =
        response_to(run, uncertainty.interval, modes.eigenvectors().rightCols(1) * std::sqrt(modes.eigenvalues().tail(1)[0]));
    covariance += response * response.transpose();
  }
  for (Eigen::Index sensor = 0; flux.drift_K > 0.0 && sensor < run.sensors(); ++sensor) {
    std::vector<double> at_s{0.0};
    for (const double duration_s : run.duration_s) {
      at_s.push_back(at_s.back() + duration_s);
    }
    for (Eigen::Index i = 0; i < samples; ++i) {
      for (Eigen::Index j = 0; j < samples; ++j) {
        const double apart_s = std::abs(at_s[static_cast<std::size_t>(i)] - at_s[static_cast<std::size_t>(j)]);
        covariance(i * run.sensors() + sensor, j * run.sensors() + sensor) +=
            std::pow(flux.drift_K, 2) * std::exp(-apart_s / flux.drift_time_scale_s);
      }
    }
  }
  for (Eigen::Index row = 0; row < rows; ++row) {
    covariance(row, row) += std::pow(noise.noise_K[static_cast<std::size_t>(row % run.sensors())], 2);
  }
  return covariance;
}

struct Dense {
  Eigen::MatrixXd covariance;  ///< covariance of the valid rows
  Columns columns;             ///< valid rows of [start, parameters, residual]
};

Dense dense(const LinearisedRun& run, const LatentFlux& flux, const SensorNoise& noise) {
  Columns all(run.by_parameter.rows(), run.states + run.by_parameter.cols() + 1);
  all << run.by_start, run.by_parameter, run.residual_K;
  const Eigen::MatrixXd covariance = dense_covariance(run, flux, noise);
  std::vector<Eigen::Index> kept;
  for (Eigen::Index row = 0; row < all.rows(); ++row) {
    if (!std::isnan(run.residual_K[row])) {
      kept.push_back(row);
    }
  }
  return {covariance(kept, kept), all(kept, Eigen::all)};
}

void expect_products_of_generalised_least_squares(const LinearisedRun& run, const LatentFlux& flux, const SensorNoise& noise) {
  const Dense reference = dense(run, flux, noise);
  const Eigen::LDLT<Eigen::MatrixXd> decomposed(reference.covariance);
  const Eigen::MatrixXd expected = reference.columns.transpose() * decomposed.solve(Eigen::MatrixXd(reference.columns));
  const Whitening whitening(run, flux, noise);
  Columns all(run.by_parameter.rows(), run.states + run.by_parameter.cols() + 1);
  all << run.by_start, run.by_parameter, run.residual_K;
  whitening.apply(all);
  const Eigen::MatrixXd gram = all.transpose() * all;
  for (Eigen::Index i = 0; i < gram.rows(); ++i) {
    for (Eigen::Index j = 0; j < gram.cols(); ++j) {
      EXPECT_NEAR(gram(i, j), expected(i, j), 1e-9 * std::sqrt(expected(i, i) * expected(j, j))) << i << ' ' << j;
    }
  }
  EXPECT_NEAR(whitening.log_determinant(), decomposed.vectorD().array().log().sum(), 1e-9 * static_cast<double>(whitening.count()));
  EXPECT_EQ(whitening.count(), reference.columns.rows());
}

TEST(Whitening, products_of_columns_are_those_of_generalised_least_squares_with_the_covariance_written_out) {
  for (const LatentFlux& flux : {LatentFlux{{0.3, 0.7}, 90.0}, LatentFlux{{0.0, 0.0}, 90.0}, LatentFlux{{2.0, 0.0}, 20.0},
                                 LatentFlux{{0.3, 0.7}, 90.0, 0.5, 7.0}, LatentFlux{{0.0, 0.4}, 90.0, 0.3, 7.0}}) {
    const LinearisedRun run = linearised(two_node_model({}, 1.0), random_run(3, 100));
    expect_products_of_generalised_least_squares(run, flux, {{0.15, 0.1}, {}});
  }
}

/// Random stable network with the given numbers of nodes, unknown heats and sensors, whose impulse response decays within some steps.
LinearisedRun random_linearised_run(Eigen::Index states, Eigen::Index fluxes, int sensors) {
  constexpr Eigen::Index kSamples = 40;
  base::Random random(11, 0);
  LinearisedRun run;
  run.states = states;
  run.fluxes = fluxes;
  for (int sensor = 0; sensor < sensors; ++sensor) {
    run.sensor_node.push_back(sensor);
  }
  const auto any = [&random](Eigen::Index rows, Eigen::Index columns) {
    return Columns(Columns::NullaryExpr(rows, columns, [&random] { return random.uniform() - 0.5; }));
  };
  run.state_C = Eigen::MatrixXd::Constant(states, kSamples, 25.0);
  run.residual_K = any(kSamples * sensors, 1);
  run.residual_K[7] = kNan;
  run.by_start = any(kSamples * sensors, states);
  run.by_parameter = any(kSamples * sensors, 3);
  for (Eigen::Index k = 0; k + 1 < kSamples; ++k) {
    const Columns transition = 0.6 * Columns::Identity(states, states) + 0.2 * any(states, states);
    const Columns injection = any(states, fluxes);
    run.transition.insert(run.transition.end(), transition.data(), transition.data() + transition.size());
    run.injection.insert(run.injection.end(), injection.data(), injection.data() + injection.size());
    run.duration_s.push_back(1.0 + random.uniform());
  }
  return run;
}

TEST(Whitening, is_the_same_operator_for_any_number_of_nodes_heats_and_sensors) {
  struct Size {
    Eigen::Index states, fluxes;
    int sensors;
  };
  for (const auto& [states, fluxes, sensors] : {Size{2, 2, 1}, Size{2, 1, 2}, Size{3, 2, 2}, Size{3, 3, 1}, Size{3, 3, 3}, Size{5, 4, 2}}) {
    for (const bool drifts : {false, true}) {
      SCOPED_TRACE(testing::Message() << states << " nodes, " << fluxes << " heats, " << sensors << " sensors, slow errors " << drifts);
      const LatentFlux flux{std::vector<double>(static_cast<std::size_t>(fluxes), 0.4), 5.0, drifts ? 0.3 : 0.0, 7.0};
      expect_products_of_generalised_least_squares(random_linearised_run(states, fluxes, sensors), flux,
                                                   {std::vector<double>(static_cast<std::size_t>(sensors), 0.2), {}});
    }
  }
}

class SmoothedFlux : public testing::TestWithParam<double> {};

TEST_P(SmoothedFlux, is_the_conditional_mean) {
  const LinearisedRun run = linearised(two_node_model({}, 1.0), random_run(5, 60));
  const LatentFlux flux{{0.3, 0.7}, 90.0, GetParam(), 7.0};
  const SensorNoise noise{{0.15, 0.1}, {}};
  const Dense reference = dense(run, flux, noise);
  // V_flux·V⁻¹·y is the sensors' response to the conditional mean of the flux.
  const Eigen::VectorXd residual = reference.columns.rightCols(1);
  const Eigen::VectorXd weighted = reference.covariance.ldlt().solve(residual);
  LinearisedRun certain = run;
  certain.state_uncertainties.clear();
  const Eigen::VectorXd explained = dense(certain, {flux.rms_W, flux.time_scale_s}, {{0.0, 0.0}, {}}).covariance * weighted;
  const Eigen::MatrixXd flux_W = Whitening(run, flux, noise).smoothed_flux(run.residual_K).mean_W;
  Eigen::VectorXd state = Eigen::VectorXd::Zero(2);
  Eigen::Index kept = 0;
  for (Eigen::Index k = 0; k < run.samples(); ++k) {
    for (Eigen::Index sensor = 0; sensor < 2; ++sensor) {
      if (!std::isnan(run.residual_K[k * 2 + sensor])) {
        EXPECT_NEAR(state[sensor], explained[kept], 1e-8) << k;
        ++kept;
      }
    }
    if (k + 1 < run.samples()) {
      const double* const transition = run.transition.data() + k * 4;
      const double* const injection = run.injection.data() + k * 4;
      const Eigen::Vector2d before = state;
      for (int i = 0; i < 2; ++i) {
        state[i] = transition[2 * i] * before[0] + transition[2 * i + 1] * before[1] + injection[2 * i] * flux_W(0, k) +
                   injection[2 * i + 1] * flux_W(1, k);
      }
    }
  }
}

/// The variance explained by the estimate and the posterior variance must add up to the flux's prior variance.
TEST_P(SmoothedFlux, has_the_standard_deviation_that_is_left) {
  const LinearisedRun run = linearised(two_node_model({}, 1.0), random_run(5, 40));
  const LatentFlux flux{{0.3, 0.7}, 90.0, GetParam(), 7.0};
  const SensorNoise noise{{0.15, 0.1}, {}};
  const Whitening whitening(run, flux, noise);
  const Eigen::MatrixXd sd_W = whitening.smoothed_flux(run.residual_K).sd_W;
  const Dense reference = dense(run, flux, noise);
  Eigen::MatrixXd by_sample(2 * run.samples(), reference.covariance.rows());
  Eigen::Index kept = 0;
  for (Eigen::Index row = 0; row < run.residual_K.size(); ++row) {
    if (!std::isnan(run.residual_K[row])) {
      const Eigen::VectorXd unit = Eigen::VectorXd::Unit(run.residual_K.size(), row);
      by_sample.col(kept++) = whitening.smoothed_flux(unit).mean_W.reshaped();
    }
  }
  const Eigen::MatrixXd explained = by_sample * reference.covariance * by_sample.transpose();
  for (Eigen::Index k = 0; k < run.samples(); ++k) {
    for (Eigen::Index f = 0; f < 2; ++f) {
      const double own_W = flux.rms_W[static_cast<std::size_t>(f)];
      EXPECT_NEAR(sd_W(f, k), std::sqrt(own_W * own_W - explained(2 * k + f, 2 * k + f)), 1e-8) << k;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Whitening, SmoothedFlux, testing::Values(0.0, 0.4),
                         [](const auto& instance) { return instance.param > 0.0 ? "drifting_sensors" : "steady_sensors"; });

TEST(Whitening, a_common_factor_of_heat_capacities_conductances_and_sources_changes_no_temperature) {
  const MeasuredRun run = random_run(7, 200);
  TwoNodeTruth scaled;
  const TwoNodeTruth plain;
  constexpr double kFactor = 1.7;
  scaled.winding_J_per_K *= kFactor;
  scaled.stator_J_per_K *= kFactor;
  scaled.winding_stator_K_per_W /= kFactor;
  scaled.stator_ambient_K_per_W /= kFactor;
  scaled.resistance_25C_ohm *= kFactor;
  const LinearisedRun a = linearised(two_node_model(plain, 1.0), run);
  const LinearisedRun b = linearised(two_node_model(scaled, 1.0), run);
  EXPECT_LT((a.state_C - b.state_C).cwiseAbs().maxCoeff(), 1e-10);
}

/// Covariance of the state at the end of interval `to` − 1, caused by the input uncertainties of intervals `from` … `to` − 1.
Eigen::MatrixXd uncertainty_after_K2(const LinearisedRun& run, Eigen::Index from, Eigen::Index to) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::MatrixXd covariance_K2 = Eigen::MatrixXd::Zero(run.states, run.states);
  for (Eigen::Index k = from; k < to; ++k) {
    const Eigen::Map<const RowMajor> step(run.transition.data() + k * run.states * run.states, run.states, run.states);
    covariance_K2 = step * covariance_K2.eval() * step.transpose();
    for (const StateUncertainty& uncertainty : run.state_uncertainties) {
      covariance_K2 += uncertainty.interval == k ? uncertainty.covariance_K2 : Eigen::MatrixXd::Zero(run.states, run.states);
    }
  }
  return covariance_K2;
}

TEST(AveragedRun, uncertainties_of_its_segments_are_those_of_the_run) {
  const LinearisedRun run = linearised(two_node_model({}, 1.0), random_run(5, 90));
  ASSERT_GT(run.state_uncertainties.size(), 3U);
  const LinearisedRun averaged = Averaging(run, {}, 3).run();  // covers samples 1 to 88
  EXPECT_LT((uncertainty_after_K2(averaged, 0, averaged.samples() - 1) - uncertainty_after_K2(run, 1, 88)).norm(), 1e-12);
  EXPECT_GT(uncertainty_after_K2(run, 1, 88).norm(), 1e-3);
}

TEST(Evidence, one_more_column_gains_what_the_projected_score_says) {
  // Frisch, Waugh, Lovell: a candidate added to the base gains ½·s²/v, calculated from the parts orthogonal to the base.
  const LinearisedRun run = linearised(two_node_model({}, 1.0), random_run(11, 150));
  const Whitening whitening(run, {{0.2, 0.3}, 100.0}, {{0.15, 0.1}, {}});
  const StartPrior start{Eigen::VectorXd::Zero(2), Eigen::VectorXd::Constant(2, 5.0)};
  const auto misfit = [&](Eigen::Index columns) {
    const std::vector<RunEvidence> one{run_evidence(run, run.by_parameter.leftCols(columns), whitening, start)};
    const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(columns, columns);
    return linear_fit(one, Eigen::VectorXd::Zero(columns), none).misfit;
  };
  const RunEvidence all = run_evidence(run, run.by_parameter, whitening, start);
  // The diagonal of the triangle's last column is the norm of the candidate's orthogonal part. The entry beside it is the score divided by
  // this norm.
  const double gain = all.triangle(3, 4) * all.triangle(3, 4);
  EXPECT_NEAR(misfit(3) - misfit(4), gain, 1e-8 * misfit(3));
}

TEST(Evidence, many_runs_say_what_one_long_least_squares_says) {
  const Model model = two_node_model({}, 1.0);
  const StartPrior start{Eigen::VectorXd::Constant(2, 0.3), Eigen::VectorXd::Constant(2, 5.0)};
  const LatentFlux flux{{0.2, 0.3}, 100.0};
  const SensorNoise noise{{0.15, 0.1}, {}};
  std::vector<RunEvidence> runs;
  Eigen::MatrixXd precision = Eigen::MatrixXd::Identity(4, 4) * 3.0;
  precision(0, 1) = precision(1, 0) = 1.0;
  const Eigen::VectorXd mean = Eigen::VectorXd::Constant(4, 0.2);
  Eigen::MatrixXd normal = precision;
  Eigen::VectorXd right = precision * mean;
  double log_determinant = 0.0;
  double squares = mean.dot(precision * mean);
  for (const std::uint64_t seed : {1, 2, 3}) {
    const LinearisedRun run = linearised(model, random_run(seed, 80));
    runs.push_back(run_evidence(run, run.by_parameter, Whitening(run, flux, noise), start));
    // Includes the prior of the start temperatures in the samples' covariance.
    Dense reference = dense(run, flux, noise);
    const Eigen::MatrixXd by_start = reference.columns.leftCols(2);
    reference.covariance += 25.0 * by_start * by_start.transpose();
    const Eigen::LDLT<Eigen::MatrixXd> decomposed(reference.covariance);
    const Eigen::MatrixXd columns = reference.columns.middleCols(2, 4);
    const Eigen::VectorXd residual = reference.columns.rightCols(1) - 0.3 * by_start.rowwise().sum();
    normal += columns.transpose() * decomposed.solve(columns);
    right += columns.transpose() * decomposed.solve(residual);
    squares += residual.dot(decomposed.solve(residual));
    log_determinant += decomposed.vectorD().array().log().sum();
  }
  const LinearFit fit = linear_fit(runs, mean, precision);
  const Eigen::LDLT<Eigen::MatrixXd> solved(normal);
  const Eigen::VectorXd expected = solved.solve(right);
  EXPECT_LT((fit.coefficients - expected).norm(), 1e-8 * expected.norm());
  EXPECT_LT((fit.covariance - solved.solve(Eigen::MatrixXd::Identity(4, 4))).norm(), 1e-8 * fit.covariance.norm());
  const double misfit = squares - right.dot(expected);
  EXPECT_NEAR(fit.misfit, misfit, 1e-8 * squares);
  const double evidence = -0.5 * (misfit + log_determinant + solved.vectorD().array().log().sum() - std::log(precision.determinant()));
  EXPECT_NEAR(fit.log_evidence, evidence, 1e-8 * std::abs(evidence));
}

}  // namespace
}  // namespace heatsoak::estimation
