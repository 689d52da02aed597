// What `diagnose` hands out: JSON, pictures, and a page that holds everything in one file.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "attribution/diagnosis.h"
#include "report/chart.h"

namespace heatsoak {

/// heatsoak.diagnosis/1.
nlohmann::ordered_json diagnosis_json(const Diagnosis& diagnosis, const DiagnosisInput& input, const HoldoutScore& score);

struct DiagnosisPicture {
  std::string name;  ///< file stem
  Chart chart;
};
/// Residual in K before and after, unknown heat in W before and after, curves that were found.
std::vector<DiagnosisPicture> diagnosis_pictures(const Diagnosis& diagnosis, const DiagnosisInput& input, const HoldoutScore& score);

/// One self-contained HTML page; `svg` by picture name.
std::string diagnosis_page(const Diagnosis& diagnosis, const DiagnosisInput& input, const HoldoutScore& score,
                           const std::vector<std::pair<std::string, std::string>>& svg);

}  // namespace heatsoak
