// Grid of the unknown heat, whose points do not depend on the start values of the model.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "estimation/fit.h"
#include "runs_for_tests.h"

namespace heatsoak::estimation {
namespace {

TEST(FirstFit, StartsFromOtherValuesShareThePointsOfTheUnknownHeat) {
  const TwoNodeTruth truth;
  std::vector<MeasuredRun> runs;
  for (const int number : {1, 2, 3}) {
    runs.push_back(generated_run(truth, {}, 1, static_cast<std::uint64_t>(number)));
    runs.back().conditions["run"] = runs.back().name = "run" + std::to_string(number);
  }
  const auto points_from = [&](double factor) {
    TwoNodeTruth start = truth;
    start.winding_stator_K_per_W *= factor;
    start.stator_ambient_K_per_W *= factor;
    return first_fit(two_node_model(start, 1.0), runs, {.starts = 0}).setup.grid.rms_W;
  };
  const std::vector<double> middle = points_from(1.0);
  for (const double factor : {0.5, 0.8, 1.3, 2.0}) {
    const std::vector<double> other = points_from(factor);
    std::vector<double> common;
    std::ranges::set_intersection(middle, other, std::back_inserter(common));
    EXPECT_GE(common.size() + 1, middle.size()) << factor;
  }
}

}  // namespace
}  // namespace heatsoak::estimation
