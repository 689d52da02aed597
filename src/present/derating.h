// Documents and JSON of `derate`.
#pragma once

#include "derate/committed_table.h"
#include "derate/derating.h"
#include "motor/motor.h"
#include "present/document.h"
#include "present/json.h"

namespace heatsoak::present {

Document derating_document(const Derating& derating, const Motor& motor);

/// Comparison of a table that was written earlier with a fresh one.
struct TableCheck {
  const CommittedTable& committed;
  const TableComparison& found;
  bool is_other_motor = false;
  bool holds = true;  ///< the earlier table is safe to use
};

/// Adds what changed since the file was written: unsafe changes are warnings, the others notes.
void add_table_check(Document& document, const Derating& derating, const TableCheck& check);
Json table_check_json(const TableCheck& check);

}  // namespace heatsoak::present
