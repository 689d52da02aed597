// Compares a committed table with a new one: C header and CSV, intact, modified, and of another motor.
#include "derate/committed_table.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <regex>
#include <sstream>

#include "base/diagnostic.h"
#include "base/files.h"
#include "derate/exporter.h"
#include "derate/header_text.h"
#include "derate/integer_form/quantised_table.h"
#include "guarded_motor.h"

namespace heatsoak::derate {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

Derating derating_with(const motor::Motor& motor, double heat_safety_factor, double approach_s = 0.5) {
  const GuardedMotor guarded(motor, rules_for(motor, approach_s), heat_safety_factor);
  Derating derating = derate::derating_of(guarded);
  derating.motor_id = motor.id;
  derating.robot_id = "a robot";
  derating.guarantee = {};
  return derating;
}

std::string exported_text(const Derating& derating, std::string_view form) {
  return std::ranges::find(all_exporters(), form, &ExporterType::name)->write(derating);
}

class Committed : public testing::TestWithParam<const char*> {
 protected:
  static void SetUpTestSuite() { fresh_ = new Derating(derating_with(ecx_32(), 1.5)); }
  static void TearDownTestSuite() { delete fresh_; }
  ~Committed() override { fs::remove(file_); }

  [[nodiscard]] CommittedTable read(const std::string& content) const {
    base::write_file(file_, content);
    return read_committed_table(file_);
  }
  [[nodiscard]] std::string message_of(const std::string& content) const {
    try {
      static_cast<void>(read(content));
    } catch (const base::Failure& failure) {
      return failure.what();
    }
    return "nothing was wrong";
  }

  /// Returns the table that a file of this form holds.
  static CurrentTable table_of(const Derating& derating) {
    return std::string_view(GetParam()) == "c_header_q15" ? integer_form::QuantisedTable(derating.table).in_units() : derating.table;
  }

  static Derating* fresh_;
  fs::path file_ = fs::path(testing::TempDir()) / fmt::format("heatsoak_committed_{}", static_cast<int>(getpid()));
};
Derating* Committed::fresh_ = nullptr;

TEST_P(Committed, SaysTheSameAsTheOneThatWroteIt) {
  const TableComparison found = compare(read(exported_text(*fresh_, GetParam())), *fresh_);
  EXPECT_EQ(found.excess.difference_A, 0.0);
  EXPECT_EQ(found.lost.difference_A, 0.0);
  EXPECT_TRUE(found.differing.empty()) << found.differing.front().text << "\n" << found.differing.front().other_text;
}

TEST_P(Committed, MayHaveTheLineEndsOfAnotherSystem) {
  std::string text = exported_text(*fresh_, GetParam());
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 2)) {
    text.insert(at, "\r");
  }
  const TableComparison found = compare(read(text), *fresh_);
  EXPECT_EQ(found.excess.difference_A, 0.0);
  EXPECT_EQ(found.lost.difference_A, 0.0);
  EXPECT_TRUE(found.differing.empty()) << found.differing.front().text << "\n" << found.differing.front().other_text;
}

TEST_P(Committed, NamesItsMotorAndRobot) {
  const CommittedTable committed = read(exported_text(*fresh_, GetParam()));
  EXPECT_EQ(committed.motor_id, fresh_->motor_id);
  EXPECT_EQ(committed.robot_id, fresh_->robot_id);
}

TEST_P(Committed, OfABolderReserveIsUnsafe) {
  const TableComparison found = compare(read(exported_text(derating_with(ecx_32(), 1.2), GetParam())), *fresh_);
  EXPECT_GT(found.excess.difference_A, 0.5);
  EXPECT_EQ(found.lost.difference_A, 0.0);
  EXPECT_NEAR(found.excess.committed_A - found.excess.fresh_A, found.excess.difference_A, 1e-12);
  EXPECT_NEAR(table_of(*fresh_).allowed_A(found.excess.speed_rad_per_s, found.excess.stator_C, found.excess.winding_C),
              found.excess.fresh_A, 1e-12);
}

TEST_P(Committed, OfAMoreCarefulReserveGivesCurrentAway) {
  const TableComparison found = compare(read(exported_text(derating_with(ecx_32(), 2.0), GetParam())), *fresh_);
  EXPECT_EQ(found.excess.difference_A, 0.0);
  EXPECT_GT(found.lost.difference_A, 0.5);
}

// The two tables share only the first point of their axes. The comparison must also find differences between the points.
TEST_P(Committed, IsComparedBetweenThePointsOfOtherAxes) {
  Derating other = *fresh_;
  other.table.most_speed_rad_per_s *= 1.1;
  other.table.no_current_speed_rad_per_s *= 1.1;
  const TableComparison found = compare(read(exported_text(other, GetParam())), *fresh_);
  const CurrentTable fresh = table_of(*fresh_);
  const CurrentTable changed = table_of(other);
  EXPECT_GE(found.excess.speed_rad_per_s, fresh.most_speed_rad_per_s);
  if (std::string_view(GetParam()) == "csv") {
    EXPECT_GT(found.excess.difference_A, 0.5);  // a CSV table contains only its own rows
    return;
  }
  // Beyond its last speed the new table allows no current.
  EXPECT_GE(found.excess.speed_rad_per_s, fresh.no_current_speed_rad_per_s);
  EXPECT_EQ(found.excess.fresh_A, 0.0);
  EXPECT_GT(found.excess.committed_A, 1.0);
  double most_A = 0.0;
  constexpr int kPoints = 40;
  const double speed_end = changed.no_current_speed_rad_per_s;
  for (int i = 0; i <= kPoints; ++i) {
    for (int k = 0; k <= kPoints; ++k) {
      const double speed = speed_end * i / kPoints;
      const double winding_C = std::lerp(fresh.winding_C.front(), fresh.winding_C.back(), static_cast<double>(k) / kPoints);
      const double stator_C = fresh.stator_C.front();
      most_A = std::max(most_A, changed.allowed_A(speed, stator_C, winding_C) - fresh.allowed_A(speed, stator_C, winding_C));
    }
  }
  EXPECT_GE(found.excess.difference_A, most_A - 0.01);
}

INSTANTIATE_TEST_SUITE_P(forms, Committed, testing::Values("c_header", "c_header_q15", "csv"),
                         [](const auto& instance) { return std::string(instance.param); });

using Tampered = Committed;

TEST_F(Tampered, OneCurrentIsFoundAtItsPlace) {
  std::string header = exported_text(*fresh_, "c_header");
  const std::vector<HeaderArray> arrays = header_arrays(header);
  const auto currents =
      std::ranges::find_if(arrays, [](const HeaderArray& each) { return each.name.ends_with("32l_48v_heat_per_ohm_A2"); });
  ASSERT_NE(currents, arrays.end());
  std::size_t comma = header.find('{', currents->begin);
  constexpr int kNumber = 1;
  for (int i = 0; i < kNumber; ++i) {
    comma = header.find(',', comma + 1);
  }
  header.replace(comma, header.find(',', comma + 1) - comma, ", 5555.0f");
  const TableComparison found = compare(read(header), *fresh_);
  EXPECT_NEAR(found.excess.committed_A, fresh_->table.most_current_A, 1e-4);
  const CurrentTable& table = fresh_->table;
  EXPECT_EQ(found.excess.winding_C, table.winding_C[kNumber % table.winding_C.size()]);
  EXPECT_EQ(found.excess.stator_C, table.stator_C[kNumber / table.winding_C.size() % table.stator_C.size()]);
  EXPECT_EQ(found.excess.speed_rad_per_s, table.speed_rad_per_s[kNumber / table.winding_C.size() / table.stator_C.size()]);
  EXPECT_TRUE(found.differing.empty());
}

TEST_F(Tampered, ObserverIsFoundAtItsLineWhereverCommentsSayOtherThings) {
  std::string header = exported_text(*fresh_, "c_header");
  header = std::regex_replace(header, std::regex("Generated by"), "Long ago made by\n * the old hands of");
  EXPECT_TRUE(compare(read(header), *fresh_).differing.empty());
  const std::size_t at = header.find("_rates(");
  const std::size_t number = header.find_first_of("123456789", header.find('{', at));
  header[number] = header[number] == '9' ? '8' : static_cast<char>(header[number] + 1);
  const TableComparison found = compare(read(header), *fresh_);
  ASSERT_EQ(found.differing.size(), 1U);
  EXPECT_EQ(found.differing.front().line, 1 + std::count(header.begin(), header.begin() + static_cast<std::ptrdiff_t>(number), '\n'));
  EXPECT_NE(found.differing.front().text, found.differing.front().other_text);
}

// A change of one thermal resistance also changes constants that are derived from it. The law explains them.
TEST_F(Tampered, LawIsListedBeforeTheConstantsThatFollowFromIt) {
  motor::Motor cooler = ecx_32();
  cooler.nominal.thermal_resistance_winding_stator_K_per_W *= 0.9;
  const TableComparison found = compare(read(exported_text(derating_with(cooler, 1.5), "c_header")), *fresh_);
  ASSERT_GT(found.differing.size(), 2U);
  EXPECT_THAT(found.differing.front().text, HasSubstr("winding_to_stator_W"));
  EXPECT_THAT(found.differing.front().other_text, HasSubstr("winding_to_stator_W"));
  EXPECT_THAT(found.differing.back().text, testing::AnyOf(HasSubstr("STRAIGHT_BELOW_A"), HasSubstr("resting_C"), HasSubstr("_SENSOR_")));
  Derating warmer = *fresh_;
  warmer.rules.limits.winding_C += 3.0;
  const TableComparison limit = compare(read(exported_text(warmer, "c_header")), *fresh_);
  ASSERT_FALSE(limit.differing.empty());
  EXPECT_THAT(limit.differing.front().text, HasSubstr("WINDING_LIMIT_C 158"));
  EXPECT_THAT(limit.differing.front().other_text, HasSubstr("WINDING_LIMIT_C 155"));
}

TEST_F(Tampered, StatementThatIsMissingOrAddedIsOneDifference) {
  const std::string header = exported_text(*fresh_, "c_header");
  const std::size_t law = header.find("  const float copper_loss_W");
  const std::size_t end = header.find(";\n", law) + 2;
  const std::vector<HeaderDifference> removed = differences(header.substr(0, law) + header.substr(end), header);
  ASSERT_EQ(removed.size(), 1U);
  EXPECT_EQ(removed[0].text, "(missing)");
  EXPECT_THAT(removed[0].other_text, HasSubstr("copper_loss_W"));
  const std::vector<HeaderDifference> added = differences(header.substr(0, law) + "  state_C[0] = 20.0f;\n" + header.substr(law), header);
  ASSERT_EQ(added.size(), 1U);
  EXPECT_THAT(added[0].text, HasSubstr("state_C[0] = 20.0f"));
  EXPECT_EQ(added[0].other_text, "(missing)");
  EXPECT_EQ(added[0].line, 1 + std::count(header.begin(), header.begin() + static_cast<std::ptrdiff_t>(law), '\n'));
}

TEST_F(Tampered, CurrentsOnlyTheIgnoredShareHigherHold) {
  // The copper heat is the square of the current.
  const auto excess_A = [&](double current_ratio) {
    Derating higher = *fresh_;
    for (double& heat_A2 : higher.table.heat_per_ohm_A2) {
      heat_A2 *= current_ratio * current_ratio;
    }
    return compare(read(exported_text(higher, "c_header")), *fresh_).excess.difference_A;
  };
  EXPECT_EQ(excess_A(1.0 + 0.9 * kIgnored_share), 0.0);
  EXPECT_GT(excess_A(1.0 + 1.2 * kIgnored_share), 0.0);
}

TEST_F(Tampered, IntegersOfAHeaderAreFoundOrRefused) {
  const std::string header = exported_text(*fresh_, "c_header_q15");
  EXPECT_TRUE(compare(read(header), *fresh_).differing.empty());
  const auto with = [&](const char* pattern, const char* replacement) {
    const std::string changed = std::regex_replace(header, std::regex(pattern), replacement, std::regex_constants::format_first_only);
    EXPECT_NE(changed, header) << pattern;
    return changed;
  };
  EXPECT_GT(compare(read(with("(q15_heat_per_ohm\\[\\d+\\] = \\{\\s*(?:-?\\d+, ){1})-?\\d+", "$0132000")), *fresh_).excess.difference_A,
            0.5);
  EXPECT_GT(compare(read(with("(_heat_per_ohm,\\s*)\\d+u", "$0199000u")), *fresh_).excess.difference_A, 0.5);
  EXPECT_FALSE(compare(read(with("(change\\[0\\] = \\(+int64_t\\)\\w+ \\+ )\\d", "$019")), *fresh_).differing.empty());
  EXPECT_THAT(message_of(with("(q15_heat_per_ohm\\[\\d+\\] = \\{\\s*)\\d+,", "$01")), HasSubstr("no whole table of integers"));
  EXPECT_THAT(message_of(with("(q15_heat_per_ohm\\[\\d+\\] = \\{\\s*)\\d+,", "$0140000,")), HasSubstr("no whole table of integers"));
  EXPECT_THAT(message_of(with("(q15_winding_mC\\[\\d+\\] = \\{\\s*)-?\\d+,", "$011.5,")), HasSubstr("no whole table of integers"));
  EXPECT_THAT(message_of(with("(q15_winding_mC\\[\\d+\\] = \\{\\s*)-?\\d+,", "$01999000,")), HasSubstr("does not increase"));
}

// Headers of earlier versions store squares, whose reader does not divide by the resistance.
TEST_F(Tampered, TableOfSquaresIsRefused) {
  const auto renamed = [](const char* form, const char* from, const char* to) {
    return std::regex_replace(exported_text(*fresh_, form), std::regex(from), to);
  };
  EXPECT_THAT(message_of(renamed("c_header", "_heat_per_ohm_A2", "_square_A2")), HasSubstr("the form of earlier versions"));
  EXPECT_THAT(message_of(renamed("c_header_q15", "_q15_heat_per_ohm", "_q15_square")), HasSubstr("the form of earlier versions"));
}

TEST_F(Tampered, ResistanceIsReadAndRefusedUnlessPositive) {
  const std::string header = exported_text(*fresh_, "c_header");
  const auto with = [&](const char* name, const char* value) {
    return std::regex_replace(header, std::regex(fmt::format("(#define \\w+_{}) \\S+\n", name)), fmt::format("$1 {}\n", value));
  };
  EXPECT_GT(compare(read(with("RESISTANCE_AT_0C_RATIO", "0.5f")), *fresh_).excess.difference_A, 0.5);
  EXPECT_THAT(message_of(with("RESISTANCE_AT_0C_RATIO", "-0.5f")), HasSubstr("RESISTANCE_AT_0C_RATIO"));
  EXPECT_THAT(message_of(with("RESISTANCE_RATIO_PER_K", "-0.001f")), HasSubstr("RESISTANCE_RATIO_PER_K"));
  EXPECT_THAT(message_of(with("RESISTANCE_RATIO_PER_K", "high")), HasSubstr("RESISTANCE_RATIO_PER_K"));
}

TEST_F(Tampered, VersionOfTheWriterIsRead) {
  EXPECT_EQ(read("/* heatsoak 9.8.7 */\n" + exported_text(*fresh_, "c_header")).version, "9.8.7");
}

// The header is cut before, inside and behind the table.
TEST_F(Tampered, HeaderThatIsCutOffIsNeverTakenForACsvTable) {
  const std::string header = exported_text(*fresh_, "c_header");
  for (const std::string_view last : {"#ifndef", "#include", "_heat_per_ohm_A2[", "_advance("}) {
    const std::size_t cut = header.find('\n', header.find(last));
    ASSERT_NE(cut, std::string::npos) << last;
    EXPECT_THAT(message_of(header.substr(0, cut + 1)), HasSubstr("truncated")) << last;
  }
  EXPECT_THAT(message_of(header.substr(0, 300)), HasSubstr("truncated"));
}

// An entry that a compiler reads differently than its leading number is no valid table entry.
TEST_F(Tampered, EntriesAreWholeNumbers) {
  const std::string text = exported_text(*fresh_, "c_header");
  const std::size_t array = text.find('{', text.find("_heat_per_ohm_A2["));
  const std::size_t end = text.find(',', array);
  const std::size_t begin = text.find_first_of("0123456789", array);
  for (const char* const entry : {"9.0f * 8.0f", "0x1p9f", "0x63", "1.0f + 98.0f", "9.0f /* x */ * 9", "1.0e", "1.0foo", ""}) {
    const std::string tampered = text.substr(0, begin) + entry + text.substr(end);
    EXPECT_THAT(message_of(tampered), testing::HasSubstr("error")) << entry;
  }
}

TEST_F(Tampered, HiddenLineIsRefused) {
  const std::string text = exported_text(*fresh_, "c_header");
  const std::size_t place = text.find("\n", text.find("_advance("));
  for (const char* const hidden : {"  // checked \\\n", "  // checked ?\?/\n"}) {
    EXPECT_THAT(message_of(text.substr(0, place + 1) + hidden + text.substr(place + 1)), testing::HasSubstr("backslash")) << hidden;
  }
}

TEST_F(Tampered, HexadecimalConstantIsCompared) {
  std::string text = exported_text(*fresh_, "c_header");
  const std::size_t at = text.find("_STARTED 0x");
  ASSERT_NE(at, std::string::npos);
  text[at + 11] = text[at + 11] == '1' ? '2' : '1';
  EXPECT_FALSE(compare(read(text), *fresh_).differing.empty());
}

// Its rows are a full grid and agree with the fresh table, but its reader would extrapolate the current of a cooler winding.
TEST_F(Tampered, CsvTableThatEndsBeforeTheFreshOneIsRefused) {
  std::istringstream csv(exported_text(*fresh_, "csv"));
  const double middle_C = 0.5 * (fresh_->table.winding_C.front() + fresh_->table.winding_C.back());
  std::string cut;
  for (std::string line; std::getline(csv, line);) {
    std::istringstream cells(line);
    double speed_rad_per_s = 0.0;
    double stator_C = 0.0;
    double winding_C = 0.0;
    char comma = 0;
    const bool is_row = static_cast<bool>(cells >> speed_rad_per_s >> comma >> stator_C >> comma >> winding_C);
    cut += is_row && winding_C > middle_C ? "" : line + "\n";
  }
  try {
    compare(read(cut), *fresh_);
    FAIL() << "a table without hot windings was accepted";
  } catch (const base::Failure& failure) {
    EXPECT_THAT(failure.what(), AllOf(HasSubstr("winding"), HasSubstr("covers"), HasSubstr("cut off")));
  }
}

TEST_F(Tampered, WhatIsNoTableIsRefused) {
  const std::string csv = exported_text(*fresh_, "csv");
  const std::string header = exported_text(*fresh_, "c_header");
  const std::size_t last_row = csv.rfind('\n', csv.size() - 2);
  EXPECT_THAT(message_of(csv.substr(0, last_row + 1)), HasSubstr("missing at the end"));
  EXPECT_THAT(message_of("speed,current\n1,2\n"), HasSubstr("speed_rad_per_s"));
  EXPECT_THAT(message_of(std::regex_replace(csv, std::regex("\n0,"), "\n-0.5,", std::regex_constants::format_first_only)),
              HasSubstr("grid"));
  EXPECT_THAT(message_of("static const float x[2] = {1.0f, 2.0f};\n"), HasSubstr("contains no derating table"));
  EXPECT_THAT(message_of(std::regex_replace(header, std::regex("(_winding_C\\[\\d+\\] = \\{\\s*)[0-9.]+f,"), "$1")),
              HasSubstr("the product of the lengths of its axes"));
  EXPECT_THAT(message_of(std::regex_replace(header, std::regex("(48v_heat_per_ohm_A2\\[\\d+\\] = \\{\\s*)[0-9.]+f,"), "$1nan,")),
              HasSubstr("a current that is not a finite number"));
  EXPECT_THAT(message_of(std::regex_replace(header, std::regex("(48v_winding_C\\[\\d+\\] = \\{\\s*)[0-9.]+f,"), "$01999.0f,")),
              HasSubstr("does not increase"));
}

}  // namespace
}  // namespace heatsoak::derate
