#include "cli/quantity_option.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "base/quantity.h"
#include "report/chart.h"

namespace heatsoak::cli {
namespace {

std::function<std::string(const std::string&)> ends_in(const std::string& ending, const std::string& why) {
  return [ending, why](const std::string& name) {
    return name.ends_with(ending) || name.ends_with(ending + "/") || name.starts_with("/dev/")
               ? std::string()
               : fmt::format("{} does not end in {}; {}", name, ending, why);
  };
}

/// Returns a value at the end of a range that the conversion of its unit has rounded to beyond that end, such as 100us for 0.0001 s.
double without_rounding(double value, const base::Range& range) {
  const double rounded = base::parse_number(fmt::format("{:.12g}", value)).value_or(value);
  return !range.contains(value) && range.contains(rounded) ? rounded : value;
}

template <class Value>
CLI::Option* add_quantity_to(CLI::App& app, const std::string& flag, Value& value, const base::ParameterSpec& spec) {
  const auto parse = [flag, spec, &value](const std::string& text) {
    const std::optional<double> bare = base::parse_number(text);
    const base::ParsedQuantity parsed =
        bare && std::isfinite(*bare) ? base::ParsedQuantity{*bare, {}} : base::parse_quantity(text, spec.unit, spec.is_share());
    if (!parsed.ok()) {
      throw CLI::ValidationError(flag, parsed.problem);
    }
    const double given = without_rounding(parsed.value, spec.range);
    if (!spec.range.contains(given)) {
      base::Range shown = spec.range;
      const bool is_percentage = spec.is_share() && text.ends_with('%');
      if (is_percentage) {
        shown.low *= 100.0;
        shown.high *= 100.0;
      }
      throw CLI::ValidationError(
          flag, fmt::format("{} is out of range; expected {}", bare && !spec.unit.empty() ? fmt::format("{} {}", text, spec.unit) : text,
                            base::to_string(shown, is_percentage ? "%" : spec.unit)));
    }
    value = given;
  };
  return app.add_option_function<std::string>(flag, parse, std::string(spec.meaning))->type_name(std::string(spec.unit));
}

}  // namespace

CLI::Option* add_quantity(CLI::App& app, const std::string& flag, double& value, const base::ParameterSpec& spec) {
  return add_quantity_to(app, flag, value, spec);
}

CLI::Option* add_quantity(CLI::App& app, const std::string& flag, std::optional<double>& value, const base::ParameterSpec& spec) {
  return add_quantity_to(app, flag, value, spec);
}

CLI::Option* add_picture(CLI::App& app, std::string& file, const std::string& meaning) {
  return app.add_option("--plot", file, meaning)
      ->check([](const std::string& name) {
        const bool is_known = std::ranges::any_of(report::kPictureEndings, [&](std::string_view ending) { return name.ends_with(ending); });
        return is_known ? std::string() : fmt::format("{} does not end in {}", name, fmt::join(report::kPictureEndings, " or "));
      })
      ->type_name("FILE.svg|png");
}

CLI::Option* add_table(CLI::App& app, std::string& file, const std::string& meaning) {
  return app.add_option("--out", file, meaning)
      ->check(ends_in(std::string(kTableEnding), "tables are written as CSV"))
      ->type_name(fmt::format("FILE{}", kTableEnding));
}

CLI::Option* add_seed(CLI::App& app, std::uint64_t& seed, const std::string& meaning) {
  return app.add_option("--seed", seed, meaning)->check(whole_number(std::numeric_limits<std::uint64_t>::max()))->capture_default_str();
}

std::function<std::string(const std::string&)> whole_number(std::uint64_t most) {
  return [most](const std::string& text) -> std::string {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_number = error == std::errc() && end == text.data() + text.size() && (text == "0" || text.front() != '0');
    return is_number && value <= most ? "" : fmt::format("'{}' is not a whole number from 0 to {}", text, most);
  };
}

}  // namespace heatsoak::cli
