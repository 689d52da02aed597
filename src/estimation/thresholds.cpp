#include "estimation/thresholds.h"

#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <limits>

namespace heatsoak::estimation {
namespace {

Thresholds& in_use() {
  static Thresholds all;
  return all;
}

}  // namespace

const Thresholds& thresholds() { return in_use(); }

void set_thresholds(const Thresholds& changed) { in_use() = changed; }

double named_probability() { return 1.0 - thresholds().wrong_answer_share; }

double named_nats() { return std::log(named_probability() / (1.0 - named_probability())); }

double rejected_sd() { return largest_sd(thresholds().wrong_rejection_share, 1); }

double largest_sd(double share, int tries) {
  const double tail = 0.5 * share / tries;
  return tail > 0.0 ? boost::math::quantile(boost::math::complement(boost::math::normal(), tail)) : std::numeric_limits<double>::infinity();
}

}  // namespace heatsoak::estimation
