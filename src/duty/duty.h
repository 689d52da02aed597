// A duty: what a wheel has to do over time, whatever motor drives it.
#pragma once

#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/figure.h"
#include "input/reader.h"

namespace heatsoak {

/// Constant demand on one wheel for a while: a torque and speed, or (for duties given as current) a current.
struct DutyPiece {
  double duration_s = 0.0;
  double torque_Nm = 0.0;
  double speed_rad_per_s = 0.0;
  double current_A = 0.0;  ///< only where the duty is given as current
};

enum class DutyKind { torque, current };

struct Duty {
  std::string id;  ///< the file's stem
  std::filesystem::path file;
  std::string shape;    ///< "intermittent", "recorded", …
  std::string summary;  ///< one line
  std::string origin;   ///< where the demand comes from, "calibrated", "synthetic", "measured": said in every answer
  std::vector<std::string> notes;
  DutyKind kind = DutyKind::torque;
  Figure ambient_C;
  Figure load;  ///< factor on torque or current, 1 with the spread that the file declares
  std::vector<DutyPiece> pieces;

  [[nodiscard]] double duration_s() const;
};

/// A way to write a duty down; one file in src/duty/shapes each.
struct ShapeType {
  std::string_view name;  ///< the file's name; set by all_shapes()
  std::string_view summary;
  std::string_view example;  ///< lines of TOML that a user can paste
  /// Reads the keys of its own table and fills kind, load and pieces; problems go to the reader.
  void (*read)(Reader& table, const std::filesystem::path& folder, Duty& duty) = nullptr;
};
const std::vector<ShapeType>& all_shapes();

/// Throws Failure (bad_input) with every problem of the file.
Duty read_duty(const std::filesystem::path& path);

}  // namespace heatsoak
