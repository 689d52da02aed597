#include "check/answer_number.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>

#include "base/number_ranges.h"
#include "base/unit_names.h"
#include "check/not_evaluated.h"

namespace heatsoak::check {
namespace {

using Json = nlohmann::ordered_json;

/// Groups that have one member per signal, such as error.winding_C. The unit in the name of such a member is that of the signal. The
/// numbers inside the member have other units.
constexpr std::array<std::string_view, 7> kBySignal{"coverage_90",          "error",          "error_before",  "holdout_error",
                                                    "holdout_error_before", "left_out_error", "residual_tests"};

constexpr std::string_view kInterval = "ci95";

/// Key of a list in a JSON object. A null is a time that never comes if the list has its key.
constexpr const char* kNever = "never";

struct Child {
  std::string name;
  const Json* value = nullptr;
};

/// Returns the name of a list element: its first value if that is a text or an integer, otherwise its place.
std::string element_name(const Json& element, std::size_t place) {
  if (element.is_object() && !element.empty()) {
    const Json& first = element.begin().value();
    if (first.is_string()) {
      return first.get<std::string>();
    }
    if (first.is_number_integer()) {
      return first.dump();
    }
  }
  return std::to_string(place);
}

std::vector<Child> children_of(const Json& group) {
  std::vector<Child> all;
  if (group.is_object()) {
    for (const auto& [key, value] : group.items()) {
      if (key != base::kNumberRanges) {
        all.push_back({key, &value});
      }
    }
  } else if (group.is_array()) {
    for (std::size_t i = 0; i < group.size(); ++i) {
      all.push_back({element_name(group[i], i), &group[i]});
    }
  }
  return all;
}

/// Returns each name once.
std::vector<std::string> names_of(const std::vector<Child>& children) {
  std::vector<std::string> names;
  for (const Child& each : children) {
    if (std::ranges::find(names, each.name) == names.end()) {
      names.push_back(each.name);
    }
  }
  return names;
}

/// Keys from the top to a value, and the groups that hold them.
struct Trail {
  std::vector<std::string> keys;
  std::vector<const Json*> groups;

  [[nodiscard]] std::string name() const { return fmt::format("{}", fmt::join(keys, ".")); }
};

/// Returns the unit that an object gives for its member `key`: "driver_unit" beside "driver", else "unit".
std::optional<std::string> unit_beside(const Json& group, const std::string& key) {
  for (const std::string& name : {key + "_unit", std::string("unit")}) {
    if (const auto beside = group.find(name); beside != group.end() && beside->is_string()) {
      return beside->get<std::string>();
    }
  }
  return std::nullopt;
}

/// Returns the index of the key that names a signal: the first key below a group of kBySignal that ends in a unit. Empty if there is none.
std::optional<std::size_t> place_of_signal(const std::vector<std::string>& keys) {
  const auto group =
      std::ranges::find_if(keys, [](const std::string& key) { return std::ranges::find(kBySignal, key) != kBySignal.end(); });
  const auto signal = std::find_if(group, keys.end(), [](const std::string& key) { return base::unit_of_name(key).has_value(); });
  return signal == keys.end() ? std::nullopt : std::optional(static_cast<std::size_t>(signal - keys.begin()));
}

/// Returns the unit of the innermost key that states one, in its own name or in a key beside it. The search ends at an object in a list,
/// because the name of the list does not state the unit of the object's numbers. It also ends at the name of a signal.
std::string unit_at(const Trail& trail) {
  const std::optional<std::size_t> signal = place_of_signal(trail.keys);
  for (std::size_t i = trail.keys.size(); i-- > 0;) {
    const Json& group = *trail.groups[i];
    if (signal == i || (group.is_array() && group.front().is_object())) {
      return {};
    }
    if (group.is_array()) {
      continue;
    }
    if (const std::optional<base::UnitOfName> own = base::unit_of_name(trail.keys[i])) {
      return own->unit;
    }
    if (const std::optional<std::string> beside = unit_beside(group, trail.keys[i])) {
      return *beside;
    }
  }
  return {};
}

/// Returns the 95 % interval of the number `key`: "ci95" beside "value", "p95_ci95" beside "p95", "probability_ci95" beside
/// "probability_over_limit".
std::optional<AnswerInterval> interval_of(const Json& group, std::string_view key) {
  for (const Child& each : group.is_object() ? children_of(group) : std::vector<Child>()) {
    const std::string_view name = each.name;
    if (name == key || !name.ends_with(kInterval) || !each.value->is_array() || each.value->size() != 2) {
      continue;
    }
    const std::string_view stem = name.substr(0, name.size() - kInterval.size());
    const bool is_of_key = stem.empty() ? key == "value" : stem.ends_with('_') && fmt::format("{}_", key).starts_with(stem);
    if (is_of_key) {
      const auto end = [&](std::size_t i) {
        const Json& value = (*each.value)[i];
        return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
      };
      return AnswerInterval{end(0), end(1)};
    }
  }
  return std::nullopt;
}

/// Returns the range that the innermost declaration of a key on the trail gives.
base::Range possible_at(const Trail& trail, bool is_whole) {
  for (std::size_t i = trail.groups.size(); i-- > 0;) {
    const Json& group = *trail.groups[i];
    const auto declared = group.is_object() ? group.find(base::kNumberRanges) : group.end();
    if (declared == group.end()) {
      continue;
    }
    for (std::size_t k = trail.keys.size(); k-- > i;) {
      if (const auto range = declared->find(trail.keys[k]); range != declared->end()) {
        constexpr double kNone = std::numeric_limits<double>::infinity();
        const auto end = [&](std::size_t place, double none) { return (*range)[place].is_number() ? (*range)[place].get<double>() : none; };
        return base::Range::between(end(0, -kNone), end(1, kNone));
      }
    }
  }
  return is_whole ? base::Range::non_negative() : base::Range::any();
}

bool is_never(const Json& group, const std::string& key) {
  const auto keys = group.is_object() ? group.find(kNever) : group.end();
  return keys != group.end() && std::ranges::find(*keys, Json(key)) != keys->end();
}

AnswerNumber number_of(const Trail& trail, const Json& value) {
  const std::string name = trail.name();
  if (value.is_object() || value.is_array()) {
    throw NotEvaluated(NumberIsGroup{name, names_of(children_of(value))});
  }
  if (value.is_null() && is_never(*trail.groups.back(), trail.keys.back())) {
    return {.name = name, .value = std::numeric_limits<double>::infinity(), .unit = unit_at(trail), .possible = possible_at(trail, false)};
  }
  if (value.is_null()) {
    throw NotEvaluated(NumberIsNull{name});
  }
  if (!value.is_number()) {
    throw NotEvaluated(NumberIsOther{name, value.dump(-1, ' ', false, Json::error_handler_t::replace)});
  }
  const bool is_whole = value.is_number_integer();
  return {.name = name,
          .value = value.get<double>(),
          .unit = unit_at(trail),
          .is_whole = is_whole,
          .interval = interval_of(*trail.groups.back(), trail.keys.back()),
          .possible = possible_at(trail, is_whole)};
}

class Search {
 public:
  std::vector<AnswerNumber> found;
  NumberMissing missing;  ///< at the deepest group that was reached

  void at(const Json& value, std::string_view rest) {
    if (rest.empty()) {
      found.push_back(number_of(trail_, value));
      return;
    }
    const std::vector<Child> children = children_of(value);
    if (trail_.keys.size() >= deepest_) {
      deepest_ = trail_.keys.size();
      missing = {std::string(rest), trail_.name(), names_of(children)};
    }
    for (const Child& child : children) {
      // A name may itself contain dots, so the key is not cut off at the next dot.
      for (const std::string_view key : {std::string_view("*"), std::string_view(child.name)}) {
        const bool is_last = rest == key;
        const bool is_first = rest.starts_with(key) && rest.size() > key.size() + 1 && rest[key.size()] == '.';
        // An interval belongs to the number beside it.
        const bool is_interval = key == "*" && child.name.ends_with(kInterval);
        if ((!is_last && !is_first) || is_interval) {
          continue;
        }
        trail_.keys.push_back(child.name);
        trail_.groups.push_back(&value);
        at(*child.value, is_last ? std::string_view() : rest.substr(key.size() + 1));
        trail_.keys.pop_back();
        trail_.groups.pop_back();
        break;
      }
    }
  }

 private:
  Trail trail_;
  std::size_t deepest_ = 0;
};

}  // namespace

std::vector<AnswerNumber> numbers_at(const Json& answer, std::string_view place) {
  Search search;
  search.at(answer, place);
  if (search.found.empty()) {
    throw NotEvaluated(std::move(search.missing));
  }
  return search.found;
}

}  // namespace heatsoak::check
