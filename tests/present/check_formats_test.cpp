// Output of checks for CI services and GitHub.
#include <expat.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <map>
#include <sstream>
#include <stdexcept>

#include "present/github.h"
#include "present/junit.h"

namespace heatsoak::present {
namespace {

using testing::HasSubstr;
using testing::Not;

struct Element {
  std::string name;
  std::map<std::string, std::string> attributes;
  std::string text;
};

/// Returns all elements in document order; throws if the text is not well-formed XML.
std::vector<Element> parsed(const std::string& xml) {
  std::vector<Element> elements;
  XML_Parser parser = XML_ParserCreate(nullptr);
  XML_SetUserData(parser, &elements);
  XML_SetStartElementHandler(parser, [](void* data, const XML_Char* name, const XML_Char** attributes) {
    Element element{name, {}, {}};
    for (; *attributes != nullptr; attributes += 2) {
      element.attributes[attributes[0]] = attributes[1];
    }
    static_cast<std::vector<Element>*>(data)->push_back(element);
  });
  XML_SetCharacterDataHandler(parser, [](void* data, const XML_Char* text, int length) {
    static_cast<std::vector<Element>*>(data)->back().text.append(text, static_cast<std::size_t>(length));
  });
  const bool is_well_formed = XML_Parse(parser, xml.data(), static_cast<int>(xml.size()), 1) == XML_STATUS_OK;
  const XML_Error problem = XML_GetErrorCode(parser);
  XML_ParserFree(parser);
  if (!is_well_formed) {
    throw std::runtime_error(std::string("not well-formed: ") + XML_ErrorString(problem));
  }
  return elements;
}

/// Two checks with three limits: one met, one exceeded, one not evaluated. The names contain difficult characters.
class Outcomes : public testing::Test {
 protected:
  Outcomes() {
    checks_[0].name = "a <b> & \"c\" | 100 %, d: \xC3\xA9\x01\xFF";
    checks_[1].name = "second";
    add(0, "winding_peak_p95", 100.0).measured = {.value = 90.0, .basis = check::MarginBasis{1.0}};
    add(0, "current_margin", 1.0).measured = {.value = 0.5, .basis = check::MarginBasis{2.0}};
    add(1, "derating_excess", 0.0).reason =
        check::Failed{base::Failure(base::ExitCode::bad_input, "", {{{"guard.h", 3, 1}, {}, "is\nno table, 100 %"}})};
  }

  check::Outcome& add(std::size_t check, std::string_view threshold, double limit) {
    const int line = 10 + static_cast<int>(outcomes_.size());
    outcomes_.push_back({.check = &checks_.at(check),
                         .limit = {check::find_threshold(threshold), limit, "", "", {"/repository/checks/robot,1.toml", line, 5}}});
    return outcomes_.back();
  }

  std::array<check::Check, 2> checks_;
  std::vector<check::Outcome> outcomes_;
};

TEST_F(Outcomes, AreJunitThatParses) {
  const std::vector<Element> elements = parsed(junit_xml(outcomes_, "1.2.3"));
  std::map<std::string, std::vector<Element>> by_name;
  for (const Element& each : elements) {
    by_name[each.name].push_back(each);
  }
  EXPECT_EQ(elements.front().name, "testsuites");
  EXPECT_EQ(elements.front().attributes.at("tests"), "3");
  EXPECT_EQ(elements.front().attributes.at("failures"), "1");
  EXPECT_EQ(elements.front().attributes.at("errors"), "1");
  ASSERT_EQ(by_name["testsuite"].size(), 2U);
  EXPECT_EQ(by_name["testsuite"][0].attributes.at("name"), "a <b> & \"c\" | 100 %, d: \xC3\xA9?");
  EXPECT_EQ(by_name["testsuite"][0].attributes.at("tests"), "2");
  EXPECT_EQ(by_name["property"][0].attributes.at("value"), "1.2.3");
  ASSERT_EQ(by_name["testcase"].size(), 3U);
  EXPECT_EQ(by_name["testcase"][1].attributes.at("name"), "current_margin");
  EXPECT_EQ(by_name["testcase"][1].attributes.at("line"), "11");
  ASSERT_EQ(by_name["failure"].size(), 1U);
  EXPECT_EQ(by_name["failure"][0].attributes.at("message"), "0.5 A is below the limit of 1 A");
  ASSERT_EQ(by_name["error"].size(), 1U);
  EXPECT_EQ(by_name["error"][0].attributes.at("message"), "guard.h:3:1: is\nno table, 100 %");
}

TEST(JunitOfAFailure, is_one_error_with_every_problem) {
  const base::Failure failure(base::ExitCode::bad_input, "",
                              {{{"a<b.toml", 3, 9}, "check[0].robot", "there is no robot"}, {{"missing.toml"}, {}, "cannot be read"}});
  const std::vector<Element> elements = parsed(junit_xml({}, failure, "1.2.3"));
  EXPECT_EQ(elements.front().attributes.at("tests"), "1");
  EXPECT_EQ(elements.front().attributes.at("errors"), "1");
  EXPECT_EQ(elements.back().name, "error");
  EXPECT_THAT(elements.back().attributes.at("message"), HasSubstr("a<b.toml:3:9: error: check[0].robot: there is no robot"));
  EXPECT_THAT(elements.back().text, HasSubstr("missing.toml: error: cannot be read"));
}

TEST_F(Outcomes, StandInTheJunitBesideAFailure) {
  const base::Failure failure(base::ExitCode::bad_input, "", {{{"missing.toml"}, {}, "cannot be read"}});
  const std::vector<Element> elements = parsed(junit_xml(outcomes_, failure, "1.2.3"));
  EXPECT_EQ(elements.front().attributes.at("tests"), "4");
  EXPECT_EQ(elements.front().attributes.at("failures"), "1");
  EXPECT_EQ(elements.front().attributes.at("errors"), "2");
  EXPECT_EQ(std::ranges::count(elements, "testcase", &Element::name), 4);
  EXPECT_EQ(std::ranges::count(elements, "testsuite", &Element::name), 3);
  EXPECT_THAT(elements.back().text, HasSubstr("missing.toml: error: cannot be read"));
}

TEST_F(Outcomes, AreAnnotationsAtFileAndLine) {
  const std::string text = annotations(outcomes_, "/repository");
  EXPECT_THAT(text, HasSubstr("::error file=checks/robot%2C1.toml,line=11,col=5,title=a <b> & \"c\" | 100 %25%2C d%3A "));
  EXPECT_THAT(text, testing::AllOf(HasSubstr("guard.h,line=3,col=1,title="), HasSubstr("derating_excess::is%0Ano table, 100 %25\n")));
  EXPECT_THAT(text, Not(HasSubstr("winding_peak_p95")));
  EXPECT_THAT(annotations(outcomes_, "/elsewhere"), HasSubstr("file=/repository/checks/robot%2C1.toml,"));
}

TEST_F(Outcomes, AreAMarkdownTable) {
  const std::string text = summary_markdown(outcomes_, "1.2.3");
  EXPECT_THAT(text, HasSubstr("1 limit of 3 does not hold; 1 limit of 3 cannot be evaluated"));
  std::istringstream lines(text);
  int rows = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('|')) {
      // Bars inside a table cell must be escaped.
      std::size_t bars = 0;
      for (std::size_t i = 0; i < line.size(); ++i) {
        bars += line[i] == '|' && (i == 0 || line[i - 1] != '\\') ? 1 : 0;
      }
      EXPECT_EQ(bars, 8U) << line;
      ++rows;
    }
  }
  EXPECT_EQ(rows, 5);
  EXPECT_THAT(text, HasSubstr("| a &lt;b&gt; &amp; \"c\" \\| 100 %"));
}

// GitHub shows code as it is written, so references such as &lt; must not stand in it.
TEST_F(Outcomes, NamesOfNumbersAreCodeInTheMarkdownTable) {
  check::ThresholdType type = *check::find_threshold("current_margin");
  type.name = "motors.a<b&c|d.*";
  outcomes_[0].limit.type = &type;
  EXPECT_THAT(summary_markdown(outcomes_, "1.2.3"), HasSubstr("| `motors.a<b&c\\|d.*` |"));
  type.name = "a`b\nc";
  EXPECT_THAT(summary_markdown(outcomes_, "1.2.3"), HasSubstr("| `` a`b c `` |"));
}

}  // namespace
}  // namespace heatsoak::present
