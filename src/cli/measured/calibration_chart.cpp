#include "cli/measured/calibration_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace heatsoak {
namespace {

enum Curve { measured, fitted, foretold, of_file };

struct Traces {
  ChartPanel panel;
  std::string signal;
};

/// All runs one after the other, with a break between. `shown_as`: fitted, or foretold where the fit never saw the run.
void append(const Calibration& calibration, const MeasuredRun& run, Curve shown_as, double offset_s, std::vector<Traces>& traces) {
  const MotorModel& motor = calibration.motor_model;
  const Eigen::MatrixXd before = open_loop_C(motor.model.network, motor.model.values, run);
  const Eigen::MatrixXd after = open_loop_C(motor.model.network, motor.model.values_at(calibration.fit.theta), run);
  for (Traces& each : traces) {
    const auto found = std::ranges::find(run.sensors, each.signal, &Sensor::signal);
    if (found == run.sensors.end()) {
      continue;
    }
    const Eigen::Index sensor = found - run.sensors.begin();
    const auto add = [&](Curve curve, double time_s, double shown_C) {
      each.panel.curves[curve].x.push_back((offset_s + time_s) / 60.0);
      each.panel.curves[curve].y.push_back(shown_C);
    };
    double time_s = 0.0;
    for (Eigen::Index k = 0; k < run.samples(); ++k) {
      time_s = run.time_s[static_cast<std::size_t>(k)] - run.time_s.front();
      add(measured, time_s, run.measured_C(k, sensor));
      add(shown_as, time_s, after(k, sensor));
      add(of_file, time_s, before(k, sensor));
    }
    for (const Curve curve : {measured, shown_as, of_file}) {
      add(curve, time_s, std::numeric_limits<double>::quiet_NaN());
    }
  }
}

std::string title_of(const Calibration& calibration, const ErrorBeforeAfter& error, const std::string& what) {
  std::string title =
      fmt::format("{}: {:.2f} K rms with the file's figures, {:.2f} K fitted", what, error.before.rmse_K, error.after.rmse_K);
  const auto unseen = std::ranges::find(calibration.holdout_error, error.signal, &ErrorBeforeAfter::signal);
  if (unseen != calibration.holdout_error.end()) {
    title += fmt::format("; held out {:.2f} K and {:.2f} K", unseen->before.rmse_K, unseen->after.rmse_K);
  }
  return title;
}

}  // namespace

Chart calibration_chart(const Motor& motor, const Calibration& calibration) {
  std::vector<Traces> traces;
  for (const ErrorBeforeAfter& each : calibration.fit_error) {
    const std::string what = each.signal.substr(0, each.signal.rfind('_'));
    Traces trace;
    trace.panel.title = title_of(calibration, each, what);
    trace.panel.y_label = what + " temperature / °C";
    trace.signal = each.signal;
    trace.panel.curves = {{.name = "measured", .color_index = 0},
                          {.name = "fit", .color_index = 1},
                          {.name = calibration.holdout.empty() ? "" : "held out", .color_index = 3},
                          {.name = "file", .color_index = 2, .dashed = true}};
    traces.push_back(std::move(trace));
  }
  double offset_s = 0.0;
  constexpr double kBetween_s = 60.0;
  const auto append_all = [&](const std::vector<MeasuredRun>& runs, Curve shown_as) {
    for (const MeasuredRun& run : runs) {
      append(calibration, run, shown_as, offset_s, traces);
      offset_s += run.time_s.back() - run.time_s.front() + kBetween_s;
    }
  };
  append_all(calibration.runs, fitted);
  append_all(calibration.holdout, foretold);
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
