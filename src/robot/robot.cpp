#include "robot/robot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/quantity.h"
#include "input/data_folders.h"
#include "input/document.h"

namespace heatsoak::robot {
namespace {

/// The ranges include any robot for a lab floor and exclude values with a wrong unit.
constexpr std::array<RobotParameterSpec, 29> kSpecs{{
    {"body",
     {"yaw_inertia", "kg m2", base::Range::between(1e-5, 200.0),
      "moment of inertia of robot and wheels about the vertical axis through the centre of gravity; check the unit, g cm2 or kg m2"},
     [](auto& robot) -> decltype(auto) { return (robot.body.yaw_inertia_kg_m2); }},
    {"body",
     {"center_of_gravity_height", "m", base::Range::between(0.0, 2.0), "height of the centre of gravity above the ground"},
     [](auto& robot) -> decltype(auto) { return (robot.body.center_of_gravity_height_m); }},
    {"body",
     {"center_of_gravity_x", "m", base::Range::between(-1.0, 1.0), "distance of the centre of gravity ahead of the robot's axis"},
     [](auto& robot) -> decltype(auto) { return (robot.body.center_of_gravity_x_m); }},
    {"body",
     {"center_of_gravity_y", "m", base::Range::between(-1.0, 1.0), "distance of the centre of gravity to the left of the robot's axis"},
     [](auto& robot) -> decltype(auto) { return (robot.body.center_of_gravity_y_m); }},
    {"wheels",
     {"inertia", "kg m2", base::Range::between(1e-9, 1.0),
      "moment of inertia of one wheel about its axle, without the rotor; check the unit, g cm2 or kg m2"},
     [](auto& robot) -> decltype(auto) { return (robot.wheels.inertia_kg_m2); }},
    {"friction",
     {"wheel_torque", "N m", base::Range::between(0.0, 20.0), "resisting torque of one wheel, without the motor's own drag"},
     [](auto& robot) -> decltype(auto) { return (robot.friction.wheel_torque_Nm); }},
    {"friction",
     {"wheel_damping", "N m s/rad", base::Range::between(0.0, 1.0), "resisting torque of one wheel per speed of the wheel"},
     [](auto& robot) -> decltype(auto) { return (robot.friction.wheel_damping_Nm_s_per_rad); }},
    {"friction",
     {"roller_drag", "", base::Range::between(0.0, 1.0), "force along the axle per normal force while the rollers turn"},
     [](auto& robot) -> decltype(auto) { return (robot.friction.roller_drag_ratio); }},
    {"friction",
     {"rolling_efficiency", "", base::Range::between(0.1, 1.0), "share of the wheel's torque that reaches the ground"},
     [](auto& robot) -> decltype(auto) { return (robot.friction.rolling_efficiency); }},
    {"friction.heading",
     {"constant", "N m", base::Range::between(0.0, 20.0), "friction in translation, mean over the directions"},
     [](auto& robot) -> decltype(auto) { return (robot.friction.heading.constant_Nm); }},
    {"friction.heading",
     {"sine", "N m", base::Range::between(-20.0, 20.0), "part of the friction that grows with the wheel's share of rolling"},
     [](auto& robot) -> decltype(auto) { return (robot.friction.heading.sine_Nm); }},
    {"friction.heading",
     {"double_angle", "N m", base::Range::between(0.0, 20.0), "amplitude of the friction that varies with twice the direction"},
     [](auto& robot) -> decltype(auto) { return (robot.friction.heading.double_angle_Nm); }},
    {"friction.heading",
     {"rotation", "N m", base::Range::between(0.0, 20.0), "friction in pure rotation"},
     [](auto& robot) -> decltype(auto) { return (robot.friction.heading.rotation_Nm); }},
    {"traction",
     {"coefficient", "", base::Range::between(0.01, 5.0), "largest rolling force per normal force"},
     [](auto& robot) -> decltype(auto) { return (robot.traction.coefficient_ratio); }},
    {"traction",
     {"slip_speed", "m/s", base::Range::between(1e-4, 10.0), "slip speed at which 0.71 of the largest rolling force is used"},
     [](auto& robot) -> decltype(auto) { return (robot.traction.slip_speed_m_per_s); }},
    {"drive",
     {"driver_resistance", "ohm", base::Range::between(0.0, 10.0),
      "resistance of switches and traces in series with the winding of one motor"},
     [](auto& robot) -> decltype(auto) { return (robot.drive.driver_resistance_ohm); }},
    {"drive",
     {"driver_standby_power", "W", base::Range::between(0.0, 100.0),
      "power of one motor's driver without current: gate drive, logic, switching"},
     [](auto& robot) -> decltype(auto) { return (robot.drive.driver_standby_W); }},
    {"drive",
     {"control_rate", "Hz", base::Range::between(20.0, 1000.0), "rate at which the firmware commands the motors"},
     [](auto& robot) -> decltype(auto) { return (robot.drive.control_rate_Hz); }},
    {"drive",
     {"command_rate", "Hz", base::Range::between(5.0, 1000.0), "rate at which the team's computer commands the robot"},
     [](auto& robot) -> decltype(auto) { return (robot.drive.command_rate_Hz); }},
    {"battery",
     {"full_voltage", "V", base::Range::between(1.0, 5000.0), "open-circuit voltage of the full battery"},
     [](auto& robot) -> decltype(auto) { return (robot.battery.full_V); }},
    {"battery",
     {"empty_voltage", "V", base::Range::between(1.0, 5000.0), "open-circuit voltage of the empty battery"},
     [](auto& robot) -> decltype(auto) { return (robot.battery.empty_V); }},
    {"battery",
     {"internal_resistance", "ohm", base::Range::between(0.0, 10.0), "resistance of the battery pack with its leads"},
     [](auto& robot) -> decltype(auto) { return (robot.battery.resistance_ohm); }},
    {"battery",
     {"capacity", "A s", base::Range::between(30.0, 4e6), "charge of the battery from full to empty"},
     [](auto& robot) -> decltype(auto) { return (robot.battery.capacity_A_s); }},
    {"limits",
     {"speed", "m/s", base::Range::between(0.01, 30.0), "largest speed that the team plans"},
     [](auto& robot) -> decltype(auto) { return (robot.limits.speed_m_per_s); }},
    {"limits",
     {"acceleration", "m/s2", base::Range::between(0.1, 200.0), "largest acceleration when speeding up"},
     [](auto& robot) -> decltype(auto) { return (robot.limits.acceleration_m_per_s2); }},
    {"limits",
     {"braking", "m/s2", base::Range::between(0.1, 200.0),
      "largest deceleration when slowing down; a match plans with the smaller of this and acceleration"},
     [](auto& robot) -> decltype(auto) { return (robot.limits.braking_m_per_s2); }},
    {"limits",
     {"jerk", "m/s3", base::Range::between(0.1, 1e5), "largest rate of change of the acceleration"},
     [](auto& robot) -> decltype(auto) { return (robot.limits.jerk_m_per_s3); }},
    {"limits",
     {"yaw_rate", "rad/s", base::Range::between(0.01, 200.0), "largest rate of turning"},
     [](auto& robot) -> decltype(auto) { return (robot.limits.yaw_rate_rad_per_s); }},
    {"limits",
     {"yaw_acceleration", "rad/s2", base::Range::between(0.01, 1e4), "largest rate of change of the rate of turning"},
     [](auto& robot) -> decltype(auto) { return (robot.limits.yaw_acceleration_rad_per_s2); }},
}};

constexpr std::array<WheelParameterSpec, 3> kWheelSpecs{{
    {{"constant", "N m", base::Range::between(0.0, 20.0), "friction of this wheel in translation"}, &HeadingWheel::constant_Nm},
    {{"sine", "N m", base::Range::between(-20.0, 20.0), "part of the friction that grows with the wheel's share of rolling"},
     &HeadingWheel::sine_Nm},
    {{"phase", "rad", base::Range::any(), "phase of the sine and of the sign, near the negative angle of the wheel's axle"},
     &HeadingWheel::phase_rad},
}};

constexpr std::array<std::string_view, 5> kOptionalKeys{"center_of_gravity_x", "center_of_gravity_y", "rolling_efficiency", "control_rate",
                                                        "command_rate"};

void read_parameter(input::Reader& reader, const RobotParameterSpec& each, input::Need need, Robot& robot) {
  if (std::optional<base::ParameterValue> parameter = reader.parameter(each.spec, need)) {
    each.value.of(robot) = parameter->value;
    robot.parameters.emplace(fmt::format("{}.{}", each.table, each.spec.key), std::move(*parameter));
  }
}

void read_file_parameters(input::Reader& reader, std::string_view table, Robot& robot) {
  for (const RobotParameterSpec& each : kSpecs) {
    if (each.table == table) {
      read_parameter(reader, each, input::Need::optional, robot);
    }
  }
}

std::string wheel_parameter_key(std::size_t wheel, const WheelParameterSpec& parameter) {
  return fmt::format("friction.heading.wheel[{}].{}", wheel, parameter.spec.key);
}

/// Adds a problem if the friction would drive the wheel in some direction of travel.
void check_sign(input::Reader& reader, std::optional<double> constant_Nm, std::optional<double> sine_Nm, double double_angle_Nm) {
  if (constant_Nm && sine_Nm && *constant_Nm + std::min(0.0, *sine_Nm) < double_angle_Nm) {
    reader.problem("constant", "is smaller than the other parts in some direction, so that friction would drive the wheel");
  }
}

/// Reads [[friction.heading.wheel]], wheel 1 first.
void read_heading_wheels(std::vector<input::Reader>& wheels, Robot& robot, double double_angle_Nm) {
  for (input::Reader& reader : wheels) {
    HeadingWheel& wheel = robot.friction.heading.wheels.emplace_back();
    for (const WheelParameterSpec& each : kWheelSpecs) {
      if (std::optional<base::ParameterValue> parameter = reader.parameter(each.spec, input::Need::required)) {
        wheel.*each.value = parameter->value;
        robot.parameters.emplace(wheel_parameter_key(robot.friction.heading.wheels.size() - 1, each), std::move(*parameter));
      }
    }
    check_sign(reader, wheel.constant_Nm, wheel.sine_Nm, double_angle_Nm);
    reader.finish();
  }
}

void read_heading(input::Reader& heading, Robot& robot) {
  std::vector<input::Reader> wheels = heading.tables("wheel");
  for (const RobotParameterSpec& each : kSpecs) {
    const bool of_all_wheels = each.spec.key == "constant" || each.spec.key == "sine";
    if (each.table == "friction.heading") {
      read_parameter(heading, each, of_all_wheels && wheels.empty() ? input::Need::required : input::Need::optional, robot);
      if (of_all_wheels && !wheels.empty() && each.value.in(robot)) {
        heading.problem(each.spec.key, "is given together with the same value for every wheel; expected only one of the two");
      }
    }
  }
  const bool has_double_angle = robot.friction.heading.double_angle_Nm.has_value();
  robot.friction.heading.double_angle_phase_rad = heading.quantities(
      {"double_angle_phases", "rad", base::Range::any(), "phases of the friction that varies with twice the direction, one per wheel"},
      has_double_angle ? input::Need::required : input::Need::optional);
  if (has_double_angle && robot.friction.heading.double_angle_phase_rad.size() != robot.wheels.axis_rad.size()) {
    heading.problem("double_angle_phases", "expected one phase per wheel");
  }
  const double double_angle_Nm = robot.friction.heading.double_angle_Nm.value_or(0.0);
  if (wheels.empty()) {
    check_sign(heading, robot.friction.heading.constant_Nm, robot.friction.heading.sine_Nm, double_angle_Nm);
  } else if (wheels.size() != robot.wheels.axis_rad.size()) {
    heading.problem("wheel", fmt::format("names {} wheels, the robot has {}", wheels.size(), robot.wheels.axis_rad.size()));
  }
  read_heading_wheels(wheels, robot, double_angle_Nm);
  heading.finish();
}

void read_friction(input::Reader& top, Robot& robot) {
  std::optional<input::Reader> friction = top.table("friction", input::Need::optional);
  if (!friction) {
    return;
  }
  read_file_parameters(*friction, "friction", robot);
  if (std::optional<input::Reader> heading = friction->table("heading", input::Need::optional)) {
    read_heading(*heading, robot);
  }
  friction->finish();
}

constexpr base::ParameterSpec kSlipFactor{"slip_factors", "", base::Range::between(0.9, 1.15),
                                          "measured speed of each wheel divided by its speed without slip, wheel 1 first"};

/// Reads `{ value = ["1.02", …], origin = "…", source = "…" }`: every wheel gets its value with the common origin.
void read_stated_slip(const input::Value& given, Robot& robot, base::Diagnostics& diagnostics) {
  const input::Value* const list = given.find("value");
  if (list == nullptr || list->kind != input::Value::Kind::array) {
    diagnostics.add(list == nullptr ? given.at : list->at, "wheels.slip_factors.value",
                    "is missing or no list; expected one factor per wheel, [\"1.02\", …]");
    return;
  }
  for (std::size_t i = 0; i < list->items.size(); ++i) {
    input::Value one = given;
    std::ranges::find(one.members, "value", &input::Member::key)->value = list->items[i];
    input::Value of_wheel;
    of_wheel.kind = input::Value::Kind::table;
    of_wheel.at = given.at;
    of_wheel.members.push_back({std::string(kSlipFactor.key), std::move(one)});
    const std::size_t before = diagnostics.list().size();
    if (std::optional<base::ParameterValue> parameter =
            input::Reader(of_wheel, "wheels", diagnostics).parameter(kSlipFactor, input::Need::required)) {
      robot.wheels.slip_factor.push_back(parameter->value);
      robot.parameters.emplace(fmt::format("wheels.{}[{}]", kSlipFactor.key, i), std::move(*parameter));
    }
    if (diagnostics.list().size() > before) {
      robot.wheels.slip_factor.resize(list->items.size(), 1.0);
      return;  // the others share origin and source
    }
  }
}

void read_slip(input::Reader& wheels, const input::Value* given, Robot& robot, base::Diagnostics& diagnostics) {
  if (given != nullptr && given->kind == input::Value::Kind::table) {
    wheels.pass_over(kSlipFactor.key);
    read_stated_slip(*given, robot, diagnostics);
  } else {
    robot.wheels.slip_factor = wheels.quantities(kSlipFactor, input::Need::optional);
  }
  if (!robot.wheels.slip_factor.empty() && robot.wheels.slip_factor.size() != robot.wheels.axis_rad.size()) {
    wheels.problem(kSlipFactor.key, fmt::format("names {} wheels, axis_angles {}; expected one factor per wheel",
                                                robot.wheels.slip_factor.size(), robot.wheels.axis_rad.size()));
  }
}

void read_wheels(const input::Value& root, input::Reader& top, Robot& robot, base::Diagnostics& diagnostics) {
  std::optional<input::Reader> wheels = top.table("wheels", input::Need::required);
  if (!wheels) {
    return;
  }
  robot.wheels.radius_m =
      wheels
          ->quantity({"radius", "m", base::Range::between(0.005, 0.5), "radius of a wheel; check the unit, mm or m"}, input::Need::required)
          .value_or(1.0);
  robot.wheels.contact_radius_m = wheels
                                      ->quantity({"contact_radius", "m", base::Range::between(0.01, 2.0),
                                                  "distance from the robot's axis to the contact points; check the unit, mm or m"},
                                                 input::Need::required)
                                      .value_or(1.0);
  robot.wheels.axis_rad = wheels->quantities(
      {"axis_angles", "rad", base::Range::any(), "direction of each wheel's axle from straight ahead, counter-clockwise, wheel 1 first"},
      input::Need::required);
  if (robot.wheels.axis_rad.size() < 3) {
    wheels->problem("axis_angles", "names fewer than three wheels; an omni-directional robot has at least three");
  }
  read_slip(*wheels, root.find("wheels")->find(kSlipFactor.key), robot, diagnostics);
  read_file_parameters(*wheels, "wheels", robot);
  wheels->finish();
}

/// Reads the robot's own motor: an id, or the path of a motor file, relative to the robot's file.
void read_own_motor(input::Reader& drive, Robot& robot) {
  robot.drive.motor = drive.text("motor", input::Need::required).value_or("");
  if (input::is_path(robot.drive.motor)) {
    robot.drive.motor_file = std::filesystem::absolute(robot.file.parent_path() / robot.drive.motor).lexically_normal();
    robot.drive.motor = robot.drive.motor_file->stem().string();
  }
}

void read_drive(input::Reader& top, Robot& robot) {
  std::optional<input::Reader> drive = top.table("drive", input::Need::required);
  if (!drive) {
    return;
  }
  read_own_motor(*drive, robot);
  robot.drive.gear_ratio =
      drive->quantity({"gear_ratio", "", base::Range::between(0.1, 500.0), "number of motor turns per wheel turn"}, input::Need::required)
          .value_or(1.0);
  robot.drive.gear_efficiency =
      drive
          ->quantity({"gear_efficiency", "", base::Range::between(0.1, 1.0), "share of the torque that the gear transmits"},
                     input::Need::optional)
          .value_or(1.0);
  robot.drive.voltage_limit_V =
      drive->quantity({"voltage_limit", "V", base::Range::between(0.5, 5000.0), "largest voltage that the driver can apply to one motor"},
                      input::Need::optional);
  robot.drive.current_limit_A = drive->quantity(
      {"current_limit", "A", base::Range::between(0.01, 1000.0), "largest equivalent DC current of one motor"}, input::Need::optional);
  constexpr std::array<std::string_view, 2> kCommutations{"block", "sinusoidal"};
  robot.drive.commutation =
      drive->choice("commutation", kCommutations, input::Need::required) == "sinusoidal" ? Commutation::sinusoidal : Commutation::block;
  read_file_parameters(*drive, "drive", robot);
  drive->finish();
}

}  // namespace

Robot::Robot() = default;
Robot::Robot(const Robot&) = default;
Robot::Robot(Robot&&) noexcept = default;
Robot& Robot::operator=(const Robot&) = default;
Robot& Robot::operator=(Robot&&) noexcept = default;
Robot::~Robot() = default;

std::span<const RobotParameterSpec> robot_parameter_specs() { return kSpecs; }
std::span<const WheelParameterSpec> wheel_parameter_specs() { return kWheelSpecs; }

void require_parameters(const Robot& robot, std::span<const std::string_view> tables) {
  base::Diagnostics diagnostics;
  for (const RobotParameterSpec& each : kSpecs) {
    const bool asked = std::ranges::find(tables, each.table) != tables.end();
    const bool optional = std::ranges::find(kOptionalKeys, each.spec.key) != kOptionalKeys.end();
    if (asked && !optional && !each.value.in(robot)) {
      diagnostics.add({robot.file.string()}, fmt::format("{}.{}", each.table, each.spec.key),
                      fmt::format("is missing ({})", each.spec.meaning));
    }
  }
  diagnostics.throw_if_any();
}

Robot draw_sample(const Robot& robot, base::Random& random) {
  Robot drawn = robot;
  const auto draw = [&](const std::string& key, auto& value) {
    const auto found = robot.parameters.find(key);
    if (found != robot.parameters.end() && found->second.spread) {
      value = found->second.quantile(random.uniform());
    }
  };
  for (const RobotParameterSpec& each : kSpecs) {
    draw(fmt::format("{}.{}", each.table, each.spec.key), each.value.of(drawn));
  }
  for (std::size_t i = 0; i < drawn.friction.heading.wheels.size(); ++i) {
    for (const WheelParameterSpec& each : kWheelSpecs) {
      draw(wheel_parameter_key(i, each), drawn.friction.heading.wheels[i].*each.value);
    }
  }
  return drawn;
}

double RobotDrive::limited_V(double voltage_V) const { return voltage_limit_V ? std::min(voltage_V, *voltage_limit_V) : voltage_V; }

double RobotDrive::limited_A(double current_A) const {
  return current_limit_A ? std::clamp(current_A, -*current_limit_A, *current_limit_A) : current_A;
}

double Robot::available_V() const { return drive.limited_V(battery.nominal_V); }

double Robot::series_resistance_ohm() const { return drive.driver_resistance_ohm.value_or(0.0); }

namespace {

Robot robot_of(const input::Value& root, const std::filesystem::path& path) {
  base::Diagnostics diagnostics;
  input::Reader top(root, "", diagnostics);
  Robot robot;
  robot.id = path.stem().string();
  robot.file = path;
  robot.name = top.text("name", input::Need::required).value_or("");
  robot.source = top.text("source", input::Need::required).value_or("");
  top.texts("notes", input::Need::optional);
  robot.mass_kg = top.quantity({"mass", "kg", base::Range::between(0.1, 200.0), "mass of the robot with battery; check the unit, g or kg"},
                               input::Need::required)
                      .value_or(1.0);
  read_wheels(root, top, robot, diagnostics);
  read_drive(top, robot);
  if (std::optional<input::Reader> battery = top.table("battery", input::Need::required)) {
    robot.battery.nominal_V =
        battery
            ->quantity({"nominal_voltage", "V", base::Range::between(1.0, 5000.0), "nominal voltage of the battery"}, input::Need::required)
            .value_or(1.0);
    read_file_parameters(*battery, "battery", robot);
    battery->finish();
  }
  for (const std::string_view name : {"body", "traction", "limits"}) {
    if (std::optional<input::Reader> table = top.table(name, input::Need::optional)) {
      read_file_parameters(*table, name, robot);
      table->finish();
    }
  }
  read_friction(top, robot);
  top.finish();
  diagnostics.throw_if_any();
  return robot;
}

}  // namespace

Robot read_robot(const std::filesystem::path& path) { return robot_of(input::read_toml(path), path); }

Robot parse_robot(const std::string& text, const std::filesystem::path& path) {
  return robot_of(input::parse_toml(text, path.string()), path);
}

}  // namespace heatsoak::robot
