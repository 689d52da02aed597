// Wording of the progress of a job.
#pragma once

#include <string>

#include "base/job_progress.h"

namespace heatsoak::present {

/// Returns the phase with the remaining time of the job, by its range of 95 %. If that ends below 5 s: "evaluating: 39 %, less than 5 s
/// left". If both ends are within a factor of two of one time: "evaluating: 39 %, 12 s left". Else the range without a share, "evaluating:
/// 20 s to 3 min left". If more phases may follow, "evaluating: at least 12 s left". `most_share`: largest share shown so far, 0 before the
/// first; the shown share does not fall below it.
std::string progress_words(const base::JobEstimate& estimate, double& most_share);

}  // namespace heatsoak::present
