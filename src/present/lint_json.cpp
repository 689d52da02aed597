#include <nlohmann/json.hpp>

#include "present/lint.h"

namespace heatsoak::present {

Json lint_json(const duty::FilesLint& lint) {
  Json findings = Json::array();
  for (const motor::LintFinding& each : lint.findings) {
    findings.push_back({{"file", each.at.file},
                        {"line", each.at.line.value_or(0)},
                        {"column", each.at.column.value_or(0)},
                        {"level", motor::to_string(each.level)},
                        {"check", each.check},
                        {"key", each.key},
                        {"message", motor::message_of(each)}});
  }
  Json data{{"schema", "heatsoak.lint/1"},
            {"files", lint.files},
            {"errors", lint.count(motor::LintFinding::Level::error)},
            {"warnings", lint.count(motor::LintFinding::Level::warning)},
            {"findings", findings}};
  if (lint.unreadable) {
    data["error"] = failure_json(*lint.unreadable).at("error");
  }
  return data;
}

}  // namespace heatsoak::present
