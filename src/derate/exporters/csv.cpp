#include <fmt/format.h>

#include <iterator>

#include "derate/export_text.h"
#include "derate/exporter.h"

namespace heatsoak::exporters {
namespace {

std::string write(const Derating& derating) {
  const CurrentTable& table = derating.table;
  require_finite(derating);
  std::string text = provenance_lines(derating, "#") + "speed_rad_per_s,stator_C,winding_C,allowed_current_A\n";
  for (std::size_t i = 0; i < table.speed_rad_per_s.size(); ++i) {
    for (std::size_t j = 0; j < table.stator_C.size(); ++j) {
      for (std::size_t k = 0; k < table.winding_C.size(); ++k) {
        fmt::format_to(std::back_inserter(text), "{:.6g},{:.6g},{:.6g},{:.5g}\n", table.speed_rad_per_s[i], table.stator_C[j],
                       table.winding_C[k], table.current_A[table.place(i, j, k)]);
      }
    }
  }
  return text;
}

}  // namespace

ExporterType csv() {
  return {.name = {},
          .summary = "the table, one place a row, for pictures and other tools; its origin in lines that begin with #",
          .write = write};
}

}  // namespace heatsoak::exporters
