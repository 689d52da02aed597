#include "present/junit.h"

#include <fmt/format.h>

#include <vector>

#include "base/xml_text.h"
#include "present/check_words.h"

namespace heatsoak::present {
namespace {

/// Groups the outcomes by check. The outcomes of one check must be adjacent.
std::vector<std::span<const check::Outcome>> by_check(std::span<const check::Outcome> outcomes) {
  std::vector<std::span<const check::Outcome>> groups;
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

std::string count_attributes(const check::OutcomeCounts& counts) {
  return fmt::format(R"(tests="{}" failures="{}" errors="{}" skipped="0")", counts.all, counts.broken, counts.not_evaluated);
}

std::string suites_begin(const check::OutcomeCounts& counts) {
  return fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"heatsoak check\" {}>\n", count_attributes(counts));
}

std::string suite_begin(std::string_view name, const check::OutcomeCounts& counts, std::string_view version) {
  return fmt::format(
      "  <testsuite name=\"{}\" {}>\n    <properties>\n      <property name=\"heatsoak\" value=\"{}\"/>\n    </properties>\n",
      base::xml_attribute(name), count_attributes(counts), base::xml_attribute(version));
}

std::string test_case(const check::Outcome& each) {
  std::string text =
      fmt::format(R"(    <testcase name="{}" classname="{}" file="{}" line="{}")", base::xml_attribute(each.limit.type->name),
                  base::xml_attribute(each.check->name), base::xml_attribute(each.limit.at.file), each.limit.at.line.value_or(0));
  const std::string facts =
      fmt::format("value {}, limit {}, margin {}\n{}", value_words(each), limit_words(each), margin_words(each), basis_words(each));
  if (each.passed()) {
    return text + fmt::format(">\n      <system-out>{}</system-out>\n    </testcase>\n", base::xml_attribute(facts));
  }
  const std::string_view element = each.measured ? "failure" : "error";
  const base::Location at = place_of(each);
  return text + fmt::format(">\n      <{0} type=\"{1}\" message=\"{2}\">{3}:{4}: {5}</{0}>\n    </testcase>\n", element,
                            each.measured ? "limit_exceeded" : "not_evaluated", base::xml_attribute(reason_words(each)),
                            base::xml_attribute(at.file), at.line.value_or(0), base::xml_attribute(facts));
}

/// Returns one test suite per check.
std::string suites_of(std::span<const check::Outcome> outcomes, std::string_view version) {
  std::string text;
  for (const std::span<const check::Outcome> group : by_check(outcomes)) {
    text += suite_begin(group.front().check->name, check::count(group), version);
    for (const check::Outcome& each : group) {
      text += test_case(each);
    }
    text += "  </testsuite>\n";
  }
  return text;
}

}  // namespace

std::string junit_xml(std::span<const check::Outcome> outcomes, std::string_view version) {
  return suites_begin(check::count(outcomes)) + suites_of(outcomes, version) + "</testsuites>\n";
}

std::string junit_xml(std::span<const check::Outcome> outcomes, const base::Failure& failure, std::string_view version) {
  constexpr check::OutcomeCounts kOneError{.all = 1, .broken = 0, .not_evaluated = 1};
  check::OutcomeCounts counts = check::count(outcomes);
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

}  // namespace heatsoak::present
