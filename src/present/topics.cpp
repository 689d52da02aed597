#include "present/topics.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "base/diagnostic.h"
#include "check/threshold.h"
#include "duty/duty.h"
#include "duty/file_kind.h"
#include "motor/motor.h"
#include "present/description.h"
#include "present/description_json.h"
#include "present/outside_effects_registry.h"
#include "present/signal_topics.h"
#include "robot/robot.h"
#include "thermal/effect.h"

namespace heatsoak::present {
namespace {

/// Head that every duty file has in addition to its shape.
constexpr std::string_view kDutyHead = R"(summary = "description of this load"
origin = "source, or whose judgement it is"
ambient = { value = "25 degC", origin = "estimated", derivation = "why this value", range = ["20 degC", "32 degC"] }
)";

std::string summary_of(const motor::Motor& motor) {
  return fmt::format("{} {} ({} thermal data)", motor.manufacturer, motor.name, motor::data_quality(motor));
}
std::string summary_of(const robot::Robot& robot) { return fmt::format("{}, drives with {}", robot.name, robot.drive.motor); }
std::string summary_of(const duty::Duty& duty) { return duty.summary; }

Document document_of(const motor::Motor& motor) { return described(motor_description(motor), motor_json(motor)); }
Document document_of(const robot::Robot& robot) { return described(robot_description(robot), robot_json(robot)); }
Document document_of(const duty::Duty& duty) { return described(duty_description(duty), duty_file_json(duty)); }

template <class Thing>
TopicList file_topics(const std::filesystem::path& folder, Thing (*read)(const std::filesystem::path&)) {
  TopicList topics;
  for (const std::string& id : input::ids_in(folder)) {
    const std::filesystem::path file = folder / (id + ".toml");
    topics.push_back({id, [file, read] { return summary_of(read(file)); }, [file, read] { return document_of(read(file)); }});
  }
  return topics;
}

/// Returns the first sentence; the description contains the rest.
std::string first_sentence(std::string_view text) {
  const std::size_t end = text.find(". ");
  return std::string(text.substr(0, end == std::string_view::npos ? end : end + 1));
}

Topic topic_of(const thermal::EffectType& effect) {
  return {std::string(effect.name), [&effect] { return first_sentence(effect.summary); },
          [&effect] { return described(effect_description(effect), network_effect_json(effect)); }};
}

Topic topic_of(const check::ThresholdType& type) {
  return {std::string(type.name),
          [&type] { return fmt::format("\"{}\": {}", type.example, type.meaning.substr(0, type.meaning.find_first_of(":;,("))); },
          [&type] { return described(threshold_description(type), threshold_json(type)); }};
}

Topic topic_of(const duty::ShapeType& shape) {
  return {std::string(shape.name), [&shape] { return fmt::format("duty shape: {}", shape.summary); },
          [&shape] {
            const std::string file = fmt::format("{}{}", kDutyHead, shape.example);
            return described(shape_description(shape, file), shape_json(shape, file));
          }};
}

Document description_of_file(const std::filesystem::path& file) {
  switch (duty::file_kind(file)) {
    case duty::FileKind::duty:
      return document_of(duty::read_duty(file));
    case duty::FileKind::robot:
      return document_of(robot::read_robot(file));
    case duty::FileKind::motor:
      break;
  }
  return document_of(motor::read_motor(file));
}

}  // namespace

TopicList motor_topics(const input::DataFolders& folders) { return file_topics(folders.motors, &motor::read_motor); }
TopicList robot_topics(const input::DataFolders& folders) { return file_topics(folders.robots, &robot::read_robot); }
TopicList duty_topics(const input::DataFolders& folders) { return file_topics(folders.duties, &duty::read_duty); }

TopicList effect_topics(const input::DataFolders& /*folders*/) {
  TopicList topics;
  for (const thermal::EffectType& effect : thermal::all_effects()) {
    topics.push_back(topic_of(effect));
  }
  for (const auto& [name, make] : outside_effects::registry) {
    std::ranges::move(make(), std::back_inserter(topics));
  }
  return topics;
}

TopicList threshold_topics(const input::DataFolders& /*folders*/) {
  TopicList topics{{"command", [] { return "\"at most 1.9\": any number of the JSON answer of a command of this program"; },
                    [] { return described(command_limits_description(), command_limits_json()); }}};
  for (const check::ThresholdType& type : check::all_thresholds()) {
    topics.push_back(topic_of(type));
  }
  return topics;
}

TopicList all_topics(const input::DataFolders& folders) {
  TopicList topics;
  for (const auto& some : {motor_topics, robot_topics, duty_topics, effect_topics, threshold_topics, signal_topics}) {
    std::ranges::move(some(folders), std::back_inserter(topics));
  }
  for (const duty::ShapeType& shape : duty::all_shapes()) {
    topics.push_back(topic_of(shape));
  }
  topics.push_back({"verdict", [] { return "meaning of pass, marginal, fail, infeasible and undecided"; },
                    [] { return described(verdict_description(), verdict_json()); }});
  topics.push_back({"signals", [] { return "unit, log column, averaging rule and worst case of every signal"; }, signals_description});
  topics.push_back({std::string(kCoreTopic), [] { return "the blocks of the drive core and their signals"; },
                    [] { return described(core_description(), core_json()); }});
  return topics;
}

Document described(Document document, const Json& json) {
  document.data = {{"schema", "heatsoak.describe/1"}};
  document.data.update(json);
  return document;
}

Document description_of(const std::string& name, const input::DataFolders& folders) {
  if (name.ends_with(".toml")) {
    return description_of_file(name);
  }
  const TopicList topics = all_topics(folders);
  if (const auto found = std::ranges::find(topics, name, &Topic::id); found != topics.end()) {
    return found->document();
  }
  if (std::optional<Document> verdict = one_verdict_description(name)) {
    return *std::move(verdict);
  }
  if (const base::SignalRow* row = signal_of_column(name)) {
    return signal_description(*row);
  }
  if (name == "motors" || name == "robots" || name == "duties" || name == "effects") {
    throw base::Failure(
        base::ExitCode::bad_input,
        fmt::format("'{0}' is not one name: `heatsoak list {0}` lists the names, `heatsoak describe NAME` describes one of them", name));
  }
  std::vector<std::string> known;
  std::ranges::transform(topics, std::back_inserter(known), &Topic::id);
  throw base::Failure(
      base::ExitCode::bad_input,
      fmt::format("there is no '{}' among motors, robots, duties, shapes, effects, thresholds, signals and verdict{} (`heatsoak list "
                  "topics` shows the names)",
                  name, base::did_you_mean(name, known)));
}

}  // namespace heatsoak::present
