// Document and JSON of `duty`.
#pragma once

#include <string>

#include "duty/make_duty.h"
#include "present/document.h"
#include "present/json.h"

namespace heatsoak::present {

Document duty_document(const duty::DutyAnswer& answer);
Json duty_json(const duty::DutyAnswer& answer);

/// Adds the names of the written table and its duty file, and the command that evaluates them.
void add_duty_files(Document& document, const std::string& table, const std::string& description);

}  // namespace heatsoak::present
