// Motors of which everything is known, their logs as files, and what a calibration makes of them. The truth has its own equations
// and its own integrator (runs_for_tests.h); it shares nothing with the analyser.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calibration/calibrate.h"
#include "runs_for_tests.h"

namespace heatsoak::study {

/// A folder that is gone with it.
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

/// What a sheet says of the motor; the truth of a case is drawn around it.
struct Sheet {
  TwoNodeTruth truth;
  std::string resistance_spread;  ///< ", tolerance = \"5 %\"": then the resistance is fitted too
  std::string resistance_origin = "datasheet";
  std::string thermal_spread = ", tolerance = \"25 %\"";
  double no_load_current_A = 0.0;  ///< the truth has no loss at speed, and most logs have no speed
  [[nodiscard]] Motor motor(const Folder& folder) const;
};

/// The four thermal figures of the sheet off by what their prior says.
TwoNodeTruth drawn_truth(const Sheet& sheet, const Motor& motor, std::uint64_t seed);

/// The log as a CSV file, as a logger would have written it.
std::filesystem::path write_log(const Recording& log, const std::filesystem::path& file);
Recording read_log(const std::filesystem::path& file);

struct Case {
  LogMaking making;
  int runs = 4;
  std::uint64_t seed = 1;
  int threads = 1;
  bool with_flux = true;
};

/// One figure of one case.
struct Mark {
  std::string name;
  double truth = 0.0;
  CalibratedParameter figure;
  [[nodiscard]] bool is_covered() const { return figure.low <= truth && truth <= figure.high; }
  [[nodiscard]] double error_ratio() const { return figure.value / truth - 1.0; }
};

struct CaseResult {
  std::vector<Mark> marks;
  Calibration calibration;
  double seconds_s = 0.0;
};
CaseResult calibrate_case(const Sheet& sheet, const Case& one);

}  // namespace heatsoak::study
