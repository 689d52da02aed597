#include "robot/robot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>

#include "base/quantity.h"
#include "input/document.h"

namespace heatsoak {
namespace {

void read_wheels(Reader& top, Robot& robot) {
  std::optional<Reader> wheels = top.table("wheels", Need::required);
  if (!wheels) {
    return;
  }
  robot.wheel_radius_m = wheels->quantity({"radius", "m", Range::positive(), "of a wheel"}, Need::required).value_or(1.0);
  robot.wheel_contact_radius_m =
      wheels->quantity({"contact_radius", "m", Range::positive(), "from the robot's axis to the contact points"}, Need::required).value_or(1.0);
  for (const std::string& text : wheels->texts("axis_angles", Need::required)) {
    const ParsedQuantity angle = parse_quantity(text, "rad");
    if (angle.ok()) {
      robot.wheel_axis_rad.push_back(angle.value);
    } else {
      wheels->problem("axis_angles", angle.problem);
    }
  }
  if (robot.wheel_axis_rad.size() < 3) {
    wheels->problem("axis_angles", "names fewer than three wheels; an omni-directional robot has at least three");
  }
  wheels->finish();
}

void read_drive(Reader& top, Robot& robot) {
  std::optional<Reader> drive = top.table("drive", Need::required);
  if (!drive) {
    return;
  }
  robot.drive_motor = drive->text("motor", Need::required).value_or("");
  robot.gear_ratio = drive->quantity({"gear_ratio", "", Range::positive(), "motor turns per wheel turn"}, Need::required).value_or(1.0);
  robot.gear_efficiency =
      drive->quantity({"gear_efficiency", "", Range::between(0.1, 1.0), "torque that the gear hands on"}, Need::optional).value_or(1.0);
  robot.voltage_limit_V = drive->quantity({"voltage_limit", "V", Range::positive(), "largest command to one motor"}, Need::optional).value_or(robot.voltage_limit_V);
  robot.current_limit_A = drive->quantity({"current_limit", "A", Range::positive(), "largest equivalent DC current of one motor"}, Need::optional).value_or(robot.current_limit_A);
  constexpr std::array<std::string_view, 2> kCommutations{"block", "sinusoidal"};
  robot.commutation = drive->choice("commutation", kCommutations, Need::required) == "sinusoidal" ? Commutation::sinusoidal : Commutation::block;
  drive->finish();
}

}  // namespace

double Robot::available_V() const { return std::min(battery_V, voltage_limit_V); }

Robot read_robot(const std::filesystem::path& path) {
  const Value root = read_toml(path);
  Diagnostics diagnostics;
  Reader top(root, "", diagnostics);
  Robot robot;
  robot.id = path.stem().string();
  robot.file = path;
  robot.name = top.text("name", Need::required).value_or("");
  robot.source = top.text("source", Need::required).value_or("");
  top.texts("notes", Need::optional);
  robot.mass_kg = top.quantity({"mass", "kg", Range::positive(), "of the robot with battery"}, Need::required).value_or(1.0);
  read_wheels(top, robot);
  read_drive(top, robot);
  if (std::optional<Reader> battery = top.table("battery", Need::required)) {
    robot.battery_V = battery->quantity({"nominal_voltage", "V", Range::positive(), "of the battery"}, Need::required).value_or(1.0);
    battery->finish();
  }
  top.finish();
  diagnostics.throw_if_any();
  return robot;
}

}  // namespace heatsoak
