// Output of `diagnose`: JSON, pictures, and a single page that contains everything.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/diagnosis_job.h"
#include "present/json.h"
#include "report/chart.h"

namespace heatsoak::present {

/// Returns the answer in the schema heatsoak.diagnosis/1.
Json diagnosis_json(const diagnosis::DiagnosisAnswer& answer, std::span<const recording::LogReading> readings);

struct DiagnosisPicture {
  std::string name;  ///< stem of the file name
  report::Chart chart;
};
/// Returns pictures of the residuals in K before and after, the unknown heat in W before and after, and the curves found.
std::vector<DiagnosisPicture> diagnosis_pictures(const diagnosis::DiagnosisAnswer& answer);

/// Returns one self-contained HTML page; `svg` holds pairs of picture name and content.
std::string diagnosis_page(const diagnosis::DiagnosisAnswer& answer, std::span<const recording::LogReading> readings,
                           const std::vector<std::pair<std::string, std::string>>& svg);

}  // namespace heatsoak::present
