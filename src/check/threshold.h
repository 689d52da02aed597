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

/// Room that --update leaves between the measured value and the new limit.
enum class Room {
  share,  ///< 5 %, or --margin, of the distance between the value and its origin (Measured::origin_value)
  none    ///< none: the measured value becomes the limit
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
  double origin_value = 0.0;  ///< in the same unit; 0 or, for a temperature, the air: the room of --update is a share of the distance to it
  Basis basis = {};
  bool is_never = false;  ///< the event never happens, so that its time, the value, is infinite
  /// Width of the value's 95 % interval. If it is larger than the distance to the origin, the room is a share of it instead.
  double interval_width_value = 0.0;
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
  largest_share,      ///< less than 100 %, because a share is never above that
  smallest_value      ///< the smallest value that the number can have
};

/// The check counts the time above a temperature that is higher than the motor's own limit, so no limit on that time protects the motor.
struct CountedTooHot {
  double temperature_C = 0.0;
  double winding_limit_C = 0.0;
};

/// The loosest limit that a check may set, such as the motor's own winding limit.
struct LoosestLimit {
  double value = 0.0;  ///< in the unit of the threshold
  LoosestBy origin = LoosestBy::largest_share;
  bool always_holds = false;                  ///< true: this value can never be exceeded, so the limit must be tighter
  std::optional<CountedTooHot> refusal = {};  ///< why the settings of the check make every limit useless
};

/// No share is above 100 %, so a limit must be below it.
inline LoosestLimit largest_share_limit() { return {0.999, LoosestBy::largest_share}; }

struct ThresholdType {
  std::string_view name;  ///< the file's name; set by all_thresholds()
  std::string_view unit;  ///< UDUNITS text; "" is a pure number
  bool is_share = false;  ///< a pure number that is shown in percent
  bool is_whole = false;  ///< a count: a limit with a fraction is a mistake
  Bound direction = Bound::at_most;
  base::Range range = {};    ///< permitted values of the limit
  Room room = Room::share;   ///< room that --update leaves
  std::string_view meaning;  ///< exact definition of the compared value
  std::string_view example;  ///< limit that can be pasted
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
