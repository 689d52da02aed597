#include "check/rewrite.h"

#include <fmt/format.h>

#include <functional>
#include <map>
#include <utility>

#include "check/limit.h"

namespace heatsoak::check {
namespace {

/// Returns the byte offset of a place given in characters; npos if the text has no such place.
std::size_t byte_at(std::string_view content, const base::Location& at) {
  std::size_t i = 0;
  for (int line = 1; line < at.line.value(); ++line) {
    i = content.find('\n', i);
    if (i == std::string_view::npos) {
      return i;
    }
    ++i;
  }
  for (int column = 1; column < at.column.value() && i < content.size(); ++column) {
    ++i;
    while (i < content.size() && (static_cast<unsigned char>(content[i]) & 0xC0U) == 0x80U) {
      ++i;
    }
  }
  return i;
}

}  // namespace

std::string with_new_limits(const std::string& content, std::span<Outcome> outcomes, double margin_share) {
  // Maps begin to length and text. Descending order, so that a replacement does not move the places still to be replaced.
  std::map<std::size_t, std::pair<std::size_t, std::string>, std::greater<>> by_place;
  for (Outcome& outcome : outcomes) {
    if (!outcome.measured) {
      continue;
    }
    Limit& limit = outcome.limit;
    if (outcome.measured->is_never) {
      outcome.not_rewritten = outcome.passed() ? std::nullopt : std::optional<NotRewritten>(NoTimeSuffices{});
      continue;
    }
    const std::string text = updated_limit(*outcome.measured, *limit.type, limit.unit, margin_share);
    const ParsedLimit parsed = parse_limit(text, *limit.type);
    if (parsed.problem) {
      outcome.not_rewritten = LimitInvalid{*parsed.problem};
      continue;
    }
    if (limit.value == 0.0 && outcome.passed() && !keeps(limit.type->direction, parsed.value, 0.0)) {
      continue;  // "never" must not become "a little" unnoticed
    }
    if (std::optional<Looseness> found = looseness(parsed.value, text, *limit.type, *outcome.check)) {
      // The limit is not changed, so that a motor above its own limit still fails.
      outcome.not_rewritten = std::move(*found);
      continue;
    }
    if (text == limit.text) {
      continue;
    }
    const std::size_t begin = byte_at(content, limit.at);
    const bool is_plain = begin != std::string::npos && begin < content.size() && (content[begin] == '"' || content[begin] == '\'') &&
                          content.compare(begin + 1, limit.text.size(), limit.text) == 0 &&
                          content.compare(begin + 1 + limit.text.size(), 1, content, begin, 1) == 0;
    if (!is_plain) {
      throw base::bad_input(limit.at, std::string(limit.type->name),
                            fmt::format("cannot be rewritten in place; write it as \"{}\" on one line without escapes", limit.text));
    }
    by_place[begin + 1] = {limit.text.size(), text};
    outcome.before = limit.text;
    outcome.failed_before = !outcome.passed();
    limit.text = text;
    limit.value = parsed.value;
  }
  std::string result = content;
  for (const auto& [begin, replacement] : by_place) {
    result.replace(begin, replacement.first, replacement.second);
  }
  return result;
}

}  // namespace heatsoak::check
