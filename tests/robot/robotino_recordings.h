// Recordings of a Festo Robotino driving on 72 headings, where they are at hand; no part of the project.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "../support/measured_data.h"
#include "robot/kinematics.h"

namespace heatsoak {

/// Means over the steady part of one run.
struct SteadyRun {
  double heading_deg = 0.0;
  double commanded_m_per_s = 0.0;
  PerWheel motor_speed_rad_per_s{};  ///< from the encoders' counts
  PerWheel current_A{};              ///< magnitude, as recorded
  BodyVelocity camera;               ///< local; its millimetres have a scale of their own

  [[nodiscard]] bool is_even() const { return static_cast<int>(heading_deg) % 10 == 0; }
};

/// Three header rows, then `;` separated numbers: time in ms, set speeds, encoder counts, velocities, currents, camera.
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

/// Leaves out 2.5 s of starting (or 40 % of a short run) and half a second at the end.
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

/// The runs of a surface at a commanded speed; file n drives on heading 5°·n, 72 for each of 0.1, 0.2 and 0.3 m/s.
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

}  // namespace heatsoak
