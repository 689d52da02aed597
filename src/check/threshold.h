// What a check can put a limit on: one file in src/check/thresholds each.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/parameter.h"

namespace heatsoak::check {

class Computations;
struct Check;

enum class Bound { at_most, at_least };

/// How --update leaves room between the value and its new limit.
enum class Room {
  share,  ///< a share of the value's distance to its origin, 5 % unless --margin says otherwise
  none    ///< the limit is the value
};

/// Keys of a [[check]] table beside its name and limits.
enum class Setting { robot, duty, motor, against, conditions, samples, seed, temperature, table, files, logs, mapping, air, derate };
struct SettingText {
  std::string_view key;
  std::string_view meaning;
};
/// In the order of Setting.
std::span<const SettingText> all_settings();

struct Measured {
  double value = 0.0;         ///< in the unit of the threshold
  double origin_value = 0.0;  ///< from which a margin is counted, in the same unit: of a temperature the air
  std::string detail = {};    ///< one line for people: what the value rests on; may be empty
};

/// The loosest limit that a check may set, such as the motor's own winding limit.
struct LoosestLimit {
  double value = 0.0;         ///< in the unit of the threshold
  std::string what;           ///< its origin: "the winding limit of the motor"
  bool always_holds = false;  ///< a limit of this value holds always, so only a tighter one is permitted
};

/// A share of 100 % holds always, so a limit must be below it.
inline LoosestLimit largest_share_limit() { return {0.999, "the largest share that a limit may permit"}; }

struct ThresholdType {
  std::string_view name;  ///< the file's name; set by all_thresholds()
  std::string_view unit;  ///< UDUNITS text; "" is a pure number
  bool is_share = false;  ///< a pure number that people read in per cent
  bool is_whole = false;  ///< counts something: a limit with a fraction is a mistake
  Bound direction = Bound::at_most;
  base::Range range = {};   ///< permitted values of the limit
  Room room = Room::share;  ///< of --update
  double least_size_ratio =
      0.0;  ///< in the unit of the threshold, for --update: a value nearer to its origin gets the room of one that is this far from it
  std::string_view meaning;  ///< what is compared, exactly
  std::string_view example;  ///< a limit that can be pasted
  std::vector<Setting> needs;
  std::vector<Setting> takes = {};  ///< others that change the value
  /// Null, or returns nothing, where every limit in `range` is permitted.
  std::optional<LoosestLimit> (*loosest)(const Check& check) = nullptr;
  /// Throws Failure with the reason where the value cannot be determined.
  Measured (*measure)(const Check& check, Computations& computations) = nullptr;
};

/// Sorted by name; they live as long as the program.
const std::vector<ThresholdType>& all_thresholds();
/// Null where there is none of that name.
const ThresholdType* find_threshold(std::string_view name);

}  // namespace heatsoak::check
