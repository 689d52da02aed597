#include "input/reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/quantity.h"

namespace heatsoak::input {

namespace {

std::string out_of_range(std::string_view text, const base::ParameterSpec& spec) {
  return fmt::format(R"("{}" is out of range; expected {} ({}))", text, base::to_string(spec.range, spec.unit), spec.meaning);
}

/// NaN and infinity: TOML accepts them as numbers, but they cannot be quantities.
bool is_no_quantity(std::string_view number) {
  return number.find("nan") != std::string_view::npos || number.find("inf") != std::string_view::npos;
}

}  // namespace

Reader::Reader(const Value& table, std::string path, base::Diagnostics& diagnostics)
    : table_(&table), path_(std::move(path)), diagnostics_(&diagnostics) {}

std::string Reader::full(std::string_view key) const {
  return path_.empty() ? std::string(key) : key.empty() ? path_ : fmt::format("{}.{}", path_, key);
}

void Reader::add(const base::Diagnostic& found) { diagnostics_->add(found.at, found.key, found.message); }

base::Location Reader::at(std::string_view key) const {
  const Value* value = table_->find(key);
  return value ? value->at : table_->at;
}

std::vector<std::string> Reader::keys() const {
  std::vector<std::string> names;
  for (const Member& member : table_->members) {
    names.push_back(member.key);
  }
  return names;
}

void Reader::problem(std::string_view key, std::string message) { diagnostics_->add(at(key), full(key), std::move(message)); }

const Value* Reader::get(std::string_view key, Value::Kind kind, Need need) {
  asked_.insert(std::string(key));
  const Value* value = table_->find(key);
  if (!value) {
    if (need == Need::required) {
      problem(key, "is missing");
    }
    return nullptr;
  }
  if (value->kind != kind) {
    const bool bare_number = kind == Value::Kind::text && value->kind == Value::Kind::number;
    const bool lacks_brackets = kind == Value::Kind::array && value->kind == Value::Kind::text;
    problem(key, lacks_brackets ? fmt::format("is a text, expected a list: [\"{}\"]", value->text)
                 : bare_number && is_no_quantity(value->text)
                     ? fmt::format("{} is no quantity; expected a number with its unit, as text", value->text)
                 : bare_number ? fmt::format("{} is a bare number; expected text, in quotes: \"{}\"", value->text, value->text)
                               : fmt::format("is {}, expected {}", to_string(value->kind), to_string(kind)));
    return nullptr;
  }
  return value;
}

std::optional<std::string> Reader::text(std::string_view key, Need need) {
  const Value* value = get(key, Value::Kind::text, need);
  if (value && value->text == "?") {
    problem(key, "is still \"?\", as in the template; expected a value, or no line");
    return std::nullopt;
  }
  return value ? std::optional(value->text) : std::nullopt;
}

std::optional<bool> Reader::flag(std::string_view key, Need need) {
  const Value* value = get(key, Value::Kind::boolean, need);
  return value ? std::optional(value->boolean) : std::nullopt;
}

std::vector<std::string> Reader::texts(std::string_view key, Need need) {
  std::vector<std::string> result;
  const Value* value = get(key, Value::Kind::array, need);
  for (const Value& item : value ? value->items : std::vector<Value>{}) {
    if (item.kind == Value::Kind::text) {
      result.push_back(item.text);
    } else {
      diagnostics_->add(item.at, full(key), fmt::format("holds {}, expected texts", to_string(item.kind)));
    }
  }
  return result;
}

std::optional<std::string> Reader::choice(std::string_view key, std::span<const std::string_view> choices, Need need) {
  const std::vector<std::string> names(choices.begin(), choices.end());
  const std::string expected = fmt::format("{}{}", names.size() > 1 ? "one of " : "", fmt::join(names, ", "));
  if (const Value* value = table_->find(key); value && value->kind != Value::Kind::text) {
    pass_over(key);
    problem(key, fmt::format("is {}, expected {}", to_string(value->kind), expected));
    return std::nullopt;
  }
  std::optional<std::string> given = text(key, need);
  if (given && std::ranges::find(choices, *given) == choices.end()) {
    problem(key, fmt::format("'{}' is not known; expected {}{}", *given, expected, base::did_you_mean(*given, names)));
    return std::nullopt;
  }
  return given;
}

std::optional<double> Reader::parse(const Value& value, std::string_view key, const base::ParameterSpec& spec) {
  const std::string_view unit = spec.unit;
  if (value.kind != Value::Kind::text) {
    diagnostics_->add(value.at, full(key),
                      value.kind == Value::Kind::number && is_no_quantity(value.text)
                          ? fmt::format("{} is no quantity; expected a number with its unit as text, \"1.5{}{}\"", value.text,
                                        unit.empty() ? "" : " ", unit)
                      : value.kind == Value::Kind::number ? fmt::format("{} is a bare number; write it as text with its unit, \"{}{}{}\"",
                                                                        value.text, value.text, unit.empty() ? "" : " ", unit)
                                                          : fmt::format("is {}, expected a quantity as text", to_string(value.kind)));
    return std::nullopt;
  }
  const base::ParsedQuantity parsed = base::parse_quantity(value.text, unit, spec.is_share());
  if (!parsed.ok()) {
    diagnostics_->add(value.at, full(key), parsed.problem);
    return std::nullopt;
  }
  return parsed.value;
}

const Value* Reader::find(const base::ParameterSpec& spec, Need need) {
  asked_.insert(std::string(spec.key));
  const Value* value = table_->find(spec.key);
  if (!value && need == Need::required) {
    problem(spec.key, fmt::format("is missing ({})", spec.meaning));
  }
  return value;
}

std::optional<double> Reader::quantity(const base::ParameterSpec& spec, Need need) {
  const Value* value = find(spec, need);
  if (!value) {
    return std::nullopt;
  }
  const std::optional<double> parsed = parse(*value, spec.key, spec);
  if (parsed && !spec.range.contains(*parsed)) {
    problem(spec.key, out_of_range(value->text, spec));
    return std::nullopt;
  }
  return parsed;
}

std::vector<double> Reader::quantities(const base::ParameterSpec& spec, Need need) {
  std::vector<double> result;
  const Value* list = get(spec.key, Value::Kind::array, need);
  for (std::size_t i = 0; list && i < list->items.size(); ++i) {
    const Value& item = list->items[i];
    const std::string key = fmt::format("{}[{}]", spec.key, i);
    const std::optional<double> parsed = parse(item, key, spec);
    const bool is_good = parsed && spec.range.contains(*parsed);
    if (parsed && !is_good) {
      diagnostics_->add(item.at, full(key), out_of_range(item.text, spec));
    }
    result.push_back(is_good ? *parsed : 0.0);
  }
  return result;
}

std::optional<Reader> Reader::table(std::string_view key, Need need) {
  const Value* value = get(key, Value::Kind::table, need);
  return value ? std::optional<Reader>(std::in_place, *value, full(key), *diagnostics_) : std::nullopt;
}

std::vector<Reader> Reader::tables(std::string_view key) {
  std::vector<Reader> readers;
  if (const Value* value = get(key, Value::Kind::array, Need::optional)) {
    for (std::size_t i = 0; i < value->items.size(); ++i) {
      if (value->items[i].kind == Value::Kind::table) {
        readers.emplace_back(value->items[i], fmt::format("{}[{}]", full(key), i), *diagnostics_);
      } else {
        diagnostics_->add(value->items[i].at, full(key), "holds something else than tables");
      }
    }
  }
  return readers;
}

std::vector<std::pair<std::string, Reader>> Reader::named_tables() {
  std::vector<std::pair<std::string, Reader>> result;
  for (const std::string& key : keys()) {
    if (std::optional<Reader> member = table(key, Need::required)) {
      result.emplace_back(key, std::move(*member));
    }
  }
  return result;
}

std::optional<base::ParameterValue> Reader::parameter(const base::ParameterSpec& spec, Need need) {
  const Value* value = find(spec, need);
  if (!value) {
    return std::nullopt;
  }
  if (value->kind != Value::Kind::table) {
    problem(spec.key,
            fmt::format("is {}; expected {{ value = \"… {}\", origin = \"…\", source = \"…\" }}", to_string(value->kind), spec.unit));
    return std::nullopt;
  }
  Reader inner(*value, full(spec.key), *diagnostics_);
  base::ParameterValue parameter;
  parameter.at = value->at;
  const std::optional<double> parsed = inner.quantity({"value", spec.unit, spec.range, spec.meaning}, Need::required);
  const std::optional<std::string> origin = inner.text("origin", Need::required);
  if (origin) {
    const std::optional<base::Origin> known = base::origin_from(*origin);
    if (!known) {
      inner.problem("origin", fmt::format("'{}' is not known; expected measured, datasheet, third_party, derived or estimated", *origin));
    }
    parameter.origin = known.value_or(base::Origin::estimated);
  }
  const bool has_origin = origin && base::origin_from(*origin);  // without a valid origin the other required keys are unknown
  const bool calculated = parameter.origin == base::Origin::derived || parameter.origin == base::Origin::estimated;
  parameter.derivation = inner.text("derivation", has_origin && calculated ? Need::required : Need::optional).value_or("");
  const Value* source = value->find("source");
  if (source && source->kind == Value::Kind::array) {
    parameter.source = fmt::format("{}", fmt::join(inner.texts("source", Need::required), ", "));
  } else {
    parameter.source = inner.text("source", calculated ? Need::optional : Need::required).value_or("");
  }
  // An empty source would give the value an origin that nobody can check.
  if (source && parameter.source.empty() && (source->kind == Value::Kind::text || source->items.empty())) {
    inner.problem("source", "is empty; expected ids of [sources]");
  }
  if (value->find("derivation") && value->find("derivation")->kind == Value::Kind::text && parameter.derivation.empty()) {
    inner.problem("derivation", "is empty; expected how the value was found");
  }
  if (parsed) {
    parameter.value = *parsed;
    parameter.printed = value->find("value")->text;
  } else {
    parameter.value = std::numeric_limits<double>::quiet_NaN();
  }
  inner.read_spread(spec, parameter);
  inner.read_confirmations(spec, parameter);
  inner.finish();
  return parsed && origin ? std::optional(parameter) : std::nullopt;
}

void Reader::read_confirmations(const base::ParameterSpec& spec, base::ParameterValue& parameter) {
  std::optional<Reader> others = table("confirmed_by", Need::optional);
  if (!others) {
    return;
  }
  for (const std::string& source : others->keys()) {
    if (const std::optional<double> value = others->quantity({source, spec.unit, spec.range, spec.meaning}, Need::required)) {
      parameter.confirmed_by.push_back({source, *value, others->table_->find(source)->text});
    }
  }
}

void Reader::read_spread(const base::ParameterSpec& spec, base::ParameterValue& parameter) {
  const bool is_temperature = spec.unit == "degC";
  asked_.insert({"tolerance", "range"});
  const Value* range = table_->find("range");
  if (table_->find("tolerance")) {
    if (range) {
      problem("range", "stands beside a tolerance; expected one of them");
    }
    const std::optional<double> share =
        quantity({"tolerance", is_temperature ? "K" : "", base::Range::between(0.0, is_temperature ? 100.0 : 0.9),
                  "± part of the value that no part exceeds"},
                 Need::required);
    if (share) {
      const double half = is_temperature ? *share : *share * std::abs(parameter.value);
      const base::Spread spread{base::Spread::Kind::tolerance, parameter.value - half, parameter.value + half, !is_temperature};
      // A value that is missing or outside has its own problem.
      if (spec.range.contains(parameter.value) && !(spec.range.contains(spread.low) && spec.range.contains(spread.high))) {
        problem(
            "tolerance",
            fmt::format("reaches {}, beyond the possible range; expected {}; give a smaller tolerance, or a range in place of it",
                        base::to_string(base::Range::between(spread.low, spread.high), spec.unit), base::to_string(spec.range, spec.unit)));
        return;
      }
      parameter.spread = spread;
    }
    return;
  }
  if (!range) {
    return;
  }
  if (range->kind != Value::Kind::array || range->items.size() != 2) {
    problem("range", fmt::format(R"(expected ["lowest {}", "highest {}"])", spec.unit, spec.unit));
    return;
  }
  const std::optional<double> low = parse(range->items[0], "range", spec);
  const std::optional<double> high = parse(range->items[1], "range", spec);
  if (!low || !high) {
    return;
  }
  // Without a value, which has its own problem, only the range itself is checked.
  const bool is_inside = std::isnan(parameter.value) ? *low <= *high : *low <= parameter.value && parameter.value <= *high;
  if (!is_inside) {
    problem("range", "does not enclose the value; expected lowest ≤ value ≤ highest");
  } else if (!spec.range.contains(*low) || !spec.range.contains(*high)) {
    problem("range", fmt::format("is outside the possible range; expected {}", base::to_string(spec.range, spec.unit)));
  } else {
    parameter.spread = {base::Spread::Kind::range, *low, *high, !is_temperature && *low > 0.0};
  }
}

void Reader::finish() {
  constexpr std::size_t kMostListed = 20;
  const std::vector<std::string> known(asked_.begin(), asked_.end());
  for (const auto& [key, value] : table_->members) {
    if (!asked_.contains(key)) {
      std::string advice = base::did_you_mean(key, known);
      if (advice.empty() && known.size() <= kMostListed) {
        advice = fmt::format("; expected one of {}", fmt::join(known, ", "));
      }
      diagnostics_->add(value.at, full(key), fmt::format("is not a key of this table{}", advice));
    }
  }
}

}  // namespace heatsoak::input
