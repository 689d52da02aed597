// Documents of `describe`: motors, robots, duties, effects, thresholds, verdicts and the drive core. Signals: signal_topics.h.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "check/threshold.h"
#include "duty/duty.h"
#include "motor/motor.h"
#include "motor/sensor_effect.h"
#include "present/document.h"
#include "robot/robot.h"
#include "thermal/effect.h"

namespace heatsoak::present {

Document motor_description(const motor::Motor& motor);
Document robot_description(const robot::Robot& robot);
Document duty_description(const duty::Duty& duty);
/// Returns the notes of the file and, for a recorded duty, a line about its recording.
std::vector<std::string> duty_notes(const duty::Duty& duty);

/// Describes a duty shape. `file` is a complete duty file of this shape.
Document shape_description(const duty::ShapeType& shape, const std::string& file);

/// Describes an effect of the thermal network, with lines for a motor file at its typical size.
Document effect_description(const thermal::EffectType& effect);
Document sensor_description(const motor::SensorEffectType& type);

Document threshold_description(const check::ThresholdType& type);
/// Describes the checks with a command, whose limits are on numbers of its answer.
Document command_limits_description();
Document verdict_description();
/// Describes one verdict, such as "pass" or "undecided"; nothing if there is none of this name.
std::optional<Document> one_verdict_description(std::string_view name);

/// Describes the blocks of the drive core with the signals that they read and write.
Document core_description();

/// Label and words of one line of a description; lines without words are left out.
struct LabelledWords {
  std::string_view label;
  std::string words;
};

/// Describes an effect that is not part of the thermal network. `where` states its place in a few words.
Document effect_outside_network(std::string_view where, std::string_view name, std::string_view summary, const base::ParameterSpec& size,
                                std::span<const LabelledWords> lines);

/// Returns the unit of a robot value by its key "table.key" or "friction.heading.wheel[0].key".
std::string_view robot_unit(std::string_view key);

/// Returns the name of a signal that an effect needs.
std::string signal_name(thermal::Signal signal);

}  // namespace heatsoak::present
