// Document of `diagnose`.
#pragma once

#include <span>
#include <string>

#include "diagnosis/diagnosis.h"
#include "present/document.h"

namespace heatsoak::present {

/// `warnings` come first. The notes listed in `of_logs` (rejected samples) rank below notes that limit the answer.
Document diagnosis_document(const Diagnosis& diagnosis, std::span<const std::string> warnings, std::span<const std::string> of_logs);

}  // namespace heatsoak::present
