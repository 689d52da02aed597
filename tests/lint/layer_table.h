// The layer diagram declared in CMakeLists.txt.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace heatsoak::lint {

struct LayerTable {
  std::map<std::string, std::set<std::string>> uses;     ///< each layer with all layers that it may include, including itself
  std::map<std::string, std::set<std::string>> plugins;  ///< key "src/report/vtk": layers that the plugin may include
  std::vector<std::string> problems;                     ///< layers that use a layer not declared above them
};

/// `folders`: names of the folders of src, which distinguish layers from libraries.
LayerTable read_layer_table(std::string_view cmake, const std::set<std::string>& folders);

/// Returns "file:line: …" for every include in a file of src that the table does not allow.
std::vector<std::string> layer_violations(const LayerTable& table, const std::string& path, std::string_view text);

/// Returns "file: …" for every namespace of the project in a file of src that is not the one of the file's layer. A namespace of another
/// layer may only contain forward declarations.
std::vector<std::string> namespace_violations(const std::string& path, std::string_view text);

}  // namespace heatsoak::lint
