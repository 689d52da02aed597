// Document and JSON of `lint`.
#pragma once

#include "duty/lint_files.h"
#include "present/document.h"
#include "present/json.h"

namespace heatsoak::present {

/// Returns the findings as lines "file:line:column: level: check: message", which editors understand.
Document lint_document(const duty::FilesLint& lint);
Json lint_json(const duty::FilesLint& lint);

}  // namespace heatsoak::present
