// JSON of `describe`, without its schema.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "check/threshold.h"
#include "duty/duty.h"
#include "motor/motor.h"
#include "motor/sensor_effect.h"
#include "present/json.h"
#include "robot/robot.h"
#include "thermal/effect.h"

namespace heatsoak::present {

Json motor_json(const motor::Motor& motor);
Json robot_json(const robot::Robot& robot);
Json duty_file_json(const duty::Duty& duty);
/// Returns the JSON of a duty shape. `file` is a complete duty file of this shape.
Json shape_json(const duty::ShapeType& shape, const std::string& file);
Json network_effect_json(const thermal::EffectType& effect);
Json sensor_json(const motor::SensorEffectType& type);
Json threshold_json(const check::ThresholdType& type);
Json command_limits_json();
Json verdict_json();
Json core_json();

struct TopicLine {
  std::string_view key;  ///< key in the JSON, as for the effects of the network
  std::string_view words;
};

/// Returns the JSON of an effect that is not part of the thermal network. `where` states its place in a few words; lines without words are
/// left out.
Json effect_outside_network_json(std::string_view where, std::string_view name, std::string_view summary, const base::ParameterSpec& size,
                                 std::span<const TopicLine> lines);

}  // namespace heatsoak::present
