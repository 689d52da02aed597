// Warnings about the use of a diagnosed model, from its errors in training and hold-out runs.
#pragma once

#include <string>

#include "diagnosis/diagnosis.h"
#include "diagnosis/holdout_score.h"

namespace heatsoak::present {

/// Returns sentences about the runs that the new file predicts worse than the original file or than the refitted one, each with a space
/// before it. Empty without such runs.
std::string reservations(const diagnosis::Diagnosis& diagnosis, const diagnosis::HoldoutScore& score);

}  // namespace heatsoak::present
