#include "thermal/law.h"

namespace heatsoak::thermal {

void HeatNames::name_flow(int from_node, int to_node, const Traced& heat_W) const {
  const std::string path = nodes.at(static_cast<std::size_t>(from_node)) + "_to_" + nodes.at(static_cast<std::size_t>(to_node)) + "_W";
  heat_W.name(path, law + "_" + path);
}

void HeatNames::name_source(int into_node, const Traced& heat_W) const {
  heat_W.name(law + "_W", law + "_" + nodes.at(static_cast<std::size_t>(into_node)) + "_W");
}

}  // namespace heatsoak::thermal
