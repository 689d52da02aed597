#include "base/version.h"
#include "present/renderer.h"

namespace heatsoak::present::renderers {
namespace {

/// Adds the program's version after the schema, so that changed results can be attributed to an upgrade.
Json with_version(const Json& answer) {
  Json result;
  for (const auto& [key, value] : answer.items()) {
    result[key] = value;
    if (key == "schema" || key == "error") {
      result["version"] = base::program_version();
    }
  }
  return result;
}

std::string render_json(const Document& document, const RenderOptions& /*options*/) { return json_text(with_version(document.data)); }

}  // namespace

Renderer json() {
  return {.name = {}, .file_ending = ".json", .summary = "JSON for other programs, also with --json FILE", .render = render_json};
}

}  // namespace heatsoak::present::renderers
