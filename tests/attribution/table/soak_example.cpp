// Writes the synthetic logs of reports/soak, see soak_scenario.h. Every run writes the same bytes.
//   heatsoak_soak_example FOLDER
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "soak_scenario.h"

namespace {

using namespace heatsoak::attribution::truth;

void write(const std::filesystem::path& file, const heatsoak::recording::Recording& log) {
  std::ofstream out(file);
  out << "time_s,winding_C,stator_C,ambient_C,current_A,speed_rad_per_s\n";
  for (std::size_t k = 0; k < log.rows(); ++k) {
    out << fmt::format("{:.0f}", log.time_s[k]);
    for (const char* key : {"winding_C", "stator_C", "ambient_C", "current_A", "speed_rad_per_s"}) {
      const double value = log.find(key)->values[k];
      out << (std::isnan(value) ? "," : fmt::format(",{:.2f}", value));
    }
    out << "\n";
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: heatsoak_soak_example FOLDER\n");
    return 2;
  }
  const std::filesystem::path folder(argv[1]);
  std::filesystem::create_directories(folder);
  for (const TrueRun& run : soak_runs(500)) {
    write(folder / (run.log.name + ".csv"), run.log);
  }
}
