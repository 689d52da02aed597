#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/quantity.h"
#include "duty/match/match_duty.h"
#include "motor/datasheet_network.h"
#include "present/description.h"
#include "present/parameter_table.h"

namespace heatsoak::present {
namespace {

/// Adds one table for each effect that the file adds to those of every motor.
void add_own_effects(const motor::Motor& motor, Document& document) {
  for (const motor::MotorEffect& effect : motor.effects) {
    std::string where;
    for (const auto& [key, value] : effect.condition) {
      where += fmt::format(", found under {}={}", key, value);
    }
    Table table = parameter_table(
        fmt::format("Effect of the file: {} ({}) at {}{}", effect.name, effect.type->name, fmt::join(effect.nodes, ", "), where));
    for (std::size_t i = 0; i < effect.parameters.size(); ++i) {
      if (effect.type->parameters[i].choices.empty()) {
        add_parameter(table, effect.type->parameters[i].key, base::unit_of(effect.type->parameters, i, effect.values()),
                      effect.parameters[i]);
      }
    }
    document.tables.push_back(std::move(table));
  }
}

Table network_table(const motor::Motor& motor) {
  Table table{.title = "Thermal network", .columns = {{"parameter", "", 0, Alignment::left}, {"value", "", 0}}, .rows = {}};
  const thermal::Network network = motor::datasheet_network(motor, motor::nominal_sample(motor));
  for (const thermal::NetworkParameter& each : network.parameters()) {
    table.rows.push_back(
        {{each.name},
         {each.choices.empty() ? with_unit(each.value, each.unit) : std::string(each.choices[static_cast<std::size_t>(each.value)].name)}});
  }
  for (const motor::MotorEffect& effect : motor.effects) {
    if (!effect.column.empty()) {
      table.rows.push_back({{effect.name + ".column"}, {effect.column}});
    }
  }
  return table;
}

}  // namespace

Document motor_description(const motor::Motor& motor) {
  Document document{.headline = {{fmt::format("{}: {} {}{}{}", motor.id, motor.manufacturer, motor.name,
                                              motor.part_number.empty() ? "" : ", ", motor.part_number)}},
                    .paragraphs = {fmt::format("{} thermal data; file {}", motor::data_quality(motor), motor.file.string())}};
  Table parameters = parameter_table("Parameters");
  for (const motor::MotorParameterSpec& each : motor::motor_parameter_specs()) {
    if (const auto found = motor.parameters.find(each.spec.key); found != motor.parameters.end()) {
      add_parameter(parameters, each.spec.key, each.spec.unit, found->second);
    }
  }
  document.tables = {std::move(parameters), network_table(motor)};
  add_own_effects(motor, document);
  if (!motor.sensors.empty()) {
    Table table = parameter_table("Sensor errors");
    for (const motor::MotorSensor& sensor : motor.sensors) {
      add_parameter(table, fmt::format("{} ({}), {}", sensor.name, sensor.type->name, sensor.type->size.key), sensor.type->size.unit,
                    sensor.size);
    }
    document.tables.push_back(std::move(table));
  }
  Table sources = labelled_table("Sources");
  for (const auto& [id, what] : motor.sources) {
    add_labelled(sources, id, what);
  }
  document.tables.push_back(std::move(sources));
  for (const std::string& note : motor.notes) {
    document.add_note(Severity::note, note);
  }
  return document;
}

std::string_view robot_unit(std::string_view key) {
  const std::string_view last = key.substr(key.rfind('.') + 1);
  if (key.find('[') != std::string_view::npos) {
    const auto found = std::ranges::find(robot::wheel_parameter_specs(), last, [](const auto& each) { return each.spec.key; });
    return found == robot::wheel_parameter_specs().end() ? std::string_view() : found->spec.unit;  // slip factors are pure numbers
  }
  const auto is_it = [&](const auto& each) { return each.spec.key == last && key.starts_with(each.table); };
  return std::ranges::find_if(robot::robot_parameter_specs(), is_it)->spec.unit;
}

Document robot_description(const robot::Robot& robot) {
  std::vector<std::string> angles;
  for (const double angle_rad : robot.wheels.axis_rad) {
    angles.push_back(base::significant(base::convert(angle_rad, "rad", "deg"), 4));
  }
  Document document{.headline = {{fmt::format("{}: {}", robot.id, robot.name)}}, .paragraphs = {}};
  Table table = labelled_table("");
  add_labelled(table, "mass", with_unit(robot.mass_kg, "kg"));
  add_labelled(table, "wheels",
               fmt::format("radius {} mm, contact radius {} mm, axes at {} °", base::significant(1e3 * robot.wheels.radius_m, 3),
                           base::significant(1e3 * robot.wheels.contact_radius_m, 3), fmt::join(angles, ", ")));
  add_labelled(table, "motor",
               fmt::format("{}, gear {}:1, {} commutation", robot.drive.motor, base::significant(robot.drive.gear_ratio, 3),
                           robot.drive.commutation == robot::Commutation::block ? "block" : "sinusoidal"));
  add_labelled(table, "battery", with_unit(robot.battery.nominal_V, "V"));
  add_labelled(
      table, "driver",
      fmt::format(
          "{}{}",
          robot.drive.voltage_limit_V ? fmt::format("command at most {} V, ", base::significant(*robot.drive.voltage_limit_V, 4)) : "",
          robot.drive.current_limit_A ? fmt::format("at most {} A", base::significant(*robot.drive.current_limit_A, 4))
                                      : "no current limit"));
  add_labelled(table, "source", robot.source);
  document.tables.push_back(std::move(table));
  if (!robot.parameters.empty()) {
    Table parameters = parameter_table("Parameters");
    for (const auto& [key, parameter] : robot.parameters) {
      add_parameter(parameters, key, robot_unit(key), parameter);
    }
    document.tables.push_back(std::move(parameters));
  }
  return document;
}

std::vector<std::string> duty_notes(const duty::Duty& duty) {
  std::vector<std::string> notes = duty.notes;
  if (duty.recording) {
    notes.push_back(fmt::format("{} of {}, run {} time{}", duty.kind == duty::DutyKind::torque ? "torque" : "current",
                                duty.recording->path.string(), duty.recording->repeats, duty.recording->repeats == 1 ? "" : "s"));
  }
  return notes;
}

Document duty_description(const duty::Duty& duty) {
  Document document{
      .headline = {{fmt::format("{}: {}", duty.id, duty.summary)}},
      .paragraphs = {fmt::format("Shape {}, ambient {:.0f} °C. The load is {}.", duty.shape, duty.ambient_C.value, duty.origin)}};
  for (const std::string& note : duty_notes(duty)) {
    document.add_note(Severity::note, note);
  }
  if (!duty.parameters.empty()) {
    Table load = parameter_table("Load");
    for (const auto& [spec, parameter] : duty.parameters) {
      if (parameter.printed.empty()) {
        add_value(load, spec.key, with_unit(parameter.value, spec.unit));
      } else {
        add_parameter(load, spec.key, spec.unit, parameter);
      }
    }
    document.tables.push_back(std::move(load));
  }
  if (const auto match = std::dynamic_pointer_cast<const duty::MatchDuty>(duty.shape_data)) {
    Table inputs = parameter_table("Inputs of the match");
    for (std::size_t i = 0; i < match->inputs().parameters.size(); ++i) {
      const base::ParameterSpec& spec = duty::match_input_specs()[i].spec;
      add_parameter(inputs, spec.key, spec.unit, match->inputs().parameters[i], spec.meaning);
    }
    document.tables.push_back(std::move(inputs));
  }
  return document;
}

Document shape_description(const duty::ShapeType& shape, const std::string& file) {
  return {.headline = {{fmt::format("{}: a duty shape, {}", shape.name, shape.summary)}},
          .listings = {{"A duty file of this shape:", file}}};
}

}  // namespace heatsoak::present
