#include "motor/sensor_effect.h"
#include "present/description.h"
#include "present/description_json.h"
#include "present/topics.h"

namespace heatsoak::present::outside_effects {

TopicList sensors() {
  TopicList topics;
  for (const motor::SensorEffectType& type : motor::all_sensor_effects()) {
    topics.push_back({std::string(type.name), [&type] { return std::string(type.summary); },
                      [&type] { return described(sensor_description(type), sensor_json(type)); }});
  }
  return topics;
}

}  // namespace heatsoak::present::outside_effects
