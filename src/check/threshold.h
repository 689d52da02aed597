// Thresholds: the quantities that a check file can limit. Each one is a file in src/check/thresholds.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/parameter.h"
#include "check/basis.h"

namespace heatsoak::check {

class Computations;
struct Check;

enum class Bound { at_most, at_least };

/// Distance that --update leaves between the measured value and its new limit.
enum class Room {
  share,  ///< a share of the value's distance to its origin, 5 % unless --margin says otherwise
  none    ///< the limit is the value
};

/// Keys of a [[check]] table other than its name and limits.
enum class Setting {
  robot,
  duty,
  motor,
  against,
  conditions,
  samples,
  seed,
  temperature,
  table,
  files,
  logs,
  mapping,
  air,
  derate,
  command
};
struct SettingText {
  std::string_view key;
  std::string_view meaning;
};
/// Returns the keys with their meanings, in the order of Setting.
std::span<const SettingText> all_settings();

struct Measured {
  double value = 0.0;         ///< in the unit of the threshold
  double origin_value = 0.0;  ///< in the same unit; --update derives the room from the distance to it; for a temperature: the air
  Basis basis = {};
  bool is_never = false;  ///< the event never happens, so that its time, the value, is infinite
  double interval_width_value =
      0.0;  ///< width of the value's 95 % interval; --update leaves a share of it as room if it exceeds the distance
};

/// Origin of the loosest limit that a check may set.
enum class LoosestBy {
  winding_limit,            ///< the motor's own
  stator_limit,             ///< the motor's own
  winding_limit_of_stator,  ///< the motor's own, for the stator of a file without a limit for it
  own_limits,               ///< the motor's, for a margin to them
  driver_limit,             ///< current limit of the robot's driver
  whole_charge,             ///< the largest current of all wheels during the whole duty
  duty_duration,
  half_match,
  temperature_range,  ///< the motor's, from the air to its winding limit
  motors_against,     ///< number of motors to rank with
  values_of_files,    ///< number of values in a complete motor file, for every file
  largest_core,       ///< twice the code of the drive core with the largest guard table
  largest_share,      ///< below 100 %, which holds always
  smallest_value      ///< the number is never below it
};

/// Time is counted above a temperature that exceeds the motor's own limit, so every limit comes too late.
struct CountedTooHot {
  double temperature_C = 0.0;
  double winding_limit_C = 0.0;
};

/// The loosest limit that a check may set, such as the motor's own winding limit.
struct LoosestLimit {
  double value = 0.0;  ///< in the unit of the threshold
  LoosestBy origin = LoosestBy::largest_share;
  bool always_holds = false;                  ///< a limit of this value holds always, so only a tighter one is permitted
  std::optional<CountedTooHot> refusal = {};  ///< why the settings of the check make every limit useless
};

/// A share of 100 % holds always, so a limit must be below it.
inline LoosestLimit largest_share_limit() { return {0.999, LoosestBy::largest_share}; }

struct ThresholdType {
  std::string_view name;  ///< the file's name; set by all_thresholds()
  std::string_view unit;  ///< UDUNITS text; "" is a pure number
  bool is_share = false;  ///< a pure number that is shown in percent
  bool is_whole = false;  ///< a count: a limit with a fraction is a mistake
  Bound direction = Bound::at_most;
  base::Range range = {};             ///< permitted values of the limit
  Room room = Room::share;            ///< room that --update leaves
  double least_distance_value = 0.0;  ///< in the unit of the threshold; --update counts a smaller distance to the origin as this one
  std::string_view meaning;           ///< exact definition of the compared value
  std::string_view example;           ///< limit that can be pasted
  std::vector<Setting> needs;
  std::vector<Setting> takes = {};  ///< optional settings that change the value
  /// Returns the loosest permitted limit; nothing if every limit in `range` is permitted. Null has the same meaning.
  std::optional<LoosestLimit> (*loosest)(const Check& check) = nullptr;
  /// Computes the value. Throws NotEvaluated or Failure if it cannot be determined.
  Measured (*measure)(const Check& check, Computations& computations) = nullptr;
};

/// Returns all thresholds, sorted by name. The list lives as long as the program.
const std::vector<ThresholdType>& all_thresholds();
/// Returns the threshold of that name; null if there is none.
const ThresholdType* find_threshold(std::string_view name);

}  // namespace heatsoak::check
