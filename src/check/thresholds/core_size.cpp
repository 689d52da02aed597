#include "check/computations.h"
#include "firmware/core_files.h"

namespace heatsoak::check::thresholds {
namespace {

Measured measure_core_size(const Check& check, Computations& computations) {
  firmware::CoreOptions core;
  derate::DerateOptions options = check.derate;
  options.period_s = firmware::guard_period_s(core.period_s);
  options.sensor.reset();  // the drive core has no temperature sensor
  const derate::Derating& derating = computations.derating(check, options);
  const firmware::CoreFolder folder = firmware::core_files(*check.robot, *check.motor, core, derating, "heatsoak 0.0.0");
  double size_byte = 0.0;
  for (const firmware::CoreFile& file : folder.files) {
    size_byte += static_cast<double>(firmware::code_bytes(file.path, file.content));
  }
  return {size_byte, 0.0, CoreSizeBasis{folder.files.size(), derating.table.size_bytes()}};
}

}  // namespace

ThresholdType core_size() {
  return {.name = {},
          .unit = "byte",
          .range = base::Range::between(0.0, 1e9),
          .meaning =
              "size of the drive core that `generate core` writes for robot and motor: its C and C++ files together without comments and "
              "empty lines, not compiled",
          .example = "at most 300 kbyte",
          .needs = {Setting::robot, Setting::motor},
          .takes = {Setting::conditions, Setting::derate},
          .loosest = [](const Check& check) -> std::optional<LoosestLimit> {
            return LoosestLimit{2.0 * static_cast<double>(firmware::largest_core_bytes(check.derate.table.most_bytes)),
                                LoosestBy::largest_core};
          },
          .measure = measure_core_size};
}

}  // namespace heatsoak::check::thresholds
