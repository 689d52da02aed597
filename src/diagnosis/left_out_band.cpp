#include "diagnosis/left_out_band.h"

#include <algorithm>
#include <cmath>

#include "base/diagnostic.h"
#include "base/parallel.h"
#include "calibration/forecast/prediction.h"
#include "estimation/left_out_runs.h"

namespace heatsoak::diagnosis {
namespace {

/// Returns the diagnosis with the same effects, fitted to the runs of the other recordings; nothing if that fit fails.
std::optional<Diagnosis> without(const std::string& recording, const Diagnosis& diagnosis) {
  const estimation::Posterior& after = diagnosis.selection.after;
  estimation::PosteriorOptions options;
  options.flux = after.flux;
  options.weights = diagnosis.selection.weights;
  const estimation::SomeRuns others = estimation::some_of(
      diagnosis.runs, after, options, [&](const estimation::MeasuredRun& run) { return estimation::recording_of(run) != recording; });
  if (others.runs.empty()) {
    return std::nullopt;
  }
  estimation::Posterior fit = estimation::fit_of(others);
  if (!std::isfinite(fit.evidence_nats)) {
    return std::nullopt;
  }
  Diagnosis out;
  out.selection = diagnosis.selection;
  out.selection.after = std::move(fit);
  out.runs = others.runs;
  for (const attribution::AcceptedTerm& term : diagnosis.selection.terms) {
    if (!term.curve || !term.effect_name.empty()) {
      out.effects.push_back(found_effect(term, out.selection, others.runs));
    }
  }
  return out;
}

/// Returns the training runs of a recording; samples that the fit excludes are NaN.
std::vector<estimation::MeasuredRun> runs_of(const std::string& recording, const Diagnosis& diagnosis) {
  std::vector<estimation::MeasuredRun> own;
  for (std::size_t r = 0; r < diagnosis.runs.size(); ++r) {
    if (estimation::recording_of(diagnosis.runs[r]) == recording) {
      own.push_back(estimation::without_rejected(diagnosis.runs[r], diagnosis.selection.weights[r]));
    }
  }
  return own;
}

}  // namespace

std::optional<motor::ForecastBand> left_out_band(const motor::Motor& motor, const ModelOfLogs& model, const Diagnosis& diagnosis,
                                                 const std::vector<recording::Recording>& recordings) {
  if (recordings.size() < 2) {
    return std::nullopt;
  }
  std::vector<std::optional<calibration::LeftOutRecording>> found(recordings.size());
  base::in_parallel(recordings.size(), 0, [&](std::size_t i) {
    if (const std::optional<Diagnosis> others = without(recordings[i].name, diagnosis)) {
      found[i] = {recordings[i], runs_of(recordings[i].name, diagnosis), extended_motor(motor, model, *others)};
    }
  });
  std::vector<calibration::LeftOutRecording> all;
  for (std::optional<calibration::LeftOutRecording>& each : found) {
    if (!each) {
      return std::nullopt;
    }
    all.push_back(*std::move(each));
  }
  try {
    return calibration::band_of_left_out(all);
  } catch (const base::Failure& failure) {
    if (failure.code() != base::ExitCode::numerics_failed) {
      throw;
    }
    return std::nullopt;
  }
}

}  // namespace heatsoak::diagnosis
