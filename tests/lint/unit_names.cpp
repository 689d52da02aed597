#include "unit_names.h"

#include <algorithm>
#include <cctype>
#include <regex>
#include <set>

#include "source_text.h"

namespace heatsoak::lint {
namespace {

/// `Lanes` are several doubles, `S` is the scalar of a law that runs on both.
const std::set<std::string, std::less<>> kFloatingTypes{"double", "float", "realtype", "Lanes", "S"};

/// A pure number; the last word of the name says which.
const std::set<std::string, std::less<>> kPureNumbers{"count",
                                                      "efficiency",
                                                      "sd",
                                                      "exponent",
                                                      "bic",
                                                      "p_value",
                                                      "determinant",
                                                      "evidence",
                                                      "misfit",
                                                      "cost",
                                                      "kUnknownVariance",
                                                      "uniforms",
                                                      "correlated_with",
                                                      "start_spread",
                                                      "theta_value",
                                                      "decay",
                                                      "factor",
                                                      "headroom",
                                                      "load",
                                                      "probability",
                                                      "probability_over_limit",
                                                      "ratio",
                                                      "share",
                                                      "uniform",
                                                      "kMarginalProbability",
                                                      "kMajority",
                                                      "kTolerableShortage",
                                                      "kTolerableShortTime",
                                                      "aggressiveness",
                                                      "pole_pairs",
                                                      "relative",
                                                      "confidence",
                                                      "weight",
                                                      "sign",
                                                      "periods"};

/// The unit is not known where the name is written, but stands beside it.
const std::set<std::string, std::less<>> kUnitBeside{// of a figure, range or tolerance: its ParameterSpec or comment has the unit
                                                     "value", "values", "low", "high", "absolute", "kUnknown", "slope", "intercept",
                                                     // of a threshold: its ThresholdType has the unit
                                                     "limit_value", "origin_value",
                                                     // of a distribution: the variable of that type has the unit
                                                     "nominal", "p05", "p50", "p95",
                                                     // of a log's column: the log has the unit
                                                     "column",
                                                     // of a chart: its axis label has the unit; of an ODE: the system has it
                                                     "x", "y", "dydt", "event_values", "written",
                                                     // mixed units, place by place
                                                     "parameters", "effect_parameters", "integrals", "variants", "signals",
                                                     // of a power: its exponent takes the unit away
                                                     "base", "b", "e",
                                                     // of a function for any argument: in the argument's unit
                                                     "width", "each", "parameter", "most",
                                                     // of a fitted figure or a candidate: its declaration has the unit
                                                     "before", "prior_sd", "spread", "spread_sd", "off_value", "scale", "size",
                                                     "typical_size",
                                                     // of a curve over a driver: the driver has the unit
                                                     "knots", "curve", "curve_sd",
                                                     // of a filter: rows and columns have different units
                                                     "transition", "injection", "gain", "expected_K2",
                                                     // stages of a method, in the state's unit
                                                     "rate", "sum",
                                                     // of a smoothed coordinate: its samples have the unit
                                                     "acceleration",
                                                     // of a square: in the root of its argument's unit
                                                     "root",
                                                     // of a channel of a log: its quantity has the unit
                                                     "columns", "noise", "saturates_high", "saturates_low", "step", "usual",
                                                     // types of a standard, no variables
                                                     "fmi2Real", "fmi3Float32", "fmi3Float64",
                                                     // VTK's own signature
                                                     "point",
                                                     // of a vector of two lengths and an angle, and of a guard's signal: its comment
                                                     // or the signal's name has the unit
                                                     "yaw", "signal", "least", "possible", "points", "corner",
                                                     // not a number
                                                     "kAbsent", "kNoSample"};

bool is_identifier(const std::string& text) { return std::isalpha(static_cast<unsigned char>(text[0])) != 0 || text[0] == '_'; }

bool is_decoration(const std::string& text) { return text == "const" || text == "&" || text == "*"; }

/// Templates whose name says nothing about what the numbers are; other templates name their fields themselves.
const std::set<std::string, std::less<>> kContainers{"array", "map", "optional", "pair", "span", "tuple", "unique_ptr", "vector"};

/// Where the arguments of the container that `at` is inside of end, or 0 where it is inside of none.
std::size_t end_of_template(const std::vector<Token>& all, std::size_t at) {
  int depth = 0;
  std::size_t back = at;
  while (back-- > 0) {
    const std::string& text = all[back].text;
    if (text == "(" || text == ")" || text == ";" || text == "{" || text == "}") {
      return 0;
    }
    depth += text == ">" ? 1 : text == "<" ? -1 : 0;
    if (depth < 0) {
      break;
    }
  }
  if (depth >= 0 || back == 0 || !kContainers.contains(all[back - 1].text)) {
    return 0;
  }
  for (depth = 0; at < all.size(); ++at) {
    depth += all[at].text == "<" ? 1 : all[at].text == ">" ? -1 : 0;
    if (depth < 0) {
      return at;
    }
  }
  return 0;
}

}  // namespace

std::vector<NamedNumber> floating_point_names(std::string_view header) {
  const std::vector<Token> all = tokens(code_only(header));
  const auto text = [&all](std::size_t at) -> const std::string& {
    static const std::string kNone = ";";
    return at < all.size() ? all[at].text : kNone;
  };
  std::vector<NamedNumber> found;
  for (std::size_t type = 0; type < all.size(); ++type) {
    if (!kFloatingTypes.contains(text(type)) || (type > 0 && (text(type - 1) == "class" || text(type - 1) == "typename"))) {
      continue;
    }
    std::size_t at = type + 1;
    for (;;) {
      while (is_decoration(text(at)) || (is_identifier(text(at)) && text(at + 1) == "::") || text(at) == "::") {
        ++at;
      }
      if (text(at) != ">" && text(at) != ",") {
        break;
      }
      const std::size_t end = end_of_template(all, at);
      if (end == 0) {
        break;
      }
      at = end + 1;
    }
    const auto names_a_variable = [&](std::size_t name) {
      static const std::set<std::string, std::less<>> kAfterName{";", ",", ")", "=", "{", "[", ":"};
      return is_identifier(text(name)) && kAfterName.contains(text(name + 1));
    };
    while (names_a_variable(at)) {
      found.push_back({text(at), all[at].line});
      // `double a = 1.0, b;` is not written here; `std::vector<double> a, b;` is. The next parameter of a
      // function starts with a type, so its name is not followed by one of the marks above.
      at += text(at + 1) == "," ? 2 : all.size();
    }
  }
  // A number inside nested templates is met once for each type, a name is reported once.
  std::ranges::stable_sort(found, {}, &NamedNumber::line);
  const auto same = [](const NamedNumber& a, const NamedNumber& b) { return a.line == b.line && a.name == b.name; };
  found.erase(std::unique(found.begin(), found.end(), same), found.end());
  return found;
}

bool ends_in_unit(std::string_view name) {
  static const std::string kUnit = "(A2|A|V2|V|W|Nm|N|ohm|H|F|Wb|s3|s2|s|ms|us|min|h|C|K|J|rad2|rad|deg|m2|m|mm|kg_m2|kg|Hz|rpm|px|nats)";
  static const std::regex kEnd("[A-Za-z0-9]_(" + kUnit + "|per_" + kUnit + ")(_per_" + kUnit + ")*_?$");
  return std::regex_search(name.begin(), name.end(), kEnd);
}

bool is_unitless_by_nature(std::string_view name) {
  if (name.ends_with('_')) {
    name.remove_suffix(1);
  }
  return kUnitBeside.contains(name) || kPureNumbers.contains(name) || kPureNumbers.contains(name.substr(name.rfind('_') + 1));
}

}  // namespace heatsoak::lint
