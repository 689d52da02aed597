// Document of `diagnose`.
#pragma once

#include <span>

#include "diagnosis/diagnosis_job.h"
#include "present/document.h"

namespace heatsoak::present {

/// Returns the document of a diagnosis. `readings` are the reports of the logs.
Document diagnosis_document(const diagnosis::DiagnosisAnswer& answer, std::span<const recording::LogReading> readings);

}  // namespace heatsoak::present
