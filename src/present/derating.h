// Documents and JSON of `derate`.
#pragma once

#include "derate/derating.h"
#include "derate/derating_job.h"
#include "present/document.h"
#include "present/json.h"

namespace heatsoak::present {

/// Returns " (lower end of the limit's range around 155 °C)" if the motor's file gives the winding limit as a range; else nothing.
std::string limit_range_words(const derate::Derating& derating);

/// States how the sensor of a committed header differs, and what to do.
std::string words_of(const derate::SensorDifference& difference);

/// Returns "written by heatsoak 0.1.0, this program is 0.2.0: an upgrade may explain the difference".
std::string upgrade_words(const std::string& other_version);

/// Returns the document. Changes since an earlier table was written come last: unsafe ones are warnings, the others notes.
/// `out` is the name of the written file, which may be empty: a name that suits another format gives a warning.
Document derating_document(const derate::DeratingJob& job, const derate::DeratingAnswer& answer, const std::string& out = {});
Json table_check_json(const derate::TableCheck& check);

}  // namespace heatsoak::present
