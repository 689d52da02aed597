#include "check/threshold.h"

#include <algorithm>
#include <array>

#include "check/thresholds_registry.h"

namespace heatsoak::check {

std::span<const SettingText> all_settings() {
  static constexpr std::array<SettingText, 15> kSettings{{
      {"robot", "id or file"},
      {"duty", "id or file"},
      {"motor", "id or file; the robot's own unless given"},
      {"against", "other motors of the ranking: ids or files, or all"},
      {"conditions", "conditions of the motor's effects that hold, { cooling = \"fan\" }"},
      {"samples", "number of draws of every declared tolerance, as in `evaluate`; 500 unless given"},
      {"seed", "seed of draws and games; 1 unless given"},
      {"temperature", "temperature above which time_above counts"},
      {"table", "committed derating table, a C header or CSV of `derate`; its path is relative to the check file"},
      {"files", "files to lint, with paths relative to the check file; the check's motor, robot and duty unless given"},
      {"logs", "measured logs, with paths relative to the check file"},
      {"map", "mapping of the logs' columns; LOG.map.toml beside a log is found automatically"},
      {"air", "air temperature of a log that has none"},
      {"derate",
       "options of `derate`: ambient, coldest, approach, period, confidence, samples, seed; those of `derate` itself unless given. For a "
       "committed C header with a sensor also thermistor, winding_resistance and their options with \"_\" for \"-\""},
      {"command", "command of this program, \"simulate --motor M --robot R --duty D\"; the limits are on numbers of its JSON answer"},
  }};
  return kSettings;
}

const std::vector<ThresholdType>& all_thresholds() {
  static const std::vector<ThresholdType> kAll = [] {
    std::vector<ThresholdType> all;
    for (const auto& [name, make] : thresholds::registry) {
      all.push_back(make());
      all.back().name = name;
    }
    return all;
  }();
  return kAll;
}

const ThresholdType* find_threshold(std::string_view name) {
  const auto found = std::ranges::find(all_thresholds(), name, &ThresholdType::name);
  return found == all_thresholds().end() ? nullptr : &*found;
}

}  // namespace heatsoak::check
