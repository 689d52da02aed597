#include "layer_table.h"

#include <regex>
#include <sstream>

#include "source_text.h"

namespace heatsoak::lint {
namespace {

/// Libraries that only one folder may include, by the beginning of their headers' paths.
struct HiddenLibrary {
  const char* headers;
  const char* folder;
};
const HiddenLibrary kHidden[] = {
    {"vtk", "src/report/vtk/"},
    {"(arkode|cvode|cvodes|ida|idas|kinsol|nvector|sundials|sunlinsol|sunmatrix|sunnonlinsol)/", "src/ode/"},
    {"toml(\\+\\+|plusplus)", "src/input/"},
    {"csv\\.h", "src/input/"},
    {"udunits", "src/base/"},
    {"muParser", "src/recording/"},
    {"CLI/", "src/cli/"},
    {"zlib\\.h", "src/duty/"},
    {"(google/protobuf/|[a-z_]+\\.pb\\.h)", "src/duty/logs/"},
};

std::vector<std::string> words(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> found;
  for (std::string word; stream >> word;) {
    found.push_back(word);
  }
  return found;
}

}  // namespace

LayerTable read_layer_table(std::string_view cmake, const std::set<std::string>& folders) {
  static const std::regex kDeclaration(R"((?:^|\n)[ \t]*(add_core|add_layer|add_plugin)\(([^)]*)\))");
  LayerTable table;
  const std::string text(cmake);
  for (std::sregex_iterator each(text.begin(), text.end(), kDeclaration), end; each != end; ++each) {
    const bool is_layer = (*each)[1] != "add_plugin";
    const std::vector<std::string> declaration = words((*each)[2]);
    const std::string& name = declaration.at(0);
    std::set<std::string> reach;
    bool in_uses = false;
    for (const std::string& word : declaration) {
      if (word == "USES" || word == "HIDES" || word == "REGISTERS" || word == "ROOMS" || word == "OPTION") {
        in_uses = word == "USES";
      } else if (in_uses && table.uses.contains(word)) {
        reach.insert(table.uses[word].begin(), table.uses[word].end());
      } else if (in_uses && folders.contains(word)) {
        table.problems.push_back(name + " uses " + word + ", which is not declared above it");
      }
    }
    if (is_layer) {
      reach.insert(name);
      table.uses[name] = reach;
    } else {
      // A plugin uses the headers, but not the code, of the layer whose folder contains it.
      const std::string& folder = declaration.at(1);
      const std::size_t begin = folder.find('/') + 1;
      reach.insert(folder.substr(begin, folder.find('/', begin) - begin));
      table.plugins[folder + "/"] = reach;
    }
  }
  return table;
}

std::vector<std::string> layer_violations(const LayerTable& table, const std::string& path, std::string_view text) {
  const std::size_t begin = path.find('/') + 1;
  const std::string layer = path.substr(begin, path.find('/', begin) - begin);
  std::vector<std::string> found;
  if (!table.uses.contains(layer)) {
    return {path + ": '" + layer + "' is no layer of CMakeLists.txt"};
  }
  const std::set<std::string>* reach = &table.uses.at(layer);
  for (const auto& [folder, of_plugin] : table.plugins) {
    reach = path.starts_with(folder) ? &of_plugin : reach;
  }
  for (const Include& include : includes(text)) {
    const std::string place = path + ":" + std::to_string(include.line) + ": ";
    for (const HiddenLibrary& library : kHidden) {
      const bool is_of_library = std::regex_search(include.path, std::regex(library.headers), std::regex_constants::match_continuous);
      if (is_of_library && !path.starts_with(library.folder)) {
        found.push_back(place + "<" + include.path + "> belongs into " + library.folder);
      }
    }
    if (!include.quoted) {
      continue;
    }
    if (!reach->contains(include.path.substr(0, include.path.find('/')))) {
      found.push_back(place + "\"" + include.path + "\" is of no layer that this file may use");
    }
    for (const auto& [folder, of_plugin] : table.plugins) {
      if (("src/" + include.path).starts_with(folder) && !path.starts_with(folder)) {
        found.push_back(place + "\"" + include.path + "\" is inside a plugin");
      }
    }
  }
  return found;
}

std::vector<std::string> namespace_violations(const std::string& path, std::string_view text) {
  static const std::regex kOpened("(?:^|\\n)namespace (heatsoak[a-z0-9_:]*) \\{(\\n(class|struct|enum class) \\w+;)?");
  const std::size_t begin = path.find('/') + 1;
  const std::string own = "heatsoak::" + path.substr(begin, path.find('/', begin) - begin);
  const std::string all(text);
  std::vector<std::string> found;
  for (std::sregex_iterator each(all.begin(), all.end(), kOpened), end; each != end; ++each) {
    const std::string opened = (*each)[1];
    const bool is_own = opened == own || opened.starts_with(own + "::");
    if (!is_own && !(*each)[2].matched) {
      found.push_back(path + ": opens " + opened + " instead of " + own);
    }
  }
  return found;
}

}  // namespace heatsoak::lint
