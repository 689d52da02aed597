// Claims that hold for a share of all seeds, checked over a range of seeds.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <string>

#include "base/binomial_bound.h"

namespace heatsoak {

/// Checks a claim for the seeds 1 to `seeds`, so that no test depends on a choice of seeds. Fails if it holds so rarely that a claim which
/// is true with probability `claimed_share` would do so with a chance below 0.1 % (exact binomial bound). 1.0: it must hold for each seed.
inline testing::AssertionResult holds_for_share(double claimed_share, int seeds, const std::function<bool(std::uint64_t)>& claim) {
  int right = 0;
  std::string missed;
  for (int seed = 1; seed <= seeds; ++seed) {
    if (claim(static_cast<std::uint64_t>(seed))) {
      ++right;
    } else {
      missed += " " + std::to_string(seed);
    }
  }
  const bool holds = claimed_share < 1.0 ? base::upper_bound_share(right, seeds, 0.999) >= claimed_share : right == seeds;
  return (holds ? testing::AssertionSuccess() : testing::AssertionFailure())
         << "holds for " << right << " of " << seeds << " seeds, claimed " << claimed_share << "; not for seed" << missed;
}

}  // namespace heatsoak
