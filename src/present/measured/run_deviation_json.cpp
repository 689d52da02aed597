#include <array>
#include <nlohmann/json.hpp>

#include "present/description_json.h"
#include "present/measured/run_deviation.h"

namespace heatsoak::present {

Json run_deviation_json(const estimation::RunDeviationType& type) {
  const std::string typical = typical_size(type);
  const std::array lines{TopicLine{"equation", type.equation}, TopicLine{"typical", typical}, TopicLine{"look_alike", type.confounded_with},
                         TopicLine{"experiment", type.experiment}};
  return effect_outside_network_json(place_of(type), type.name, type.summary, type.size, lines);
}

}  // namespace heatsoak::present
