#include "present/measured/friction_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <variant>

#include "base/confidence.h"
#include "base/quantity.h"
#include "present/measured/friction.h"

namespace heatsoak::present {
namespace {

constexpr double kDegrees_per_rad = 180.0 / std::numbers::pi;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::string wheel_name(std::size_t wheel) { return fmt::format("wheel {}", wheel + 1); }

report::ChartCurve dots(std::size_t wheel, const std::string& name) {
  report::ChartCurve curve;
  curve.name = name;
  curve.color_index = static_cast<int>(wheel);
  curve.dots = true;
  return curve;
}

/// Adds the interval as a vertical line at `x`.
void add_interval(report::ChartCurve& bars, double x, const friction::Estimate& estimate) {
  if (const auto& interval = estimate.interval) {
    bars.x.insert(bars.x.end(), {x, x, x});
    bars.y.insert(bars.y.end(), {interval->low, interval->high, kNaN});
  }
}

/// Returns f(θ), interrupted at its changes of sign.
report::ChartCurve fitted_curve(const friction::WheelFriction& wheel, std::size_t index) {
  report::ChartCurve curve;
  curve.color_index = static_cast<int>(index);
  double before_V = kNaN;
  for (int i = -720; i <= 720; ++i) {
    const double heading_rad = 0.25 * i / kDegrees_per_rad;
    const double value_V = wheel.friction_V(heading_rad);
    const bool jumps = std::abs(value_V - before_V) > std::abs(wheel.constant_V->value);
    curve.x.push_back(0.25 * i);
    curve.y.push_back(jumps ? kNaN : value_V);
    before_V = value_V;
  }
  return curve;
}

report::ChartPanel heading_panel(const friction::FrictionFit& fit, bool of_damping) {
  report::ChartPanel panel;
  panel.title = of_damping ? "Damping of every heading; dashed: fitted over all"
                           : "Static friction of every heading; lines: f = a sin(θ+φ) + b sign(sin(θ+φ))";
  panel.y_label = of_damping ? "damping / V s/rad" : "offset / V";
  for (std::size_t i = 0; i < fit.wheels.size(); ++i) {
    const friction::WheelFriction& wheel = fit.wheels[i];
    report::ChartCurve points = dots(i, wheel_name(i));
    report::ChartCurve bars{.color_index = static_cast<int>(i)};
    for (const friction::HeadingLine& line : fit.lines[i]) {
      const std::optional<friction::Estimate> estimate = of_damping ? line.damping_V_s_per_rad : line.offset_V;
      if (!estimate) {
        continue;
      }
      const double x =
          line.heading_rad * kDegrees_per_rad + 0.8 * (static_cast<double>(i) - 0.5 * static_cast<double>(fit.wheels.size() - 1));
      points.x.push_back(x);
      points.y.push_back(estimate->value);
      add_interval(bars, x, *estimate);
    }
    panel.curves.push_back(points);
    panel.curves.push_back(bars);
    if (of_damping && wheel.is_learned()) {
      panel.curves.push_back({.x = {-180.0, 180.0},
                              .y = {wheel.damping_V_s_per_rad->value, wheel.damping_V_s_per_rad->value},
                              .color_index = static_cast<int>(i),
                              .dashed = true});
    } else if (wheel.is_learned() && wheel.constant_V) {
      panel.curves.push_back(fitted_curve(wheel, i));
    }
  }
  return panel;
}

bool has_points(const report::ChartPanel& panel) {
  return std::ranges::any_of(panel.curves, [](const report::ChartCurve& curve) {
    return curve.dots && std::ranges::any_of(curve.y, [](double value) { return std::isfinite(value); });
  });
}

/// Draws the legs that the fit uses.
class Drives {
 public:
  Drives(const friction::SteadyParts& steady, const friction::FrictionFit& fit, const robot::Kinematics& kinematics,
         const friction::FitSettings& settings)
      : fit_(fit), kinematics_(kinematics), numbers_(friction::heading_numbers(steady.parts, settings)) {
    for (std::size_t i = 0; i < steady.parts.size(); ++i) {
      if (settings.use_return_legs || !steady.parts[i].is_return) {
        parts_.emplace_back(&steady.parts[i], numbers_[i]);
      }
    }
  }

  /// Returns the lines of the heading with the most legs. Among equals, the heading on which the slowest wheel turns fastest.
  [[nodiscard]] std::optional<report::ChartPanel> of_one_heading() const {
    const std::optional<int> number = informative_heading();
    if (!number) {
      return std::nullopt;
    }
    report::ChartPanel panel;
    panel.y_label = "voltage / V";
    bool has_line = false;
    for (std::size_t i = 0; i < fit_.wheels.size(); ++i) {
      report::ChartCurve points = dots(i, wheel_name(i));
      double heading_rad = 0.0;
      for (const auto& [part, of_part] : parts_) {
        if (of_part == number) {
          points.x.push_back(part->wheel_speed_rad_per_s[i]);
          points.y.push_back(part->voltage_V[i]);
          heading_rad = part->heading_rad;
        }
      }
      panel.title = fmt::format("Towards {:.0f}°: measured, and the line of each wheel; at 0 rad/s its static friction",
                                heading_rad * kDegrees_per_rad);
      panel.curves.push_back(points);
      const auto line = std::ranges::find_if(fit_.lines[i], [&](const friction::HeadingLine& each) {
        return std::abs(std::remainder(each.heading_rad - heading_rad, 2.0 * std::numbers::pi)) < kSameHeading_rad;
      });
      if (line != fit_.lines[i].end() && line->damping_V_s_per_rad) {
        const double end_rad_per_s = *std::ranges::max_element(points.x, {}, [](double speed) { return std::abs(speed); });
        panel.curves.push_back({.x = {0.0, end_rad_per_s},
                                .y = {line->offset_V.value, line->offset_V.value + line->damping_V_s_per_rad->value * end_rad_per_s},
                                .color_index = static_cast<int>(i)});
        has_line = true;
      }
    }
    return has_line ? std::optional(panel) : std::nullopt;
  }

  /// Returns the legs of pure rotation, with the lines d·ω ± c.
  [[nodiscard]] std::optional<report::ChartPanel> of_rotation() const {
    report::ChartPanel panel;
    panel.title = "Turning on the spot: measured; lines: d ω + c sign(ω)";
    panel.y_label = "voltage / V";
    for (std::size_t i = 0; i < fit_.wheels.size(); ++i) {
      const friction::WheelFriction& wheel = fit_.wheels[i];
      report::ChartCurve points = dots(i, wheel_name(i));
      for (const auto& [part, number] : parts_) {
        if (part->is_rotation) {
          points.x.push_back(part->wheel_speed_rad_per_s[i]);
          points.y.push_back(part->voltage_V[i]);
        }
      }
      if (points.x.empty()) {
        return std::nullopt;
      }
      if (wheel.is_learned() && wheel.rotation_V) {
        const double slope = wheel.damping_V_s_per_rad->value;
        const double offset_V = wheel.rotation_V->value;
        for (const auto& [end_rad_per_s, side] : {std::pair(std::ranges::min(points.x), -1.0), {std::ranges::max(points.x), 1.0}}) {
          if (side * end_rad_per_s > 0.0) {
            panel.curves.push_back({.x = {0.0, end_rad_per_s},
                                    .y = {side * offset_V, slope * end_rad_per_s + side * offset_V},
                                    .color_index = static_cast<int>(i)});
          }
        }
      }
      panel.curves.push_back(points);
    }
    return panel;
  }

  /// Returns all headings together: voltage minus the fitted friction, which leaves d·ω.
  [[nodiscard]] report::ChartPanel less_friction() const {
    report::ChartPanel panel;
    panel.title = "All headings: voltage less the fitted friction; lines: d ω";
    panel.y_label = "voltage less friction / V";
    for (std::size_t i = 0; i < fit_.wheels.size(); ++i) {
      const friction::WheelFriction& wheel = fit_.wheels[i];
      report::ChartCurve points = dots(i, wheel_name(i));
      for (const auto& [part, number] : parts_) {
        const double speed_rad_per_s = part->wheel_speed_rad_per_s[i];
        const bool is_fitted = part->is_rotation ? wheel.rotation_V.has_value() : wheel.constant_V.has_value();
        if (is_fitted && (part->is_rotation || !friction::should_stand(kinematics_.wheels[i], part->heading_rad))) {
          const double friction_V =
              part->is_rotation ? wheel.rotation_V->value * (speed_rad_per_s > 0.0 ? 1.0 : -1.0)
                                : wheel.voltage_V(part->heading_rad, speed_rad_per_s) - wheel.damping_V_s_per_rad->value * speed_rad_per_s;
          points.x.push_back(speed_rad_per_s);
          points.y.push_back(part->voltage_V[i] - friction_V);
        }
      }
      if (wheel.is_learned() && !points.x.empty()) {
        const auto [least, most] = std::ranges::minmax(points.x);
        const double slope = wheel.damping_V_s_per_rad->value;
        panel.curves.push_back({.x = {least, most}, .y = {slope * least, slope * most}, .color_index = static_cast<int>(i)});
      }
      panel.curves.push_back(points);
    }
    return panel;
  }

 private:
  static constexpr double kSameHeading_rad = 2.5 / kDegrees_per_rad;

  [[nodiscard]] std::optional<int> informative_heading() const {
    std::map<int, std::pair<int, double>> worth;  // number of legs, and the share of the travel speed at the slowest wheel
    for (const auto& [part, number] : parts_) {
      double least_share = 1.0;
      for (int i = 0; i < kinematics_.wheel_count; ++i) {
        least_share = std::min(least_share, std::abs(friction::rolling_share(kinematics_.wheels[i], part->heading_rad)));
      }
      if (number) {
        ++worth[*number].first;
        worth[*number].second = least_share;
      }
    }
    const auto best = std::ranges::max_element(worth, {}, [](const auto& each) { return each.second; });
    return best == worth.end() ? std::nullopt : std::optional(best->first);
  }

  const friction::FrictionFit& fit_;
  const robot::Kinematics& kinematics_;
  std::vector<std::optional<int>> numbers_;
  std::vector<std::pair<const friction::SteadyPart*, std::optional<int>>> parts_;
};

/// Offset and damping of every heading over the direction of travel.
report::Chart heading_chart(const std::string& verdict, const friction::SteadyFriction& found) {
  const friction::FrictionFit& fit = found.fit;
  report::Chart chart;
  chart.title = verdict;
  const bool has_intervals = std::ranges::any_of(fit.lines, [](const std::vector<friction::HeadingLine>& lines) {
    return std::ranges::any_of(lines, [](const friction::HeadingLine& line) { return line.offset_V.interval.has_value(); });
  });
  const bool is_given =
      std::ranges::any_of(fit.wheels, [](const friction::WheelFriction& wheel) { return wheel.is_learned() && wheel.damping_is_given; });
  chart.subtitle =
      fmt::format("Friction over the direction of travel, from {} legs on {} headings{}{}", found.steady.parts.size(), fit.headings,
                  has_intervals ? fmt::format("; vertical lines: {} intervals of each heading alone, from the scatter of all",
                                              base::level_text(base::kInterval_share))
                                : "",
                  is_given ? "; all at one speed, so the expected damping is used" : "");
  chart.x_label = "direction of travel in the robot's frame / °";
  for (const bool of_damping : {false, true}) {
    if (report::ChartPanel panel = heading_panel(fit, of_damping); has_points(panel)) {
      chart.panels.push_back(std::move(panel));
    }
  }
  return chart;
}

report::Chart voltage_chart(const std::string& verdict, const friction::FrictionJob& job, const friction::SteadyFriction& found) {
  report::Chart chart;
  chart.title = verdict;
  chart.subtitle =
      fmt::format("Voltage over wheel speed in {} steady intervals; wheels that should stand are left out", found.steady.parts.size());
  chart.x_label = "wheel speed / rad/s";
  const robot::Kinematics kinematics = robot::make_kinematics(job.robot);
  const Drives drives(found.steady, found.fit, kinematics, found.settings);
  for (const std::optional<report::ChartPanel>& panel : {drives.of_one_heading(), drives.of_rotation()}) {
    if (panel) {
      chart.panels.push_back(*panel);
    }
  }
  if (found.fit.headings > 0) {
    chart.panels.push_back(drives.less_friction());
  }
  return chart;
}

}  // namespace

std::vector<report::Chart> friction_charts(const friction::FrictionJob& job, const friction::FrictionAnswer& answer) {
  const auto* const found = std::get_if<friction::SteadyFriction>(&answer);
  if (found == nullptr) {
    return {};
  }
  std::string verdict = fmt::format("{}: friction of {} identifiable", job.robot.name, identifiable_wheels(found->fit));
  if (found->error.after_V) {
    verdict += fmt::format(", hold-out error {} V", base::significant(*found->error.after_V, 2));
  }
  std::vector<report::Chart> charts;
  if (report::Chart chart = heading_chart(verdict, *found); !chart.panels.empty()) {
    charts.push_back(std::move(chart));
  }
  charts.push_back(voltage_chart(verdict, job, *found));
  return charts;
}

}  // namespace heatsoak::present
