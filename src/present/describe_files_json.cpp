#include <memory>
#include <nlohmann/json.hpp>

#include "duty/match/match_duty.h"
#include "motor/datasheet_network.h"
#include "present/description.h"
#include "present/description_json.h"

namespace heatsoak::present {
namespace {

Json parameter_json(std::string_view key, std::string_view unit, const base::ParameterValue& parameter) {
  Json json{{"key", key},
            {"value", parameter.value},
            {"unit", unit},
            {"origin", base::to_string(parameter.origin)},
            {"source", parameter.source}};
  if (parameter.spread) {
    json["range"] = {parameter.spread->low, parameter.spread->high};
  }
  for (const base::Confirmation& each : parameter.confirmed_by) {
    json["confirmed_by"][each.source] = each.value;
  }
  if (!parameter.derivation.empty()) {
    json["derivation"] = parameter.derivation;
  }
  return json;
}

/// Returns the effects that the file adds to those of every motor.
Json own_effects(const motor::Motor& motor) {
  Json all;
  for (const motor::MotorEffect& effect : motor.effects) {
    Json json = {{"name", effect.name}, {"type", effect.type->name}, {"nodes", effect.nodes}, {"condition", effect.condition}};
    for (std::size_t i = 0; i < effect.parameters.size(); ++i) {
      if (effect.type->parameters[i].choices.empty()) {
        const std::string_view unit = base::unit_of(effect.type->parameters, i, effect.values());
        json["figures"].push_back(parameter_json(effect.type->parameters[i].key, unit, effect.parameters[i]));
      }
    }
    all.push_back(std::move(json));
  }
  return all;
}

}  // namespace

Json motor_json(const motor::Motor& motor) {
  Json result{{"kind", "motor"},
              {"id", motor.id},
              {"manufacturer", motor.manufacturer},
              {"name", motor.name},
              {"data_quality", motor::data_quality(motor)}};
  for (const motor::MotorParameterSpec& each : motor::motor_parameter_specs()) {
    if (const auto found = motor.parameters.find(each.spec.key); found != motor.parameters.end()) {
      result["figures"].push_back(parameter_json(each.spec.key, each.spec.unit, found->second));
    }
  }
  const thermal::Network network = motor::datasheet_network(motor, motor::nominal_sample(motor));
  for (const thermal::NetworkParameter& each : network.parameters()) {
    result["network"].push_back(
        {{"name", each.name},
         {"value", each.choices.empty() ? Json(each.value) : Json(each.choices[static_cast<std::size_t>(each.value)].name)},
         {"unit", each.unit}});
  }
  for (const motor::MotorEffect& effect : motor.effects) {
    if (!effect.column.empty()) {
      result["network"].push_back({{"name", effect.name + ".column"}, {"value", effect.column}, {"unit", ""}});
    }
  }
  if (!motor.effects.empty()) {
    result["effects"] = own_effects(motor);
  }
  for (const motor::MotorSensor& sensor : motor.sensors) {
    Json json = parameter_json(sensor.type->size.key, sensor.type->size.unit, sensor.size);
    json["name"] = sensor.name;
    json["type"] = sensor.type->name;
    result["sensors"].push_back(std::move(json));
  }
  result["sources"] = motor.sources;
  result["notes"] = motor.notes;
  return result;
}

Json robot_json(const robot::Robot& robot) {
  Json result{{"kind", "robot"},
              {"id", robot.id},
              {"name", robot.name},
              {"motor", robot.drive.motor},
              {"mass_kg", robot.mass_kg},
              {"wheel_radius_m", robot.wheels.radius_m},
              {"gear_ratio", robot.drive.gear_ratio},
              {"available_V", robot.available_V()},
              {"source", robot.source}};
  for (const auto& [key, parameter] : robot.parameters) {
    result["figures"].push_back(parameter_json(key, robot_unit(key), parameter));
  }
  return result;
}

Json duty_file_json(const duty::Duty& duty) {
  Json result{{"kind", "duty"},           {"id", duty.id},       {"summary", duty.summary},
              {"origin", duty.origin},    {"shape", duty.shape}, {"ambient_C", duty.ambient_C.value},
              {"notes", duty_notes(duty)}};
  for (const auto& [spec, parameter] : duty.parameters) {
    result["figures"].push_back(parameter.printed.empty() ? Json{{"key", spec.key}, {"value", parameter.value}, {"unit", spec.unit}}
                                                          : parameter_json(spec.key, spec.unit, parameter));
  }
  if (const auto match = std::dynamic_pointer_cast<const duty::MatchDuty>(duty.shape_data)) {
    for (std::size_t i = 0; i < match->inputs().parameters.size(); ++i) {
      const base::ParameterSpec& spec = duty::match_input_specs()[i].spec;
      Json json = parameter_json(spec.key, spec.unit, match->inputs().parameters[i]);
      json["meaning"] = spec.meaning;
      result["figures"].push_back(json);
    }
  }
  return result;
}

Json shape_json(const duty::ShapeType& shape, const std::string& file) {
  return {{"kind", "shape"}, {"id", shape.name}, {"example", file}};
}

}  // namespace heatsoak::present
