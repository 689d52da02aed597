// Parts of the JSON answers that all verbs share.
#pragma once

#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>

#include "base/diagnostic.h"

namespace heatsoak::present {

using Json = nlohmann::ordered_json;
struct Note;

/// Returns a JSON number rounded to `decimals`, or null for NaN and infinity.
Json rounded(double value, int decimals);
/// Returns a JSON number rounded to `decimals`, or null without a value.
Json rounded(const std::optional<double>& value, int decimals);

/// Adds the key "never": those of the keys whose null means that the event never happens. `check` reads it.
void add_never(Json& json, std::initializer_list<const char*> keys);

/// Adds the keys "notes", the words of all notes, and "warnings", the words of those with the severity warning.
void add_notes(Json& json, std::span<const Note> notes);

/// Returns the JSON as lines of text. Bytes that are not UTF-8 become U+FFFD.
std::string json_text(const Json& json);

/// Returns the answer of a command that failed.
Json failure_json(const base::Failure& failure);

}  // namespace heatsoak::present
