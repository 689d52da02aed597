#include "cli/verdict_topic.h"

#include <nlohmann/json.hpp>

#include "present/description.h"
#include "present/description_json.h"

namespace heatsoak::cli {

Topic verdict_topic() {
  return {"verdict", "meaning of pass, marginal, fail, infeasible and undecided", present::verdict_description, present::verdict_json};
}

}  // namespace heatsoak::cli
