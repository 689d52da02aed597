// Output of `diagnose`: JSON, pictures, and a single page that contains everything.
#pragma once

#include <string>

#include "diagnosis/diagnosis.h"
#include "present/json.h"
#include "report/chart.h"

namespace heatsoak::present {

/// Returns the answer in the schema heatsoak.diagnosis/1.
Json diagnosis_json(const Diagnosis& diagnosis, const DiagnosisInput& input, const HoldoutScore& score);

struct DiagnosisPicture {
  std::string name;  ///< stem of the file name
  Chart chart;
};
/// Returns pictures of the residuals in K before and after, the unknown heat in W before and after, and the curves found.
std::vector<DiagnosisPicture> diagnosis_pictures(const Diagnosis& diagnosis, const DiagnosisInput& input, const HoldoutScore& score);

/// Returns one self-contained HTML page; `svg` holds pairs of picture name and content.
std::string diagnosis_page(const Diagnosis& diagnosis, const DiagnosisInput& input, const HoldoutScore& score,
                           const std::vector<std::pair<std::string, std::string>>& svg);

}  // namespace heatsoak::present
