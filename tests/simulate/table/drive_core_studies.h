// Four studies of the drive core in the closed loop, and what they share: tables, spreads, the robot and its motor.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "motor/motor.h"
#include "report/chart.h"
#include "robot/robot.h"
#include "simulate/core_drive.h"

namespace heatsoak::studies {

/// Over seeds, headings or motors.
struct Spread {
  double mean = 0.0;
  double low = 0.0;   ///< 5th percentile
  double high = 0.0;  ///< 95th percentile
  double most = 0.0;
};
/// Percentiles are interpolated between the sorted values. `values` must not be empty.
Spread spread_of(std::vector<double> values);
/// "12.3 [10.1, 14.5]": mean, and 5th to 95th percentile.
std::string to_text(const Spread& spread, int decimals);

/// One table, written as Markdown and as CSV.
struct Sheet {
  std::vector<std::string> header;  ///< with units
  std::vector<std::vector<std::string>> rows;

  [[nodiscard]] std::string markdown() const;
  [[nodiscard]] std::string csv() const;
};

/// What a study leaves in the folder of its report.
struct Report {
  std::filesystem::path folder;

  void write(const std::string& file, const std::string& text) const;
  void draw(const std::string& file, const Chart& chart) const;
};

/// The paper's robot with the motor that it lost.
struct Subject {
  Robot robot;
  Motor motor;
};

/// Sensors and radio of the robot; a current sensor per motor where asked for, which Twente's driver does not have.
DriveOptions sensed_drive(const Robot& robot, std::uint64_t seed, bool has_current_sensor);

void study_low_speed(const Subject& subject, const Report& report);
void study_planners_in_match(const Subject& subject, const Report& report);
void study_guard(const Subject& subject, const Report& report);
void study_costs(const Subject& subject, const Report& report);

}  // namespace heatsoak::studies
