// Document and JSON of `check`.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "check/run_checks.h"
#include "present/document.h"
#include "present/json.h"

namespace heatsoak::present {

/// Returns one table for each check: result, threshold, value, limit, margin and basis of the value. `is_update`: limits were rewritten.
/// `files` are the names as the user gave them.
Document check_document(std::span<const check::Outcome> outcomes, bool is_update, const std::vector<std::string>& files = {});
/// Returns the answer as JSON, the data of the document.
Json check_json(std::span<const check::Outcome> outcomes, const std::vector<std::string>& files);

}  // namespace heatsoak::present
