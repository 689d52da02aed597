// Documents and JSON of `derate`.
#pragma once

#include "derate/derating.h"
#include "derate/derating_job.h"
#include "motor/motor.h"
#include "present/document.h"
#include "present/json.h"

namespace heatsoak::present {

Document derating_document(const Derating& derating, const Motor& motor);

/// Adds what changed since the file was written: unsafe changes are warnings, the others notes.
void add_table_check(Document& document, const Derating& derating, const TableCheck& check);
Json table_check_json(const TableCheck& check);

}  // namespace heatsoak::present
