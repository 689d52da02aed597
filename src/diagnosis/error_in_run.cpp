#include "diagnosis/error_in_run.h"

#include <algorithm>

namespace heatsoak::diagnosis {

std::vector<ErrorInRun> worst_runs(const std::vector<ErrorInRun>& errors) {
  std::vector<ErrorInRun> worst;
  for (const ErrorInRun& each : errors) {
    const auto found = std::ranges::find(worst, each.signal, &ErrorInRun::signal);
    if (found == worst.end()) {
      worst.push_back(each);
    } else if (each.after.rmse_K > found->after.rmse_K) {
      *found = each;
    }
  }
  return worst;
}

}  // namespace heatsoak::diagnosis
