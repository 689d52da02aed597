#include "base/quantity.h"

#include <gtest/gtest.h>

#include <atomic>
#include <clocale>
#include <cmath>
#include <limits>
#include <locale>
#include <numbers>
#include <random>
#include <stdexcept>
#include <thread>
#include <vector>

namespace heatsoak::base {
namespace {

constexpr double kRpm_rad_per_s = 2.0 * std::numbers::pi / 60.0;

struct Spelling {
  const char* text;
  const char* unit;
  double value;
};

class SheetSpelling : public testing::TestWithParam<Spelling> {};

TEST_P(SheetSpelling, is_read) {
  const auto& [text, unit, value] = GetParam();
  const ParsedQuantity parsed = parse_quantity(text, unit);
  EXPECT_TRUE(parsed.ok()) << text << ": " << parsed.problem;
  EXPECT_NEAR(parsed.value, value, 1e-12 * std::abs(value) + 1e-300) << text;
}

// Reference values calculated by hand from the definitions of the units.
INSTANTIATE_TEST_SUITE_P(
    Sheets, SheetSpelling,
    testing::Values(
        Spelling{"36.9 mNm/A", "N m/A", 0.0369}, Spelling{"36.9 mN m/A", "N m/A", 0.0369}, Spelling{"36.9mNm/A", "N m/A", 0.0369},
        Spelling{"0.0369 Nm/A", "N m/A", 0.0369}, Spelling{"0.0369 N m/A", "N m/A", 0.0369}, Spelling{"181 gcm2", "kg m2", 1.81e-5},
        Spelling{"181 g cm2", "kg m2", 1.81e-5}, Spelling{"181 gcm²", "kg m2", 1.81e-5}, Spelling{"181 g cm²", "kg m2", 1.81e-5},
        Spelling{"265 rpm/V", "rad/s/V", 265.0 * kRpm_rad_per_s}, Spelling{"4.26 rpm/mNm", "rad/s/(N m)", 4260.0 * kRpm_rad_per_s},
        Spelling{"4.26 rpm/(mN m)", "rad/s/(N m)", 4260.0 * kRpm_rad_per_s}, Spelling{"6000 rpm", "rad/s", 200.0 * std::numbers::pi},
        Spelling{"12 rad/s", "rad/s", 12.0}, Spelling{"90 deg", "rad", std::numbers::pi / 2.0},
        Spelling{"-30 deg", "rad", -std::numbers::pi / 6.0}, Spelling{"0.463 mH", "H", 0.463e-3}, Spelling{"463 uH", "H", 0.463e-3},
        Spelling{"463 µH", "H", 0.463e-3} /* U+00B5 */, Spelling{"463 μH", "H", 0.463e-3} /* U+03BC */, Spelling{"5 µNm", "N m", 5e-6},
        Spelling{"5 μNm", "N m", 5e-6}, Spelling{"5 uNm", "N m", 5e-6}, Spelling{"2 kNm", "N m", 2000.0},
        Spelling{"155 degC", "degC", 155.0}, Spelling{"155 °C", "degC", 155.0}, Spelling{"311 degF", "degC", 155.0},
        Spelling{"428.15 K", "degC", 155.0}, Spelling{"-40 degC", "degC", -40.0}, Spelling{"3.8 K/W", "K/W", 3.8},
        Spelling{"12 s", "s", 12.0}, Spelling{"12 ms", "s", 0.012}, Spelling{"2 min", "s", 120.0}, Spelling{"0.39 %/K", "1/K", 0.0039},
        Spelling{"10 %", "", 0.1}, Spelling{"10%", "", 0.1}, Spelling{"8", "", 8.0}, Spelling{"0.85", "", 0.85},
        Spelling{"1.07 ohm", "ohm", 1.07}, Spelling{"1.07 Ω", "ohm", 1.07}, Spelling{"205 mohm", "ohm", 0.205}, Spelling{"48 V", "V", 48.0},
        Spelling{"71 g", "kg", 0.071}, Spelling{"32 mm", "m", 0.032}, Spelling{"50 W", "W", 50.0}, Spelling{"1 kWh", "J", 3.6e6},
        Spelling{"10 Wh", "J", 36000.0}, Spelling{"1300 mAh", "C", 4680.0}, Spelling{"1.5e-3 A", "A", 0.0015}, Spelling{"+5 A", "A", 5.0},
        Spelling{"  5   A  ", "A", 5.0}, Spelling{"\t5\tA", "A", 5.0}, Spelling{"-2.5 A", "A", -2.5}, Spelling{".5 A", "A", 0.5}));

class Refused : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(Refused, with_a_reason) {
  const auto& [text, unit] = GetParam();
  const ParsedQuantity parsed = parse_quantity(text, unit);
  EXPECT_FALSE(parsed.ok()) << '"' << text << "\" was taken for " << parsed.value << ' ' << unit;
  EXPECT_NE(parsed.problem, "");
}

INSTANTIATE_TEST_SUITE_P(Texts, Refused,
                         testing::Values(std::pair{"", "A"}, std::pair{" ", "A"}, std::pair{"A", "A"}, std::pair{"five A", "A"},
                                         std::pair{"5", "A"}, std::pair{"5 ", "K/W"}, std::pair{"5 V", "A"}, std::pair{"5 W/K", "K/W"},
                                         std::pair{"5 parsnip", "A"}, std::pair{"5 m", ""}, std::pair{"nan A", "A"},
                                         std::pair{"NaN A", "A"}, std::pair{"inf A", "A"}, std::pair{"-inf A", "A"},
                                         std::pair{"infinity A", "A"}, std::pair{"1e999 A", "A"}, std::pair{"nan", ""},
                                         std::pair{"inf", ""}, std::pair{"1,5 A", "A"}, std::pair{"1.5.2 A", "A"}, std::pair{"5 A A", "A"},
                                         std::pair{"5 A 6", "A"}, std::pair{"+-5 A", "A"}, std::pair{"--5 A", "A"},
                                         std::pair{"0x10 A", "A"},
                                         // On a data sheet "1/min" means rpm. As a plain unit it would be smaller by 2π.
                                         std::pair{"6000 1/min", "rad/s"}, std::pair{"6000 min-1", "rad/s"}, std::pair{"100 Hz", "rad/s"},
                                         std::pair{"100 1/s", "rad/s"}, std::pair{"5 K", "K/W"}, std::pair{"155 deg", "degC"},
                                         std::pair{"2 degC", "K"}, std::pair{"2 degF", "K"}));

TEST(ParseQuantity, says_what_is_wrong_and_what_was_expected) {
  EXPECT_NE(parse_quantity("5", "A").problem.find("has no unit"), std::string::npos);
  EXPECT_NE(parse_quantity("5", "A").problem.find("1.5 A"), std::string::npos);
  EXPECT_NE(parse_quantity("5 parsnip", "A").problem.find("'parsnip' is not a unit"), std::string::npos);
  EXPECT_NE(parse_quantity("5 V", "A").problem.find("no unit of this quantity"), std::string::npos);
  EXPECT_NE(parse_quantity("inf A", "A").problem.find("finite"), std::string::npos);
  EXPECT_NE(parse_quantity("6000 1/min", "rad/s").problem.find("rpm"), std::string::npos);
  EXPECT_NE(parse_quantity("2 degC", "K").problem.find("write the difference in K"), std::string::npos);
}

TEST(ParseQuantity, a_number_too_large_for_its_unit_is_no_value) {
  const ParsedQuantity parsed = parse_quantity("1e308 kA", "A");
  EXPECT_TRUE(!parsed.ok() || std::isfinite(parsed.value)) << parsed.value;
}

TEST(ParseQuantity, does_not_depend_on_the_locale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* locale : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8"}) {
    if (std::setlocale(LC_ALL, locale)) {
      EXPECT_EQ(parse_quantity("1.5 mN m/A", "N m/A").value, 0.0015) << locale;
      EXPECT_FALSE(parse_quantity("1,5 A", "A").ok()) << locale;
      EXPECT_EQ(significant(1234.5, 5), "1234.5") << locale;
    }
  }
  std::setlocale(LC_ALL, before.c_str());
  struct CommaAsPoint : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  const std::locale kept = std::locale::global(std::locale(std::locale::classic(), new CommaAsPoint));
  EXPECT_EQ(parse_quantity("1.5 A", "A").value, 1.5);
  EXPECT_EQ(parse_number("1234.5"), 1234.5);
  EXPECT_EQ(significant(1234.5, 5), "1234.5");
  std::locale::global(kept);
}

TEST(ParseQuantity, survives_any_bytes) {
  std::mt19937_64 engine(900);
  constexpr std::string_view kAlphabet = "0123456789.+-eE %/()[]{}^*µ°ΩAVWNmkgsKradpinf\0\n\t\"\\;,~#@";
  for (int i = 0; i < 20000; ++i) {
    std::string text;
    for (std::size_t length = engine() % 14; text.size() < length;) {
      text += kAlphabet[engine() % kAlphabet.size()];
    }
    const ParsedQuantity parsed = parse_quantity(text, i % 2 == 0 ? "A" : "");
    if (parsed.ok()) {
      EXPECT_TRUE(std::isfinite(parsed.value)) << text;
    }
  }
}

TEST(ParseNumber, takes_all_of_the_text_or_nothing) {
  EXPECT_EQ(parse_number("1.5"), 1.5);
  EXPECT_EQ(parse_number(" -2e3 "), -2000.0);
  EXPECT_EQ(parse_number("+7"), 7.0);
  for (const char* text : {"", " ", "1.5 A", "1,5", "abc", "1 2", "+-1", "0x10", "1e"}) {
    EXPECT_FALSE(parse_number(text).has_value()) << text;
  }
}

TEST(Convert, between_units_of_the_program) {
  EXPECT_NEAR(convert(1.0, "rad/s", "rpm"), 30.0 / std::numbers::pi, 1e-12);
  EXPECT_NEAR(convert(155.0, "degC", "K"), 428.15, 1e-10);
  EXPECT_NEAR(convert(0.0369, "N m/A", "mN m/A"), 36.9, 1e-12);
  EXPECT_THROW(convert(1.0, "A", "V"), std::logic_error);
  EXPECT_THROW(convert(1.0, "A", "parsnip"), std::logic_error);
}

TEST(Convert, there_and_back_is_the_same) {
  std::mt19937_64 engine(901);
  for (int i = 0; i < 200; ++i) {
    const double value = std::ldexp(static_cast<double>(engine() % 10000 + 1), static_cast<int>(engine() % 20) - 10);
    EXPECT_NEAR(convert(convert(value, "rad/s/V", "rpm/V"), "rpm/V", "rad/s/V"), value, 1e-13 * value);
    EXPECT_NEAR(convert(convert(value, "kg m2", "g cm2"), "g cm2", "kg m2"), value, 1e-13 * value);
  }
}

TEST(UnitForDisplay, writes_degrees_as_people_do) {
  EXPECT_EQ(unit_for_display("degC"), "°C");
  EXPECT_EQ(unit_for_display("K/W"), "K/W");
}

struct Rounded {
  double value;
  int digits;
  const char* text;
};
class Significant : public testing::TestWithParam<Rounded> {};

TEST_P(Significant, is_plain_and_without_trailing_zeros) {
  const auto& [value, digits, text] = GetParam();
  EXPECT_EQ(significant(value, digits), text);
}

INSTANTIATE_TEST_SUITE_P(Numbers, Significant,
                         testing::Values(Rounded{3.8, 3, "3.8"}, Rounded{0.0041, 3, "0.0041"}, Rounded{161.97, 3, "162"},
                                         Rounded{0.0, 3, "0"}, Rounded{-0.0, 3, "0"}, Rounded{-3.14159, 3, "-3.14"},
                                         Rounded{99.96, 3, "100"}, Rounded{0.99996, 3, "1"}, Rounded{9.996, 3, "10"},
                                         Rounded{123456.0, 2, "120000"}, Rounded{999999.0, 3, "1000000"}, Rounded{1e-7, 2, "0.0000001"},
                                         Rounded{1e15, 3, "1000000000000000"}, Rounded{-1.2345e308, 3, "-1.23e+308"},
                                         Rounded{1e-300, 3, "1e-300"}, Rounded{2.0, 5, "2"}, Rounded{100.0, 6, "100"},
                                         Rounded{-0.0004, 1, "-0.0004"}, Rounded{1234.5, 5, "1234.5"}));

TEST(Quantity, IsParsedInSeveralThreads) {
  std::vector<std::thread> threads;
  std::atomic<int> wrong = 0;
  for (int i = 0; i < 8; ++i) {
    threads.emplace_back([&wrong] {
      for (int repeat = 0; repeat < 2000; ++repeat) {
        try {
          const bool is_right =
              std::abs(convert(60.0, "rpm", "rad/s") - 60.0 * kRpm_rad_per_s) < 1e-12 && parse_quantity("36.9 mN m/A", "N m/A").ok();
          wrong += is_right ? 0 : 1;
        } catch (const std::logic_error&) {
          ++wrong;
        }
      }
    });
  }
  for (std::thread& each : threads) {
    each.join();
  }
  EXPECT_EQ(wrong, 0);
}

TEST(Significant, is_within_half_a_digit) {
  std::mt19937_64 engine(902);
  for (int i = 0; i < 2000; ++i) {
    const double value = std::ldexp(1.0 + static_cast<double>(engine() % 100000) / 100000.0, static_cast<int>(engine() % 60) - 30);
    const int digits = 1 + static_cast<int>(engine() % 8);
    const double back = std::stod(significant(value, digits));
    EXPECT_NEAR(back, value, 0.5000001 * std::pow(10.0, std::floor(std::log10(value)) - digits + 1)) << significant(value, digits);
  }
}

TEST(Significant, says_what_is_no_number) {
  EXPECT_EQ(significant(std::numeric_limits<double>::infinity(), 3), "inf");
  EXPECT_EQ(significant(std::nan(""), 3), "nan");
}

TEST(Quantity, a_placeholder_of_a_template_is_named) {
  EXPECT_EQ(parse_quantity("? V", "V").problem, "\"? V\" is still to be filled in; expected a number with a unit such as \"1.5 V\"");
  EXPECT_TRUE(parse_quantity("about ? V", "V").problem.starts_with("\"about ? V\" does not begin with a number"));
}

TEST(Quantity, an_error_names_an_example_that_fits) {
  EXPECT_TRUE(parse_quantity("3 ohm", "", true).problem.ends_with("expected a share such as \"10 %\""));
  EXPECT_TRUE(parse_quantity("3 ohm", "").problem.ends_with("expected a number such as \"8\""));
  EXPECT_TRUE(parse_quantity("3 ohm", "A").problem.ends_with("expected a number with a unit such as \"1.5 A\""));
}

}  // namespace
}  // namespace heatsoak::base
