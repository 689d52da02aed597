#include "identify/attribution/left_out_runs.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "identify/attribution/open_loop.h"
#include "identify/attribution/run_deviation.h"

namespace heatsoak {
namespace {

template <typename T>
std::vector<T> without(std::vector<T> all, std::size_t place) {
  if (!all.empty()) {
    all.erase(all.begin() + static_cast<std::ptrdiff_t>(place));
  }
  return all;
}

/// Some other run tells of every condition that this one has.
bool can_be_left_out(const ExtendedModel& model, const std::vector<MeasuredRun>& runs, std::size_t place) {
  const auto is_told = [&](const Condition& condition) {
    return !has_condition(runs[place], condition) ||
           std::ranges::count_if(runs, [&](const MeasuredRun& run) { return has_condition(run, condition); }) > 1;
  };
  return std::ranges::all_of(model.conditional, is_told, &ConditionalTerm::condition) &&
         std::ranges::all_of(model.deviations, is_told, &RunDeviation::condition);
}

}  // namespace

LeftOutErrors left_out_errors(const Selection& found, const std::vector<MeasuredRun>& runs) {
  LeftOutErrors errors;
  if (runs.size() < 2) {
    return errors;
  }
  std::vector<std::size_t> places;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    if (can_be_left_out(found.after.model, runs, r)) {
      places.push_back(r);
    }
  }
  std::vector<double> own_K(places.size());
  std::vector<double> with_K(places.size());
  in_parallel(2 * places.size(), 0, [&](std::size_t i) {
    const std::size_t left_out = places[i / 2];
    const RefitResult& from = i % 2 == 0 ? found.own : found.after;
    RefitOptions options{.grid = found.grid, .place = from.place, .errors = found.errors, .merged = {}};
    options.errors.weights = without(options.errors.weights, left_out);
    const std::vector<MeasuredRun> others = without(runs, left_out);
    const RefitResult fit = try_refit(from.model, others, without(from.start_C, left_out), options);
    const ExtendedModel& model = std::isfinite(fit.evidence_nats) ? fit.model : from.model;
    (i % 2 == 0 ? own_K : with_K)[i / 2] = rms_K(open_loop_errors(model, {runs[left_out]}, others));
  });
  for (std::size_t i = 0; i < places.size(); ++i) {
    errors.own_K += own_K[i] * own_K[i];
    errors.with_K += with_K[i] * with_K[i];
  }
  errors.runs = static_cast<int>(places.size());
  if (errors.runs > 0) {
    errors.own_K = std::sqrt(errors.own_K / errors.runs);
    errors.with_K = std::sqrt(errors.with_K / errors.runs);
  }
  return errors;
}

}  // namespace heatsoak
