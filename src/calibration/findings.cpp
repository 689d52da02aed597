#include "calibration/findings.h"

namespace heatsoak::calibration {

std::vector<std::string> remarks_in(const std::vector<CalibrationFinding>& findings) {
  std::vector<std::string> all;
  for (const CalibrationFinding& each : findings) {
    if (const auto* const remark = std::get_if<Remark>(&each)) {
      all.push_back(remark->words);
    }
  }
  return all;
}

}  // namespace heatsoak::calibration
