// Document of `lint`.
#pragma once

#include <span>

#include "motor/lint.h"
#include "present/document.h"

namespace heatsoak::present {

/// The findings are lines "file:line:column: level: check: message", which editors understand.
Document lint_document(std::span<const LintFinding> findings, std::size_t files);

}  // namespace heatsoak::present
