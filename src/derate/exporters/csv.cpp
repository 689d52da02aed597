#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "derate/export_text.h"
#include "derate/exporter.h"

namespace heatsoak::derate::exporters {
namespace {

/// Returns the breakpoints of an axis with intermediate points at most `step` apart, so that linear interpolation between the rows follows
/// the table.
std::vector<double> sampled(const std::vector<double>& axis, double step) {
  std::vector<double> points{axis.front()};
  for (std::size_t i = 1; i < axis.size(); ++i) {
    const auto parts = static_cast<int>(std::ceil((axis[i] - axis[i - 1]) / step));
    const std::vector<double> between = evenly(axis[i - 1], axis[i], parts + 1);
    points.insert(points.end(), between.begin() + 1, between.end());
  }
  return points;
}

std::string write_csv(const Derating& derating) {
  constexpr double kStatorStep_K = 25.0;
  constexpr double kWindingStep_K = 4.0;
  const CurrentTable& table = derating.table;
  require_finite(derating);
  std::vector<double> speeds = table.speed_rad_per_s;
  for (const double last_rad_per_s : {table.most_speed_rad_per_s, table.no_current_speed_rad_per_s}) {
    if (last_rad_per_s > speeds.back()) {
      speeds.push_back(last_rad_per_s);
    }
  }
  std::string text = provenance_lines(derating, "#") + "speed_rad_per_s,stator_C,winding_C,allowed_current_A\n";
  for (const double speed_rad_per_s : speeds) {
    for (const double stator_C : sampled(table.stator_C, kStatorStep_K)) {
      for (const double winding_C : sampled(table.winding_C, kWindingStep_K)) {
        fmt::format_to(std::back_inserter(text), "{:.6g},{:.6g},{:.6g},{:.5g}\n", speed_rad_per_s, stator_C, winding_C,
                       table.allowed_A(speed_rad_per_s, stator_C, winding_C));
      }
    }
  }
  return text;
}

}  // namespace

ExporterType csv() {
  return {.name = {},
          .summary = "the table, one grid point per row, for plots and other tools; lines that begin with # state its origin",
          .file_ending = ".csv",
          .write = write_csv};
}

}  // namespace heatsoak::derate::exporters
