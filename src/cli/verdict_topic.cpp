#include "cli/verdict_topic.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "present/verdict_topic.h"

namespace heatsoak {

Topic verdict_topic() {
  std::string text = "verdict: the result of `evaluate` for a motor on a duty, from the best to the worst\n";
  nlohmann::ordered_json meanings = nlohmann::ordered_json::array();
  for (const present::VerdictMeaning& each : present::verdict_meanings()) {
    text += fmt::format("\n{}\n  {}\n", to_string(each.verdict), each.meaning);
    meanings.push_back({{"verdict", to_string(each.verdict)}, {"meaning", each.meaning}});
  }
  text += fmt::format("\nundecided\n  {}\n", present::undecided_meaning());
  text +=
      "\nwith --closed-loop\n  fail: the first game or more than half of the games exceed a limit; infeasible: a game was not driven; "
      "marginal: any other game exceeds a limit.\n";
  return {"verdict", "what pass, marginal, fail, infeasible and undecided mean", text, [meanings] {
            return nlohmann::ordered_json{{"kind", "verdict"}, {"id", "verdict"}, {"verdicts", meanings}};
          }};
}

}  // namespace heatsoak
