// Four studies of the drive core in closed loop, and their shared parts: tables, spreads, the robot and its motor.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "motor/motor.h"
#include "report/chart.h"
#include "robot/robot.h"
#include "simulate/core_drive.h"

namespace heatsoak::simulate::studies {

/// Statistics over seeds, headings or motors.
struct Spread {
  double mean = 0.0;
  double low = 0.0;   ///< 5th percentile
  double high = 0.0;  ///< 95th percentile
  double most = 0.0;
};
/// Percentiles are interpolated between the sorted values. `values` must not be empty.
Spread spread_of(std::vector<double> values);
/// Formats mean, and 5th to 95th percentile: "12.3 [10.1, 14.5]".
std::string to_text(const Spread& spread, int decimals);

/// One table, written as Markdown and as CSV.
struct Sheet {
  std::vector<std::string> header;  ///< with units
  std::vector<std::vector<std::string>> rows;

  [[nodiscard]] std::string markdown() const;
  [[nodiscard]] std::string csv() const;
};

/// Writes a study's files to the folder of its report.
struct Report {
  std::filesystem::path folder;

  void write(const std::string& file, const std::string& text) const;
  void draw(const std::string& file, const report::Chart& chart) const;
};

/// The paper's robot with the motor that failed in it.
struct Subject {
  robot::Robot robot;
  motor::Motor motor;
};

/// Sensors and radio of the robot, with an optional current sensor per motor, which Twente's motor controller lacks.
DriveOptions sensed_drive(const robot::Robot& robot, std::uint64_t seed, bool has_current_sensor);

void study_low_speed(const Subject& subject, const Report& report);
void study_planners_in_match(const Subject& subject, const Report& report);
void study_guard(const Subject& subject, const Report& report);
void study_costs(const Subject& subject, const Report& report);

}  // namespace heatsoak::simulate::studies
