#include "input/csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <fstream>

#include "base/diagnostic.h"

namespace heatsoak::input {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

const std::array<std::string, 2> kWanted{"time_s", "current_A"};
const std::array<std::string, 1> kOptional{"bus_V"};

class CsvTest : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(file_); }
  void read(const std::string& content) {
    std::ofstream(file_, std::ios::binary) << content;
    rows_.clear();
    lines_.clear();
    read_csv(file_, kWanted, kOptional, [this](const CsvRow& row) {
      rows_.emplace_back(row.values.begin(), row.values.end());
      lines_.push_back(row.line);
    });
  }
  /// Returns "line:column key: message" for every problem.
  std::vector<std::string> problems(const std::string& content) {
    std::vector<std::string> result;
    try {
      read(content);
    } catch (const base::Failure& failure) {
      EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
      for (const base::Diagnostic& each : failure.diagnostics()) {
        result.push_back(std::to_string(each.at.line.value_or(0)) + ":" + std::to_string(each.at.column.value_or(0)) + " " + each.key +
                         ": " + each.message);
      }
    }
    return result;
  }

  std::filesystem::path file_ = std::filesystem::temp_directory_path() / ("heatsoak_csv_" + std::to_string(::getpid()) + ".csv");
  std::vector<std::vector<double>> rows_;
  std::vector<int> lines_;
};

TEST_F(CsvTest, columns_may_be_chosen_by_the_header) {
  std::ofstream(file_, std::ios::binary) << "\xEF\xBB\xBF\"b_V\",a_A,\"time_s\"\n2,1,0\n4,3,1\n";
  std::vector<std::string> seen;
  const auto choose = [&](std::span<const std::string> header) {
    seen.assign(header.begin(), header.end());
    return CsvColumns{{"time_s", header.front()}, {"absent_W"}};
  };
  read_csv(file_, choose, {}, [this](const CsvRow& row) { rows_.emplace_back(row.values.begin(), row.values.begin() + 2); });
  EXPECT_THAT(seen, ElementsAre("b_V", "a_A", "time_s"));
  EXPECT_THAT(rows_, ElementsAre(ElementsAre(0.0, 2.0), ElementsAre(1.0, 4.0)));
}

TEST_F(CsvTest, finds_columns_by_name_in_any_order) {
  read("note,current_A,bus_V,time_s\nx,2,24,0\ny,3.5,23,1e-1\n");
  EXPECT_THAT(rows_, ElementsAre(ElementsAre(0.0, 2.0, 24.0), ElementsAre(0.1, 3.5, 23.0)));
  EXPECT_THAT(lines_, ElementsAre(2, 3));
}

TEST_F(CsvTest, an_optional_column_that_is_absent_gives_nan) {
  read("time_s,current_A\n0,1\n");
  EXPECT_TRUE(std::isnan(rows_.at(0).at(2)));
}

TEST_F(CsvTest, the_last_line_needs_no_end) {
  read("time_s,current_A\n0,1\n1,2");
  EXPECT_THAT(rows_, SizeIs(2));
}

TEST_F(CsvTest, line_ends_blanks_byte_order_mark_and_signs) {
  read("\xEF\xBB\xBF time_s , \"current_A\"\r\n 0 , +1 \r\n\r\n1,\"-2\"\r\n");
  EXPECT_EQ(rows_.at(0).at(1), 1.0);
  EXPECT_EQ(rows_.at(1).at(1), -2.0);
  EXPECT_THAT(lines_, ElementsAre(2, 4));
}

TEST_F(CsvTest, line_breaks_in_quotes_count) {
  read("time_s,\"no\nte\",current_A\n0,\"a \"\"b\"\", c\n\nd\",1\n1,,2\n");
  EXPECT_THAT(lines_, ElementsAre(3, 6));  // lines where the rows start
  EXPECT_EQ(rows_.at(1).at(1), 2.0);
}

TEST_F(CsvTest, places_of_bad_cells) {
  const std::vector<std::string> said = problems("note,time_s,current_A\na,0,1\nb,x,\n\"c,µ\",1,1e999\nd,2,0x10\n");
  ASSERT_THAT(said, SizeIs(4));
  EXPECT_THAT(said[0], HasSubstr("3:3 time_s: \"x\""));
  EXPECT_THAT(said[1], HasSubstr("3:5 current_A: \"\""));
  EXPECT_THAT(said[2], HasSubstr("4:9 current_A: \"1e999\""));
  EXPECT_THAT(said[3], HasSubstr("5:5 current_A: \"0x10\""));
}

TEST_F(CsvTest, cells_of_other_columns_may_hold_anything) { EXPECT_THAT(problems("time_s,note,current_A\n0,nan,1\n1,,2\n"), IsEmpty()); }

TEST_F(CsvTest, a_missing_column_has_a_suggestion) {
  EXPECT_THAT(problems("time_s,curent_A\n0,1\n"),
              ElementsAre(HasSubstr("1:1 current_A: there is no such column; did you mean 'curent_A'?")));
}

TEST_F(CsvTest, lists_twenty_problems_and_counts_the_rest) {
  std::string content = "time_s,current_A\n";
  for (int i = 0; i < 57; ++i) {
    content += "x,1\n";
  }
  const std::vector<std::string> said = problems(content);
  ASSERT_THAT(said, SizeIs(21));
  EXPECT_THAT(said.back(), HasSubstr("and 37 more problems"));
}

// Valid rows are still returned, so that the same run can report problems with their order.
TEST_F(CsvTest, sound_rows_are_given_beside_a_problem) {
  EXPECT_THAT(problems("time_s,current_A\n0,1\nx,1\n2,1\n3\n4,1\n"), SizeIs(2));
  EXPECT_THAT(lines_, ElementsAre(2, 4, 6));
}

TEST_F(CsvTest, quotes_that_do_not_match) {
  EXPECT_THAT(problems("time_s,current_A\n0,\"1\n1,2\n"), ElementsAre(HasSubstr("not closed")));
  EXPECT_THAT(problems("time_s,current_A\n0,1\"2\n"), ElementsAre(HasSubstr("2:1 : a quote stands inside a cell")));
}

TEST_F(CsvTest, memory_does_not_grow_with_the_file) {
  {
    std::ofstream stream(file_, std::ios::binary);
    stream << "time_s,current_A,note\n";
    for (int i = 0; stream.tellp() < 50'000'000; ++i) {
      stream << i << ",1.25,\"a note, quoted\"\n";
    }
  }
  const auto memory_kB = [] {
    rusage used{};
    ::getrusage(RUSAGE_SELF, &used);
    return used.ru_maxrss;
  };
  const long before_kB = memory_kB();
  const auto start = std::chrono::steady_clock::now();
  double last_s = -1.0;
  std::size_t rows = 0;
  read_csv(file_, kWanted, {}, [&](const CsvRow& row) {
    ++rows;
    last_s = row.values[0];
  });
  const double elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  RecordProperty("MB_per_s", static_cast<int>(50.0 / elapsed_s));
  EXPECT_EQ(last_s, static_cast<double>(rows - 1));
  EXPECT_LT(memory_kB() - before_kB, 5'000);
}

}  // namespace
}  // namespace heatsoak::input
