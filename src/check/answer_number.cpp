#include "check/answer_number.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "base/diagnostic.h"

namespace heatsoak::check {
namespace {

using Json = nlohmann::ordered_json;

/// Last words of a name that are units, and their UDUNITS texts.
constexpr std::array<std::pair<std::string_view, std::string_view>, 20> kUnits{
    {{"A", "A"},   {"A2", "A^2"}, {"C", "degC"}, {"Hz", "Hz"},   {"J", "J"}, {"K", "K"},   {"N", "N"},
     {"Nm", "N m"}, {"V", "V"},    {"W", "W"},    {"byte", "byte"}, {"g", "g"}, {"kg", "kg"}, {"m", "m"},
     {"m2", "m^2"}, {"mm", "mm"},  {"ohm", "ohm"}, {"rad", "rad"}, {"s", "s"}, {"s2", "s^2"}}};

/// Keys of one value of a quantity, such as its maximum. The enclosing key names the quantity and its unit.
constexpr std::array<std::string_view, 18> kValueWords{"after", "before", "ci95", "from", "high", "low", "max", "mean", "most",
                                                       "nominal", "p05", "p50", "p95", "rms", "rmse", "sd", "to", "value"};

std::string_view unit_of_word(std::string_view word) {
  const auto found = std::ranges::find(kUnits, word, [](const auto& each) { return each.first; });
  return found == kUnits.end() ? std::string_view() : found->second;
}

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
      all.push_back({key, &value});
    }
  } else if (group.is_array()) {
    for (std::size_t i = 0; i < group.size(); ++i) {
      all.push_back({element_name(group[i], i), &group[i]});
    }
  }
  return all;
}

/// Returns at most twelve of the names, separated by commas.
std::string names_text(const std::vector<Child>& children) {
  constexpr std::size_t kMost = 12;
  std::vector<std::string> names;
  for (const Child& each : children) {
    if (std::ranges::find(names, each.name) == names.end()) {
      names.push_back(each.name);
    }
  }
  const bool is_cut = names.size() > kMost;
  names.resize(std::min(names.size(), kMost));
  return fmt::format("{}{}", fmt::join(names, ", "), is_cut ? ", …" : "");
}

/// Keys from the top to a value, and the groups that hold them.
struct Trail {
  std::vector<std::string> keys;
  std::vector<const Json*> groups;

  [[nodiscard]] std::string name() const { return fmt::format("{}", fmt::join(keys, ".")); }
};

/// Last words of keys whose numbers never have a unit, even inside a group with a unit.
constexpr std::array<std::string_view, 7> kPureNumbers{"count", "nats", "normal", "p", "ratio", "samples", "share"};

/// Returns whether the members of a group with a unit in its name have this unit: "limited_s" with a member for each limit does,
/// "winding_C" with the members "rmse_K" and "samples" does not.
bool gives_unit(const Json& members, std::string_view member) {
  const std::string_view last = member.substr(member.find_last_of('_') + 1);
  return std::ranges::find(kPureNumbers, last) == kPureNumbers.end() &&
         std::ranges::all_of(members.items(), [](const auto& each) { return unit_of_name(each.key()).empty(); });
}

std::string unit_at(const Trail& trail) {
  bool is_element = false;
  for (std::size_t i = trail.keys.size(); i-- > 0;) {
    const Json& group = *trail.groups[i];
    const std::string& key = trail.keys[i];
    if (group.is_array()) {
      is_element = !group.front().is_object();
      if (!is_element) {
        return {};
      }
      continue;
    }
    const bool is_share = i > 0 && trail.keys[i - 1].starts_with("coverage");
    if (std::string unit = unit_of_name(key); !unit.empty() && !is_share) {
      return unit;
    }
    if (std::ranges::find(kValueWords, key) == kValueWords.end()) {
      return i > 0 && i + 1 == trail.keys.size() && trail.groups[i - 1]->is_object() && gives_unit(group, key)
                 ? unit_of_name(trail.keys[i - 1])
                 : std::string();
    }
    if (const auto beside = group.find("unit"); beside != group.end() && beside->is_string()) {
      return beside->get<std::string>();
    }
  }
  return {};
}

/// Returns the 95 % interval of the number `key`: "ci95" beside "value", "probability_ci95" beside "probability_over_limit".
std::optional<AnswerInterval> interval_of(const Json& group, std::string_view key) {
  constexpr std::string_view kEnd = "ci95";
  for (const Child& each : group.is_object() ? children_of(group) : std::vector<Child>()) {
    const std::string_view name = each.name;
    const bool is_of_key = name == kEnd ? key == "value"
                                        : name.ends_with(fmt::format("_{}", kEnd)) && key != name &&
                                              key.starts_with(name.substr(0, name.size() - kEnd.size()));
    const Json& ends = *each.value;
    if (is_of_key && ends.is_array() && ends.size() == 2 && ends[0].is_number() && ends[1].is_number()) {
      return AnswerInterval{ends[0].get<double>(), ends[1].get<double>()};
    }
  }
  return std::nullopt;
}

[[noreturn]] void refuse(const std::string& reason) { throw base::Failure(base::ExitCode::cannot_answer, reason); }

AnswerNumber number_of(const Trail& trail, const Json& value) {
  const std::string name = trail.name();
  if (value.is_object() || value.is_array()) {
    refuse(value.empty() ? fmt::format("'{}' is empty", name)
                         : fmt::format("'{}' is no number; expected one of its members: {}", name, names_text(children_of(value))));
  }
  if (value.is_null()) {
    refuse(fmt::format("'{}' is null: the answer has no value there", name));
  }
  if (!value.is_number()) {
    refuse(fmt::format("'{}' is {}; expected a number", name, value.dump(-1, ' ', false, Json::error_handler_t::replace)));
  }
  return {name, value.get<double>(), unit_at(trail), interval_of(*trail.groups.back(), trail.keys.back())};
}

class Search {
 public:
  std::vector<AnswerNumber> found;

  void at(const Json& value, std::string_view rest) {
    if (rest.empty()) {
      found.push_back(number_of(trail_, value));
      return;
    }
    const std::vector<Child> children = children_of(value);
    if (trail_.keys.size() >= deepest_) {
      deepest_ = trail_.keys.size();
      reached_ = fmt::format("{}; expected one of {}", trail_.keys.empty() ? "the answer" : fmt::format("'{}'", trail_.name()),
                             children.empty() ? "…" : names_text(children));
      missing_ = rest;
    }
    for (const Child& child : children) {
      // A name may itself contain dots, so the key is not cut off at the next dot.
      for (const std::string_view key : {std::string_view("*"), std::string_view(child.name)}) {
        const bool is_last = rest == key;
        const bool is_first = rest.starts_with(key) && rest.size() > key.size() + 1 && rest[key.size()] == '.';
        if (!is_last && !is_first) {
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

  [[nodiscard]] std::string missing_text() const { return fmt::format("there is no '{}' in {}", missing_, reached_); }

 private:
  Trail trail_;
  std::size_t deepest_ = 0;
  std::string reached_;
  std::string_view missing_;
};

}  // namespace

std::string unit_of_name(std::string_view name) {
  std::vector<std::string_view> words;
  for (std::size_t begin = 0; begin <= name.size();) {
    const std::size_t end = std::min(name.find('_', begin), name.size());
    words.push_back(name.substr(begin, end - begin));
    begin = end + 1;
  }
  std::string below;
  std::string above;
  // The first word is the quantity, also where it looks like a unit: "a_V".
  for (std::size_t i = words.size(); i-- > 1;) {
    if (words[i] == "per" && !above.empty() && below.empty()) {
      below = std::exchange(above, {});
      continue;
    }
    const std::string_view unit = unit_of_word(words[i]);
    if (unit.empty()) {
      break;
    }
    above = above.empty() ? std::string(unit) : fmt::format("{} {}", unit, above);
  }
  if (below.empty()) {
    return above;
  }
  const bool is_product = below.find(' ') != std::string::npos;
  return fmt::format("{}/{}{}{}", above.empty() ? "1" : above, is_product ? "(" : "", below, is_product ? ")" : "");
}

std::vector<AnswerNumber> numbers_at(const Json& answer, std::string_view place) {
  Search search;
  search.at(answer, place);
  if (search.found.empty()) {
    refuse(search.missing_text());
  }
  return search.found;
}

}  // namespace heatsoak::check
