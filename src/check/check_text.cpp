#include "check/check_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "base/xml_text.h"
#include "check/limit.h"

namespace heatsoak::check {
namespace {

struct Counts {
  std::size_t all = 0;
  std::size_t exceeded = 0;
  std::size_t not_evaluated = 0;
};

Counts counts_of(std::span<const Outcome> outcomes) {
  Counts counts;
  for (const Outcome& each : outcomes) {
    ++counts.all;
    counts.exceeded += !each.passed && each.measured ? 1 : 0;
    counts.not_evaluated += each.measured ? 0 : 1;
  }
  return counts;
}

/// Groups the outcomes by check. The outcomes of one check must be adjacent.
std::vector<std::span<const Outcome>> by_check(std::span<const Outcome> outcomes) {
  std::vector<std::span<const Outcome>> groups;
  for (std::size_t begin = 0; begin < outcomes.size();) {
    std::size_t end = begin + 1;
    while (end < outcomes.size() && outcomes[end].check == outcomes[begin].check) {
      ++end;
    }
    groups.push_back(outcomes.subspan(begin, end - begin));
    begin = end;
  }
  return groups;
}

std::string count_attributes(const Counts& counts) {
  return fmt::format(R"(tests="{}" failures="{}" errors="{}" skipped="0")", counts.all, counts.exceeded, counts.not_evaluated);
}

std::string suites_begin(const Counts& counts) {
  return fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"heatsoak check\" {}>\n", count_attributes(counts));
}

std::string suite_begin(std::string_view name, const Counts& counts, std::string_view version) {
  return fmt::format(
      "  <testsuite name=\"{}\" {}>\n    <properties>\n      <property name=\"heatsoak\" value=\"{}\"/>\n    </properties>\n",
      base::xml_attribute(name), count_attributes(counts), base::xml_attribute(version));
}

std::string test_case(const Outcome& each) {
  std::string text =
      fmt::format(R"(    <testcase name="{}" classname="{}" file="{}" line="{}")", base::xml_attribute(each.limit.type->name),
                  base::xml_attribute(each.check->name), base::xml_attribute(each.limit.at.file), each.limit.at.line);
  const std::string facts = fmt::format("value {}, limit {}, margin {}\n{}", value_text(each), limit_text(each), margin_text(each),
                                        each.measured ? each.measured->detail : "");
  if (each.passed) {
    return text + fmt::format(">\n      <system-out>{}</system-out>\n    </testcase>\n", base::xml_attribute(facts));
  }
  const std::string_view element = each.measured ? "failure" : "error";
  return text + fmt::format(">\n      <{0} type=\"{1}\" message=\"{2}\">{3}:{4}: {5}</{0}>\n    </testcase>\n", element,
                            each.measured ? "limit_exceeded" : "not_evaluated", base::xml_attribute(each.reason),
                            base::xml_attribute(each.limit.at.file), each.limit.at.line, base::xml_attribute(facts));
}

/// Returns one test suite per check.
std::string suites_of(std::span<const Outcome> outcomes, std::string_view version) {
  std::string text;
  for (const std::span<const Outcome> group : by_check(outcomes)) {
    text += suite_begin(group.front().check->name, counts_of(group), version);
    for (const Outcome& each : group) {
      text += test_case(each);
    }
    text += "  </testsuite>\n";
  }
  return text;
}

/// Escapes text for a cell of a Markdown table.
std::string in_markdown(std::string_view text) {
  std::string result;
  for (const char c : text) {
    result += c == '|' ? "\\|" : c == '\n' ? "<br>" : c == '<' ? "&lt;" : std::string(1, c);
  }
  return result;
}

/// Escapes the data and the properties of a GitHub workflow command.
std::string escaped_command(std::string_view text, bool is_property) {
  std::string result;
  for (const char c : text) {
    const bool is_special = c == '%' || c == '\r' || c == '\n' || (is_property && (c == ':' || c == ','));
    result += is_special ? fmt::format("%{:02X}", static_cast<unsigned char>(c)) : std::string(1, c);
  }
  return result;
}

}  // namespace

std::string conclusion_text(std::span<const Outcome> outcomes) {
  const Counts counts = counts_of(outcomes);
  const auto some = [](std::size_t count) { return fmt::format("{} limit{}", count, count == 1 ? "" : "s"); };
  if (counts.exceeded + counts.not_evaluated == 0) {
    return fmt::format("{} {}", some(counts.all), counts.all == 1 ? "holds" : "hold");
  }
  std::string text;
  if (counts.exceeded > 0) {
    text = fmt::format("{} of {} {} not hold", some(counts.exceeded), counts.all, counts.exceeded == 1 ? "does" : "do");
  }
  if (counts.not_evaluated > 0) {
    text += fmt::format("{}{} of {} cannot be evaluated and {} as failed", text.empty() ? "" : "; ", some(counts.not_evaluated), counts.all,
                        counts.not_evaluated == 1 ? "counts" : "count");
  }
  return text;
}

std::string value_text(const Outcome& outcome) { return outcome.measured ? shown(outcome.measured->value, *outcome.limit.type) : "–"; }

std::string margin_text(const Outcome& outcome) {
  if (!outcome.measured || outcome.measured->is_never) {
    return "–";
  }
  const double margin = *outcome.margin_value();
  const ThresholdType& type = *outcome.limit.type;
  if (type.unit == "degC") {
    return fmt::format("{:+.1f} K", margin);
  }
  const std::string text = shown(margin, type);
  return margin > 0.0 ? "+" + text : text;
}

std::string limit_text(const Outcome& outcome) {
  return fmt::format("{} {}", to_string(outcome.limit.type->direction), shown(outcome.limit.value, *outcome.limit.type));
}

std::string things_of(const Check& check) {
  std::string text;
  const auto add = [&text](const std::string& id) { text += (text.empty() ? "" : ", ") + id; };
  if (!check.command.empty()) {
    add(check.command);
  }
  if (check.motor) {
    add(check.motor->id);
  }
  if (check.robot) {
    add(check.robot->id);
  }
  if (check.duty) {
    add(check.duty->id);
  }
  return text;
}

std::string explanation(const Outcome& outcome) {
  if (!outcome.measured) {
    return outcome.reason;
  }
  const std::string& detail = outcome.measured->detail;
  if (outcome.passed) {
    return detail;
  }
  return detail.empty() ? outcome.reason : fmt::format("{}: {}", outcome.reason, detail);
}

std::string junit_xml(std::span<const Outcome> outcomes, std::string_view version) {
  return suites_begin(counts_of(outcomes)) + suites_of(outcomes, version) + "</testsuites>\n";
}

std::string junit_xml(std::span<const Outcome> outcomes, const base::Failure& failure, std::string_view version) {
  constexpr Counts kOneError{.all = 1, .exceeded = 0, .not_evaluated = 1};
  Counts counts = counts_of(outcomes);
  counts.all += kOneError.all;
  counts.not_evaluated += kOneError.not_evaluated;
  const std::string all = failure.what();
  return suites_begin(counts) + suites_of(outcomes, version) + suite_begin("heatsoak check", kOneError, version) +
         fmt::format(
             "    <testcase name=\"check files\" classname=\"heatsoak check\">\n      <error type=\"not_evaluated\" "
             "message=\"{}\">{}</error>\n"
             "    </testcase>\n  </testsuite>\n</testsuites>\n",
             base::xml_attribute(all.substr(0, all.find('\n'))), base::xml_attribute(all));
}

std::string summary_markdown(std::span<const Outcome> outcomes, std::string_view version) {
  std::string text = fmt::format("### heatsoak check: {}\n\n", conclusion_text(outcomes));
  text += "| | check | threshold | value | limit | margin | |\n|---|---|---|--:|--:|--:|---|\n";
  for (const Outcome& each : outcomes) {
    text += fmt::format("| {} | {} | `{}` | {} | {} | {} | {} |\n", each.passed ? "✅" : "❌", in_markdown(each.check->name),
                        in_markdown(each.limit.type->name), value_text(each), limit_text(each), margin_text(each),
                        in_markdown(explanation(each)));
  }
  return text + fmt::format("\nheatsoak {}\n", version);
}

std::string annotation(const base::Location& at, const std::filesystem::path& workspace, std::string_view title, std::string_view message) {
  std::filesystem::path file = at.file;
  if (!workspace.empty()) {
    std::error_code unreachable;
    const std::filesystem::path inside = std::filesystem::proximate(file, workspace, unreachable);
    file = unreachable || inside.string().starts_with("..") ? file : inside;
  }
  return fmt::format("::error file={},line={},col={},title={}::{}\n", escaped_command(file.string(), true), std::max(1, at.line),
                     std::max(1, at.column), escaped_command(title, true), escaped_command(message, false));
}

std::string annotations(std::span<const Outcome> outcomes, const std::filesystem::path& workspace) {
  std::string text;
  for (const Outcome& each : outcomes) {
    if (!each.passed) {
      text += annotation(each.limit.at, workspace, fmt::format("{}: {}", each.check->name, each.limit.type->name), explanation(each));
    }
  }
  return text;
}

}  // namespace heatsoak::check
