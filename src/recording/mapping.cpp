#include "recording/mapping.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fnmatch.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/quantity.h"
#include "input/document.h"
#include "input/reader.h"

namespace heatsoak::recording {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 3> kConventions{"held", "linear", "previous_interval"};
constexpr std::array<std::string_view, 2> kSigns{"+", "-"};
constexpr std::array<std::string_view, 2> kDecimals{".", ","};
/// Keys of a quantity whose meaning depends on its unit.
constexpr std::array<std::string_view, 4> kKeysWithUnit{"sign", "saturates_low", "saturates_high", "fill"};

bool matches(const std::string& pattern, const fs::path& log) { return ::fnmatch(pattern.c_str(), log.filename().c_str(), 0) == 0; }

std::optional<int> whole_number(input::Reader& reader, const char* key, int lowest, int highest, const char* meaning) {
  const std::optional<double> value = reader.quantity(
      {key, "", base::Range::between(static_cast<double>(lowest), static_cast<double>(highest)), meaning}, input::Need::optional);
  if (value && *value != std::floor(*value)) {
    reader.problem(key, "is not a whole number");
    return std::nullopt;
  }
  return value ? std::optional(static_cast<int>(*value)) : std::nullopt;
}

input::TableFormat read_format(input::Reader& file) {
  input::TableFormat format;
  if (const std::optional<std::string> separator = file.text("separator", input::Need::optional)) {
    if (*separator == "tab") {
      format.separator = '\t';
    } else if (separator->size() == 1 && std::string_view("\"\n\r.#+-").find(*separator) == std::string_view::npos) {
      format.separator = separator->front();
    } else {
      file.problem("separator",
                   fmt::format(R"('{}' cannot separate cells; expected one character such as "," or ";", or "tab")", *separator));
    }
  }
  if (const std::optional<std::string> decimal = file.choice("decimal", kDecimals, input::Need::optional)) {
    format.decimal_point = decimal->front();
    if (format.decimal_point == format.separator) {
      file.problem("decimal", "is also the separator of the cells");
    }
  }
  format.comment = file.text("comment", input::Need::optional).value_or(format.comment);
  format.header_rows = whole_number(file, "header_rows", 1, 20, "number of rows of the header").value_or(format.header_rows);
  format.names_row = whole_number(file, "names_row", 1, 20, "row of the header that names the columns").value_or(1);
  if (format.names_row > format.header_rows) {
    file.problem("names_row", fmt::format("{} is not one of the {} header rows", format.names_row, format.header_rows));
  }
  file.finish();
  return format;
}

/// Reads unit and sign into value and scale_factor. Returns false if the unit is unknown, so that no other value can be read with it.
bool read_unit(input::Reader& reader, QuantityMapping& mapping) {
  const std::string& wanted = mapping.quantity.unit;
  const std::string unit = reader.text("unit", input::Need::optional).value_or(wanted);
  const base::ParsedQuantity zero = base::parse_quantity("0 " + unit, wanted);
  const base::ParsedQuantity one = base::parse_quantity("1 " + unit, wanted);
  if (!zero.ok() || !one.ok()) {
    reader.problem("unit", fmt::format("'{}' is not a unit of {}; expected one that converts to {}", unit, mapping.quantity.key,
                                       wanted.empty() ? "a pure number" : wanted));
    std::ranges::for_each(kKeysWithUnit, [&reader](std::string_view key) { reader.pass_over(key); });
    return false;
  }
  mapping.value = zero.value;
  mapping.scale_factor = one.value - zero.value;
  if (reader.choice("sign", kSigns, input::Need::optional).value_or("+") == "-") {
    if (wanted == "degC") {
      reader.problem("sign", "a temperature has no sign; expected no key sign");
    }
    mapping.value = -mapping.value;
    mapping.scale_factor = -mapping.scale_factor;
  }
  return true;
}

std::optional<double> limit(input::Reader& reader, const char* key, const QuantityMapping& mapping) {
  return reader.quantity({key, mapping.quantity.unit, base::Range::any(), "value at which the sensor saturates"}, input::Need::optional);
}

void read_fills(input::Reader& reader, QuantityMapping& mapping) {
  for (input::Reader& fill : reader.tables("fill")) {
    const std::optional<double> value =
        fill.quantity({"value", mapping.quantity.unit, mapping.quantity.possible, "value of a blank cell"}, input::Need::required);
    const std::optional<std::string> where = fill.text("where", input::Need::required);
    if (value && where) {
      mapping.fills.push_back({*value, *where});
    }
    fill.finish();
  }
}

std::optional<QuantityMapping> read_quantity(const std::string& key, input::Reader& reader) {
  const std::optional<Quantity> quantity = quantity_named(key);
  if (!quantity) {
    reader.problem("",
                   fmt::format("is not a quantity: it is not in the table, and its name does not end in a unit{}", nearest_quantity(key)));
    return std::nullopt;
  }
  QuantityMapping mapping;
  mapping.quantity = *quantity;
  mapping.at = reader.at("");
  for (const std::string& part : reader.keys()) {
    mapping.places[part] = reader.at(part);
  }
  mapping.column = reader.text("column", input::Need::optional).value_or("");
  mapping.expression = reader.text("expression", input::Need::optional).value_or("");
  if (mapping.column.empty() == mapping.expression.empty()) {
    reader.problem("", "expected one of column = \"…\" and expression = \"…\"");
  }
  const bool has_unit = read_unit(reader, mapping);
  mapping.valid = reader.text("valid", input::Need::optional).value_or("");
  if (has_unit) {
    mapping.saturates_low = limit(reader, "saturates_low", mapping);
    mapping.saturates_high = limit(reader, "saturates_high", mapping);
    read_fills(reader, mapping);
  }
  mapping.is_optional = reader.flag("optional", input::Need::optional).value_or(false);
  if (mapping.is_optional && mapping.column.empty()) {
    reader.problem("optional", "expected for a column only");
  }
  mapping.clock_offset_s = reader
                               .quantity({"clock_offset", "s", base::Range::between(-3600.0, 3600.0),
                                          "offset of this channel's clock: time of its sample minus time of the row"},
                                         input::Need::optional)
                               .value_or(0.0);
  if (quantity->kind == QuantityKind::time && (mapping.clock_offset_s != 0.0 || !mapping.fills.empty())) {
    reader.problem("", "the time has no clock_offset and no fill");
  }
  reader.finish();
  return mapping;
}

void read_conditions(input::Reader& table, std::map<std::string, std::string>& conditions) {
  for (const std::string& key : table.keys()) {
    if (const std::optional<std::string> text = table.text(key, input::Need::required)) {
      conditions[key] = *text;
    }
  }
}

/// Applies the [[files]] entries for this log. Returns true if there is any.
bool read_files(input::Reader& root, const fs::path& log, Mapping& mapping) {
  bool is_named = false;
  std::map<std::pair<std::string, std::string>, std::string> said;  // values that entries gave, by log name and condition
  for (input::Reader& file : root.tables("files")) {
    const std::string name = file.text("name", input::Need::required).value_or("");
    std::map<std::string, std::string> conditions;
    const std::optional<std::string> motor = file.text("motor", input::Need::optional);
    if (std::optional<input::Reader> table = file.table("conditions", input::Need::optional)) {
      read_conditions(*table, conditions);
      for (const auto& [key, text] : conditions) {
        if (const auto& [before, is_new] = said.try_emplace({name, key}, text); !is_new && before->second != text) {
          table->problem(key, fmt::format("contradicts \"{}\", which another [[files]] states for {}", before->second, name));
        }
      }
    }
    if (matches(name, log)) {
      is_named = true;
      mapping.motor = motor.value_or(mapping.motor);
      for (auto& [key, text] : conditions) {
        mapping.conditions[key] = text;
      }
    }
    file.finish();
  }
  return is_named;
}

void read_quantities(input::Reader& root, Mapping& mapping) {
  std::optional<input::Reader> table = root.table("quantities", input::Need::required);
  if (!table) {
    return;
  }
  bool is_any_unknown = false;
  for (auto& [key, reader] : table->named_tables()) {
    std::optional<QuantityMapping> quantity = read_quantity(key, reader);
    is_any_unknown = is_any_unknown || !quantity;
    if (quantity) {
      mapping.quantities.push_back(*std::move(quantity));
    }
  }
  const auto is_time = [](const QuantityMapping& each) { return each.quantity.kind == QuantityKind::time; };
  // An unknown quantity may be the misspelt time.
  if (!is_any_unknown && std::ranges::none_of(mapping.quantities, is_time)) {
    table->problem("", "has no time_s, which every log needs");
  }
}

}  // namespace

base::Location QuantityMapping::place_of(const std::string& part) const {
  const auto found = places.find(part);
  return found == places.end() ? at : found->second;
}

Mapping read_mapping(const fs::path& file, const fs::path& log) {
  const input::Value document = input::read_toml(file);
  base::Diagnostics problems;
  input::Reader root(document, "", problems);
  Mapping mapping;
  mapping.file = file;
  root.text("summary", input::Need::optional);
  mapping.motor = root.text("motor", input::Need::optional).value_or("");
  if (std::optional<input::Reader> conditions = root.table("conditions", input::Need::optional)) {
    read_conditions(*conditions, mapping.conditions);
  }
  if (std::optional<input::Reader> format = root.table("file", input::Need::optional)) {
    mapping.format = read_format(*format);
  }
  if (std::optional<input::Reader> rows = root.table("rows", input::Need::optional)) {
    mapping.valid = rows->text("valid", input::Need::required).value_or("");
    mapping.valid_at = rows->at("valid");
    rows->finish();
  }
  if (std::optional<input::Reader> runs = root.table("runs", input::Need::optional)) {
    mapping.run_column = runs->text("column", input::Need::optional).value_or("");
    mapping.run_column_at = runs->at("column");
    mapping.longest_gap_s =
        runs->quantity({"longest_gap", "s", base::Range::positive(), "longest gap between two rows of one run"}, input::Need::optional);
    runs->finish();
  }
  const std::string convention = root.choice("inputs", kConventions, input::Need::optional).value_or("held");
  mapping.inputs = static_cast<InputConvention>(std::ranges::find(kConventions, convention) - kConventions.begin());
  read_quantities(root, mapping);
  const std::vector<std::string> patterns =
      document.find("applies_to") != nullptr ? root.texts("applies_to", input::Need::required) : std::vector<std::string>{"*"};
  const bool is_named = read_files(root, log, mapping);
  if (!is_named && std::ranges::none_of(patterns, [&log](const std::string& pattern) { return matches(pattern, log); })) {
    root.problem("applies_to",
                 fmt::format("{} is not one of the files of this mapping: {}", log.filename().string(), fmt::join(patterns, ", ")));
  }
  root.finish();
  problems.throw_if_any();
  return mapping;
}

Mapping mapping_for(const fs::path& log, const fs::path& chosen) {
  if (!chosen.empty()) {
    return read_mapping(chosen, log);
  }
  for (const fs::path& beside : {fs::path(log.string() + ".map.toml"), fs::path(log).replace_extension(".map.toml")}) {
    std::error_code ignored;
    if (fs::exists(beside, ignored)) {
      return read_mapping(beside, log);
    }
  }
  return {};
}

}  // namespace heatsoak::recording
