// Interface of an output format of the derating. Each format is one file in src/derate/exporters.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "derate/derating.h"

namespace heatsoak::derate {

/// Heat at the highest speed that a format cannot express, with the safety factor.
struct OmittedHeat {
  double loss_W = 0.0;
  double rise_K = 0.0;  ///< by which the winding of the file is too cold if, with `loss_W` and a constant current, it is at its limit
  double speed_rad_per_s = 0.0;
};

struct ExporterType {
  std::string_view name;  ///< the file's name; set by all_exporters()
  std::string_view summary;
  std::string_view file_ending = {};   ///< ending of a file name that selects this format; empty if none does
  std::string_view usual_ending = {};  ///< usual ending if it selects another format
  std::string (*write)(const Derating& derating) = nullptr;
  /// Writes the format with a binary built by the named C compiler; null if the format contains no binary.
  std::string (*write_compiled)(const Derating& derating, const std::string& compiler) = nullptr;
  /// Returns the heat that the format omits; null if it omits none.
  OmittedHeat (*omitted)(const Derating& derating) = nullptr;
};

/// Returns the format that the ending of a file name, with its dot, selects; null if there is none.
const ExporterType* exporter_of_ending(std::string_view ending);
/// Returns the other format that readers expect in a file of this name; null if the name suits `exporter`.
const ExporterType* expected_by_name(const ExporterType& exporter, std::string_view file);

/// Returns all formats, sorted by name. The reference stays valid until the program ends.
const std::vector<ExporterType>& all_exporters();

}  // namespace heatsoak::derate
