// Compares the integer header with the single-precision header. The integer form must never allow more current or be colder, and must be
// identical on a Cortex-M0.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <regex>
#include <sstream>

#include "base/diagnostic.h"
#include "derate/export_text.h"
#include "derate/integer_form/integer_lines.h"
#include "derate/integer_form/quantised_table.h"
#include "q15_header.h"

namespace heatsoak::derate {
namespace {

using testing::HasSubstr;

/// Runs some thousand steps of the integer form, saves and restores, and prints a check sum of its answers.
constexpr const char* kIntegerSteps = R"(
#include "q15_guard.h"
static uint32_t check_sum(void) {
  static const int32_t elapsed_ms[4] = {-1, 0, 1500, 400000};
  uint8_t saved[64];
  MOTOR_q15_state state = {0u, {0}};
  MOTOR_q15_state again = {0u, {0}};
  MOTOR_q15_input in;
  uint32_t seed = 99u, sum = 2166136261u;
  int i;
  MOTOR_q15_start(&state, 31000);
  for (i = 0; i < 3000; ++i) {
    MOTOR_q15_output out;
    seed = seed * 1664525u + 1013904223u;
    in.current_mA = (int32_t)(seed >> 18) - 4000;
    in.speed_mrad_per_s = (int32_t)(seed >> 13) - 200000;
    in.ambient_mC = i % 500 == 0 ? -300000 : 20000 + (int32_t)(seed >> 22);
    out = MOTOR_q15_step(&state, &in);
    sum = (sum ^ (uint32_t)out.allowed_current_mA) * 16777619u;
    sum = (sum ^ (uint32_t)out.guarded_winding_mC) * 16777619u;
    sum = (sum ^ (uint32_t)out.reason) * 16777619u;
  }
  MOTOR_q15_save(&state, saved);
  for (i = 0; i < 4; ++i) {
    sum = (sum ^ (uint32_t)MOTOR_q15_restore(&again, saved, elapsed_ms[i], 100 * i, 20000)) * 16777619u;
    sum = (sum ^ (uint32_t)again.stored[0] ^ (uint32_t)(again.stored[1] >> 20)) * 16777619u;
  }
  return sum;
}
)";

constexpr const char* kHostMain = R"(
#include <stdio.h>
int main(void) {
  printf("%08x", (unsigned)check_sum());
  return 0;
}
)";

/// Start-up code of a Cortex-M0 and two calls of ARM's semihosting.
constexpr const char* kBareMain = R"(
static int ask(int what, const void *with) {
  register int r0 __asm__("r0") = what;
  register const void *r1 __asm__("r1") = with;
  __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
  return r0;
}
void *memset(void *to, int value, __SIZE_TYPE__ count);
void *memset(void *to, int value, __SIZE_TYPE__ count) {
  unsigned char *at = (unsigned char *)to;
  while (count-- > 0) *at++ = (unsigned char)value;
  return to;
}
void *memcpy(void *to, const void *from, __SIZE_TYPE__ count);
void *memcpy(void *to, const void *from, __SIZE_TYPE__ count) {
  unsigned char *at = (unsigned char *)to;
  const unsigned char *source = (const unsigned char *)from;
  while (count-- > 0) *at++ = *source++;
  return to;
}
void start(void);
void start(void) {
  static char text[9];
  uint32_t sum = check_sum();
  int i;
  for (i = 7; i >= 0; --i) {
    text[i] = "0123456789abcdef"[sum & 15u];
    sum >>= 4;
  }
  ask(4, text);
  ask(0x18, (const void *)0x20026);
  for (;;) {
  }
}
__attribute__((section(".vectors"), used)) static const void *const vectors[2] = {(const void *)0x20003f00, (const void *)start};
)";

constexpr const char* kLayout = R"(
MEMORY { FLASH (rx) : ORIGIN = 0, LENGTH = 256K  RAM (rwx) : ORIGIN = 0x20000000, LENGTH = 16K }
SECTIONS {
  .text : { KEEP(*(.vectors)) *(.text*) *(.rodata*) } > FLASH
  .bss : { *(.bss*) *(.data*) } > RAM
  /DISCARD/ : { *(.ARM*) }
}
)";

TEST_F(Q15Header, AllowsNeverMoreThanSinglePrecisionAndLittleLess) {
  for (const char* const id : {"maxon_ecx_flat_32l_48v", "maxon_ecx_flat_42m_24v", "maxon_ec45_flat_70w_24v"}) {
    Derating derating = derating_of(shipped_motor(id));
    derating.motor_id = id;
    const StatedLimits stated(exported("c_header_q15", derating), derating.table);
    write_headers(derating);
    write("both.c", kBoth, derating);
    static_cast<void>(output_of(fmt::format("cc -std=c99 {} -o both both.c -lm", kWarnings)));
    EXPECT_LT(stated.excess_mK, 600.0) << id;
    EXPECT_LT(stated.table_permille, 50.0) << id;
    for (const char* const broken : {"", " broken"}) {
      const Comparison found = comparison(output_of(fmt::format("./both {:.6g} 200000{}", derating.table.straight_below_A, broken)));
      EXPECT_LE(found.most_mA, 0.0) << id << broken;
      EXPECT_GE(found.coldest_mK, 0.0) << id << broken;
      EXPECT_LE(found.hottest_mK, stated.excess_mK + 1.0) << id << broken;
      EXPECT_LE(found.short_permille, stated.short_permille) << id << broken;
    }
  }
}

TEST_F(Q15Header, HasTheSameBitsOnACortexM0WithoutAnyFloatingPoint) {
  if (!has("arm-none-eabi-gcc") || !has("qemu-system-arm")) {
    GTEST_SKIP() << HEATSOAK_FAILS_CI "no compiler or no machine for a Cortex-M0 here";
  }
  const Derating& derating = ecx_derating();
  write_headers(derating);
  write("host.c", std::string(kIntegerSteps) + kHostMain, derating);
  write("bare.c", std::string(kIntegerSteps) + kBareMain, derating);
  std::ofstream(folder_ / "layout.ld") << kLayout;
  static_cast<void>(output_of(fmt::format("cc -std=c99 {} -o host host.c", kWarnings)));
  static_cast<void>(
      output_of("arm-none-eabi-gcc -std=gnu99 -Os -Wall -Wextra -Werror -mcpu=cortex-m0 -mthumb -ffreestanding -nostdlib "
                "-fno-tree-loop-distribute-patterns "
                "-T layout.ld -o bare.elf bare.c -lgcc"));
  // Soft-float helpers of the compiler's library would be listed here.
  EXPECT_THAT(output_of("arm-none-eabi-nm bare.elf"),
              testing::Not(testing::ContainsRegex("__aeabi_(f|d|i2f|ui2f|l2f|ul2f|i2d)[a-z0-9]*$")));
  const std::string on_host = output_of("./host");
  EXPECT_EQ(on_host.size(), 8U);
  EXPECT_EQ(
      output_of("timeout 60 qemu-system-arm -M microbit -nographic -semihosting-config enable=on,target=native -kernel bare.elf 2>&1"),
      on_host);
}

// Laws with operations that the integer form lacks are refused with the effect's name.
/// Prints the stored stator temperature after 200 s at an impossible and at the fastest accepted speed, and the reasons of a cold and of a
/// warm motor.
constexpr const char* kExtremes = R"(
#include "q15_guard.h"
#include <stdio.h>
#include <stdlib.h>
static long stored_after(int32_t speed) {
  MOTOR_q15_state state;
  MOTOR_q15_input in = {0, speed, 40000};
  int i;
  MOTOR_q15_start(&state, 40000);
  for (i = 0; i < 20000; ++i) {
    (void)MOTOR_q15_step(&state, &in);
  }
  return (long)(state.stored[1] / 65536);
}
static int reason_at(int32_t body_mC) {
  MOTOR_q15_state state;
  MOTOR_q15_input in = {0, 100000, 20000};
  MOTOR_q15_start(&state, body_mC);
  return (int)MOTOR_q15_step(&state, &in).reason;
}
int main(int argc, char **argv) {
  (void)argc;
  printf("%ld %ld %d %d", stored_after(2000000000), stored_after((int32_t)atol(argv[1])), reason_at(20000), reason_at(90000));
  return 0;
}
)";

TEST_F(Q15Header, TakesTheHottestAcceptedSpeedAndCallsAColdMotorsCurrentFull) {
  const Derating derating = derating_of(shipped_motor("maxon_ecx_flat_32l_48v"));
  write_headers(derating);
  write("extremes.c", kExtremes, derating);
  const auto accepted = static_cast<long>(999.0 * derating.table.no_current_speed_rad_per_s);
  std::istringstream answers(output_of(fmt::format("cc -std=c99 {} -o extremes extremes.c && ./extremes {}", kWarnings, accepted)));
  long impossible = 0;
  long fastest = 0;
  int cold = -1;
  int warm = -1;
  answers >> impossible >> fastest >> cold >> warm;
  EXPECT_GE(impossible, fastest);
  EXPECT_EQ(cold, 0) << "full";
  EXPECT_EQ(warm, 1) << "derated";
}

/// Prints the hottest winding of 30 s at 60 A in °C, the number of steps that were colder than the one before or counted as not started,
/// and the reason without current after that.
constexpr const char* kOvercurrent = R"(
#include "q15_guard.h"
#include <stdio.h>
int main(void) {
  MOTOR_q15_state state;
  MOTOR_q15_input in = {60000, 0, 40000};
  int32_t last_mC = 40000;
  int wrong = 0;
  int i;
  MOTOR_q15_start(&state, 40000);
  for (i = 0; i < 3000; ++i) {
    const MOTOR_q15_output out = MOTOR_q15_step(&state, &in);
    wrong += (out.guarded_winding_mC < last_mC) || (out.reason == MOTOR_q15_not_started);
    last_mC = out.guarded_winding_mC;
  }
  in.current_mA = 0;
  printf("%d %d %d", (int)(last_mC / 1000), wrong, (int)MOTOR_q15_step(&state, &in).reason);
  return 0;
}
)";

TEST_F(Q15Header, ForgetsNoHeatOfAnImpossibleOvercurrent) {
  write_headers(ecx_derating());
  write("overcurrent.c", kOvercurrent, ecx_derating());
  EXPECT_EQ(output_of(fmt::format("cc -std=c99 {} -o overcurrent overcurrent.c && ./overcurrent", kWarnings)), "1000 0 2");
}

TEST(Q15HeaderText, RefusesLawsThatItCannotCompute) {
  const Derating derating = derating_of(ecx_32_with(R"([effects.air]
type = "natural_convection"
conductance = { value = "0.05 W/K", origin = "estimated", derivation = "a test" }
exponent = { value = "0.25", origin = "estimated", derivation = "a test" }
)"));
  try {
    static_cast<void>(exported("c_header_q15", derating));
    FAIL() << "no failure";
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
    EXPECT_THAT(failure.what(), HasSubstr("air (natural_convection)"));
  }
}

// One effect can be expressed, so only the other is named; together with an effect that fails for the same reason, both are.
TEST(Q15HeaderText, NamesOnlyTheEffectsThatItCannotCompute) {
  const std::string radiation = R"([effects.my_radiation]
type = "radiation"
emissive_area = { value = "0.002 m2", origin = "estimated", derivation = "a test" }
)";
  const std::string bearing = R"([effects.my_bearing]
type = "bearing_friction"
loss = { value = "0.5 W", origin = "estimated", derivation = "a test" }
viscous_share = { value = "0.5", origin = "estimated", derivation = "a test" }
thinning = { value = "0.02 1/K", origin = "estimated", derivation = "a test" }
)";
  const std::string air = R"([effects.air]
type = "natural_convection"
conductance = { value = "0.05 W/K", origin = "estimated", derivation = "a test" }
exponent = { value = "0.25", origin = "estimated", derivation = "a test" }
)";
  const auto answer = [](const std::string& lines) -> std::string {
    try {
      static_cast<void>(exported("c_header_q15", derating_of(ecx_32_with(lines))));
    } catch (const base::Failure& failure) {
      return failure.what();
    }
    return "accepted";
  };
  EXPECT_EQ(answer(radiation), "accepted");
  const std::string one = answer(radiation + "\n" + bearing);
  EXPECT_THAT(one, HasSubstr("cannot express my_bearing (bearing_friction): "));
  const std::string two = answer(radiation + "\n" + bearing + "\n" + air);
  EXPECT_THAT(two, testing::AllOf(HasSubstr("my_bearing (bearing_friction)"), HasSubstr("air (natural_convection)")));
  EXPECT_THAT(one + two, testing::Not(HasSubstr("radiation)")));
}

TEST(Q15HeaderText, LinesHaveTheNamesOfTheQuantitiesWithScaleAndUnit) {
  const std::string text = exported("c_header_q15");
  for (const char* const line : {"const int32_t copper_loss_W = [^;]+;\\s+/\\* 2\\^-[0-9]+ W \\*/",
                                 "const int32_t winding_C = state_C\\[0\\]; /\\* 2\\^-20 degC \\*/",
                                 "const int32_t winding_to_stator_W = [^;]+;\\s+/\\* 2\\^-[0-9]+ W \\*/",
                                 "const int32_t winding_rate_K_per_s = [^;]+;\\s+/\\* 2\\^-[0-9]+ K/s \\*/"}) {
    EXPECT_TRUE(std::regex_search(text, std::regex(line))) << line;
  }
  EXPECT_FALSE(std::regex_search(text, std::regex("\\bt[0-9]+\\b"))) << "names of steps of the formula";
}

// Exact arithmetic on the statements' own scales: the rounding bound holds for the constants and is at most a few steps wide.
TEST(Q15Lines, RoundingIsBounded) {
  const integer_form::IntegerLines lines = integer_form::integer_lines(ecx_derating(), "motor");
  ASSERT_EQ(lines.rate_K_per_s.size(), 2U);
  for (const integer_form::FixedPoint& rate : lines.rate_K_per_s) {
    EXPECT_GT(rate.most_error, 0.0);
    EXPECT_LT(rate.most_error, 5e-3);
    EXPECT_LT(std::ldexp(std::max(std::abs(rate.low), std::abs(rate.high)), rate.bits), std::ldexp(1.0, 30));
  }
}

}  // namespace
}  // namespace heatsoak::derate
