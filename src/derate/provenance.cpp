#include "derate/provenance.h"

#include <fmt/format.h>

#include <boost/crc.hpp>
#include <cstdint>

#include "base/files.h"
#include "base/version.h"
#include "derate/derating.h"

namespace heatsoak::derate {

std::string input_hash(std::string_view bytes) {
  boost::crc_optimal<64, 0x42F0E1EBA9EA3693U, 0xFFFFFFFFFFFFFFFFU, 0xFFFFFFFFFFFFFFFFU, true, true> sum;
  sum.process_bytes(bytes.data(), bytes.size());
  return fmt::format("{:016x}", std::uint64_t{sum.checksum()});
}

std::string options_text(const DerateOptions& options, double approach_s) {
  std::string text = fmt::format(
      "--period {:.9g}s --ambient {:.9g}degC --coldest {:.9g}degC --approach {:.9g}s --error {:.9g} --size {} --confidence {:.9g} "
      "--samples {} --seed {}",
      options.period_s, options.hottest_ambient_C, options.coldest_ambient_C, options.approach_s.value_or(approach_s),
      options.table.shortfall_ratio, options.table.most_bytes, options.guarantee.required_share, options.guarantee.samples,
      options.guarantee.seed);
  if (options.sensor) {
    const SensorOptions& sensor = *options.sensor;
    text +=
        fmt::format(" --{} {} {:.9g}K {:.9g}s {:.9g}V {:.9g}A", sensor.kind == SensorKind::thermistor ? "thermistor" : "winding-resistance",
                    sensor.node, sensor.accuracy_K, sensor.lag_s, sensor.voltage_error_V, sensor.current_error_A);
  }
  return text;
}

Provenance provenance_of(const motor::Motor& motor, const robot::Robot& robot, const DerateOptions& options) {
  constexpr std::size_t kLargestFile_bytes = 16U << 20U;
  std::string text = options_text(options, approach_s(motor, options));
  for (const auto& [key, value] : motor.assumed) {
    text += fmt::format(" --condition {}={}", key, value);
  }
  return {.program_version = fmt::format("heatsoak {}", base::program_version()),
          .input_hash = input_hash(base::read_file(robot.file, kLargestFile_bytes) + '\n' +
                                   base::read_file(motor.file, kLargestFile_bytes) + '\n' + text)};
}

}  // namespace heatsoak::derate
