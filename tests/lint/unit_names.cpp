#include "unit_names.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "base/unit_names.h"
#include "source_text.h"

namespace heatsoak::lint {
namespace {

/// Floating-point types. `Lanes` holds several doubles, `S` is the scalar type of a law that supports both.
const std::set<std::string, std::less<>> kFloatingTypes{"double", "float", "realtype", "Lanes", "S"};

/// Final words of names of pure numbers.
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

/// Names whose unit is documented elsewhere.
const std::set<std::string, std::less<>> kUnitBeside{// values, ranges and tolerances: their ParameterSpec or comment has the unit
                                                     "value", "values", "low", "high", "absolute", "kUnknown", "slope", "intercept",
                                                     // fixed-point values: the expression of that type has the unit
                                                     "most_error",
                                                     // thresholds: their ThresholdType has the unit
                                                     "limit_value", "origin_value", "least_distance_value", "interval_width_value",
                                                     // distributions: the variable of that type has the unit
                                                     "nominal", "p05", "p50", "p95",
                                                     // columns of logs: the log has the unit
                                                     "first_column", "second_column", "third_column", "bridged",
                                                     // charts: the axis label has the unit; ODEs: the system has it
                                                     "x", "y", "dydt", "event_values", "written",
                                                     // mixed units, place by place
                                                     "parameters", "effect_parameters", "integrals", "variants", "signals",
                                                     // powers: the exponent removes the unit
                                                     "base", "b", "e",
                                                     // functions for any argument: the unit of the argument
                                                     "width", "each", "parameter", "most",
                                                     // fitted parameters or candidates: their declaration has the unit
                                                     "before", "prior_sd", "spread", "spread_sd", "off_value", "scale", "size",
                                                     "typical_size",
                                                     // curves over a signal: the signal has the unit
                                                     "knots", "curve", "curve_sd",
                                                     // filters: rows and columns have different units
                                                     "transition", "injection", "gain", "expected_K2",
                                                     // stages of a method, in the state's unit
                                                     "rate", "sum",
                                                     // smoothed coordinates: their samples have the unit
                                                     "acceleration",
                                                     // squares: the root of their argument's unit
                                                     "root",
                                                     // channels of logs: their quantity has the unit
                                                     "columns", "noise", "saturates_high", "saturates_low", "step", "usual",
                                                     // types of a standard, no variables
                                                     "fmi2Real", "fmi3Float32", "fmi3Float64",
                                                     // signature given by VTK
                                                     "point",
                                                     // vectors of two lengths and an angle, and signals of a guard: their comment or the
                                                     // signal's name has the unit
                                                     "yaw", "signal", "least", "possible", "points", "corner",
                                                     // no numbers
                                                     "kAbsent", "kNoSample"};

bool is_identifier(const std::string& text) { return std::isalpha(static_cast<unsigned char>(text[0])) != 0 || text[0] == '_'; }

bool is_decoration(const std::string& text) { return text == "const" || text == "&" || text == "*"; }

/// Templates whose name does not describe their numbers; other templates name their fields.
const std::set<std::string, std::less<>> kContainers{"array", "map", "optional", "pair", "span", "tuple", "unique_ptr", "vector"};

/// Returns the end of the arguments of the container around `at`, or 0 if there is none.
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
      // This code base writes `std::vector<double> a, b;` but not `double a = 1.0, b;`. The next parameter of a function starts with a
      // type, so its name is not followed by one of these marks.
      at += text(at + 1) == "," ? 2 : all.size();
    }
  }
  // A number inside nested templates is found once for each type but reported once.
  std::ranges::stable_sort(found, {}, &NamedNumber::line);
  const auto same = [](const NamedNumber& a, const NamedNumber& b) { return a.line == b.line && a.name == b.name; };
  found.erase(std::unique(found.begin(), found.end(), same), found.end());
  return found;
}

bool ends_in_unit(std::string_view name) {
  if (name.ends_with('_')) {
    name.remove_suffix(1);
  }
  // Pixels occur in code alone.
  return name.ends_with("_px") || !base::unit_of_name(name).value_or(base::UnitOfName{}).unit.empty() || name.ends_with("_nats");
}

bool is_unitless_by_nature(std::string_view name) {
  if (name.ends_with('_')) {
    name.remove_suffix(1);
  }
  return kUnitBeside.contains(name) || kPureNumbers.contains(name) || kPureNumbers.contains(name.substr(name.rfind('_') + 1));
}

}  // namespace heatsoak::lint
