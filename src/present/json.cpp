#include "present/json.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "present/document.h"

namespace heatsoak::present {

Json rounded(double value, int decimals) {
  if (!std::isfinite(value)) {
    return nullptr;
  }
  const double scale = std::pow(10.0, decimals);
  return std::round(value * scale) / scale;
}

Json rounded(const std::optional<double>& value, int decimals) { return value ? rounded(*value, decimals) : nullptr; }

void add_never(Json& json, std::initializer_list<const char*> keys) {
  Json never = Json::array();
  std::copy_if(keys.begin(), keys.end(), std::back_inserter(never), [&json](const char* key) { return json.at(key).is_null(); });
  json["never"] = std::move(never);
}

void add_notes(Json& json, std::span<const Note> notes) {
  json["notes"] = Json::array();
  json["warnings"] = Json::array();
  for (const Note& each : notes) {
    json["notes"].push_back(each.words);
    if (each.severity == Severity::warning) {
      json["warnings"].push_back(each.words);
    }
  }
}

std::string json_text(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

Json failure_json(const base::Failure& failure) {
  Json diagnostics = Json::array();
  for (const base::Diagnostic& each : failure.diagnostics()) {
    diagnostics.push_back({{"file", each.at.file},
                           {"line", each.at.line.value_or(0)},
                           {"column", each.at.column.value_or(0)},
                           {"key", each.key},
                           {"message", each.message}});
  }
  if (diagnostics.empty()) {
    std::istringstream lines(failure.message());
    for (std::string line; std::getline(lines, line) && !line.starts_with('`');) {
      diagnostics.push_back({{"file", ""}, {"line", 0}, {"column", 0}, {"key", ""}, {"message", line}});
    }
  }
  const std::string message = failure.message().empty() ? "the input is wrong" : failure.message();
  return {{"error", {{"code", static_cast<int>(failure.code())}, {"message", message}, {"diagnostics", diagnostics}}}};
}

}  // namespace heatsoak::present
