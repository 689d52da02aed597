// A figure of a data file: a value that knows where it comes from and how far it can be trusted.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"

namespace heatsoak {

/// From best to worst.
enum class Origin { measured, datasheet, third_party, derived, estimated };

std::string_view to_string(Origin origin);
std::optional<Origin> origin_from(std::string_view text);

/// How far the true value may lie from the figure, declared in the file.
/// `tolerance`: ± a share of the value that no part exceeds (normal, cut off at two standard deviations);
/// `range`: between the bounds; as likely above the figure as below it, and on each side every ratio alike
/// (every difference for temperatures).
struct Spread {
  enum class Kind { tolerance, range };
  Kind kind = Kind::tolerance;
  double low = 0.0;   ///< in the figure's unit
  double high = 0.0;  ///< in the figure's unit
  bool by_ratio = true;
};

/// What an independent source says of the same figure; `heatsoak lint` compares.
struct Confirmation {
  std::string source;  ///< an id of the file's [sources]
  double value = 0.0;  ///< in the figure's unit
  std::string printed;
};

struct Figure {
  double value = 0.0;  ///< in the unit that the declaration of its key names
  Origin origin = Origin::estimated;
  std::string printed;     ///< the value as the file gives it, "36.9 mN m/A"
  std::string source;      ///< ids of the file's [sources], comma separated; may be empty for estimates
  std::string derivation;  ///< how a derived or estimated figure was found
  std::optional<Spread> spread;
  std::vector<Confirmation> confirmed_by;
  Location at;

  /// The value at `uniform` in (0, 1): the inverse of the spread's distribution function; 0.5 is the figure itself.
  [[nodiscard]] double quantile(double uniform) const;
};

}  // namespace heatsoak
