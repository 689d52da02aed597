#include "cli/friction_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace heatsoak {
namespace {

constexpr double kDegrees_per_rad = 180.0 / std::numbers::pi;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::string wheel_name(std::size_t wheel) { return fmt::format("wheel {}", wheel + 1); }

ChartCurve dots(std::size_t wheel, const std::string& name) {
  ChartCurve curve;
  curve.name = name;
  curve.color_index = static_cast<int>(wheel);
  curve.dots = true;
  return curve;
}

/// Upright lines of the intervals; the wheels stand beside each other.
void add_interval(ChartCurve& bars, double x, const Estimate& estimate) {
  if (estimate.is_known()) {
    bars.x.insert(bars.x.end(), {x, x, x});
    bars.y.insert(bars.y.end(), {estimate.low, estimate.high, kNaN});
  }
}

/// f(θ), broken where its sign changes.
ChartCurve fitted(const WheelFriction& wheel, std::size_t index) {
  ChartCurve curve;
  curve.color_index = static_cast<int>(index);
  double before_V = kNaN;
  for (int i = -720; i <= 720; ++i) {
    const double heading_rad = 0.25 * i / kDegrees_per_rad;
    const double value_V = wheel.friction_V(heading_rad);
    const bool jumps = std::abs(value_V - before_V) > std::abs(wheel.constant_V.value);
    curve.x.push_back(0.25 * i);
    curve.y.push_back(jumps ? kNaN : value_V);
    before_V = value_V;
  }
  return curve;
}

ChartPanel heading_panel(const FrictionFit& fit, bool of_damping) {
  ChartPanel panel;
  panel.title = of_damping ? "Damping of every heading; dashed: fitted over all"
                           : "Static friction of every heading; lines: f = a sin(θ+φ) + b sign(sin(θ+φ))";
  panel.y_label = of_damping ? "damping / V s/rad" : "offset / V";
  for (std::size_t i = 0; i < fit.wheels.size(); ++i) {
    const WheelFriction& wheel = fit.wheels[i];
    ChartCurve points = dots(i, wheel_name(i));
    ChartCurve bars{.color_index = static_cast<int>(i)};
    for (const HeadingLine& line : fit.lines[i]) {
      const Estimate& estimate = of_damping ? line.damping_V_s_per_rad : line.offset_V;
      const double x =
          line.heading_rad * kDegrees_per_rad + 0.8 * (static_cast<double>(i) - 0.5 * static_cast<double>(fit.wheels.size() - 1));
      points.x.push_back(x);
      points.y.push_back(estimate.value);
      add_interval(bars, x, estimate);
    }
    panel.curves.push_back(points);
    panel.curves.push_back(bars);
    if (of_damping && wheel.is_learned()) {
      panel.curves.push_back({.x = {-180.0, 180.0},
                              .y = {wheel.damping_V_s_per_rad.value, wheel.damping_V_s_per_rad.value},
                              .color_index = static_cast<int>(i),
                              .dashed = true});
    } else if (wheel.is_learned() && std::isfinite(wheel.constant_V.value)) {
      panel.curves.push_back(fitted(wheel, i));
    }
  }
  return panel;
}

bool has_points(const ChartPanel& panel) {
  return std::ranges::any_of(panel.curves, [](const ChartCurve& curve) {
    return curve.dots && std::ranges::any_of(curve.y, [](double value) { return std::isfinite(value); });
  });
}

}  // namespace

Chart friction_chart(const FrictionFit& fit, const std::string& robot, const std::string& subtitle) {
  Chart chart;
  chart.title = fmt::format("Friction of {} over the direction of travel", robot);
  chart.subtitle = subtitle + "; upright lines: 95 % intervals of one heading by itself";
  chart.x_label = "direction of travel in the robot's frame / °";
  for (const bool of_damping : {false, true}) {
    if (ChartPanel panel = heading_panel(fit, of_damping); has_points(panel)) {
      chart.panels.push_back(std::move(panel));
    }
  }
  return chart;
}

Chart voltage_chart(const SteadyParts& steady, const FrictionFit& fit, const std::string& robot, bool with_return_legs) {
  Chart chart;
  chart.title = fmt::format("Voltage over wheel speed of {}", robot);
  chart.subtitle = fmt::format("{} steady legs; lines: fitted damping with b on its side", steady.parts.size());
  chart.x_label = "wheel speed / rad/s";
  ChartPanel panel;
  panel.y_label = "voltage / V";
  for (std::size_t i = 0; i < fit.wheels.size(); ++i) {
    ChartCurve points = dots(i, wheel_name(i));
    for (const SteadyPart& part : steady.parts) {
      if (with_return_legs || !part.is_return) {
        points.x.push_back(part.wheel_speed_rad_per_s[i]);
        points.y.push_back(part.voltage_V[i]);
      }
    }
    const WheelFriction& wheel = fit.wheels[i];
    if (wheel.is_learned() && !points.x.empty()) {
      const auto [least, most] = std::ranges::minmax(points.x);
      const double offset_V = std::isfinite(wheel.constant_V.value) ? wheel.constant_V.value : wheel.rotation_V.value;
      const double slope = wheel.damping_V_s_per_rad.value;
      panel.curves.push_back(
          {.x = {std::min(0.0, least), 0.0, kNaN, 0.0, std::max(0.0, most)},
           .y = {slope * std::min(0.0, least) - offset_V, -offset_V, kNaN, offset_V, slope * std::max(0.0, most) + offset_V},
           .color_index = static_cast<int>(i)});
    }
    panel.curves.push_back(points);
  }
  chart.panels.push_back(panel);
  chart.panel_height_px = 480;
  return chart;
}

}  // namespace heatsoak
