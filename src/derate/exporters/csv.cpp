#include <fmt/format.h>

#include <iterator>

#include "base/quantity.h"
#include "derate/export_text.h"
#include "derate/exporter.h"
#include "derate/sampled_table.h"

namespace heatsoak::derate::exporters {
namespace {

std::string write_csv(const Derating& derating) {
  require_finite(derating);
  const CurrentTable& table = derating.table;
  const SampledTable samples = sampled_table(table, derating.rules.limits.winding_C);
  std::string text =
      provenance_lines(derating, "#") +
      fmt::format(
          "# Interpolate allowed_current_A linearly along the first three columns. The result is at most 0.1 mA above the table of the C "
          "header, "
          "and\n"
          "# at most {} % below it, from {} A up. Below the first value of a column use its first value.\n"
          "# Above the last winding_C or speed_rad_per_s the current is 0. Each kelvin of the stator above the last stator_C counts as\n"
          "# {:.6g} K of the winding.\n"
          "speed_rad_per_s,stator_C,winding_C,allowed_current_A\n",
          significant_above(100.0 * samples.shortfall_ratio, 2), base::significant(kCounted_ratio * table.straight_below_A, 3),
          table.winding_per_stator_K);
  std::size_t place = 0;
  for (const double speed_rad_per_s : samples.speed_rad_per_s) {
    for (const double stator_C : samples.stator_C) {
      for (const double winding_C : samples.winding_C) {
        fmt::format_to(std::back_inserter(text), "{:.9g},{:.9g},{:.9g},{:.9g}\n", speed_rad_per_s, stator_C, winding_C,
                       samples.current_A[place++]);
      }
    }
  }
  return text;
}

}  // namespace

ExporterType csv() {
  return {.name = {},
          .summary = "the table as currents on a grid, for plots and other tools; lines that begin with # state its origin",
          .file_ending = ".csv",
          .write = write_csv};
}

}  // namespace heatsoak::derate::exporters
