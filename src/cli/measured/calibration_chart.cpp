#include "cli/measured/calibration_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace heatsoak {
namespace {

enum Color { measured, fitted, of_file };

struct Traces {
  ChartPanel panel;
  std::string signal;
};

/// All runs one after the other, with a break between.
void append(const Calibration& calibration, const MeasuredRun& run, double offset_s, std::vector<Traces>& traces) {
  const MotorModel& motor = calibration.motor_model;
  const Eigen::MatrixXd before = open_loop_C(motor.model.network, motor.model.values, run);
  const Eigen::MatrixXd after = open_loop_C(motor.model.network, motor.model.values_at(calibration.fit.theta), run);
  for (Traces& each : traces) {
    const auto found = std::ranges::find(run.sensors, each.signal, &Sensor::signal);
    if (found == run.sensors.end()) {
      continue;
    }
    const Eigen::Index sensor = found - run.sensors.begin();
    for (Eigen::Index k = 0; k <= run.samples(); ++k) {
      const bool is_break = k == run.samples();
      const double nan = std::numeric_limits<double>::quiet_NaN();
      const double time_s = run.time_s[static_cast<std::size_t>(is_break ? k - 1 : k)] - run.time_s.front();
      const double shown_C[] = {is_break ? nan : run.measured_C(k, sensor), is_break ? nan : after(k, sensor),
                                is_break ? nan : before(k, sensor)};
      for (const int curve : {measured, fitted, of_file}) {
        each.panel.curves[static_cast<std::size_t>(curve)].x.push_back((offset_s + time_s) / 60.0);
        each.panel.curves[static_cast<std::size_t>(curve)].y.push_back(shown_C[curve]);
      }
    }
  }
}

}  // namespace

Chart calibration_chart(const Motor& motor, const Calibration& calibration) {
  std::vector<Traces> traces;
  for (const ErrorBeforeAfter& each : calibration.fit_error) {
    const std::string what = each.signal.substr(0, each.signal.rfind('_'));
    Traces trace;
    trace.panel.title =
        fmt::format("{}: {:.2f} K rms with the file's figures, {:.2f} K fitted", what, each.before.rmse_K, each.after.rmse_K);
    trace.panel.y_label = what + " temperature / °C";
    trace.signal = each.signal;
    trace.panel.curves = {
        {.name = "measured", .color_index = 0}, {.name = "fit", .color_index = 1}, {.name = "file", .color_index = 2, .dashed = true}};
    traces.push_back(std::move(trace));
  }
  double offset_s = 0.0;
  constexpr double kBetween_s = 60.0;
  for (const auto& runs : {calibration.runs, calibration.holdout}) {
    for (const MeasuredRun& run : runs) {
      append(calibration, run, offset_s, traces);
      offset_s += run.time_s.back() - run.time_s.front() + kBetween_s;
    }
  }
  Chart chart{.title = fmt::format("{}: calibration", motor.name), .subtitle = {}, .x_label = "time, runs one after the other / min"};
  chart.subtitle = fmt::format("{} fitted{}; the model runs free from the start of each",
                               calibration.runs.size() == 1 ? "1 run" : fmt::format("{} runs", calibration.runs.size()),
                               calibration.holdout.empty() ? "" : fmt::format(", then {} held out", calibration.holdout.size()));
  for (Traces& each : traces) {
    chart.panels.push_back(std::move(each.panel));
  }
  return chart;
}

}  // namespace heatsoak
