#include "base/parameter_value.h"

#include <array>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <utility>

namespace heatsoak::base {
namespace {

constexpr std::array<std::pair<Origin, std::string_view>, 5> kOrigins{{{Origin::measured, "measured"},
                                                                       {Origin::datasheet, "datasheet"},
                                                                       {Origin::third_party, "third_party"},
                                                                       {Origin::derived, "derived"},
                                                                       {Origin::estimated, "estimated"}}};

/// Quantile of the standard normal distribution truncated at ±2 standard deviations, divided by 2 so that it lies in ±1.
double cut_off_normal(double uniform) {
  static const boost::math::normal kNormal;
  static const double kBelow = boost::math::cdf(kNormal, -2.0);
  return boost::math::quantile(kNormal, kBelow + uniform * (1.0 - 2.0 * kBelow)) / 2.0;
}

}  // namespace

std::string_view to_string(Origin origin) {
  for (const auto& [each, name] : kOrigins) {
    if (each == origin) {
      return name;
    }
  }
  return "?";
}

std::optional<Origin> origin_from(std::string_view text) {
  for (const auto& [origin, name] : kOrigins) {
    if (name == text) {
      return origin;
    }
  }
  return std::nullopt;
}

double ParameterValue::quantile(double uniform) const {
  if (!spread) {
    return value;
  }
  if (spread->kind == Spread::Kind::tolerance) {
    return value + 0.5 * (spread->high - spread->low) * cut_off_normal(uniform);
  }
  const double bound = uniform < 0.5 ? spread->low : spread->high;
  const double towards_bound = std::abs(2.0 * uniform - 1.0);
  if (spread->by_ratio) {
    return value * std::pow(bound / value, towards_bound);
  }
  return value + towards_bound * (bound - value);
}

}  // namespace heatsoak::base
