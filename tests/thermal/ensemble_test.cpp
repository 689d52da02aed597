#include "thermal/ensemble.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>

#include "two_node.h"

namespace heatsoak::thermal {
namespace {

/// Eight motors in parallel, each with its own duty: durations are shared, operating points are not.
struct Eight {
  std::array<TwoNode, base::kLanes> motors;
  std::array<std::vector<Interval>, base::kLanes> duties;

  [[nodiscard]] std::vector<Lanes> parameters() const {
    std::vector<Lanes> side_by_side;
    for (int lane = 0; lane < base::kLanes; ++lane) {
      const std::vector<double> values = motors[static_cast<std::size_t>(lane)].network().values();
      side_by_side.resize(values.size());
      for (std::size_t i = 0; i < values.size(); ++i) {
        side_by_side[i][lane] = values[i];
      }
    }
    return side_by_side;
  }

  [[nodiscard]] OperatingPoint<Lanes> point(std::size_t piece) const {
    OperatingPoint<Lanes> at;
    for (int lane = 0; lane < base::kLanes; ++lane) {
      const OperatingPoint<double>& one = duties[static_cast<std::size_t>(lane)][piece].at;
      at.current_rms_A[lane] = one.current_rms_A;
      at.speed_mean_rad_per_s[lane] = one.speed_mean_rad_per_s;
      at.speed_rms_rad_per_s[lane] = one.speed_rms_rad_per_s;
      at.ambient_C[lane] = one.ambient_C;
    }
    return at;
  }

  struct Outcome {
    std::vector<Lanes> end_C, peak_C;
  };
  /// If `fixed_step_s` is 0, each piece uses the step of longest_step_s().
  [[nodiscard]] Outcome run(double fixed_step_s = 0.0) const {
    const Network network = motors[0].network();
    const std::vector<Lanes> values = parameters();
    const std::vector<Lanes> start_C(2, point(0).ambient_C);
    EnsembleRun ensemble(network, values, start_C);
    for (std::size_t piece = 0; piece < duties[0].size(); ++piece) {
      const OperatingPoint<Lanes> at = point(piece);
      ensemble.over(duties[0][piece].duration_s, at, fixed_step_s > 0.0 ? fixed_step_s : longest_step_s(network, values, at));
    }
    return {ensemble.state_C(), ensemble.peak_C()};
  }

  [[nodiscard]] TransientResult reference(std::size_t lane, double tolerance = 1e-11) const {
    TransientOptions options;
    options.tolerances = {tolerance, tolerance};
    const Network network = motors[lane].network();
    return run_transient(network, network.values(), duties[lane], options);
  }
};

Eight random_eight(Chance& chance) {
  Eight eight;
  for (TwoNode& motor : eight.motors) {
    motor = chance.motor();
  }
  return eight;
}

/// Returns the largest deviation of the peaks from the reference, in K.
double worst_peak_error_K(const Eight& eight, Node node) {
  const Eight::Outcome outcome = eight.run();
  double worst_K = 0.0;
  for (std::size_t lane = 0; lane < base::kLanes; ++lane) {
    const TransientResult reference = eight.reference(lane);
    worst_K = std::max(worst_K, std::abs(outcome.peak_C[node][static_cast<int>(lane)] - std::min(reference.peak_C[node], kDestroyed_C)));
  }
  return worst_K;
}

// The bounds are about four times the measured errors: 0.0005 K and 0.0077 K for the on/off duty, 0.00002 K and 0.0024 K for the random
// one. Peaks are taken at steps only, which slightly underestimates the stator's peak after switch-off.
TEST(Ensemble, peaks_of_an_on_off_duty_are_those_of_the_reference) {
  Chance chance(700);
  double winding_K = 0.0;
  double stator_K = 0.0;
  for (int block = 0; block < 10; ++block) {
    Eight eight = random_eight(chance);
    for (std::size_t lane = 0; lane < base::kLanes; ++lane) {
      const OperatingPoint<double> on = chance.point(eight.motors[lane]);
      OperatingPoint<double> off;
      off.ambient_C = on.ambient_C;
      for (int cycle = 0; cycle < 60; ++cycle) {
        eight.duties[lane].push_back({4.0, on});
        eight.duties[lane].push_back({6.0, off});
      }
    }
    winding_K = std::max(winding_K, worst_peak_error_K(eight, winding));
    stator_K = std::max(stator_K, worst_peak_error_K(eight, stator));
  }
  RecordProperty("winding_K", std::to_string(winding_K));
  RecordProperty("stator_K", std::to_string(stator_K));
  EXPECT_LT(winding_K, 0.0025);
  EXPECT_LT(stator_K, 0.03);
}

TEST(Ensemble, peaks_of_a_random_duty_of_2000_pieces_are_those_of_the_reference) {
  Chance chance(701);
  double winding_K = 0.0;
  double stator_K = 0.0;
  for (int block = 0; block < 3; ++block) {
    Eight eight = random_eight(chance);
    for (int piece = 0; piece < 2000; ++piece) {
      const double duration_s = chance.by_ratio(0.02, 5.0);
      for (std::size_t lane = 0; lane < base::kLanes; ++lane) {
        OperatingPoint<double> at = chance.point(eight.motors[lane]);
        at.ambient_C = 25.0;
        eight.duties[lane].push_back({duration_s, at});
      }
    }
    winding_K = std::max(winding_K, worst_peak_error_K(eight, winding));
    stator_K = std::max(stator_K, worst_peak_error_K(eight, stator));
  }
  RecordProperty("winding_K", std::to_string(winding_K));
  RecordProperty("stator_K", std::to_string(stator_K));
  EXPECT_LT(winding_K, 0.0001);
  EXPECT_LT(stator_K, 0.01);
}

TEST(Ensemble, end_is_the_two_exponentials) {
  Chance chance(702);
  double worst_K = 0.0;
  for (int block = 0; block < 30; ++block) {
    Eight eight = random_eight(chance);
    const double duration_s = chance.by_ratio(0.1, 2000.0);
    for (std::size_t lane = 0; lane < base::kLanes; ++lane) {
      eight.duties[lane].push_back({duration_s, chance.point(eight.motors[lane])});
    }
    const Eight::Outcome outcome = eight.run();
    for (std::size_t lane = 0; lane < base::kLanes; ++lane) {
      const double ambient_C = eight.duties[lane][0].at.ambient_C;
      const TwoNode::Pair expected = eight.motors[lane].after(eight.duties[lane], {ambient_C, ambient_C});
      for (const std::size_t node : {0U, 1U}) {
        worst_K = std::max(worst_K, std::abs(outcome.end_C[node][static_cast<int>(lane)] - static_cast<double>(expected[node])));
      }
    }
  }
  RecordProperty("worst_K", std::to_string(worst_K));
  EXPECT_LT(worst_K, 0.0002);  // measured: 0.00004 K
}

TEST(Ensemble, error_has_order_four_in_the_step) {
  Chance chance(703);
  Eight eight = random_eight(chance);
  for (std::size_t lane = 0; lane < base::kLanes; ++lane) {
    eight.motors[lane].winding_stator_K_per_W = 4.0;
    eight.motors[lane].winding_J_per_K = 2.0 + 0.5 * static_cast<double>(lane);
    OperatingPoint<double> at = chance.point(eight.motors[lane]);
    at.current_rms_A += 1.0 / std::sqrt(eight.motors[lane].resistance_25C_ohm);
    eight.duties[lane].push_back({16.0, at});
  }
  std::vector<Lanes> error_K;
  for (const double step_s : {2.0, 1.0, 0.5, 0.25}) {
    const Eight::Outcome outcome = eight.run(step_s);
    Lanes error;
    for (std::size_t lane = 0; lane < base::kLanes; ++lane) {
      const double ambient_C = eight.duties[lane][0].at.ambient_C;
      error[static_cast<int>(lane)] =
          std::abs(outcome.end_C[winding][static_cast<int>(lane)] -
                   static_cast<double>(eight.motors[lane].after(eight.duties[lane], {ambient_C, ambient_C})[winding]));
    }
    error_K.push_back(error);
  }
  for (std::size_t i = 2; i < error_K.size(); ++i) {
    for (int lane = 0; lane < base::kLanes; ++lane) {
      EXPECT_NEAR(std::log2(error_K[i - 1][lane] / error_K[i][lane]), 4.0, 0.3) << "halving " << i << " lane " << lane;
    }
  }
}

TEST(Ensemble, a_sample_has_the_same_bits_in_every_lane_whatever_its_neighbours) {
  Chance chance(704);
  Eight eight = random_eight(chance);
  for (int piece = 0; piece < 100; ++piece) {
    const double duration_s = chance.by_ratio(0.02, 5.0);
    for (std::size_t lane = 0; lane < base::kLanes; ++lane) {
      eight.duties[lane].push_back({duration_s, chance.point(eight.motors[lane])});
    }
  }
  const double step_s = 0.1;
  const Eight::Outcome first = eight.run(step_s);
  for (std::size_t place = 1; place < base::kLanes; ++place) {
    Eight other = random_eight(chance);
    for (std::size_t lane = 0; lane < base::kLanes; ++lane) {
      other.duties[lane] = eight.duties[(lane + 3) % base::kLanes];
    }
    other.motors[place] = eight.motors[0];
    other.duties[place] = eight.duties[0];
    const Eight::Outcome moved = other.run(step_s);
    for (const std::size_t node : {0U, 1U}) {
      EXPECT_EQ(std::bit_cast<std::uint64_t>(first.end_C[node][0]),
                std::bit_cast<std::uint64_t>(moved.end_C[node][static_cast<int>(place)]));
      EXPECT_EQ(std::bit_cast<std::uint64_t>(first.peak_C[node][0]),
                std::bit_cast<std::uint64_t>(moved.peak_C[node][static_cast<int>(place)]));
    }
  }
}

TEST(Ensemble, a_runaway_lane_stops_at_the_end_of_the_scale_and_leaves_its_neighbours_alone) {
  Chance chance(705);
  Eight eight = random_eight(chance);
  for (std::size_t lane = 0; lane < base::kLanes; ++lane) {
    eight.duties[lane].push_back({2000.0, chance.point(eight.motors[lane])});
  }
  eight.motors[3].temperature_coefficient_per_K = 0.004;
  eight.duties[3][0].at.current_rms_A = 30.0 * eight.motors[3].critical_current_A();
  const Eight::Outcome outcome = eight.run();
  EXPECT_EQ(outcome.end_C[winding][3], kDestroyed_C);
  EXPECT_EQ(outcome.peak_C[winding][3], kDestroyed_C);
  for (std::size_t lane = 0; lane < base::kLanes; ++lane) {
    if (lane != 3) {
      const double ambient_C = eight.duties[lane][0].at.ambient_C;
      const TwoNode::Pair expected = eight.motors[lane].after(eight.duties[lane], {ambient_C, ambient_C});
      EXPECT_NEAR(outcome.end_C[winding][static_cast<int>(lane)], static_cast<double>(expected[winding]), 1e-2);
    }
  }
}

TEST(Ensemble, longest_step_is_stable_for_every_lane) {
  Chance chance(706);
  for (int i = 0; i < 100; ++i) {
    Eight eight = random_eight(chance);
    for (std::size_t lane = 0; lane < base::kLanes; ++lane) {
      eight.duties[lane].push_back({1.0, chance.point(eight.motors[lane])});
    }
    const std::vector<Lanes> values = eight.parameters();
    const double step_s = longest_step_s(eight.motors[0].network(), values, eight.point(0));
    for (std::size_t lane = 0; lane < base::kLanes; ++lane) {
      const auto [slow, fast] = eight.motors[lane].eigenvalues_per_s(eight.duties[lane][0].at);
      EXPECT_LE(step_s * static_cast<double>(std::max(std::abs(slow), std::abs(fast))), 0.25 * (1.0 + 1e-9));
    }
  }
}

}  // namespace
}  // namespace heatsoak::thermal
