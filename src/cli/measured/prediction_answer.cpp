#include "cli/measured/prediction_answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/quantity.h"
#include "cli/command.h"

namespace heatsoak {
namespace {

std::string what_of(const PredictedSignal& signal) { return signal.signal.substr(0, signal.signal.rfind('_')); }

}  // namespace

present::Document prediction_document(const Motor& motor, const Prediction& prediction, std::span<const std::string> warnings,
                                      std::span<const std::string> of_logs) {
  present::Document document;
  const PredictedSignal* worst = nullptr;
  const PredictedRun* worst_run = nullptr;
  present::Table table{.columns = {{"run", "", 0, present::Alignment::left},
                                   {"signal", "", 0, present::Alignment::left},
                                   {"rms error", "K", 0},
                                   {"max. error", "K", 0},
                                   {"within 90 % band", "%", 0},
                                   {"samples", "", 1}},
                       .rows = {}};
  for (const PredictedRun& run : prediction.runs) {
    for (const PredictedSignal& each : run.signals) {
      table.rows.push_back({{run.name},
                            {what_of(each)},
                            {fmt::format("{:.2f}", each.rmse_K)},
                            {fmt::format("{:.2f}", each.max_abs_K)},
                            {fmt::format("{:.0f}", 100.0 * each.coverage_share)},
                            {fmt::format("{}", each.samples)}});
      if (worst == nullptr || each.rmse_K > worst->rmse_K) {
        worst = &each;
        worst_run = &run;
      }
    }
  }
  if (worst != nullptr) {
    document.headline.push_back(
        {fmt::format("{} forecasts {} run{}; the largest error is {} K rms, of the {} in {}.", motor.id, prediction.runs.size(),
                     prediction.runs.size() == 1 ? "" : "s", significant(worst->rmse_K, 2), what_of(*worst), worst_run->name)});
  }
  document.paragraphs.emplace_back("Each run is predicted from its first temperatures and its measured inputs.");
  document.tables.push_back(std::move(table));
  for (const std::string& each : warnings) {
    document.add_note(present::Severity::warning, each);
  }
  for (const std::string& each : prediction.notes) {
    const bool is_of_logs = std::ranges::find(of_logs, each) != of_logs.end();
    document.add_note(is_of_logs ? present::Severity::background : present::Severity::note, each);
  }
  return document;
}

nlohmann::ordered_json runs_json(const std::vector<PredictedRun>& runs) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const PredictedRun& run : runs) {
    nlohmann::ordered_json error = nlohmann::ordered_json::object();
    nlohmann::ordered_json coverage = nlohmann::ordered_json::object();
    for (const PredictedSignal& each : run.signals) {
      error[each.signal] = {{"rmse_K", rounded(each.rmse_K, 4)}, {"max_abs_K", rounded(each.max_abs_K, 4)}, {"samples", each.samples}};
      coverage[each.signal] = rounded(each.coverage_share, 4);
    }
    all.push_back({{"name", run.name}, {"error", error}, {"coverage_90", coverage}});
  }
  return all;
}

nlohmann::ordered_json prediction_json(const Motor& motor, const Prediction& prediction) {
  return {{"schema", "heatsoak.prediction/1"}, {"motor", motor.id}, {"runs", runs_json(prediction.runs)}, {"notes", prediction.notes}};
}

Chart prediction_chart(const Motor& motor, const Prediction& prediction) {
  Chart chart{.title = fmt::format("{}: prediction", motor.name),
              .subtitle = "from the first temperatures and the measured inputs of each run; 90 % of the samples are expected in the band",
              .x_label = "time / min"};
  for (const PredictedRun& run : prediction.runs) {
    std::vector<double> time_min;
    for (const double time_s : run.time_s) {
      time_min.push_back((time_s - run.time_s.front()) / 60.0);
    }
    for (const PredictedSignal& each : run.signals) {
      ChartPanel panel;
      panel.title = fmt::format("{}, {}: {} K rms, {:.0f} % within the band", run.name, what_of(each), significant(each.rmse_K, 2),
                                100.0 * each.coverage_share);
      panel.y_label = what_of(each) + " temperature / °C";
      panel.bands = {{.name = "90 % band", .x = time_min, .low = each.low_C, .high = each.high_C, .color_index = 1}};
      panel.curves = {{.name = "measured", .x = time_min, .y = each.measured_C, .color_index = 0},
                      {.name = "predicted", .x = time_min, .y = each.predicted_C, .color_index = 1}};
      chart.panels.push_back(std::move(panel));
    }
  }
  return chart;
}

}  // namespace heatsoak
