#include "present/measured/calibration_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "base/quantity.h"
#include "present/measured/run_words.h"

namespace heatsoak::present {
namespace {

enum Curve { measured, fitted, predicted, of_file };

struct Traces {
  report::ChartPanel panel;
  std::string signal;
};

/// Appends one run to the traces, followed by a gap. `shown_as`: fitted, or predicted for a hold-out run.
void append(const calibration::PredictedRun& before, const calibration::PredictedRun& after, Curve shown_as, double offset_s,
            std::vector<Traces>& traces) {
  for (Traces& each : traces) {
    const auto found = std::ranges::find(after.signals, each.signal, &calibration::PredictedSignal::signal);
    const auto of_file_too = std::ranges::find(before.signals, each.signal, &calibration::PredictedSignal::signal);
    if (found == after.signals.end() || of_file_too == before.signals.end()) {
      continue;
    }
    const auto add = [&](Curve curve, double time_s, double sensor_C) {
      each.panel.curves[curve].x.push_back((offset_s + time_s) / 60.0);
      each.panel.curves[curve].y.push_back(sensor_C);
    };
    double time_s = 0.0;
    for (std::size_t k = 0; k < after.time_s.size(); ++k) {
      time_s = after.time_s[k] - after.time_s.front();
      add(measured, time_s, found->measured_C[k]);
      add(shown_as, time_s, found->predicted_C[k]);
      add(of_file, time_s, of_file_too->predicted_C[k]);
    }
    for (const Curve curve : {measured, shown_as, of_file}) {
      add(curve, time_s, std::numeric_limits<double>::quiet_NaN());
    }
  }
}

std::string title_of(const calibration::Calibration& calibration, const calibration::ErrorBeforeAfter& error, const std::string& what) {
  std::string title =
      fmt::format("{}: {:.2f} K rms with the file's values, {:.2f} K fitted", what, error.before.rmse_K, error.after.rmse_K);
  const auto unseen = std::ranges::find(calibration.holdout_error, error.signal, &calibration::ErrorBeforeAfter::signal);
  if (unseen != calibration.holdout_error.end()) {
    title += fmt::format("; held out {:.2f} K and {:.2f} K", unseen->before.rmse_K, unseen->after.rmse_K);
  }
  return title;
}

/// States how many values the runs determine, and the largest error that remains, on hold-out runs if there are any.
std::string verdict_of(const motor::Motor& motor, const calibration::Calibration& calibration) {
  const auto identifiable = std::ranges::count_if(calibration.parameters, &calibration::CalibratedParameter::is_identifiable);
  std::string verdict = fmt::format("{}: {} of {} values identifiable", motor.name, identifiable, calibration.parameters.size());
  const bool is_held_out = !calibration.holdout_error.empty();
  const std::vector<calibration::ErrorBeforeAfter>& errors = is_held_out ? calibration.holdout_error : calibration.fit_error;
  if (!errors.empty()) {
    const double largest_K =
        std::ranges::max(errors, {}, [](const calibration::ErrorBeforeAfter& each) { return each.after.rmse_K; }).after.rmse_K;
    verdict += fmt::format(", largest {} {} K rms", is_held_out ? "hold-out error" : "error", base::significant(largest_K, 2));
  }
  return verdict;
}

}  // namespace

report::Chart calibration_chart(const motor::Motor& motor, const calibration::Calibration& calibration) {
  std::vector<Traces> traces;
  for (const calibration::ErrorBeforeAfter& each : calibration.fit_error) {
    const std::string what = part_of(each.signal);
    Traces trace;
    trace.panel.title = title_of(calibration, each, what);
    trace.panel.y_label = what + " temperature / °C";
    trace.signal = each.signal;
    trace.panel.curves = {{.name = "measured", .color_index = 4, .dots = true},
                          {.name = "fit", .color_index = 1},
                          {.name = calibration.holdout_after.empty() ? "" : "held out", .color_index = 3},
                          {.name = "file", .color_index = 2, .dashed = true}};
    traces.push_back(std::move(trace));
  }
  double offset_s = 0.0;
  constexpr double kBetween_s = 60.0;
  const auto append_all = [&](const std::vector<calibration::PredictedRun>& before, const std::vector<calibration::PredictedRun>& after,
                              Curve shown_as) {
    for (std::size_t r = 0; r < after.size(); ++r) {
      append(before[r], after[r], shown_as, offset_s, traces);
      offset_s += after[r].time_s.back() - after[r].time_s.front() + kBetween_s;
    }
  };
  append_all(calibration.fitted_before, calibration.fitted_after, fitted);
  append_all(calibration.holdout_before, calibration.holdout_after, predicted);
  report::Chart chart{.title = verdict_of(motor, calibration), .subtitle = {}, .x_label = "time, runs one after the other / min"};
  chart.subtitle =
      fmt::format("Calibration: {} fitted{}; the model runs free from the start of each",
                  calibration.runs.size() == 1 ? "1 run" : fmt::format("{} runs", calibration.runs.size()),
                  calibration.holdout_after.empty() ? "" : fmt::format(", then {} held out", calibration.holdout_after.size()));
  for (Traces& each : traces) {
    chart.panels.push_back(std::move(each.panel));
  }
  return chart;
}

}  // namespace heatsoak::present
