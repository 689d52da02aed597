// A parameter value from a data file, with its origin, its source and its uncertainty.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"

namespace heatsoak::base {

/// Origin of a value, from the most to the least reliable.
enum class Origin { measured, datasheet, third_party, derived, estimated };

std::string_view to_string(Origin origin);
std::optional<Origin> origin_from(std::string_view text);

/// Uncertainty of a value, as the file declares it. `tolerance`: symmetric limits that no part exceeds (normal distribution, truncated at
/// two standard deviations). `range`: the true value is as likely above the value as below it. On each side it is uniform in the logarithm
/// (`by_ratio`), or uniform in the value itself, as for temperatures.
struct Spread {
  enum class Kind { tolerance, range };
  Kind kind = Kind::tolerance;
  double low = 0.0;   ///< in the unit of the value
  double high = 0.0;  ///< in the unit of the value
  bool by_ratio = true;
};

/// Value of a parameter in a second, independent source; `heatsoak lint` compares the two.
struct Confirmation {
  std::string source;  ///< an id of the file's [sources]
  double value = 0.0;  ///< in the unit of the value that it confirms
  std::string printed;
};

struct ParameterValue {
  double value = 0.0;  ///< in the unit of its ParameterSpec
  Origin origin = Origin::estimated;
  std::string printed;     ///< the text in the file, "36.9 mN m/A"
  std::string source;      ///< ids of the file's [sources], comma separated; may be empty for estimates
  std::string derivation;  ///< method by which a derived or estimated value was found
  std::optional<Spread> spread;
  std::vector<Confirmation> confirmed_by;
  Location at;

  /// Returns the quantile of the uncertainty at probability `uniform` in (0, 1), in the unit of the value. 0.5 gives the value itself;
  /// without a spread every probability does.
  [[nodiscard]] double quantile(double uniform) const;
};

}  // namespace heatsoak::base
