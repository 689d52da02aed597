#include "thermal/tangent_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "base/diagnostic.h"
#include "base/random.h"
#include "thermal/transient.h"

namespace heatsoak::thermal {
namespace {

const std::vector<std::string> kWinding{"winding"};

/// Two nodes with temperature-dependent copper loss, no-load loss, and a source of unknown heat at each node.
Network example_network() {
  Network network;
  network.add_node("winding", 18.0);
  network.add_node("stator", 95.0);
  const auto add = [&](const char* name, const char* type, std::vector<std::string> nodes, std::vector<double> parameters) {
    network.add_effect(name, *find_effect(type), nodes, parameters);
  };
  add("no_load", "no_load_loss", {"stator"}, {0.008});
  add("winding_stator", "conduction", {"winding", "stator"}, {1.6});
  add("copper", "copper_loss", {"winding"}, {0.6, 0.0039});
  add("stator_ambient", "conduction", {"stator", "ambient"}, {5.5});
  network.limit_current_by("copper");
  return network;
}

std::vector<Interval> drive(base::Random& random, int rows) {
  std::vector<Interval> intervals;
  for (int i = 0; i < rows; ++i) {
    OperatingPoint<double> at;
    at.current_rms_A = 6.0 * random.uniform();
    at.speed_mean_rad_per_s = at.speed_rms_rad_per_s = 500.0 * random.uniform();
    at.ambient_C = 20.0 + 5.0 * random.uniform();
    intervals.push_back({0.5 + 2.0 * random.uniform(), at});
  }
  return intervals;
}

/// Reference: integration by SUNDIALS without derivatives.
std::vector<double> end_C(const Network& network, const std::vector<double>& parameters, const std::vector<double>& start_C,
                          const std::vector<Interval>& intervals) {
  TransientOptions options;
  options.tolerances = {1e-12, 1e-10};
  options.start_C = start_C;
  return run_transient(network, parameters, intervals, options).end_C;
}

struct Chained {
  Eigen::VectorXd state_C;
  Eigen::MatrixXd by_start;
  Eigen::MatrixXd by_parameter;
};

Chained chain(TangentRun& run, const std::vector<double>& start_C, std::size_t parameter_count, const std::vector<Interval>& intervals) {
  const auto states = static_cast<Eigen::Index>(start_C.size());
  Chained all{Eigen::Map<const Eigen::VectorXd>(start_C.data(), states), Eigen::MatrixXd::Identity(states, states),
              Eigen::MatrixXd::Zero(states, static_cast<Eigen::Index>(parameter_count))};
  for (const Interval& interval : intervals) {
    const NetworkStep& step = run.over({all.state_C.data(), start_C.size()}, interval.duration_s, interval.at);
    all.state_C = step.state_C;
    all.by_start = step.by_start * all.by_start;
    all.by_parameter = step.by_start * all.by_parameter + step.by_parameter;
  }
  return all;
}

TEST(TangentRun, agrees_with_differences_of_sundials_runs) {
  const Network network = example_network();
  base::Random random(7, 0);
  const std::vector<Interval> intervals = drive(random, 120);
  const std::vector<double> parameters = network.values();
  const std::vector<double> start_C{60.0, 35.0};
  std::vector<int> wanted(parameters.size());
  std::iota(wanted.begin(), wanted.end(), 0);
  TangentRun run(network, parameters, wanted);
  const Chained all = chain(run, start_C, wanted.size(), intervals);
  const std::vector<double> reference_C = end_C(network, parameters, start_C, intervals);
  EXPECT_NEAR(all.state_C[0], reference_C[0], 1e-5);
  EXPECT_NEAR(all.state_C[1], reference_C[1], 1e-5);
  const auto expect_slope = [&](const auto& moved_end_C, double derivative, int node, double step, const std::string& what) {
    const double difference = (moved_end_C(step)[node] - moved_end_C(-step)[node]) / (2.0 * step);
    EXPECT_NEAR(derivative, difference, 1e-5 * std::abs(difference) + 1e-7 / step) << what;
  };
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    for (int node = 0; node < 2; ++node) {
      expect_slope(
          [&](double step) {
            std::vector<double> moved = parameters;
            moved[p] += step;
            return end_C(network, moved, start_C, intervals);
          },
          all.by_parameter(node, static_cast<Eigen::Index>(p)), node, 1e-4 * parameters[p], network.parameters()[p].name);
    }
  }
  for (std::size_t s = 0; s < start_C.size(); ++s) {
    for (int node = 0; node < 2; ++node) {
      expect_slope(
          [&](double step) {
            std::vector<double> moved = start_C;
            moved[s] += step;
            return end_C(network, parameters, moved, intervals);
          },
          all.by_start(node, static_cast<Eigen::Index>(s)), node, 0.1, "start");
    }
  }
}

TEST(TangentRun, is_of_fourth_order_where_the_interval_is_long_and_never_unstable) {
  const Network network = example_network();
  OperatingPoint<double> at;
  at.current_rms_A = 5.0;
  TangentRun run(network, network.values(), {});
  const std::vector<double> start_C{25.0, 25.0};
  const std::vector<double> reference_C = end_C(network, network.values(), start_C, {{600.0, at}});
  EXPECT_NEAR(run.over(start_C, 600.0, at).state_C[0], reference_C[0], 1e-2);
}

TEST(TangentRun, says_when_the_network_is_too_fast) {
  const Network network = example_network();
  std::vector<double> parameters = network.values();
  parameters[0] = 1e-9;
  TangentRun run(network, parameters, {});
  const std::vector<double> start_C{25.0, 25.0};
  EXPECT_THROW(run.over(start_C, 1.0, {}), base::Failure);
}

}  // namespace
}  // namespace heatsoak::thermal
