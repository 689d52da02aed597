#include "present/measured/calibration.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/confidence.h"
#include "base/quantity.h"
#include "present/measured/calibration_words.h"
#include "present/measured/log.h"

namespace heatsoak::present {
namespace {

/// Formats a value with the digits that its interval supports: half the interval width has two.
std::string with_digits(double value, double half) {
  const double smallest = std::max(half, 1e-6 * std::abs(value));
  const int digits = 2 + static_cast<int>(std::floor(std::log10(std::abs(value)))) - static_cast<int>(std::floor(std::log10(smallest)));
  return base::significant(value, std::clamp(digits, 1, 6));
}

Table fitted_parameters(const calibration::Calibration& result) {
  Table table{.columns = {{"value", "", 0, Alignment::left},
                          {"file", "", 2},
                          {"fit", "", 0},
                          {base::level_text(base::kInterval_share) + " interval", "", 0},
                          {"unit", "", 0, Alignment::left},
                          {"identifiable", "", 1, Alignment::left}},
              .rows = {}};
  for (const calibration::CalibratedParameter& each : result.parameters) {
    const double half = 0.5 * (each.high - each.low);
    table.rows.push_back({{each.name},
                          {base::significant(each.before, 3)},
                          {with_digits(each.value, half)},
                          {fmt::format("{}…{}", with_digits(each.low, half), with_digits(each.high, half))},
                          {std::string(base::unit_for_display(each.unit))},
                          {each.is_identifiable ? "yes" : "no"}});
  }
  return table;
}

void add_errors(Table& table, const std::string& what, const std::vector<calibration::ErrorBeforeAfter>& errors) {
  for (const calibration::ErrorBeforeAfter& each : errors) {
    table.rows.push_back({{what},
                          {each.signal},
                          {fmt::format("{:.2f}", each.before.rmse_K)},
                          {fmt::format("{:.2f}", each.after.rmse_K)},
                          {fmt::format("{:.2f}", each.before.max_abs_K)},
                          {fmt::format("{:.2f}", each.after.max_abs_K)},
                          {fmt::format("{}", each.after.samples)}});
  }
}

std::vector<Text> headline_of(const motor::Motor& motor, const calibration::CalibrationAnswer& answer) {
  const calibration::Calibration& result = answer.calibration;
  std::vector<std::string> open;
  for (const calibration::CalibratedParameter& each : result.parameters) {
    if (!each.is_identifiable) {
      open.push_back(each.name);
    }
  }
  const std::string runs = fmt::format("{} run{}", result.runs.size(), result.runs.size() == 1 ? "" : "s");
  std::vector<Text> sentences;
  if (open.size() == result.parameters.size()) {
    sentences.push_back(
        {fmt::format("No value of {} is identifiable from {}, but the uncertainty of some is smaller now.", motor.id, runs)});
  } else {
    sentences.push_back({fmt::format("{} of {} values of {} are identifiable from {}{}{}.", result.parameters.size() - open.size(),
                                     result.parameters.size(), motor.id, runs, open.empty() ? "" : ", all but ", fmt::join(open, ", "))});
  }
  if (const std::string next = next_steps_words(answer); !next.empty()) {
    sentences.push_back({fmt::format("Next experiment: {}.", next)});
  }
  return sentences;
}

/// Describes the heat that the written model does not contain.
std::string heat_words(const calibration::Calibration& result) {
  std::string words;
  if (result.is_forecast_written) {
    const motor::ForecastBand& band = result.forecast->band;
    words = fmt::format(
        "The written forecast model treats no heat as unknown; its error band allows for {} % of the heat at the winding and {} % at the "
        "stator, correlated over about {} s.",
        base::significant(100.0 * band.unknown_heat_share[0], 2), base::significant(100.0 * band.unknown_heat_share[1], 2),
        base::significant(band.time_scale_s, 1));
  } else {
    words = fmt::format("Unmodelled heat: winding {} W rms, stator {} W rms, correlated over about {} s.",
                        base::significant(result.fit.flux.rms_W[0], 2), base::significant(result.fit.flux.rms_W[1], 2),
                        base::significant(result.fit.flux.time_scale_s, 1));
  }
  if (result.fit.rejected_share(result.runs) > 0.0) {
    words += fmt::format(" {} % of the samples were left out as outliers.",
                         base::significant(100.0 * result.fit.rejected_share(result.runs), 2));
  }
  return words;
}

std::string_view name_of(calibration::ForecastSource source) {
  switch (source) {
    case calibration::ForecastSource::file:
      return "file";
    case calibration::ForecastSource::ordinary:
      return "least squares of free runs";
    case calibration::ForecastSource::tempered:
      return "forecast fit";
    case calibration::ForecastSource::innovations:
      break;
  }
  return "innovations fit";
}

/// Errors of all alternatives in the left-out pieces. Ordinary least squares is the simple alternative to the others.
Table left_out_errors(const calibration::Forecast& forecast, bool is_forecast_written) {
  using calibration::ForecastSource;
  Table table{
      .title = fmt::format("RMS error in {} pieces of the runs, each predicted by a fit to the others, in K", forecast.pieces.size()),
      .columns = {{"fit", "", 0, Alignment::left}},
      .rows = {}};
  for (const auto& [signal, error_K] : forecast.rivals.front().rmse_K) {
    table.columns.push_back({signal, "", 0});
  }
  table.columns.push_back({"written", "", 0, Alignment::left});
  for (const calibration::RivalScore& rival : forecast.rivals) {
    std::vector<Text> cells{{std::string(name_of(rival.source))}};
    for (const auto& [signal, error_K] : rival.rmse_K) {
      cells.push_back({base::significant(error_K, 2)});
    }
    const bool is_written = rival.source == (is_forecast_written ? forecast.source : ForecastSource::innovations);
    cells.push_back({is_written ? "yes" : ""});
    table.rows.push_back(std::move(cells));
  }
  return table;
}

}  // namespace

std::vector<Note> calibration_notes(const calibration::CalibrationAnswer& answer, std::span<const recording::LogReading> readings) {
  const calibration::Calibration& result = answer.calibration;
  std::vector<Note> all;
  // A wrong unit makes all other warnings meaningless, so it comes first.
  for (const std::string& note : words_of(answer.admission.notes)) {
    all.push_back({Severity::warning, note});
  }
  for (const calibration::GrownError& each : result.worse) {
    all.push_back({Severity::warning, words_of(each)});
  }
  for (const calibration::OpenDirection& each : result.open) {
    all.push_back(
        {Severity::note, fmt::format("Not identifiable: {} ({}). To determine it: {}.", parameter_words(each), reason_words(each),
                                     each.remedy == result.next_experiment ? "the next experiment above" : words_of(each.remedy))});
  }
  for (const calibration::CalibrationFinding& each : result.findings) {
    const auto* const extended = std::get_if<calibration::ExtendedForForecasts>(&each);
    // The file contains effects that the motor file did not have, so users must see this.
    all.push_back({extended && extended->is_written ? Severity::scope : severity_of(each), words_of(each)});
  }
  // Rejected samples rank below notes that limit the answer.
  for (const std::string& note : reading_words(readings)) {
    all.push_back({Severity::background, note});
  }
  return all;
}

Document calibration_document(const motor::Motor& motor, const calibration::CalibrationAnswer& answer,
                              std::span<const recording::LogReading> readings, const std::string& out) {
  const calibration::Calibration& result = answer.calibration;
  Document document{.headline = headline_of(motor, answer)};
  document.paragraphs.push_back(heat_words(result));
  document.tables.push_back(fitted_parameters(result));
  Table errors{.title = "Error of the free-running model in K",
               .columns = {{"runs", "", 0, Alignment::left},
                           {"signal", "", 0, Alignment::left},
                           {"rms: file", "", 0},
                           {"rms: fit", "", 0},
                           {"largest: file", "", 0},
                           {"largest: fit", "", 0},
                           {"samples", "", 1}},
               .rows = {}};
  add_errors(errors, result.fitted_after.size() > 1 ? "worst fit" : "fit", result.fit_error);
  add_errors(errors, result.holdout_after.size() > 1 ? "worst hold-out" : "hold-out", result.holdout_error);
  document.tables.push_back(std::move(errors));
  if (result.forecast && !result.forecast->rivals.empty()) {
    document.tables.push_back(left_out_errors(*result.forecast, result.is_forecast_written));
  }
  for (const Note& each : calibration_notes(answer, readings)) {
    document.add_note(each.severity, each.words);
  }
  document.data = calibration_json(motor, answer, readings, out);
  return document;
}

std::string next_steps_words(const calibration::CalibrationAnswer& answer) {
  std::vector<std::string> steps;
  std::ranges::transform(answer.admission.lagging, std::back_inserter(steps), lag_words);
  if (answer.calibration.next_experiment) {
    steps.emplace_back(words_of(*answer.calibration.next_experiment));
  }
  return fmt::format("{}", fmt::join(steps, "; then: "));
}

}  // namespace heatsoak::present
