// A duty: what a wheel has to do over time, whatever motor drives it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
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

/// A duty that has been read: gives what the wheels of a robot have to do.
class DutyShape {
 public:
  virtual ~DutyShape() = default;
  /// One demand per wheel, or one for a duty that does not tell wheels apart. Same seed, same demand.
  [[nodiscard]] virtual std::vector<WheelDemand> demand(const robot::Robot& robot, std::uint64_t seed) const = 0;
  /// Whether the demand follows from the robot's mass and wheels; if not, the duty states torque and speed of the wheel itself.
  [[nodiscard]] virtual bool depends_on_robot() const { return false; }
  /// True if the duty has parameters with ranges, in addition to ambient and load, that draw() samples.
  [[nodiscard]] virtual bool has_unknowns() const { return false; }
  /// The hardest wheel's demand under draw number `draw` of these, and of what the robot's file leaves open. Same seed, same draws.
  [[nodiscard]] virtual WheelDemand draw(const robot::Robot& robot, std::uint64_t seed, std::uint64_t /*draw*/) const {
    return hardest(demand(robot, seed));
  }
};

struct Duty {
  std::string id;  ///< the file's stem
  std::filesystem::path file;
  std::string shape;    ///< "intermittent", "recorded", …
  std::string summary;  ///< one line
  std::string origin;   ///< where the demand comes from, "calibrated", "synthetic", "measured": said in every answer
  std::vector<std::string> notes;
  DutyKind kind = DutyKind::torque;
  base::ParameterValue ambient_C;
  base::ParameterValue load;  ///< factor on torque or current, 1 with the spread that the file declares
  /// What the shape's table gives, for `describe`; a bare quantity has no `printed`.
  std::vector<std::pair<base::ParameterSpec, base::ParameterValue>> parameters;
  std::shared_ptr<const DutyShape> shape_data;

  [[nodiscard]] std::vector<WheelDemand> demand(const robot::Robot& robot, std::uint64_t seed) const {
    return shape_data->demand(robot, seed);
  }
};

/// A way to write a duty down; one file in src/duty/shapes each.
struct ShapeType {
  std::string_view name;  ///< the file's name; set by all_shapes()
  std::string_view summary;
  std::string_view example;  ///< lines of TOML that a user can paste
  /// Reads the keys of its own table and fills kind, load and shape_data; problems go to the reader.
  void (*read)(input::Reader& table, const std::filesystem::path& folder, Duty& duty) = nullptr;
};
const std::vector<ShapeType>& all_shapes();

/// Throws Failure (bad_input) with every problem of the file.
Duty read_duty(const std::filesystem::path& path);

}  // namespace heatsoak::duty
