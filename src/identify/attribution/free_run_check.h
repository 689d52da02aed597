// What explains the unknown from second to second, judged by how a model follows whole runs with it.
#pragma once

#include <string_view>
#include <vector>

#include "identify/attribution/extended_model.h"

namespace heatsoak {

/// The error of `with` on the runs, run free, is more than `most_ratio` times that of `without`, and by what matters.
bool leads_away(const ExtendedModel& with, const ExtendedModel& without, const std::vector<MeasuredRun>& runs, double most_ratio);

/// Whole runs decided the figures of `without`, and it follows the runs as well as it is used to, or `with` does so hardly better: what
/// follows the load at once is known to be otherwise and no evidence alone.
inline constexpr std::string_view kHardlyBetterTold =
    "whole runs, which decided the figures of the model, are followed hardly better with it";
bool is_hardly_better(const ExtendedModel& with, const ExtendedModel& without, const std::vector<MeasuredRun>& runs);

}  // namespace heatsoak
