#include "identify/measurement/mapping.h"

namespace heatsoak {

Location QuantityMapping::place_of(const std::string& part) const {
  const auto found = places.find(part);
  return found == places.end() ? at : found->second;
}

}  // namespace heatsoak
