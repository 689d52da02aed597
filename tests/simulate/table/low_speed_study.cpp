// Accuracy of a slow velocity with and without equations (2) and (3) of RoboTeam Twente, ETDP 2025, for each direction of travel.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "drive_core_studies.h"
#include "firmware/core_config.h"
#include "simulate/test_drive.h"

namespace heatsoak::simulate::studies {
namespace {

constexpr std::array<double, 7> kSpeeds_m_per_s{0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5};
constexpr double kShownSpeed_m_per_s = 0.1;
constexpr std::size_t kShownSpeed = 1;
constexpr std::size_t kHeadings = 24;
constexpr std::size_t kSeeds = 5;
constexpr std::size_t kDirtyWheel = 2;  ///< rear left
constexpr double kDirt_ratio = 2.0;
constexpr double kWrong_ratio = 0.2;
constexpr double kDuration_s = 2.5;

struct Case {
  std::string name;
  robot_core::Config core;
  const robot::Robot* robot = nullptr;
};

/// Disables equations (2) and (3); back-EMF, acceleration and control remain.
robot_core::Config without_feed_forward(robot_core::Config config, double gain_ratio) {
  config.has_friction = false;
  for (robot_core::WheelConfig& wheel : config.wheel) {
    wheel.damping_V_s_per_rad = config.torque_constant_Nm_per_A * config.gear_ratio;
  }
  config.wheel_gain_V_s_per_rad *= static_cast<float>(gain_ratio);
  config.wheel_integral_V_per_rad *= static_cast<float>(gain_ratio);
  robot_core::complete(config);
  return config;
}

std::vector<Case> cases_of(const robot_core::Config& core, const robot::Robot& clean, const robot::Robot& dirty) {
  return {{"feed-forward", core, &clean},
          {"no feed-forward", without_feed_forward(core, 1.0), &clean},
          {"no feed-forward, PI gains doubled", without_feed_forward(core, 2.0), &clean},
          {"feed-forward, friction 20 % too low", with_friction_factor(core, 1.0 - kWrong_ratio), &clean},
          {"feed-forward, friction 20 % too high", with_friction_factor(core, 1.0 + kWrong_ratio), &clean},
          {"feed-forward, wheel 3 dirty", core, &dirty},
          {"no feed-forward, wheel 3 dirty", without_feed_forward(core, 1.0), &dirty}};
}
constexpr std::size_t kDrawnCases = 6;

/// Result of one drive.
struct Outcome {
  double error_rms_m_per_s = 0.0;  ///< RMS of the velocity vector's error over the whole drive
  double steady_m_per_s = 0.0;     ///< robot minus plan along the direction in the last quarter
  double direction_rad = 0.0;      ///< absolute error of the direction in the last quarter
  double distance_m = 0.0;         ///< distance between plan and robot at the end
  double ripple_m_per_s = 0.0;     ///< RMS of the velocity about its mean in the last quarter
  double fault_s = 0.0;
};

Outcome drive(const Case& tried, const motor::Motor& motor, bool is_core_alone, double speed_m_per_s, std::size_t heading,
              std::size_t seed) {
  const DriveOptions with_feedback = sensed_drive(*tried.robot, seed + 1, true);
  const DriveOptions options = is_core_alone ? without_position_feedback(with_feedback) : with_feedback;
  StraightDrive straight;
  straight.direction_rad = 2.0 * std::numbers::pi * static_cast<double>(heading) / kHeadings;
  straight.speed_m_per_s = speed_m_per_s;
  straight.duration_s = kDuration_s;
  const DrivenLine driven = drive_straight(*tried.robot, motor, tried.core, options, straight);
  Outcome outcome{driven.speed_error_rms_m_per_s,
                  driven.steady_speed_error_m_per_s,
                  std::abs(driven.direction_error_rad),
                  driven.distance_error_m,
                  0.0,
                  0.0};
  const std::size_t steady = driven.moments.size() - driven.moments.size() / 4;
  double x_m_per_s = 0.0, y_m_per_s = 0.0, square_m2_per_s2 = 0.0;
  for (std::size_t i = 0; i < driven.moments.size(); ++i) {
    const DriveMoment& each = driven.moments[i];
    outcome.fault_s += std::ranges::any_of(each.reason, robot_core::is_fault) ? SimulatedRobot::kPeriod_s : 0.0;
    if (i >= steady) {
      x_m_per_s += each.velocity.x_m_per_s;
      y_m_per_s += each.velocity.y_m_per_s;
      square_m2_per_s2 += each.velocity.x_m_per_s * each.velocity.x_m_per_s + each.velocity.y_m_per_s * each.velocity.y_m_per_s;
    }
  }
  const auto count = static_cast<double>(driven.moments.size() - steady);
  const double mean_square = (x_m_per_s * x_m_per_s + y_m_per_s * y_m_per_s) / (count * count);
  outcome.ripple_m_per_s = std::sqrt(std::max(0.0, square_m2_per_s2 / count - mean_square));
  return outcome;
}

/// All drives: [case][speed][heading][seed]. Either the core alone keeps the course, or the team's computer corrects it with the cameras.
class Results {
 public:
  Results(const std::vector<Case>& cases, const motor::Motor& motor, bool is_core_alone)
      : outcomes_(cases.size() * kSpeeds_m_per_s.size() * kHeadings * kSeeds) {
    base::in_parallel(outcomes_.size(), 0, [&](std::size_t i) {
      const std::size_t drive_of_case = i % (kSpeeds_m_per_s.size() * kHeadings * kSeeds);
      const double speed_m_per_s = kSpeeds_m_per_s.at(drive_of_case / (kHeadings * kSeeds));
      outcomes_[i] = drive(cases[i / (kSpeeds_m_per_s.size() * kHeadings * kSeeds)], motor, is_core_alone, speed_m_per_s,
                           drive_of_case / kSeeds % kHeadings, drive_of_case % kSeeds);
    });
  }

  /// Spread over headings and seeds, multiplied by `scale`.
  [[nodiscard]] Spread over_all(std::size_t tried, std::size_t speed, double Outcome::*value, double scale) const {
    return over(tried, speed, 0, kHeadings, value, scale);
  }
  /// Spread over the seeds of one heading.
  [[nodiscard]] Spread over_seeds(std::size_t tried, std::size_t speed, std::size_t heading, double Outcome::*value, double scale) const {
    return over(tried, speed, heading, heading + 1, value, scale);
  }
  [[nodiscard]] double fault_s() const {
    double sum_s = 0.0;
    for (const Outcome& each : outcomes_) {
      sum_s += each.fault_s;
    }
    return sum_s;
  }
  [[nodiscard]] std::size_t size() const { return outcomes_.size(); }

 private:
  [[nodiscard]] Spread over(std::size_t tried, std::size_t speed, std::size_t from, std::size_t to, double Outcome::*value,
                            double scale) const {
    std::vector<double> values;
    const std::size_t first = (tried * kSpeeds_m_per_s.size() + speed) * kHeadings;
    for (std::size_t i = (first + from) * kSeeds; i < (first + to) * kSeeds; ++i) {
      values.push_back(scale * outcomes_[i].*value);
    }
    return spread_of(std::move(values));
  }

  std::vector<Outcome> outcomes_;
};

constexpr double kMilli = 1e3;
constexpr double kDegree = 180.0 / std::numbers::pi;

void write_tables(const std::vector<Case>& cases, const Results& results, const Report& report) {
  Sheet by_speed{{"case", "speed_m_per_s", "error_rms_mm_per_s", "error_p05_mm_per_s", "error_p95_mm_per_s", "steady_error_mm_per_s",
                  "direction_error_deg", "position_error_mm", "ripple_rms_mm_per_s"},
                 {}};
  Sheet by_heading{{"case", "speed_m_per_s", "heading_deg", "error_rms_mm_per_s", "error_p05_mm_per_s", "error_p95_mm_per_s",
                    "steady_error_mm_per_s", "direction_error_deg", "position_error_mm"},
                   {}};
  const auto number = [](double value) { return fmt::format("{:.3g}", value); };
  for (std::size_t c = 0; c < cases.size(); ++c) {
    std::string name = cases[c].name;
    std::erase(name, ',');
    for (std::size_t s = 0; s < kSpeeds_m_per_s.size(); ++s) {
      const Spread error = results.over_all(c, s, &Outcome::error_rms_m_per_s, kMilli);
      by_speed.rows.push_back({name, number(kSpeeds_m_per_s.at(s)), number(error.mean), number(error.low), number(error.high),
                               number(results.over_all(c, s, &Outcome::steady_m_per_s, kMilli).mean),
                               number(results.over_all(c, s, &Outcome::direction_rad, kDegree).mean),
                               number(results.over_all(c, s, &Outcome::distance_m, kMilli).mean),
                               number(results.over_all(c, s, &Outcome::ripple_m_per_s, kMilli).mean)});
      for (std::size_t h = 0; h < kHeadings; ++h) {
        const Spread at = results.over_seeds(c, s, h, &Outcome::error_rms_m_per_s, kMilli);
        by_heading.rows.push_back({name, number(kSpeeds_m_per_s.at(s)), number(360.0 * static_cast<double>(h) / kHeadings), number(at.mean),
                                   number(at.low), number(at.high),
                                   number(results.over_seeds(c, s, h, &Outcome::steady_m_per_s, kMilli).mean),
                                   number(results.over_seeds(c, s, h, &Outcome::direction_rad, kDegree).mean),
                                   number(results.over_seeds(c, s, h, &Outcome::distance_m, kMilli).mean)});
      }
    }
  }
  report.write("low_speed.csv", by_speed.csv());
  report.write("low_speed_heading.csv", by_heading.csv());
}

std::string error_table(const std::vector<Case>& cases, const Results& results) {
  Sheet sheet{{"velocity error / mm/s rms"}, {}};
  for (const double speed : kSpeeds_m_per_s) {
    sheet.header.push_back(fmt::format("{} m/s", speed));
  }
  for (std::size_t c = 0; c < cases.size(); ++c) {
    sheet.rows.push_back({cases[c].name});
    for (std::size_t s = 0; s < kSpeeds_m_per_s.size(); ++s) {
      sheet.rows.back().push_back(to_text(results.over_all(c, s, &Outcome::error_rms_m_per_s, kMilli), 1));
    }
  }
  return sheet.markdown();
}

std::string other_table(const std::vector<Case>& cases, const Results& results, const Results& corrected) {
  Sheet sheet{{fmt::format("at {} m/s", kShownSpeed_m_per_s), "steady speed error / mm/s", "direction error / °",
               "position error at the end / mm", "ripple of the velocity / mm/s rms", "worst heading, velocity error / mm/s rms",
               "with position feedback: velocity error / mm/s rms", "with position feedback: position error at the end / mm"},
              {}};
  for (std::size_t c = 0; c < cases.size(); ++c) {
    const auto cell = [&](double Outcome::*value, double scale, int decimals) {
      return to_text(results.over_all(c, kShownSpeed, value, scale), decimals);
    };
    double worst_mm_per_s = 0.0;
    std::size_t where = 0;
    for (std::size_t h = 0; h < kHeadings; ++h) {
      const double mean = results.over_seeds(c, kShownSpeed, h, &Outcome::error_rms_m_per_s, kMilli).mean;
      where = mean > worst_mm_per_s ? h : where;
      worst_mm_per_s = std::max(worst_mm_per_s, mean);
    }
    sheet.rows.push_back({cases[c].name, cell(&Outcome::steady_m_per_s, kMilli, 1), cell(&Outcome::direction_rad, kDegree, 1),
                          cell(&Outcome::distance_m, kMilli, 1), cell(&Outcome::ripple_m_per_s, kMilli, 1),
                          fmt::format("{:.1f} at {}°", worst_mm_per_s, 360 * where / kHeadings),
                          to_text(corrected.over_all(c, kShownSpeed, &Outcome::error_rms_m_per_s, kMilli), 1),
                          to_text(corrected.over_all(c, kShownSpeed, &Outcome::distance_m, kMilli), 1)});
  }
  return sheet.markdown();
}

void draw_over_speed(const std::vector<Case>& cases, const Results& results, const Report& report) {
  const double with = results.over_all(0, kShownSpeed, &Outcome::error_rms_m_per_s, kMilli).mean;
  const double without = results.over_all(1, kShownSpeed, &Outcome::error_rms_m_per_s, kMilli).mean;
  report::Chart chart{
      .title = fmt::format("Feed-forward cuts the velocity error at {} m/s from {:.0f} to {:.0f} mm/s", kShownSpeed_m_per_s, without, with),
      .subtitle = fmt::format("Twente v2024 simulated with real sensing; means of {} directions and {} seeds; areas: 5 % to 95 %",
                              kHeadings, kSeeds),
      .x_label = "commanded speed / (m/s)",
      .panels = {},
      .panel_height_px = 400};
  const auto add = [&](const char* title, const char* label, double Outcome::*value, double scale, bool is_first) {
    report::ChartPanel panel{.title = title, .y_label = label, .curves = {}, .bands = {}, .levels = {}};
    for (std::size_t c = 0; c < kDrawnCases; ++c) {
      report::ChartCurve curve{.name = is_first ? cases[c].name : "", .color_index = static_cast<int>(c)};
      report::ChartBand band{.color_index = static_cast<int>(c)};
      for (std::size_t s = 0; s < kSpeeds_m_per_s.size(); ++s) {
        const Spread spread = results.over_all(c, s, value, scale);
        curve.x.push_back(kSpeeds_m_per_s.at(s));
        curve.y.push_back(spread.mean);
        band.low.push_back(spread.low);
        band.high.push_back(spread.high);
      }
      band.x = curve.x;
      panel.curves.push_back(std::move(curve));
      if (c < 2) {
        panel.bands.push_back(std::move(band));
      }
    }
    chart.panels.push_back(std::move(panel));
  };
  add("Velocity error, start included", "error / (mm/s rms)", &Outcome::error_rms_m_per_s, kMilli, true);
  add("Distance between plan and robot after 2.5 s", "distance / mm", &Outcome::distance_m, kMilli, false);
  report.draw("low_speed.svg", chart);
}

void draw_over_heading(const std::vector<Case>& cases, const Results& results, const Report& report) {
  const auto worst_mm_per_s = [&](std::size_t tried) {
    double worst = 0.0;
    for (std::size_t h = 0; h < kHeadings; ++h) {
      worst = std::max(worst, results.over_seeds(tried, kShownSpeed, h, &Outcome::error_rms_m_per_s, kMilli).mean);
    }
    return worst;
  };
  report::Chart chart{
      .title = fmt::format("Worst direction at {} m/s: error {:.0f} mm/s without feed-forward, {:.0f} mm/s with it", kShownSpeed_m_per_s,
                           worst_mm_per_s(1), worst_mm_per_s(0)),
      .subtitle = fmt::format(
          "Twente v2024 simulated with real sensing; means of {} seeds; areas, mostly as thin as the lines: 5 % to 95 %", kSeeds),
      .x_label = "direction of travel from straight ahead, counter-clockwise / °",
      .panels = {},
      .panel_height_px = 400};
  const auto add = [&](const char* title, const char* label, double Outcome::*value, double scale, bool is_first) {
    report::ChartPanel panel{.title = title, .y_label = label, .curves = {}, .bands = {}, .levels = {}};
    for (std::size_t c = 0; c < kDrawnCases; ++c) {
      report::ChartCurve curve{.name = is_first ? cases[c].name : "", .color_index = static_cast<int>(c)};
      report::ChartBand band{.color_index = static_cast<int>(c)};
      for (std::size_t h = 0; h <= kHeadings; ++h) {
        const Spread spread = results.over_seeds(c, kShownSpeed, h % kHeadings, value, scale);
        curve.x.push_back(360.0 * static_cast<double>(h) / kHeadings);
        curve.y.push_back(spread.mean);
        band.low.push_back(spread.low);
        band.high.push_back(spread.high);
      }
      band.x = curve.x;
      panel.curves.push_back(std::move(curve));
      if (c < 2) {
        panel.bands.push_back(std::move(band));
      }
    }
    chart.panels.push_back(std::move(panel));
  };
  add("Velocity error, start included", "error / (mm/s rms)", &Outcome::error_rms_m_per_s, kMilli, true);
  add("Error of the direction, last 0.6 s", "magnitude / °", &Outcome::direction_rad, kDegree, false);
  report.draw("low_speed_heading.svg", chart);
}

}  // namespace

void study_low_speed(const Subject& subject, const Report& report) {
  const robot::Robot dirty = with_dirty_wheel(subject.robot, kDirtyWheel, kDirt_ratio);
  const std::vector<Case> cases = cases_of(firmware::make_core_config(subject.robot, subject.motor.nominal, {}), subject.robot, dirty);
  const Results results(cases, subject.motor, true);
  const Results corrected(cases, subject.motor, false);
  write_tables(cases, results, report);
  report.write("low_speed.md",
               fmt::format("Means over {} directions and {} seeds; in brackets 5th and 95th percentile.\n\n{}\n{}\n"
                           "Without position feedback unless said otherwise.\nFalse faults in {} drives of {} s: {:.3f} s.\n",
                           kHeadings, kSeeds, error_table(cases, results), other_table(cases, results, corrected), 2 * results.size(),
                           kDuration_s, results.fault_s() + corrected.fault_s()));
  draw_over_speed(cases, results, report);
  draw_over_heading(cases, results, report);
}

}  // namespace heatsoak::simulate::studies
