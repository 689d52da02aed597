// Documents and JSON of `derate`.
#pragma once

#include "derate/derating.h"
#include "derate/derating_job.h"
#include "motor/motor.h"
#include "present/document.h"
#include "present/json.h"

namespace heatsoak::present {

/// Returns " (lower end of the limit's range around 155 °C)" if the motor's file gives the winding limit as a range; else nothing.
std::string limit_range_words(const derate::Derating& derating);

Document derating_document(const derate::Derating& derating, const motor::Motor& motor);

/// Adds what changed since the file was written: unsafe changes are warnings, the others notes.
void add_table_check(Document& document, const derate::Derating& derating, const derate::TableCheck& check);
Json table_check_json(const derate::TableCheck& check);

}  // namespace heatsoak::present
