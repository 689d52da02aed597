// Recordings of a Festo Robotino on 72 headings. They are not part of the project; tests are skipped without them.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "../support/measured_data.h"
#include "robot/kinematics.h"

namespace heatsoak::robot {

/// Means over the steady part of one run.
struct SteadyRun {
  double heading_deg = 0.0;
  double commanded_m_per_s = 0.0;
  PerWheel motor_speed_rad_per_s{};  ///< calculated from encoder counts
  PerWheel current_A{};              ///< absolute value, as recorded
  BodyVelocity camera;               ///< local velocity; its millimetres have an unknown scale

  [[nodiscard]] bool is_even() const { return static_cast<int>(heading_deg) % 10 == 0; }
};

/// Reads a recording with three header rows, then numbers separated by `;`: time in ms, set speeds, encoder counts, velocities, currents,
/// camera.
inline std::vector<std::vector<double>> read_recording(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  std::vector<std::vector<double>> rows;
  for (int number = 0; std::getline(file, line); ++number) {
    if (number < 3) {
      continue;
    }
    std::vector<double>& row = rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ';');) {
      row.push_back(cell.empty() || cell == "\r" ? 0.0 : std::stod(cell));
    }
  }
  return rows;
}

/// Returns the part without the first 2.5 s (or 40 % of a short run) and the last half second.
inline SteadyRun steady_part(const std::vector<std::vector<double>>& rows) {
  constexpr double kCounts_per_rad = 2000.0 / 6.283185307179586;
  const double end_ms = rows.back()[0];
  SteadyRun run;
  const std::vector<double>* first = nullptr;
  const std::vector<double>* last = nullptr;
  int count = 0;
  for (const std::vector<double>& row : rows) {
    if (row[0] <= std::min(2500.0, 0.4 * end_ms) || row[0] >= end_ms - 500.0) {
      continue;
    }
    for (int i = 0; i < 3; ++i) {
      run.current_A[i] += row[13 + i];
    }
    if (first != nullptr) {
      run.camera.x_m_per_s += row[22] / 1000.0;
      run.camera.y_m_per_s += row[23] / 1000.0;
      run.camera.yaw_rad_per_s += row[24] / 57.29577951308232;
    }
    first = first == nullptr ? &row : first;
    last = &row;
    ++count;
  }
  const double duration_s = ((*last)[0] - (*first)[0]) / 1000.0;
  for (int i = 0; i < 3; ++i) {
    run.current_A[i] /= count;
    run.motor_speed_rad_per_s[i] = ((*last)[7 + i] - (*first)[7 + i]) / kCounts_per_rad / duration_s;
  }
  run.camera = {run.camera.x_m_per_s / duration_s, run.camera.y_m_per_s / duration_s, run.camera.yaw_rad_per_s / duration_s};
  run.commanded_m_per_s = std::hypot(rows[50][1], rows[50][2]);
  return run;
}

/// Returns the runs on a surface at a commanded speed. File n drives on heading 5°·n; each of 0.1, 0.2 and 0.3 m/s has 72 files.
inline std::vector<SteadyRun> steady_runs(const std::filesystem::path& surface, int speed_index) {
  std::vector<SteadyRun> runs;
  for (int n = 72 * speed_index; n < 72 * (speed_index + 1); ++n) {
    const std::string digits = std::to_string(n);
    const std::filesystem::path path = surface / ("exp" + (n < 10 ? "0" + digits : digits) + ".csv");
    if (std::filesystem::exists(path)) {
      runs.push_back(steady_part(read_recording(path)));
      runs.back().heading_deg = 5.0 * (n % 72);
    }
  }
  return runs;
}

}  // namespace heatsoak::robot
