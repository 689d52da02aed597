// Document of `diagnose`.
#pragma once

#include <span>

#include "diagnosis/diagnosis_job.h"
#include "present/document.h"

namespace heatsoak::present {

/// `readings` are the reports of the logs.
Document diagnosis_document(const DiagnosisAnswer& answer, std::span<const LogReading> readings);

}  // namespace heatsoak::present
