// Synthetic motors with known parameters, their logs as files, and calibrations of them. The truth has its own equations and its own
// integrator (runs_for_tests.h) and shares no code with the analyser.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calibration/calibrate.h"
#include "runs_for_tests.h"

namespace heatsoak::calibration::study {

/// Temporary folder, deleted by the destructor.
class Folder {
 public:
  Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder();
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Data sheet of a motor. The true parameters of a case are drawn around it.
struct Sheet {
  estimation::TwoNodeTruth truth;
  std::string resistance_spread;  ///< for example ", tolerance = \"5 %\"", which makes the resistance a free parameter
  std::string resistance_origin = "datasheet";
  std::string thermal_spread = ", tolerance = \"25 %\"";
  double no_load_current_A = 0.0;  ///< the true motor has no loss at speed, and most logs have no speed
  [[nodiscard]] motor::Motor motor(const Folder& folder) const;
};

/// Draws the true values of the data sheet's four thermal parameters from their prior.
estimation::TwoNodeTruth drawn_truth(const Sheet& sheet, const motor::Motor& motor, std::uint64_t seed);

/// Writes the log as a CSV file in a logger's format.
std::filesystem::path write_log(const recording::Recording& log, const std::filesystem::path& file);
recording::Recording read_log(const std::filesystem::path& file);

struct Case {
  estimation::LogMaking making;
  int runs = 4;
  std::uint64_t seed = 1;
  int threads = 1;
  bool with_flux = true;
  WrittenFit written = WrittenFit::best;
};

/// Result for one parameter of one case.
struct Mark {
  std::string name;
  double truth = 0.0;
  CalibratedParameter parameter;
  [[nodiscard]] bool is_covered() const { return parameter.low <= truth && truth <= parameter.high; }
  [[nodiscard]] double error_ratio() const { return parameter.value / truth - 1.0; }
};

struct CaseResult {
  std::vector<Mark> marks;
  Calibration calibration;
  double seconds_s = 0.0;
};
CaseResult calibrate_case(const Sheet& sheet, const Case& one);

}  // namespace heatsoak::calibration::study
