// Texts that several generated headers share: their include guards detect another text of the same name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/crc.hpp>
#include <cstdlib>
#include <fstream>
#include <regex>
#include <sstream>

#include "base/source_text.h"
#include "derate/observer.h"
#include "exported_motor.h"

namespace heatsoak::derate {
namespace {

namespace fs = std::filesystem;

std::string content_of(const fs::path& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

class SharedText : public testing::TestWithParam<const char*> {};

// The number is the CRC-32 of the code in which the number itself is 0. A longer comment does not change it.
TEST_P(SharedText, GuardHasTheCheckSumOfTheCode) {
  const std::string text = content_of(kSource / GetParam());
  const std::regex number("(_H (?:!= )?)0x([0-9a-f]{8})u");
  const std::string code = base::without_comments(std::regex_replace(text, number, "$010x00000000u"));
  boost::crc_32_type sum;
  sum.process_bytes(code.data(), code.size());
  int found = 0;
  for (std::sregex_iterator each(text.begin(), text.end(), number), end; each != end; ++each) {
    EXPECT_EQ((*each)[2], fmt::format("{:08x}", sum.checksum())) << "the code has changed: write this number in both places";
    ++found;
  }
  EXPECT_EQ(found, 2) << "#define and #elif";
}

INSTANTIATE_TEST_SUITE_P(Files, SharedText,
                         testing::Values("robot_core/crc_32.h", "robot_core/current_table.h", "robot_core/thermal_math.h",
                                         "src/derate/integer_form/integer_table.h"),
                         [](const auto& instance) { return fs::path(instance.param).stem().string(); });

/// Returns the meaning itself, without sign convention and substitute.
std::string first_clause(std::string_view meaning) {
  const std::string_view clause = meaning.substr(0, meaning.find_first_of(",;("));
  return std::string(clause.substr(0, clause.find_last_not_of(' ') + 1));
}

// robot_core cannot include the table of signals, so its comments repeat the meanings.
TEST(GuardSignals, MeanTheSameInTheDriveCoreAsInTheTable) {
  const std::string text = content_of(kSource / "robot_core/thermal_guard.h");
  for (std::size_t i = 0; i < observed::kSignalCount; ++i) {
    const base::FirmwareInput& input = observed::firmware_of(i);
    std::smatch comment;
    ASSERT_TRUE(std::regex_search(text, comment, std::regex(fmt::format("SIGNAL\\({}\\) */\\* ([^*]*)\\*/", input.field)))) << input.field;
    EXPECT_EQ(first_clause(comment[1].str()), first_clause(input.meaning)) << input.field;
  }
}

class TwoHeaders : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  /// Compiles both headers in one program; returns the compiler's messages, empty if there is none.
  [[nodiscard]] std::string compiled(const std::string& one, const std::string& other) const {
    std::ofstream(folder_ / "one.h") << one;
    std::ofstream(folder_ / "other.h") << other;
    std::ofstream(folder_ / "use.c") << "#include \"one.h\"\n#include \"other.h\"\nint unused;\n";
    const int code = std::system(
        fmt::format("cd '{}' && cc -std=c99 -Wall -Wextra -Wundef -Werror -c -o use.o use.c 2> messages", folder_.string()).c_str());
    return code == 0 ? std::string() : content_of(folder_ / "messages");
  }

  fs::path folder_ = fs::path(testing::TempDir()) / fmt::format("heatsoak_two_headers_{}", static_cast<int>(getpid()));
};

Derating of_another_motor() {
  Derating other = ecx_derating();
  other.motor_id = "another";
  return other;
}

TEST_F(TwoHeaders, OfOneVersionCompileTogether) {
  for (const char* const form : {"c_header", "c_header_q15"}) {
    EXPECT_EQ(compiled(exported(form), exported(form, of_another_motor())), "") << form;
  }
  EXPECT_EQ(compiled(exported("c_header"), exported("c_header_q15")), "");
}

TEST_F(TwoHeaders, OfTwoVersionsAreAnError) {
  for (const auto& [form, macro] : {std::pair("c_header", "CURRENT_TABLE"), std::pair("c_header", "CRC_32"),
                                    std::pair("c_header_q15", "INTEGER_TABLE"), std::pair("c_header_q15", "CRC_32")}) {
    const std::string number = fmt::format("(HEATSOAK_{}_H (?:!= )?)0x[0-9a-f]+u", macro);
    const std::string changed = std::regex_replace(exported(form, of_another_motor()), std::regex(number), "$010x12345678u");
    EXPECT_THAT(compiled(exported(form), changed), testing::HasSubstr("different heatsoak versions")) << form << " " << macro;
    // Earlier versions define the guard without a number.
    const std::string earlier =
        std::regex_replace(exported(form, of_another_motor()), std::regex(fmt::format("(#define HEATSOAK_{}_H) 0x.*", macro)), "$1");
    EXPECT_NE(compiled(earlier, exported(form)), "") << form << " " << macro;
  }
}

// Otherwise the first header would silently replace the second.
TEST_F(TwoHeaders, OfTwoGuardsOfOneMotorAreAnError) {
  Derating other = ecx_derating();
  other.options.period_s = 0.02;
  for (const char* const form : {"c_header", "c_header_q15"}) {
    EXPECT_NE(compiled(exported(form), exported(form, other)), "") << form;
  }
}

}  // namespace
}  // namespace heatsoak::derate
