// Effects that are none of the network's: what `list` and `describe` say of them.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/parameter.h"
#include "cli/command.h"

namespace heatsoak {

struct TopicLine {
  std::string_view key;    ///< of the JSON, as for the network's effects
  std::string_view label;  ///< for people
  std::string words;
};

/// `where` in a few words; `use` says what a user does with it, after everything else.
Topic effect_topic(std::string_view where, std::string_view name, std::string_view summary, const ParameterSpec& size,
                   std::span<const TopicLine> lines, std::string_view use);

/// "[effects.my_NAME]" with its type: lines to paste into a motor file.
std::string effect_table(std::string_view type_name);
/// A parameter of it at its typical size.
std::string typical_figure(std::string_view key, double value, std::string_view unit);

/// Errors of sensors, and what the answers of verbs may name.
std::vector<Topic> all_topics();

}  // namespace heatsoak
