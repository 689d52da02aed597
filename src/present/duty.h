// Document and JSON of `duty`.
#pragma once

#include <string>

#include "duty/make_duty.h"
#include "present/document.h"
#include "present/json.h"

namespace heatsoak::present {

Document duty_document(const duty::DutyAnswer& answer);
Json duty_json(const duty::DutyAnswer& answer);

/// Adds the command that evaluates the written duty file.
void add_next_command(Document& document, const std::string& description);

}  // namespace heatsoak::present
