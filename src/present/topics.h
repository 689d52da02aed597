// Everything that `describe` explains and `list` lists, by its name.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "input/data_folders.h"
#include "present/document.h"

namespace heatsoak::present {

struct Topic {
  std::string id;
  std::function<std::string()> summary;  ///< may read the file of a motor, robot or duty
  std::function<Document()> document;
};
using TopicList = std::vector<Topic>;

TopicList motor_topics(const input::DataFolders& folders);
TopicList robot_topics(const input::DataFolders& folders);
TopicList duty_topics(const input::DataFolders& folders);
/// Returns the effects of the thermal network, then those of src/present/outside_effects.
TopicList effect_topics(const input::DataFolders& folders);
TopicList threshold_topics(const input::DataFolders& folders);
/// Returns the signals of base/signal_table.h, except one that has the name of an effect.
TopicList signal_topics(const input::DataFolders& folders);
/// Returns all of the above, duty shapes, the verdicts, the table of signals and the drive core. Ids are unique.
TopicList all_topics(const input::DataFolders& folders);

/// Returns the document with the JSON as its data, in the schema heatsoak.describe/1.
Document described(Document document, const Json& json);

/// Describes the topic of this id, the signal of a log column, or the motor, robot or duty in a file whose name ends in .toml. Throws
/// Failure (bad_input) for an unknown id, with "did you mean", and for a file with problems.
Document description_of(const std::string& name, const input::DataFolders& folders);

/// Id of the drive core's topic, whose block diagram can be drawn.
inline constexpr std::string_view kCoreTopic = "robot_core";

}  // namespace heatsoak::present
