#include <embedded/shared_c_text.h>
#include <fmt/format.h>

#include <algorithm>
#include <boost/crc.hpp>
#include <span>
#include <string>

#include "derate/c_header/c_text.h"
#include "derate/c_header/parts.h"
#include "derate/export_text.h"
#include "derate/exporter.h"

namespace heatsoak::derate::exporters {
namespace {

/// Returns a checksum that differs between guards. In the include guard it makes the compiler report two headers with the same names.
unsigned signature_of(const Derating& derating) {
  const std::string all =
      fmt::format("{}|{}|{}|{}", derating.motor_id, derating.robot_id, derating.options.period_s, derating.observer.heat_safety_factor());
  boost::crc_32_type sum;
  sum.process_bytes(all.data(), all.size());
  return sum.checksum();
}

/// Text without its include of <stdint.h>, which the header has at its top, and without the empty line after it.
std::string shared_text(std::string_view file) {
  constexpr std::string_view kInclude = "#include <stdint.h>\n";
  const std::span<const embedded::Text> all = embedded::shared_c_text();
  std::string text(std::ranges::find_if(all, [file](const embedded::Text& each) { return each.path.ends_with(file); })->text);
  const std::size_t at = text.find(kInclude);
  const bool is_alone = text.compare(at - 2, 2, "\n\n") == 0 && text[at + kInclude.size()] == '\n';
  return text.erase(at, kInclude.size() + (is_alone ? 1 : 0));
}

std::string write_c_header(const Derating& derating) {
  require_finite(derating);
  const std::string prefix = identifier(derating.motor_id);
  const c_header::Source source{derating, prefix, c_header::in_capitals(prefix), c_header::used_signals(derating.observer)};
  const unsigned signature = signature_of(derating);
  const c_header::Rates rates = c_header::rates(source);
  const c_header::Rates sensor = c_header::sensor_functions(source);
  return c_header::wrapped(
      c_header::head_comment(source) +
      fmt::format("#ifndef {0}\n#define {0}\n\n", fmt::format("HEATSOAK_{}_{:08X}_H", source.capital, signature)) +
      "#include <stdbool.h>\n#include <stdint.h>\n\n" +
      "#ifdef __FAST_MATH__\n#error \"compile without -ffast-math: it removes the checks for NaN and the carried rounding "
      "error\"\n#endif\n\n" +
      // MISRA 20.1: current_table.h includes <math.h>, so it comes before every other text.
      shared_text("current_table.h") + "\n" + (rates.calls_thermal_math ? shared_text("thermal_math.h") + "\n" : "") +
      shared_text("crc_32.h") + "\n" + c_header::constants(source) + c_header::plausible_constants(source) +
      c_header::foc_conversion(source) + c_header::structures(source) + c_header::tables(source) + rates.text +
      c_header::candidates(source) + c_header::allowed_function(source) + c_header::step_functions(source) +
      c_header::memory_functions(source, signature) + sensor.text + "#endif\n");
}

}  // namespace

ExporterType c_header() {
  return {.name = {},
          .summary = "C99 header without dependencies: observer, table, one step per period; single precision",
          .write = write_c_header};
}

}  // namespace heatsoak::derate::exporters
