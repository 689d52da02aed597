#include "estimation/run_deviation.h"
#include "present/measured/run_deviation.h"
#include "present/topics.h"

namespace heatsoak::present::outside_effects {

TopicList single_runs() {
  TopicList topics;
  for (const estimation::RunDeviationType& type : estimation::all_run_deviations()) {
    topics.push_back({std::string(type.name), [&type] { return std::string(type.summary); },
                      [&type] { return described(run_deviation_description(type), run_deviation_json(type)); }});
  }
  return topics;
}

}  // namespace heatsoak::present::outside_effects
