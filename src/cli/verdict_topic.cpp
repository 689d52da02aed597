#include "cli/verdict_topic.h"

#include <nlohmann/json.hpp>

#include "present/description.h"
#include "present/verdict_topic.h"

namespace heatsoak {

Topic verdict_topic() {
  nlohmann::ordered_json meanings = nlohmann::ordered_json::array();
  for (const present::VerdictMeaning& each : present::verdict_meanings()) {
    meanings.push_back({{"verdict", to_string(each.verdict)}, {"meaning", each.meaning}});
  }
  return {"verdict", "what pass, marginal, fail, infeasible and undecided mean", present::verdict_description, [meanings] {
            return nlohmann::ordered_json{{"kind", "verdict"}, {"id", "verdict"}, {"verdicts", meanings}};
          }};
}

}  // namespace heatsoak
