#include "present/measured/prediction_chart.h"

#include <fmt/format.h>

#include "base/confidence.h"
#include "base/quantity.h"
#include "present/measured/prediction.h"
#include "present/measured/run_words.h"

namespace heatsoak::present {

report::Chart prediction_chart(const motor::Motor& motor, const calibration::Prediction& prediction) {
  report::Chart chart{
      .title = fmt::format("{}: {}", fitted_motor(motor), largest_error_words(prediction)),
      .subtitle = fmt::format(
          "Prediction from the first temperatures and the measured inputs of each run; {} of the samples are expected in the band",
          base::level_text(base::kBand_share)),
      .x_label = "time / min"};
  for (const calibration::PredictedRun& run : prediction.runs) {
    std::vector<double> time_min;
    for (const double time_s : run.time_s) {
      time_min.push_back((time_s - run.time_s.front()) / 60.0);
    }
    for (const calibration::PredictedSignal& each : run.signals) {
      report::ChartPanel panel;
      panel.title = fmt::format("{}, {}: {} K rms, {:.0f} % within the band", run.name, part_of(each.signal),
                                base::significant(each.rmse_K, 2), 100.0 * each.coverage_share);
      panel.y_label = part_of(each.signal) + " temperature / °C";
      panel.bands = {
          {.name = base::level_text(base::kBand_share) + " band", .x = time_min, .low = each.low_C, .high = each.high_C, .color_index = 1}};
      panel.curves = {{.name = "measured", .x = time_min, .y = each.measured_C, .color_index = 4, .dots = true},
                      {.name = "predicted", .x = time_min, .y = each.predicted_C, .color_index = 1}};
      chart.panels.push_back(std::move(panel));
    }
  }
  return chart;
}

}  // namespace heatsoak::present
