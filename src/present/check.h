// Document of `check`.
#pragma once

#include <span>

#include "check/run_checks.h"
#include "present/document.h"

namespace heatsoak::present {

/// One table for each check: result, threshold, value, limit, margin, and what the value rests on. `is_update`: limits were rewritten.
Document check_document(std::span<const Outcome> outcomes, bool is_update);

}  // namespace heatsoak::present
