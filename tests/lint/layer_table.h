// The layer diagram as CMakeLists.txt declares it.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace heatsoak::lint {

struct LayerTable {
  std::map<std::string, std::set<std::string>> uses;     ///< of each layer, everything below it and itself
  std::map<std::string, std::set<std::string>> plugins;  ///< "src/report/vtk": what its code may include
  std::vector<std::string> problems;                     ///< a layer that uses one not declared above it
};

/// `folders`: the names of the folders of src, to tell layers from libraries.
LayerTable read_layer_table(std::string_view cmake, const std::set<std::string>& folders);

/// "file:line: …" for every include of a file in src that the table does not allow.
std::vector<std::string> layer_violations(const LayerTable& table, const std::string& path, std::string_view text);

}  // namespace heatsoak::lint
