#include "base/quantity.h"

#include <fmt/format.h>
#include <udunits2.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <utility>

namespace heatsoak::base {
namespace {

struct FreeUnit {
  void operator()(ut_unit* unit) const { ut_free(unit); }
};
struct FreeConverter {
  void operator()(cv_converter* converter) const { cv_free(converter); }
};
using Unit = std::unique_ptr<ut_unit, FreeUnit>;
using Converter = std::unique_ptr<cv_converter, FreeConverter>;

/// Reading the unit database takes 5 ms, so it is postponed until the first quantity is parsed.
ut_system* unit_system() {
  static ut_system* const system = [] {
    ut_set_error_message_handler(ut_ignore);
    ut_system* read = ut_read_xml(nullptr);
    if (!read) {
      throw std::runtime_error("the unit database of UDUNITS-2 cannot be read (package libudunits2-data)");
    }
    return read;
  }();
  return system;
}

/// UDUNITS-2 parses with global variables, and checks of several motors lint their files at the same time.
std::mutex& parsing() {
  static std::mutex mutex;
  return mutex;
}

/// Replaces data sheet spellings that UDUNITS-2 does not know.
std::string as_udunits(std::string_view unit) {
  std::string text(unit);
  // Longer spellings first, so that no replacement text is replaced again. µ is U+00B5 or the Greek letter U+03BC.
  constexpr std::array<std::pair<std::string_view, std::string_view>, 12> kSpellings{{{"mNm", "(mN m)"},
                                                                                      {"µNm", "(µN m)"},
                                                                                      {"μNm", "(µN m)"},
                                                                                      {"uNm", "(µN m)"},
                                                                                      {"kNm", "(kN m)"},
                                                                                      {"Nm", "(N m)"},
                                                                                      {"gcm2", "(g cm2)"},
                                                                                      {"gcm²", "(g cm2)"},
                                                                                      {"kWh", "(kW h)"},
                                                                                      {"Wh", "(W h)"},
                                                                                      {"mAh", "(mA h)"},
                                                                                      {"Ah", "(A h)"}}};
  for (const auto& [sheet, udunits] : kSpellings) {
    for (std::size_t at = text.find(sheet); at != std::string::npos; at = text.find(sheet, at + udunits.size())) {
      text.replace(at, sheet.size(), udunits);
    }
  }
  if (text == "deg") {
    return "arc_degree";
  }
  return text;
}

Unit parse_unit(std::string_view unit) { return Unit(ut_parse(unit_system(), as_udunits(unit).c_str(), UT_UTF8)); }

bool names_an_angle(std::string_view unit) {
  constexpr std::array<std::string_view, 5> kAngles{"rad", "rpm", "deg", "rev", "V s"};
  return std::ranges::any_of(kAngles, [&](std::string_view angle) { return unit.find(angle) != std::string_view::npos; });
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) {
    return {};
  }
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Removes a leading plus sign, which std::from_chars does not accept. "+-5" stays as it is and is rejected later.
std::string_view without_plus(std::string_view text) { return text.starts_with('+') && !text.starts_with("+-") ? text.substr(1) : text; }

/// Rejects texts that UDUNITS would misread: it takes "000 ohm" for zero ohm and "ohm @ 3" for a shifted scale, so "1 000 ohm" would
/// silently become 0. Digits are allowed in exponents ("cm2", "s-1") and in a leading "1/". Returns the error text, or an empty string.
std::string misread_as_unit(std::string_view unit) {
  if (unit.starts_with(',')) {
    return "has a decimal comma; write a point";
  }
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  for (std::size_t i = unit.starts_with("1/") ? 2 : 0; i < unit.size(); ++i) {
    const auto c = static_cast<unsigned char>(unit[i]);
    if (c < 0x20 || c == 0x7f) {
      return "holds a control character";
    }
    std::size_t before = i;  // index of the exponent's sign, or of the digit if it has none
    if (is_digit(unit[i]) && before > 0 && (unit[before - 1] == '-' || unit[before - 1] == '+')) {
      --before;
    }
    const unsigned char last = before > 0 ? static_cast<unsigned char>(unit[before - 1]) : ' ';
    const bool is_exponent = std::isalnum(last) != 0 || last == '^' || last >= 0x80;
    if ((is_digit(unit[i]) && !is_exponent) || unit[i] == '@') {
      return "has a second number where the unit should stand; write the number in one piece";
    }
  }
  return {};
}

/// Shortens a text of the user for use in a message: at most 60 bytes, no control characters.
std::string shown(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  std::string line(text.substr(0, kLongest));
  while (line.size() < text.size() && !line.empty() && (static_cast<unsigned char>(text[line.size()]) & 0xC0U) == 0x80U) {
    line.pop_back();  // do not cut inside a UTF-8 character
  }
  std::ranges::replace_if(
      line, [](unsigned char c) { return std::iscntrl(c) != 0; }, '?');
  return line.size() < text.size() ? line + "…" : line;
}

std::string example_for(std::string_view wanted_unit, bool is_share) {
  if (is_share) {
    return "expected a share such as \"10 %\"";
  }
  return wanted_unit.empty() ? "expected a number such as \"8\""
                             : fmt::format("expected a number with a unit such as \"1.5 {}\"", wanted_unit);
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
  text = without_plus(trimmed(text));
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    return std::nullopt;
  }
  return value;
}

ParsedQuantity parse_quantity(std::string_view text, std::string_view wanted_unit, bool is_share) {
  const std::string_view rest = without_plus(trimmed(text));
  double value = 0.0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  if (error == std::errc::result_out_of_range) {
    return {0.0, fmt::format("\"{}\" is too large or too small a number", shown(text))};
  }
  if (error != std::errc()) {
    const std::string_view what = rest.starts_with('?') ? "is still to be filled in" : "does not begin with a number";
    return {0.0, fmt::format("\"{}\" {}; {}", shown(text), what, example_for(wanted_unit, is_share))};
  }
  if (!std::isfinite(value)) {
    return {0.0, fmt::format("\"{}\" is not a finite number; {}", shown(text), example_for(wanted_unit, is_share))};
  }
  const std::string_view unit = trimmed(rest.substr(static_cast<std::size_t>(end - rest.data())));
  if (unit.empty() && !wanted_unit.empty()) {
    return {0.0, fmt::format("\"{}\" has no unit; {}", shown(text), example_for(wanted_unit, is_share))};
  }
  if (const std::string wrong = misread_as_unit(unit); !wrong.empty()) {
    return {0.0, fmt::format("\"{}\" {}; {}", shown(text), wrong, example_for(wanted_unit, is_share))};
  }
  const std::lock_guard lock(parsing());
  const Unit from = parse_unit(unit);
  if (!from) {
    return {0.0, fmt::format("'{}' is not a unit; {}", shown(unit), example_for(wanted_unit, is_share))};
  }
  const Unit to = parse_unit(wanted_unit);
  const Converter converter(ut_get_converter(from.get(), to.get()));
  // UDUNITS-2 also converts to the reciprocal ("5 W/K" to 0.2 K/W). Only a reciprocal conversion maps zero to infinity.
  if (!converter || !std::isfinite(cv_convert_double(converter.get(), 0.0))) {
    return {0.0, fmt::format("'{}' is no unit of this quantity; {}", shown(unit), example_for(wanted_unit, is_share))};
  }
  if (wanted_unit == "K" && cv_convert_double(converter.get(), 0.0) != 0.0) {
    return {0.0, fmt::format("\"{}\" is a temperature, not a difference of temperatures; write the difference in K", shown(text))};
  }
  if (wanted_unit.find("rad") != std::string_view::npos && !names_an_angle(unit)) {
    return {0.0, fmt::format("'{}' names no angle, so a turn could be taken for a radian; write rpm or rad/s", shown(unit))};
  }
  const double converted = cv_convert_double(converter.get(), value);
  if (!std::isfinite(converted)) {
    return {0.0, fmt::format("\"{}\" is too large a number", shown(text))};
  }
  return {converted, {}};
}

double convert(double value, std::string_view from, std::string_view to) {
  const std::lock_guard lock(parsing());
  const Unit from_unit = parse_unit(from);
  const Unit to_unit = parse_unit(to);
  const Converter converter(from_unit && to_unit ? ut_get_converter(from_unit.get(), to_unit.get()) : nullptr);
  if (!converter) {
    throw std::logic_error(fmt::format("no conversion from '{}' to '{}'", from, to));
  }
  return cv_convert_double(converter.get(), value);
}

std::string unit_for_display(std::string_view unit) {
  if (unit == "degC") {
    return "°C";
  }
  return std::string(unit);
}

std::string significant(double value, int digits) {
  if (value == 0.0) {
    return "0";
  }
  if (!std::isfinite(value)) {
    return fmt::format("{}", value);
  }
  const int magnitude = static_cast<int>(std::floor(std::log10(std::abs(value))));
  constexpr int kMostZeros = 15;
  if (std::abs(magnitude) > kMostZeros) {
    return fmt::format("{:.{}g}", value, digits);
  }
  const int decimals = std::max(0, digits - 1 - magnitude);
  const double step = std::pow(10.0, magnitude - digits + 1);
  const double rounded = decimals > 0 ? value : std::round(value / step) * step;
  std::string text = fmt::format("{:.{}f}", rounded, decimals);
  if (decimals > 0) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.ends_with('.')) {
      text.pop_back();
    }
  }
  return text;
}

}  // namespace heatsoak::base
