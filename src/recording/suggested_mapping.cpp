#include "recording/suggested_mapping.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include "base/quantity.h"
#include "base/unit_names.h"
#include "input/toml_text.h"
#include "recording/quantities.h"

namespace heatsoak::recording {
namespace {

/// Name of a column without its unit, in the form of a quantity's name, and its unit; `number` is that of a wheel.
struct ColumnName {
  std::string stem;
  std::string unit;
  std::string number;
};

/// A quantity that a column contains, with the unit of the column; no unit: that of the quantity.
struct MappedColumn {
  std::string key;
  std::string unit;
};

/// Converts "Winding temp" to "winding".
std::string stem_of(std::string_view words) {
  std::string stem;
  for (const char c : words) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0) {
      stem += static_cast<char>(std::tolower(byte));
    } else if (!stem.empty() && stem.back() != '_') {
      stem += '_';
    }
  }
  stem.erase(stem.find_last_not_of('_') + 1);
  for (const std::string_view end : {"_temperature", "_temp"}) {
    if (stem.ends_with(end)) {
      stem.resize(stem.size() - end.size());
    }
  }
  return stem == "t" ? "time" : stem;
}

/// Returns the possible readings of a name: "winding [degF]", and "speed_rad_per_s" as speed in rad/s or as speed_rad in 1/s.
std::vector<ColumnName> readings_of(const std::string& name) {
  const std::size_t open = name.find_first_of("[(");
  if (open != std::string::npos && open > 0 && (name.back() == ']' || name.back() == ')')) {
    return {{stem_of(std::string_view(name).substr(0, open)), name.substr(open + 1, name.size() - open - 2), ""}};
  }
  std::string body = name;
  std::string number;
  if (const std::size_t last = name.find_last_not_of("0123456789");
      last != std::string::npos && last > 0 && last + 1 < name.size() && name[last] == '_') {
    number = name.substr(last);
    body = name.substr(0, last);
  }
  std::vector<ColumnName> all;
  for (std::size_t at = body.find('_', 1); at != std::string::npos && at + 1 < body.size(); at = body.find('_', at + 1)) {
    std::string unit = body.substr(at + 1);
    constexpr std::string_view kPer = "_per_";
    for (std::size_t per = unit.find(kPer); per != std::string::npos; per = unit.find(kPer)) {
      unit.replace(per, kPer.size(), "/");
    }
    all.push_back({stem_of(body.substr(0, at)), unit, number});
  }
  return all;
}

/// Returns the text of the unit that the mapping states; nothing if it does not convert to `wanted`.
std::optional<std::string> unit_text(const std::string& unit, std::string_view wanted) {
  for (const std::string& each : {unit, "deg" + unit, unit == "percent" || unit == "pct" ? std::string("%") : unit}) {
    if (base::parse_quantity("1 " + each, wanted).ok()) {
      return each;
    }
  }
  return std::nullopt;
}

/// Returns the quantity of the table that the column contains.
std::optional<MappedColumn> known_quantity(const std::string& name) {
  if (const std::optional<Quantity> same = quantity_named(name); same && !same->meaning.empty()) {
    return MappedColumn{same->key, ""};
  }
  for (const ColumnName& reading : readings_of(name)) {
    for (const QuantityType& type : quantity_types()) {
      const std::optional<base::UnitOfName> of_type = base::unit_of_name(type.key);
      if (!of_type || of_type->quantity != reading.stem || type.is_numbered == reading.number.empty()) {
        continue;
      }
      if (const std::optional<std::string> unit = unit_text(reading.unit, type.unit)) {
        return MappedColumn{std::string(type.key) + reading.number, *unit};
      }
    }
  }
  return std::nullopt;
}

std::string entry(std::string_view key, const std::string& name, std::string_view unit) {
  return fmt::format("{} = {{ column = {}{} }}\n", key, input::toml_text(name),
                     unit.empty() ? "" : fmt::format(", unit = {}", input::toml_text(unit)));
}

bool is_bare_key(std::string_view key) {
  return std::ranges::all_of(key, [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; });
}

}  // namespace

std::string suggested_mapping(std::span<const std::string> header) {
  std::string mapped;
  std::string others;
  std::set<std::string> keys;
  for (const std::string& name : header) {
    std::optional<MappedColumn> column = known_quantity(name);
    if (!column && quantity_named(name) && is_bare_key(name)) {
      column = MappedColumn{name, ""};
    }
    if (column && keys.insert(column->key).second) {
      mapped += entry(column->key, name, column->unit);
    } else {
      others += "# " + entry("?", name, "?");
    }
  }
  return "# Quantities and units: docs/file_formats.md\n[quantities]\n" +
         (keys.contains("time_s") ? "" : std::string("# Required: time_s = { column = \"?\", unit = \"s\" }\n")) + mapped +
         (others.empty() ? "" : "# Columns that are not mapped: replace \"?\" and remove the #, or delete the line.\n" + others);
}

}  // namespace heatsoak::recording
