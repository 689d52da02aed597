// Topics of `list` and `describe` for effects that are not part of the thermal network.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "base/parameter.h"
#include "cli/command.h"

namespace heatsoak {

struct TopicLine {
  std::string_view key;  ///< key in the JSON, as for the effects of the network
  std::string_view words;
};

/// Returns the JSON of an effect. `where` states its place in a few words; lines without words are left out.
nlohmann::ordered_json effect_json(std::string_view where, std::string_view name, std::string_view summary, const ParameterSpec& size,
                                   std::span<const TopicLine> lines);

/// Returns all topics: sensor effects and those of the commands.
std::vector<Topic> all_topics();

}  // namespace heatsoak
