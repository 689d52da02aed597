// Topics of `list` and `describe` for effects that are not part of the thermal network.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/parameter.h"
#include "cli/command.h"

namespace heatsoak {

struct TopicLine {
  std::string_view key;    ///< key in the JSON, as for the effects of the network
  std::string_view label;  ///< label in the text
  std::string words;
};

/// Returns the topic of an effect. `where` states its place in a few words; `use` tells how it is used and is printed last.
Topic effect_topic(std::string_view where, std::string_view name, std::string_view summary, const ParameterSpec& size,
                   std::span<const TopicLine> lines, std::string_view use);

/// Returns the table "[effects.my_NAME]" with its type, ready to paste into a motor file.
std::string effect_table(std::string_view type_name);
/// Returns the line of a parameter at its typical size.
std::string typical_value(std::string_view key, double value, std::string_view unit);

/// Returns all topics: sensor effects and those of the commands.
std::vector<Topic> all_topics();

}  // namespace heatsoak
