#include "derate/exporter.h"

#include <algorithm>
#include <filesystem>

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

const ExporterType* exporter_of_ending(std::string_view ending) {
  const auto found = ending.empty() ? all_exporters().end() : std::ranges::find(all_exporters(), ending, &ExporterType::file_ending);
  return found == all_exporters().end() ? nullptr : &*found;
}

const ExporterType* expected_by_name(const ExporterType& exporter, std::string_view file) {
  const std::string ending = std::filesystem::path(file).extension().string();
  const bool suits = ending == (exporter.file_ending.empty() ? exporter.usual_ending : exporter.file_ending);
  return suits ? nullptr : exporter_of_ending(ending);
}

}  // namespace heatsoak::derate
