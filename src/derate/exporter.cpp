#include "derate/exporter.h"

#include "derate/exporters_registry.h"

namespace heatsoak::derate {

const std::vector<ExporterType>& all_exporters() {
  static const std::vector<ExporterType> all = [] {
    std::vector<ExporterType> types;
    for (const exporters::Entry& entry : exporters::registry) {
      types.push_back(entry.make());
      types.back().name = entry.name;
    }
    return types;
  }();
  return all;
}

}  // namespace heatsoak::derate
