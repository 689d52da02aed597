// What a form of the derating is that leaves this program: one file in src/derate/exporters each.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "derate/derating.h"

namespace heatsoak {

struct ExporterType {
  std::string_view name;  ///< the file's name; set by all_exporters()
  std::string_view summary;
  std::string (*write)(const Derating& derating) = nullptr;
  /// The same with a binary that the named C compiler makes; null where the form has none.
  std::string (*write_compiled)(const Derating& derating, const std::string& compiler) = nullptr;
};

/// Sorted by name; they live as long as the program.
const std::vector<ExporterType>& all_exporters();

}  // namespace heatsoak
