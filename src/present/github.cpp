#include "present/github.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "present/check_words.h"

namespace heatsoak::present {
namespace {

/// Escapes text for a cell of a Markdown table.
std::string in_markdown(std::string_view text) {
  std::string result;
  for (const char c : text) {
    result += c == '|' ? "\\|" : c == '\n' ? "<br>" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  }
  return result;
}

/// Returns the text as code in a cell of a Markdown table. GitHub shows references such as &lt; in code as they are written.
std::string as_code(std::string_view text) {
  std::string result;
  for (const char c : text) {
    result += c == '|' ? "\\|" : c == '\n' ? " " : std::string(1, c);
  }
  return result.find('`') == std::string::npos ? fmt::format("`{}`", result) : fmt::format("`` {} ``", result);
}

/// Escapes the data and the properties of a GitHub workflow command.
std::string escaped_command(std::string_view text, bool is_property) {
  std::string result;
  for (const char c : text) {
    const bool is_special = c == '%' || c == '\r' || c == '\n' || (is_property && (c == ':' || c == ','));
    result += is_special ? fmt::format("%{:02X}", static_cast<unsigned char>(c)) : std::string(1, c);
  }
  return result;
}

}  // namespace

std::string summary_markdown(std::span<const check::Outcome> outcomes, std::string_view version) {
  std::string text = fmt::format("### heatsoak check: {}\n\n", conclusion_words(outcomes));
  text += "| | check | threshold | value | limit | margin | |\n|---|---|---|--:|--:|--:|---|\n";
  for (const check::Outcome& each : outcomes) {
    text += fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", each.passed() ? "✅" : "❌", in_markdown(each.check->name),
                        as_code(each.limit.type->name), value_words(each), limit_words(each), margin_words(each),
                        in_markdown(explanation_words(each)));
  }
  return text + fmt::format("\nheatsoak {}\n", version);
}

std::string annotation(const base::Location& at, const std::filesystem::path& workspace, std::string_view title, std::string_view message) {
  std::filesystem::path file = at.file;
  if (!workspace.empty()) {
    std::error_code unreachable;
    const std::filesystem::path inside = std::filesystem::proximate(file, workspace, unreachable);
    file = unreachable || inside.string().starts_with("..") ? file : inside;
  }
  return fmt::format("::error file={},line={},col={},title={}::{}\n", escaped_command(file.string(), true), at.line.value_or(1),
                     at.column.value_or(1), escaped_command(title, true), escaped_command(message, false));
}

std::string annotations(std::span<const check::Outcome> outcomes, const std::filesystem::path& workspace) {
  std::string text;
  for (const check::Outcome& each : outcomes) {
    if (!each.passed()) {
      text += annotation(place_of(each), workspace, fmt::format("{}: {}", each.check->name, each.limit.type->name),
                         unlocated_explanation(each));
    }
  }
  return text;
}

}  // namespace heatsoak::present
