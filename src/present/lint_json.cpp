#include <nlohmann/json.hpp>

#include "present/lint.h"

namespace heatsoak::present {

Json lint_json(const FilesLint& lint) {
  Json findings = Json::array();
  for (const LintFinding& each : lint.findings) {
    findings.push_back({{"file", each.at.file},
                        {"line", each.at.line},
                        {"column", each.at.column},
                        {"level", to_string(each.level)},
                        {"check", each.check},
                        {"message", each.message}});
  }
  return {{"schema", "heatsoak.lint/1"},
          {"files", lint.files},
          {"errors", lint.count(LintFinding::Level::error)},
          {"warnings", lint.count(LintFinding::Level::warning)},
          {"findings", findings}};
}

}  // namespace heatsoak::present
