// Duty: the load of a wheel over time, independent of the motor.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/parameter_value.h"
#include "duty/demand.h"
#include "input/reader.h"
#include "robot/robot.h"

namespace heatsoak::duty {

enum class DutyKind { torque, current };

/// Content of a duty file; computes the demand of a robot's wheels.
class DutyShape {
 public:
  virtual ~DutyShape() = default;
  /// Returns one demand per wheel, or a single one if the duty does not distinguish wheels. Equal seeds give equal demands.
  [[nodiscard]] virtual std::vector<WheelDemand> demand(const robot::Robot& robot, std::uint64_t seed) const = 0;
  /// Returns true if the demand depends on the robot's mass and wheels, false if the duty states the load of the wheel.
  [[nodiscard]] virtual bool depends_on_robot() const { return false; }
  /// Returns true if the duty has parameters with ranges, in addition to ambient and load, that draw() samples.
  [[nodiscard]] virtual bool has_unknowns() const { return false; }
  /// Returns the demand of the most loaded wheel for draw number `draw` of these parameters and of the robot's uncertain ones. Equal seeds
  /// give equal draws.
  [[nodiscard]] virtual WheelDemand draw(const robot::Robot& robot, std::uint64_t seed, std::uint64_t /*draw*/) const {
    return hardest(demand(robot, seed));
  }
};

/// File that a recorded duty repeats.
struct RecordedFile {
  std::filesystem::path path;
  int repeats = 1;
};

struct Duty {
  std::string id;  ///< stem of the file name
  std::filesystem::path file;
  std::string shape;               ///< "intermittent", "recorded", …
  std::string summary;             ///< one line
  std::string origin;              ///< origin of the demand: "calibrated", "synthetic" or "measured"; printed with every answer
  std::vector<std::string> notes;  ///< notes of the file
  std::optional<RecordedFile> recording;
  DutyKind kind = DutyKind::torque;
  base::ParameterValue ambient_C;
  base::ParameterValue load;  ///< factor on torque or current: 1 with the spread of the file
  /// Parameters of the shape's table, for `describe`. A bare quantity has no `printed`.
  std::vector<std::pair<base::ParameterSpec, base::ParameterValue>> parameters;
  std::shared_ptr<const DutyShape> shape_data;

  [[nodiscard]] std::vector<WheelDemand> demand(const robot::Robot& robot, std::uint64_t seed) const {
    return shape_data->demand(robot, seed);
  }
};

/// Format of a duty. Each file in src/duty/shapes defines one.
struct ShapeType {
  std::string_view name;  ///< name of the source file; set by all_shapes()
  std::string_view summary;
  std::string_view example;  ///< lines of TOML that a user can paste
  /// Reads the keys of the shape's table and sets kind, load and shape_data. The reader collects problems.
  void (*read)(input::Reader& table, const std::filesystem::path& folder, Duty& duty) = nullptr;
};
const std::vector<ShapeType>& all_shapes();

/// Reads a duty file. Throws Failure (bad_input) with all problems of the file.
Duty read_duty(const std::filesystem::path& path);

}  // namespace heatsoak::duty
