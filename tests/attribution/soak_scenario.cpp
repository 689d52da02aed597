#include "soak_scenario.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <fstream>
#include <string_view>
#include <vector>

#include "drive_rows.h"
#include "truth_motor.h"

namespace heatsoak::attribution::truth {
namespace {

constexpr int kRows = 1200;

/// The data sheet's drag torque K_t·I_0, and a chassis of 0.4 kg of aluminium behind the motor's flange.
Missing chassis() {
  Missing missing;
  missing.heat.push_back([](const Moment& m, PerPart& q) {
    q[yoke] += 0.0369 * 0.234 * std::abs(m.in.speed_rad_per_s);
    const double into_chassis_W = 0.22 * (m.part_C[shield_front] - m.part_C[lump_a]);
    q[shield_front] -= into_chassis_W;
    q[lump_a] += into_chassis_W - 0.1 * (m.part_C[lump_a] - m.in.ambient_C);
  });
  missing.lump_capacity_J_per_K[lump_a] = 360.0;
  return missing;
}

void write(const std::filesystem::path& file, const recording::Recording& log) {
  std::ofstream out(file);
  out << "time_s,winding_C,stator_C,ambient_C,current_A,speed_rad_per_s\n";
  for (std::size_t k = 0; k < log.rows(); ++k) {
    out << fmt::format("{:.0f}", log.time_s[k]);
    for (const std::string_view key :
         std::array<std::string_view, 5>{"winding_C", "stator_C", "ambient_C", "current_A", "speed_rad_per_s"}) {
      const double value = log.find(key)->values[k];
      out << (std::isnan(value) ? "," : fmt::format(",{:.2f}", value));
    }
    out << "\n";
  }
}

std::vector<TrueRun> soak_runs(std::uint64_t seed) {
  const MotorMake make{.copper_capacity_J_per_K = 6.6,
                       .iron_capacity_J_per_K = 54.0,
                       .copper_to_iron_K_per_W = 4.4,
                       .iron_to_air_K_per_W = 3.9,
                       .resistance_25C_ohm = 0.608,
                       .copper_per_K = 0.0039};
  const Missing missing = chassis();
  const Surprise surprise{
      .flux_W = 0.04, .flux_time_s = 200.0, .noise_K = 0.12, .step_K = 0.1, .outlier_probability = 0.002, .gap_probability = 0.0005};
  std::vector<TrueRun> runs;
  double age_h = 0.0;
  for (const std::uint64_t number : {1U, 2U, 3U}) {
    runs.push_back(
        run_motor(make, missing, surprise, robot_rows(kRows, seed + number), age_h, seed + number, fmt::format("match_{}", number)));
    age_h += kRows / 3600.0;
  }
  runs.push_back(run_motor(make, missing, surprise, bench_rows(1800, seed + 10), age_h, seed + 10, "bench"));
  return runs;
}

}  // namespace

void write_soak_logs(std::uint64_t seed, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  for (const TrueRun& run : soak_runs(seed)) {
    write(folder / (run.log.name + ".csv"), run.log);
  }
}

}  // namespace heatsoak::attribution::truth
