#include "present/measured/prediction.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <variant>

#include "base/confidence.h"
#include "base/quantity.h"
#include "present/measured/calibration_words.h"
#include "present/measured/log.h"
#include "present/measured/run_words.h"
#include "recording/quantities.h"

namespace heatsoak::present {
namespace {

std::string say(const calibration::UnseenCondition& of) {
  return fmt::format(
      "The forecast of {0} may be far off: its run has {1}={2}, the model was fitted to runs {3}. Calibrate with a run under {1}={2}.",
      of.recording, of.key, of.value,
      of.seen.empty() ? fmt::format("that do not state {}", of.key) : fmt::format("with {}", fmt::join(of.seen, ", ")));
}

std::string say(const calibration::Extrapolation& of) {
  const std::string_view input = of.channel == recording::kAmbientColumn                   ? "an ambient temperature"
                                 : of.channel == recording::column_of(base::Signal::speed) ? "a speed"
                                                                                           : "a current";
  return fmt::format("The forecast of {} extrapolates: it has {} of {} {}, the fitted runs had {} to {} {}.", of.recording, input,
                     base::significant(of.value, 3), of.unit, base::significant(of.low, 3), base::significant(of.high, 3), of.unit);
}

std::string say(const calibration::FittedRuns& of) {
  const std::string names = fmt::format("{}", fmt::join(of.recordings, ", "));
  return of.recordings.size() == 1
             ? fmt::format("the error of {} is not a forecast error, because the model was fitted to this run", names)
             : fmt::format("the errors of {} are not forecast errors, because the model was fitted to these runs", names);
}

std::string say(const calibration::SignalsMissing& of) { return words_of(calibration::CalibrationFinding(of)); }

std::string say(const calibration::OutsideTraining& of) {
  return std::visit([](const auto& each) { return say(each); }, of);
}

}  // namespace

std::vector<Note> prediction_notes(const calibration::PredictionAnswer& answer, std::span<const recording::LogReading> readings) {
  std::vector<Note> all;
  for (const calibration::PredictionWarning& warning : answer.warnings) {
    all.push_back({Severity::warning, std::visit([](const auto& each) { return say(each); }, warning)});
  }
  for (const std::string& each : reading_words(readings)) {
    all.push_back({Severity::background, each});
  }
  for (const std::string& each : words_of(answer.admission.notes)) {
    all.push_back({Severity::note, each});
  }
  const std::vector<std::string> words = words_of(answer.prediction.notes);
  for (std::size_t i = 0; i < words.size(); ++i) {
    all.push_back({severity_of(answer.prediction.notes[i]), words[i]});
  }
  return all;
}

std::string fitted_motor(const motor::Motor& motor) { return motor.fit ? motor.fit->motor : motor.id; }

std::string largest_error_words(const calibration::Prediction& prediction) {
  const calibration::PredictedSignal* worst = nullptr;
  const calibration::PredictedRun* worst_run = nullptr;
  for (const calibration::PredictedRun& run : prediction.runs) {
    for (const calibration::PredictedSignal& each : run.signals) {
      if (worst == nullptr || each.rmse_K > worst->rmse_K) {
        worst = &each;
        worst_run = &run;
      }
    }
  }
  return worst == nullptr ? ""
                          : fmt::format("the largest error is {} K rms, of the {} in {}", base::significant(worst->rmse_K, 2),
                                        part_of(worst->signal), worst_run->name);
}

/// Names the signal that its band contains least, if that is less than half of what a correct band contains; else empty.
std::string poor_band_words(const calibration::Prediction& prediction) {
  constexpr double kPoor_share = 0.5 * base::kBand_share;
  double least_share = kPoor_share;
  std::string words;
  for (const calibration::PredictedRun& run : prediction.runs) {
    for (const calibration::PredictedSignal& each : run.signals) {
      if (each.samples > 0 && each.coverage_share < least_share) {
        least_share = each.coverage_share;
        words = fmt::format("Do not rely on the band: of the {} in {}, only {:.0f} % of the samples lie within the {} band.",
                            part_of(each.signal), run.name, 100.0 * each.coverage_share, base::level_text(base::kBand_share));
      }
    }
  }
  return words;
}

Document prediction_document(const motor::Motor& motor, const calibration::PredictionAnswer& answer,
                             std::span<const recording::LogReading> readings) {
  const calibration::Prediction& prediction = answer.prediction;
  Document document;
  Table table{.columns = {{"run", "", 0, Alignment::left},
                          {"signal", "", 0, Alignment::left},
                          {"rms error", "K", 0},
                          {"max. error", "K", 0},
                          {"in band", "%", 0},
                          {"samples", "", 1}},
              .rows = {}};
  for (const calibration::PredictedRun& run : prediction.runs) {
    for (const calibration::PredictedSignal& each : run.signals) {
      const bool is_scored = each.samples > 0;
      table.rows.push_back({{run.name},
                            {part_of(each.signal)},
                            {is_scored ? base::significant(each.rmse_K, 2) : "–"},
                            {is_scored ? base::significant(each.max_abs_K, 2) : "–"},
                            {is_scored ? fmt::format("{:.0f}", 100.0 * each.coverage_share) : "–"},
                            {fmt::format("{}", each.samples)}});
    }
  }
  if (const std::string largest = largest_error_words(prediction); !largest.empty()) {
    document.headline.push_back(
        {fmt::format("{} forecasts {} run{}; {}.",
                     motor.fit ? fmt::format("The model {} of {}", motor.file.filename().string(), motor.fit->motor) : motor.id,
                     prediction.runs.size(), prediction.runs.size() == 1 ? "" : "s", largest)});
  }
  if (const std::string poor = poor_band_words(prediction); !poor.empty()) {
    document.headline.push_back({poor});
  }
  document.paragraphs.emplace_back(fmt::format(
      "Each run is predicted from its first temperatures and its measured inputs. A correct {0} band contains {0} of the samples.",
      base::level_text(base::kBand_share)));
  document.tables.push_back(std::move(table));
  for (const Note& each : prediction_notes(answer, readings)) {
    document.add_note(each.severity, each.words);
  }
  document.data = prediction_json(motor, answer, readings);
  return document;
}

}  // namespace heatsoak::present
