#include <fmt/format.h>

#include <string>

#include "derate/c_header/c_text.h"
#include "derate/c_header/parts.h"
#include "derate/export_text.h"
#include "derate/exporter.h"

namespace heatsoak::derate::exporters {
namespace {

std::string write_c_header(const Derating& derating) {
  require_finite(derating);
  const std::string prefix = identifier(derating.motor_id);
  const c_header::Source source{derating, prefix, c_header::in_capitals(prefix), c_header::used_signals(derating.observer)};
  const unsigned signature = guard_signature(derating, "");
  const c_header::Rates rates = c_header::rates(source);
  const c_header::Rates sensor = c_header::sensor_functions(source);
  return c_header::wrapped(
      c_header::head_comment(source) +
      fmt::format("#ifndef {0}\n#define {0}\n\n", fmt::format("HEATSOAK_{}_{:08X}_H", source.capital, signature)) +
      "#include <stdbool.h>\n#include <stdint.h>\n\n" +
      "#ifdef __FAST_MATH__\n#error \"compile without -ffast-math: it removes the checks for NaN and the carried rounding "
      "error\"\n#endif\n\n" +
      // MISRA 20.1: current_table.h includes <math.h>, so it comes before every other text.
      c_header::shared_text("current_table.h") + "\n" + (rates.calls_thermal_math ? c_header::shared_text("thermal_math.h") + "\n" : "") +
      c_header::shared_text("crc_32.h") + "\n" + c_header::constants(source) + c_header::plausible_constants(source) +
      c_header::foc_conversion(source) + c_header::structures(source) + c_header::tables(source) + rates.text +
      c_header::candidates(source) + c_header::allowed_function(source) + c_header::step_functions(source) +
      c_header::memory_functions(source, signature) + sensor.text + "#endif\n");
}

}  // namespace

ExporterType c_header() {
  return {.name = {},
          .summary = "C99 header without dependencies: observer, table, one step per period; single precision",
          .file_ending = ".h",
          .write = write_c_header};
}

}  // namespace heatsoak::derate::exporters
