#include "input/reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <optional>

#include "base/files.h"

namespace heatsoak::input {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// Writes the text to a file and reads it.
class ReaderTest : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(file_); }
  Reader read(const std::string& toml) {
    std::ofstream(file_, std::ios::binary) << toml;
    root_ = read_toml(file_);
    return {root_, "", diagnostics_};
  }
  /// Returns "line:column key" for every problem.
  [[nodiscard]] std::vector<std::string> places() const {
    std::vector<std::string> result;
    for (const base::Diagnostic& each : diagnostics_.list()) {
      result.push_back(std::to_string(each.at.line.value_or(0)) + ":" + std::to_string(each.at.column.value_or(0)) + " " + each.key);
    }
    return result;
  }
  [[nodiscard]] std::string message() const { return diagnostics_.empty() ? "" : diagnostics_.list().front().message; }

  std::filesystem::path file_ = std::filesystem::temp_directory_path() / ("heatsoak_reader_" + std::to_string(::getpid()) + ".toml");
  Value root_;
  base::Diagnostics diagnostics_;
};

const base::ParameterSpec kResistance{"resistance", "ohm", base::Range::positive(), "of the test"};
const base::ParameterSpec kTemperature{"temperature", "degC", base::Range::between(-40.0, 100.0), "of the test"};

TEST_F(ReaderTest, converts_a_quantity) {
  EXPECT_DOUBLE_EQ(read("resistance = \"608 mohm\"").quantity(kResistance, Need::required).value(), 0.608);
  EXPECT_TRUE(diagnostics_.empty());
}

TEST_F(ReaderTest, counts_columns_in_characters_as_an_editor_does) {
  read("x = { \"ä\" = \"ü\", resistance = \"1 V\" }").table("x", Need::required)->quantity(kResistance, Need::required);
  EXPECT_THAT(places(), ElementsAre("1:31 x.resistance"));
}

TEST_F(ReaderTest, a_missing_key_is_reported_where_its_table_begins) {
  Reader top = read("\n[a]\nx = 1\n\n[a.b]\ny = 2\n");
  top.text("name", Need::required);
  top.table("a", Need::required)->table("b", Need::required)->text("z", Need::required);
  EXPECT_THAT(places(), ElementsAre("1:1 name", "5:1 a.b.z"));
}

TEST_F(ReaderTest, optional_keys_may_be_absent) {
  Reader top = read("");
  EXPECT_FALSE(top.text("a", Need::optional));
  EXPECT_FALSE(top.flag("b", Need::optional));
  EXPECT_FALSE(top.quantity(kResistance, Need::optional));
  EXPECT_FALSE(top.parameter(kResistance, Need::optional));
  EXPECT_FALSE(top.table("d", Need::optional));
  EXPECT_THAT(top.texts("e", Need::optional), IsEmpty());
  EXPECT_THAT(top.tables("f"), IsEmpty());
  top.finish();
  EXPECT_TRUE(diagnostics_.empty());
}

TEST_F(ReaderTest, names_unknown_keys_with_the_nearest_known_one) {
  Reader top = read("resistence = \"1 ohm\"\n");
  top.quantity(kResistance, Need::optional);
  top.finish();
  EXPECT_THAT(places(), ElementsAre("1:14 resistence"));
  EXPECT_THAT(message(), HasSubstr("did you mean 'resistance'?"));
}

TEST_F(ReaderTest, items_of_a_list_are_named_one_by_one) {
  read("names = [\"a\", 1,\n  true, \"b\"]\n").texts("names", Need::required);
  EXPECT_THAT(places(), ElementsAre("1:15 names", "2:3 names"));
}

TEST_F(ReaderTest, tables_of_a_list_are_numbered) {
  Reader top = read("[[wheel]]\n[[wheel]]\nresistance = \"-1 ohm\"\n");
  std::vector<Reader> wheels = top.tables("wheel");
  ASSERT_THAT(wheels, SizeIs(2));
  wheels[1].quantity(kResistance, Need::required);
  EXPECT_THAT(places(), ElementsAre("3:14 wheel[1].resistance"));
}

TEST_F(ReaderTest, a_wrong_quantity_of_a_list_is_reported_at_its_place) {
  const std::vector<double> values =
      read(R"(resistance = ["1 ohm", 2, "3 V", "-4 ohm", "5000 mohm"])").quantities(kResistance, Need::required);
  EXPECT_THAT(values, ElementsAre(1.0, 0.0, 0.0, 0.0, 5.0));
  EXPECT_THAT(places(), ElementsAre("1:24 resistance[1]", "1:27 resistance[2]", "1:34 resistance[3]"));
}

base::ParameterValue parameter_of(std::optional<base::ParameterValue> parameter) { return parameter.value_or(base::ParameterValue{}); }

TEST_F(ReaderTest, a_tolerance_is_a_share_and_of_a_temperature_a_difference) {
  Reader top = read(
      "resistance = { value = \"2 ohm\", origin = \"datasheet\", source = \"s\", tolerance = \"10 %\" }\n"
      "temperature = { value = \"20 degC\", origin = \"datasheet\", source = [\"s\", \"t\"], tolerance = \"3 K\" }\n");
  const base::ParameterValue resistance = parameter_of(top.parameter(kResistance, Need::required));
  const base::ParameterValue temperature = parameter_of(top.parameter(kTemperature, Need::required));
  ASSERT_TRUE(diagnostics_.empty()) << message();
  EXPECT_DOUBLE_EQ(resistance.spread->low, 1.8);
  EXPECT_DOUBLE_EQ(resistance.spread->high, 2.2);
  EXPECT_DOUBLE_EQ(temperature.spread->low, 17.0);
  EXPECT_DOUBLE_EQ(temperature.spread->high, 23.0);
  EXPECT_EQ(temperature.source, "s, t");
}

constexpr base::ParameterSpec kShare{"share", "", base::Range::between(0.0, 1.0), "a share"};

TEST_F(ReaderTest, a_tolerance_stays_within_the_possible_range) {
  read("share = { value = \"0.9\", origin = \"measured\", source = \"s\", tolerance = \"20 %\" }").parameter(kShare, Need::required);
  EXPECT_THAT(places(), ElementsAre("1:73 share.tolerance"));
  EXPECT_EQ(message(),
            "reaches 0.72 to 1.08, beyond the possible range; expected 0 to 1; give a smaller tolerance, or a range in place of it");
}

TEST_F(ReaderTest, a_tolerance_may_reach_the_end_of_the_possible_range) {
  const base::ParameterValue share = parameter_of(
      read("share = { value = \"0.8\", origin = \"measured\", source = \"s\", tolerance = \"25 %\" }").parameter(kShare, Need::required));
  ASSERT_TRUE(diagnostics_.empty()) << message();
  EXPECT_DOUBLE_EQ(share.spread->high, 1.0);
}

TEST_F(ReaderTest, a_range_has_units_of_its_own) {
  const base::ParameterValue parameter = parameter_of(
      read("resistance = { value = \"2 ohm\", origin = \"measured\", source = \"s\", range = [\"1900 mohm\", \"0.0025 kohm\"] }")
          .parameter(kResistance, Need::required));
  ASSERT_TRUE(diagnostics_.empty()) << message();
  EXPECT_DOUBLE_EQ(parameter.spread->low, 1.9);
  EXPECT_DOUBLE_EQ(parameter.spread->high, 2.5);
}

TEST_F(ReaderTest, other_sources_of_a_value_have_units_too) {
  const base::ParameterValue parameter = parameter_of(
      read(R"(resistance = { value = "2 ohm", origin = "measured", source = "s", confirmed_by = { a = "2100 mohm", b = "1.9 ohm" } })")
          .parameter(kResistance, Need::required));
  ASSERT_TRUE(diagnostics_.empty()) << message();
  ASSERT_EQ(parameter.confirmed_by.size(), 2U);
  EXPECT_EQ(parameter.confirmed_by[0].source, "a");
  EXPECT_DOUBLE_EQ(parameter.confirmed_by[0].value, 2.1);
  EXPECT_EQ(parameter.confirmed_by[0].printed, "2100 mohm");
}

TEST_F(ReaderTest, an_unknown_origin_is_one_problem_not_three) {
  read("resistance = { value = \"2 ohm\", origin = \"internet\" , source = \"s\"}").parameter(kResistance, Need::required);
  EXPECT_THAT(places(), ElementsAre("1:42 resistance.origin"));
}

TEST_F(ReaderTest, an_invalid_value_hides_no_other_problem_of_its_entry) {
  read("resistance = { value = \"42\", origin = \"measured\", source = \"s\", tolerance = \"150 %\" }")
      .parameter(kResistance, Need::required);
  EXPECT_THAT(places(), ElementsAre("1:24 resistance.value", "1:77 resistance.tolerance"));
}

TEST_F(ReaderTest, a_range_around_an_invalid_value_is_checked_for_its_order_only) {
  read("resistance = { value = \"42\", origin = \"measured\", source = \"s\", range = [\"1 ohm\", \"2 ohm\"] }")
      .parameter(kResistance, Need::required);
  EXPECT_THAT(places(), ElementsAre("1:24 resistance.value"));
}

TEST_F(ReaderTest, problems_come_sorted_by_place) {
  Reader top = read("a = 1\nb = 2\nresistance = \"1 V\"\n");
  top.quantity(kResistance, Need::required);
  top.text("b", Need::required);
  top.text("a", Need::required);
  try {
    diagnostics_.throw_if_any();
    FAIL() << "nothing thrown";
  } catch (const base::Failure& failure) {
    std::vector<std::string> keys;
    for (const base::Diagnostic& each : failure.diagnostics()) {
      keys.push_back(each.key);
    }
    EXPECT_THAT(keys, ElementsAre("a", "b", "resistance"));
    EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
  }
}

TEST_F(ReaderTest, nothing_is_left_of_a_file_that_cannot_be_written) {
  EXPECT_THROW(base::write_file("/proc/no_such_place/x", "text"), base::Failure);
  base::write_file(file_, "first");
  base::write_file(file_, "second");
  EXPECT_EQ(base::read_file(file_, 100), "second");
  EXPECT_THROW(base::read_file(file_, 5), base::Failure);
}

}  // namespace
}  // namespace heatsoak::input
