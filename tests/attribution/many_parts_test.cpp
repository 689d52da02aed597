// A motor with poor thermal contact between its parts, which two nodes approximate badly. Fast and slow transients need different
// parameters. The fit favours forecasts of whole runs, and the remaining error must not be reported as a missing effect.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>

#include "examination.h"
#include "scoring.h"

namespace heatsoak::attribution::truth {
namespace {

Case loose(std::uint64_t seed) {
  Case one;
  one.metal_ratio = 0.02;
  one.seed = seed;
  return one;
}

Calibrated calibrated(const Case& one, const std::vector<TrueRun>& runs) { return calibrated(one, record(one).make, runs); }

TEST(ManyParts, FreeRunsDecideTheParametersIfTwoNodesAreTooFew) {
  const SeedRate rate = rate_over_seeds(kSeeds, [](std::uint64_t seed, Claim& claim) {
    const Case one = loose(seed);
    const Runs runs = record(one);
    const Calibrated found = calibrated(one, runs.training);
    claim.expect(found.fit.free_run_error_K.has_value(), "innovations decide");
    claim.expect(rms_error_K(found.model, runs.unseen) < 1.5 * found.fit.free_run_error_K.value_or(0.0), "error of unseen runs");
    // The covariance must cover the difference between two calibrations of one motor with different runs.
    const Calibrated other = calibrated(one, runs.unseen);
    const Eigen::VectorXd apart = other.fit.theta - found.fit.theta;
    const Eigen::MatrixXd allowed = other.fit.covariance + found.fit.covariance;
    const double chi2_per_parameter = apart.dot(allowed.ldlt().solve(apart)) / static_cast<double>(apart.size());
    claim.expect(chi2_per_parameter < 9.0, fmt::format("{} per parameter", chi2_per_parameter));
  });
  EXPECT_GE(rate.right, kSeeds - 2) << rate.misses;
}

TEST(ManyParts, OtherwiseTheMostProbableParametersStay) {
  const SeedRate rate = rate_over_seeds(kSeeds, [](std::uint64_t seed, Claim& claim) {
    Case one = loose(seed);
    one.metal_ratio = 1.0;
    claim.expect(calibrated(one, record(one).training).fit.free_run_error_K == std::nullopt, "free runs decide");
  });
  EXPECT_GE(rate.right, kSeeds - 1) << rate.misses;
}

// Averaging over rows would mistake a periodic load for wrong parameters.
TEST(ManyParts, ALoadThatRepeatsIsNone) {
  for (const int period_rows : {5, 10}) {
    std::vector<TrueRun> runs;
    for (const std::uint64_t seed : {1, 2}) {
      std::vector<RowInputs> rows(1800);
      for (std::size_t k = 0; k < rows.size(); ++k) {
        rows[k].current_A = static_cast<int>(k) % period_rows < 0.4 * period_rows ? 6.0 : 0.0;
      }
      runs.push_back(run_motor({}, {}, {}, rows, 0.0, seed, "on_off"));
    }
    EXPECT_EQ(calibrated({}, runs).fit.free_run_error_K, std::nullopt) << period_rows;
  }
}

/// Holds for 6 of 8 motors.
TEST(ManyParts, AreNoMissingEffect) {
  const SeedRate rate = rate_over_seeds(kSeeds, [](std::uint64_t seed, Claim& claim) {
    const Case one = loose(seed);
    const Runs runs = record(one);
    Calibrated found = calibrated(one, runs.training);
    diagnosis::DiagnosisInput input = question(one, runs);
    input.train = holdout(runs);
    input.model = found.model;
    input.usual = found.usual;
    const diagnosis::Diagnosis diagnosis = diagnosis::diagnose(input, {});
    claim.expect(diagnosis.verdict == diagnosis::DiagnosisVerdict::nothing_missing && diagnosis.effects.empty(), account(diagnosis));
  });
  EXPECT_GE(rate.right, kSeeds - 3) << rate.misses;
}

/// Loosely connected parts look like a wrong gain of the winding's sensor. That gain explains the runs, but does not predict others.
TEST(ManyParts, AreNoSensorErrorBesideTheBodyThatIsMissing) {
  const SeedRate rate = rate_over_seeds(kSeeds, [](std::uint64_t seed, Claim& claim) {
    Case one;
    one.metal_ratio = 0.05;
    one.seed = seed;
    const Subject& body = *std::ranges::find(subjects(), "third_node", &Subject::name);
    one.missing = body.make(1.5);
    const Answer answer = examine(one);
    claim.expect(names(answer.named, body), account(answer));
    claim.expect(std::ranges::find(answer.named, "sensor_gain_winding") == answer.named.end(), account(answer));
  });
  EXPECT_GE(rate.right, kSeeds - 1) << rate.misses;
}

/// Both heat the stator with the square of the current; with other thermal values they are nearly the same, so some runs leave both open.
TEST(ManyParts, AnUnevenWindingIsNoConnectionResistance) {
  const SeedRate rate = rate_over_seeds(kSeeds, [](std::uint64_t seed, Claim& claim) {
    Case one;
    one.seed = seed;
    one.missing = std::ranges::find(subjects(), "uneven_winding", &Subject::name)->make(1.0);
    const Answer answer = examine(one);
    claim.expect(std::ranges::find(answer.named, "uneven_winding") != answer.named.end(), account(answer));
    claim.expect(std::ranges::find(answer.named, "connection_resistance") == answer.named.end(), account(answer));
  });
  EXPECT_GE(rate.right, kSeeds - 1) << rate.misses;
}

TEST(ManyParts, ABodyAtTheWindingIsFoundThere) {
  const SeedRate rate = rate_over_seeds(kSeeds, [](std::uint64_t seed, Claim& claim) {
    Case one;
    one.seed = seed;
    one.missing.heat.emplace_back([](const Moment& now, PerPart& q) {
      const double in_W = 0.4 * (now.part_C[slot] - now.part_C[lump_a]);
      q[slot] -= in_W;
      q[lump_a] += in_W;
    });
    one.missing.lump_capacity_J_per_K[lump_a] = 40.0;
    const Answer answer = examine(one);
    const auto is_body_there = [](const diagnosis::FoundEffect& each) { return each.id == "third_node" && each.node == "winding"; };
    claim.expect(answer.named.size() == 1 && std::ranges::any_of(answer.diagnosis.effects, is_body_there), account(answer));
  });
  EXPECT_GE(rate.right, kSeeds - 1) << rate.misses;
}

TEST(ManyParts, ABodyAtTheWindingGetsAnUnusedName) {
  const Case one;
  diagnosis::DiagnosisInput input = question(one, record(one));
  input.model.network.add_node("third_node_winding", 10.0);
  int bodies = 0;
  for (const Candidate& each : candidates_for(input.model, input.train).candidates) {
    if (each.id == "third_node@winding") {
      EXPECT_EQ(each.nodes.at(1), "third_node_winding_2");
      ++bodies;
    }
  }
  EXPECT_GT(bodies, 0);
}

/// A sensor at the stator does not show a body at the winding.
TEST(ManyParts, ABodyAtTheWindingNeedsASensorThere) {
  for (const bool has_winding_sensor : {true, false}) {
    Case one;
    one.has_winding_sensor = has_winding_sensor;
    const diagnosis::DiagnosisInput input = question(one, record(one));
    const std::vector<Candidate> candidates = candidates_for(input.model, input.train).candidates;
    const auto is_body = [](const Candidate& each) { return each.id == "third_node@winding"; };
    EXPECT_EQ(std::ranges::any_of(candidates, is_body), has_winding_sensor);
  }
}

/// Without a sensor there, heat in a body that an earlier diagnosis added cannot be distinguished from another size of the body.
TEST(ManyParts, HeatInABodyOfTheFileNeedsASensorThere) {
  for (const bool has_sensor : {true, false}) {
    const Case one;
    diagnosis::DiagnosisInput input = question(one, record(one));
    input.model.network.add_node("third_node", 10.0);
    if (has_sensor) {
      input.train.front().sensors.front().node = "third_node";
    }
    const auto is_there = [](const Candidate& each) { return each.type && each.nodes.front() == "third_node"; };
    EXPECT_EQ(std::ranges::any_of(candidates_for(input.model, input.train).candidates, is_there), has_sensor);
  }
}

/// A measured current contains the effect of weaker magnets. A current that follows from the torque does not.
TEST(ManyParts, WeakerMagnetsNeedACurrentThatWasNotMeasured) {
  for (const bool is_measured : {true, false}) {
    const Case one;
    diagnosis::DiagnosisInput input = question(one, record(one));
    for (estimation::MeasuredRun& run : input.train) {
      EXPECT_TRUE(run.is_current_measured);
      run.is_current_measured = is_measured;
    }
    const CandidateList list = candidates_for(input.model, input.train);
    const auto is_magnet = [](const Candidate& each) { return each.id == "magnet_weakening"; };
    EXPECT_EQ(std::ranges::any_of(list.candidates, is_magnet), !is_measured);
    EXPECT_EQ(std::ranges::count(list.not_judged, "magnet_weakening", &UntestedEffect::effect), is_measured ? 1 : 0);
  }
}

TEST(ManyParts, HideNothingThatWholeRunsTell) {
  const SeedRate rate = rate_over_seeds(kSeeds, [](std::uint64_t seed, Claim& claim) {
    Case one = loose(seed);
    Calibrated found = calibrated(one, record(one).training);
    one.missing = std::ranges::find(subjects(), "enclosure_warm_up", &Subject::name)->make(1.5);
    diagnosis::DiagnosisInput input = question(one, record(one));
    input.model = found.model;
    input.usual = found.usual;
    const diagnosis::Diagnosis diagnosis = diagnosis::diagnose(input, {});
    claim.expect(diagnosis.verdict != diagnosis::DiagnosisVerdict::nothing_missing, account(diagnosis));
  });
  EXPECT_GE(rate.right, kSeeds - 1) << rate.misses;
}

}  // namespace
}  // namespace heatsoak::attribution::truth
