#include "identify/attribution/free_run_check.h"

#include "identify/attribution/open_loop.h"

namespace heatsoak {

bool leads_away(const ExtendedModel& with, const ExtendedModel& without, const std::vector<MeasuredRun>& runs, double most_ratio) {
  constexpr double kMatters_K = 0.1;
  const double without_K = rms_K(open_loop_errors(without, runs, {}));
  const double with_K = rms_K(open_loop_errors(with, runs, {}));
  return with_K > most_ratio * without_K && with_K > without_K + kMatters_K;
}

bool is_hardly_better(const ExtendedModel& with, const ExtendedModel& without, const std::vector<MeasuredRun>& runs) {
  if (without.free_run_error_K == 0.0) {
    return false;
  }
  constexpr double kPlainlyBetter_ratio = 0.85;
  const double without_K = rms_K(open_loop_errors(without, runs, {}));
  return without.is_as_usual(without_K) || rms_K(open_loop_errors(with, runs, {})) > kPlainlyBetter_ratio * without_K;
}

}  // namespace heatsoak
