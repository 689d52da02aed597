// Memory over power-off in the generated header. After a short loss of power the guard is as warm as before and never colder than the
// network. It starts at its limit if the buffer is damaged.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/crc.hpp>
#include <cmath>
#include <cstring>
#include <limits>

#include "compiled_guard.h"
#include "derate/power_off.h"
#include "exported_motor.h"
#include "powered_off_motor.h"
#include "thermal/transient.h"

namespace heatsoak::derate {
namespace {

constexpr float kUnknown_s = std::numeric_limits<float>::quiet_NaN();
constexpr float kNoSensor_C = std::numeric_limits<float>::quiet_NaN();

class Memory : public testing::Test {
 protected:
  static const CompiledGuard& guard() {
    static const CompiledGuard made(ecx_derating(), "memory");
    return made;
  }
  /// Returns a guard after a period of hard driving.
  static ModelGuard driven(int steps) {
    ModelGuard motor(guard());
    motor.start(25.0F);
    float allowed_A = 0.0F;
    for (int i = 0; i < steps; ++i) {
      allowed_A = motor.step({allowed_A, 100.0F, 30.0F}).allowed_A;
    }
    return motor;
  }
  static float allowed_after_A(ModelGuard& motor, double time_s) {
    float allowed_A = 0.0F;
    for (int i = 0; i <= static_cast<int>(time_s / 0.01); ++i) {
      allowed_A = motor.step({0.0F, 0.0F, 40.0F}).allowed_A;
    }
    return allowed_A;
  }
};

TEST_F(Memory, WithoutTimeItIsWhatWasSaved) {
  ModelGuard motor = driven(8000);
  ModelGuard after(guard());
  ASSERT_EQ(after.restore(motor.saved(2), 0.0F, 0.0F, 25.0F), CompiledGuard::restored);
  EXPECT_EQ(after.temperatures_C(2), motor.temperatures_C(2));
}

TEST_F(Memory, ATwoSecondResetChangesNothingThatTwoSecondsWouldNot) {
  ModelGuard motor = driven(8000);
  ModelGuard after(guard());
  after.restore(motor.saved(2), 2.0F, 0.0F, 25.0F);
  for (int i = 0; i < 200; ++i) {
    motor.step({0.0F, 0.0F, 40.0F});
  }
  for (std::size_t node = 0; node < 2; ++node) {
    EXPECT_GE(after.temperatures_C(2)[node], motor.temperatures_C(2)[node] - 0.01F) << node;
    EXPECT_LE(after.temperatures_C(2)[node], motor.temperatures_C(2)[node] + 1.0F) << node;
  }
}

// Reference: the solver on the same network without current. The guard must never be colder and not much warmer.
TEST_F(Memory, CoolsAsTheNetworkDoesAndNoFaster) {
  const ModelGuard motor = driven(12'000);
  const thermal::Network network = motor::datasheet_network(ecx_32(), motor::nominal_sample(ecx_32()));
  const std::vector<float> before_C = motor.temperatures_C(2);
  for (const double elapsed_s : {0.5, 2.0, 10.0, 45.0, 120.0, 600.0, 3600.0, 1e6}) {
    thermal::OperatingPoint<double> at;
    at.ambient_C = 40.0;
    thermal::TransientOptions options;
    options.start_C = {before_C[0], before_C[1]};
    const thermal::TransientResult exact =
        thermal::run_transient(network, network.values(), std::vector<thermal::Interval>{{std::min(elapsed_s, 1e4), at}}, options);
    ModelGuard after(guard());
    after.restore(motor.saved(2), static_cast<float>(elapsed_s), 0.0F, 20.0F);
    const std::vector<float> found_C = after.temperatures_C(2);
    for (std::size_t node = 0; node < 2; ++node) {
      EXPECT_GE(found_C[node], exact.end_C[node] - 0.01) << elapsed_s << " " << node;
      EXPECT_LE(found_C[node], exact.end_C[node] + 0.02) << elapsed_s << " " << node;
    }
  }
}

TEST_F(Memory, AfterAnUnknownTimeNoNodeIsColderThanItMayBe) {
  const ModelGuard motor = driven(3000);
  ModelGuard unknown(guard());
  EXPECT_EQ(unknown.restore(motor.saved(2), kUnknown_s, 0.0F, 20.0F), CompiledGuard::time_unknown);
  const std::vector<float> assumed_C = unknown.temperatures_C(2);
  bool is_reached = false;
  for (const float elapsed_s : {0.0F, 1.0F, 3.0F, 6.0F, 10.0F, 20.0F, 40.0F, 100.0F, 1000.0F}) {
    ModelGuard after(guard());
    after.restore(motor.saved(2), elapsed_s, 0.0F, 20.0F);
    EXPECT_GE(assumed_C[0], after.temperatures_C(2)[0] - 1e-3F) << elapsed_s;
    EXPECT_GE(assumed_C[1], after.temperatures_C(2)[1] - 0.05F) << elapsed_s;
    is_reached = is_reached || after.temperatures_C(2)[1] > assumed_C[1] - 0.5F;
  }
  EXPECT_TRUE(is_reached) << "the assumption is one that can happen";
  EXPECT_EQ(assumed_C[0], motor.temperatures_C(2)[0]);
  constexpr float kInfinite_s = std::numeric_limits<float>::infinity();
  for (const float elapsed_s : {-1.0F, -kInfinite_s, kInfinite_s, std::numeric_limits<float>::max(), 1e9F}) {
    ModelGuard other(guard());
    EXPECT_EQ(other.restore(motor.saved(2), elapsed_s, 0.0F, 20.0F), CompiledGuard::time_unknown) << elapsed_s;
    EXPECT_EQ(other.temperatures_C(2), assumed_C) << elapsed_s;
  }
  ModelGuard rested(guard());
  EXPECT_EQ(rested.restore(motor.saved(2), 9.9e8F, 0.0F, 20.0F), CompiledGuard::restored);
  EXPECT_LT(rested.temperatures_C(2)[0], assumed_C[0]);
}

TEST_F(Memory, NoNodeIsColderThanTheBoard) {
  const ModelGuard motor = driven(100);
  ModelGuard after(guard());
  after.restore(motor.saved(2), 1e5F, 0.0F, 70.0F);
  EXPECT_EQ(after.temperatures_C(2)[0], 70.0F);
  EXPECT_EQ(after.temperatures_C(2)[1], 70.0F);
  ModelGuard dead_sensor(guard());
  dead_sensor.restore(motor.saved(2), 1e5F, 0.0F, std::numeric_limits<float>::quiet_NaN());
  EXPECT_GE(dead_sensor.temperatures_C(2)[1], 40.0F);
}

// Time between the last save and the loss of power counts as the hottest driving that the guard allowed.
TEST_F(Memory, UnsavedTimeCountsAsTheHardestDriving) {
  for (const int before : {10, 500, 8000}) {
    ModelGuard motor = driven(before);
    const std::vector<unsigned char> buffer = motor.saved(2);
    float allowed_A = 0.0F;
    for (int i = 0; i < 100; ++i) {
      allowed_A = motor.step({allowed_A, 250.0F, 40.0F}).allowed_A;
    }
    ModelGuard after(guard());
    after.restore(buffer, 0.0F, 1.0F, 25.0F);
    EXPECT_GE(after.temperatures_C(2)[0], motor.temperatures_C(2)[0] - 0.01F);
    EXPECT_GE(after.temperatures_C(2)[1], motor.temperatures_C(2)[1] - 0.01F);
  }
  ModelGuard after(guard());
  after.restore(driven(10).saved(2), 0.0F, kUnknown_s, 25.0F);
  EXPECT_FLOAT_EQ(after.temperatures_C(2)[1], 155.0F);
}

/// Returns a buffer with these temperatures of guard and nominal motor and a valid check sum, from the buffer of the same guard.
std::vector<unsigned char> with_temperatures(std::vector<unsigned char> buffer, const std::vector<float>& state_C) {
  for (std::size_t node = 0; node < state_C.size(); ++node) {
    std::memcpy(&buffer[4 + 4 * node], &state_C[node], sizeof(float));
    std::memcpy(&buffer[4 + 4 * (state_C.size() + node)], &state_C[node], sizeof(float));
  }
  boost::crc_32_type sum;
  sum.process_bytes(buffer.data(), buffer.size() - 4);
  const std::uint32_t word = sum.checksum();
  std::memcpy(&buffer[buffer.size() - 4], &word, sizeof(word));
  return buffer;
}

// More unsaved time never makes a node colder, also above the limit and at any time without power.
TEST_F(Memory, UnsavedTimeOnlyHeats) {
  const std::vector<unsigned char> whole = driven(10).saved(2);
  std::mt19937 engine(7);
  std::uniform_real_distribution<float> temperature_C(10.0F, 260.0F);
  for (int draw = 0; draw < 200; ++draw) {
    const std::vector<unsigned char> buffer = with_temperatures(whole, {temperature_C(engine), temperature_C(engine)});
    for (const float elapsed_s : {0.0F, 2.0F, 60.0F, kUnknown_s}) {
      std::vector<float> before_C = {0.0F, 0.0F};
      for (const float unsaved_s : {0.0F, 1e-3F, 0.1F, 1.0F, 5.0F, 60.0F, 1e8F}) {
        ModelGuard after(guard());
        ASSERT_NE(after.restore(buffer, elapsed_s, unsaved_s, 20.0F), CompiledGuard::nothing_restored);
        for (std::size_t node = 0; node < 2; ++node) {
          // The length of the cooling steps depends on the temperatures.
          EXPECT_GE(after.temperatures_C(2)[node], before_C[node] - (elapsed_s == 0.0F ? 0.0F : 0.02F))
              << draw << ": node " << node << ", " << elapsed_s << " s without power, " << unsaved_s << " s unsaved";
        }
        before_C = after.temperatures_C(2);
      }
    }
  }
}

// A chassis warms after the save while winding and stator cool.
TEST(MemoryOfThreeNodes, NoNodeIsColderThanTheNetwork) {
  const motor::Motor motor = ecx_32_with_chassis("60 J/K", "0.3 W/K", "0.2");
  const CompiledGuard guard(derating_of(motor), "three_nodes");
  const thermal::Network network = motor::datasheet_network(motor, motor::nominal_sample(motor));
  ASSERT_EQ(network.state_count(), 3);
  ModelGuard cold(guard);
  cold.start(40.0F);
  for (const std::vector<float>& saved_C : {std::vector<float>{120.0F, 80.0F, 42.0F}, {150.0F, 60.0F, 40.0F}, {60.0F, 58.0F, 50.0F}}) {
    for (const double elapsed_s : {0.5, 2.0, 10.0, 30.0, 60.0, 120.0, 300.0, 1000.0, 5000.0}) {
      thermal::OperatingPoint<double> at;
      at.ambient_C = 40.0;
      thermal::TransientOptions options;
      options.start_C.assign(saved_C.begin(), saved_C.end());
      const thermal::TransientResult exact =
          thermal::run_transient(network, network.values(), std::vector<thermal::Interval>{{elapsed_s, at}}, options);
      ModelGuard after(guard);
      after.restore(with_temperatures(cold.saved(3), saved_C), static_cast<float>(elapsed_s), 0.0F, 20.0F);
      for (std::size_t node = 0; node < 3; ++node) {
        EXPECT_GE(after.temperatures_C(3)[node], exact.end_C[node] - 0.001) << elapsed_s << " s, node " << node;
        EXPECT_LE(after.temperatures_C(3)[node], exact.end_C[node] + (elapsed_s > 1000.0 ? 0.3 : 0.02)) << elapsed_s << " s, node " << node;
      }
    }
  }
}

// Reference: the solver on the same network. Some times are longer than the header simulates.
TEST(MemoryOfAnyMotor, NoNodeIsColderThanTheNetwork) {
  for (const PoweredOffCase& each : powered_off_cases()) {
    const PoweredOffMotor motor(each);
    const CompiledGuard guard(motor.derating, each.name);
    ModelGuard cold(guard);
    cold.start(40.0F);
    expect_safe_and_useful(motor, [&](const std::vector<double>& saved_C, double elapsed_s) {
      ModelGuard after(guard);
      after.restore(with_temperatures(cold.saved(motor.nodes()), {saved_C.begin(), saved_C.end()}), static_cast<float>(elapsed_s), 0.0F, 0.0F);
      const std::vector<float> found_C = after.temperatures_C(motor.nodes());
      return std::vector<double>(found_C.begin(), found_C.end());
    });
  }
}

TEST_F(Memory, EveryFlippedBitCountsAsAtTheLimit) {
  const std::vector<unsigned char> whole = driven(3000).saved(2);
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    std::vector<unsigned char> broken = whole;
    broken[bit / 8] ^= static_cast<unsigned char>(1U << (bit % 8));
    ModelGuard after(guard());
    ASSERT_EQ(after.restore(broken, 10.0F, 0.0F, 25.0F), CompiledGuard::nothing_restored) << bit;
    EXPECT_EQ(after.temperatures_C(2)[0], 155.0F);
    EXPECT_LT(after.step({0.0F, 0.0F, 40.0F}).allowed_A, 0.05F);
  }
  for (const int fill : {0x00, 0xff}) {
    ModelGuard after(guard());
    EXPECT_EQ(after.restore(std::vector<unsigned char>(whole.size(), static_cast<unsigned char>(fill)), 1.0F, 0.0F, 25.0F),
              CompiledGuard::nothing_restored);
  }
}

TEST_F(Memory, TheCheckSumIsTheCommonOne) {
  const std::vector<unsigned char> buffer = driven(1000).saved(2);
  boost::crc_32_type sum;
  sum.process_bytes(buffer.data(), buffer.size() - 4);
  const std::size_t at = buffer.size() - 4;
  EXPECT_EQ(sum.checksum(), static_cast<unsigned>(buffer[at]) | static_cast<unsigned>(buffer[at + 1]) << 8U |
                                static_cast<unsigned>(buffer[at + 2]) << 16U | static_cast<unsigned>(buffer[at + 3]) << 24U);
}

TEST_F(Memory, AnotherGuardsBufferIsRefused) {
  Derating other = ecx_derating();
  other.robot_id = "another";
  const CompiledGuard another(other, "another");
  ModelGuard motor(another);
  motor.start(30.0F);
  ModelGuard after(guard());
  EXPECT_EQ(after.restore(motor.saved(2), 1.0F, 0.0F, 25.0F), CompiledGuard::nothing_restored);
}

TEST_F(Memory, WhatWasNeverStartedIsNotSaved) {
  ModelGuard zero(guard());
  ModelGuard after(guard());
  EXPECT_EQ(after.restore(zero.saved(2), 1.0F, 0.0F, 25.0F), CompiledGuard::nothing_restored);
}

std::vector<float> in_single(const std::vector<double>& values) { return {values.begin(), values.end()}; }

/// Regenerates the committed text of docs/power_off.md from the header; `start_C`: every node before the loss of power.
std::string power_off_table(const CompiledGuard& guard, const std::vector<double>& start_C) {
  struct Case {
    const char* name;
    float elapsed_s;
    bool is_whole;
  };
  ModelGuard before(guard);
  before.start(100.0F);
  const std::vector<unsigned char> hot = with_temperatures(before.saved(start_C.size()), in_single(start_C));
  std::string text = fmt::format("(observer: winding {:.0f} °C, stator {:.0f} °C; air at 40 °C).\n\n", start_C[0], start_C[1]);
  text += "| after | allowed after 1 s, A | after 10 s, A | after 60 s, A |\n|---|---|---|---|\n";
  for (const Case& each :
       {Case{"no loss of power", 0.0F, true}, Case{"2 s without power", 2.0F, true}, Case{"30 s", 30.0F, true}, Case{"5 min", 300.0F, true},
        Case{"1 h", 3600.0F, true}, Case{"an unknown time", kUnknown_s, true}, Case{"a damaged buffer", 2.0F, false}}) {
    text += fmt::format("| {} |", each.name);
    for (const double time_s : {1.0, 10.0, 60.0}) {
      std::vector<unsigned char> buffer = hot;
      buffer[5] ^= each.is_whole ? 0U : 1U;
      ModelGuard motor(guard);
      motor.restore(buffer, each.elapsed_s, 0.0F, kNoSensor_C);
      CompiledGuard::Output out;
      for (int i = 0; i < static_cast<int>(std::lround(time_s / 0.01)); ++i) {
        out = motor.step({0.0F, 0.0F, 40.0F});
      }
      text += fmt::format(" {:.1f} |", out.allowed_A);
    }
    text += "\n";
  }
  return text;
}

TEST_F(Memory, TheDocumentsTableIsWhatTheHeaderDoes) {
  const PowerOffReport report = power_off_report(ecx_derating());
  const std::string table = power_off_table(guard(), report.start_C);
  std::stringstream page;
  page << std::ifstream(kSource / "docs/power_off.md").rdbuf();
  EXPECT_THAT(page.str(), testing::HasSubstr(table)) << "put this into docs/power_off.md:\n" << table;
  for (const PowerOffCase& each : report.cases) {
    EXPECT_THAT(page.str(), testing::HasSubstr(fmt::format("| {} | {:.1f} |\n", each.name, fmt::join(each.allowed_A, " | "))))
        << "as heatsoak derate --explain shows it";
  }
}

// No continuous use makes a node hotter than the temperatures with which the document and --explain begin, and one use reaches them. Those
// are steady states at the last current of a use, up to 0.1 K below the guard's own.
TEST_F(Memory, TheDocumentBeginsWithTheHottestContinuousUse) {
  const std::vector<double> start_C = power_off_report(ecx_derating()).start_C;
  std::vector<double> reached_C(2, 0.0);
  const auto most_speed_rad_per_s = static_cast<float>(ecx_derating().rules.most_speed_rad_per_s);
  for (int tenths = 0; tenths <= 10; ++tenths) {
    ModelGuard motor(guard());
    motor.start(120.0F);
    float allowed_A = 0.0F;
    for (int i = 0; i < 120'000; ++i) {
      allowed_A = motor.step({allowed_A, 0.1F * static_cast<float>(tenths) * most_speed_rad_per_s, 40.0F}).allowed_A;
    }
    for (std::size_t node = 0; node < 2; ++node) {
      const auto found_C = static_cast<double>(motor.temperatures_C(2)[node]);
      EXPECT_LE(found_C, start_C[node] + 0.2) << node << " at " << tenths << "/10 of the highest speed";
      reached_C[node] = std::max(reached_C[node], found_C);
    }
  }
  for (std::size_t node = 0; node < 2; ++node) {
    EXPECT_NEAR(reached_C[node], start_C[node], 0.5) << node;
  }
}

class PowerOffReportTest : public testing::TestWithParam<const char*> {};

// Reference: the generated header, started from the same temperatures.
TEST_P(PowerOffReportTest, IsWhatTheHeaderDoes) {
  const std::string_view laws = GetParam();
  Derating derating = laws.empty() ? ecx_derating() : derating_of(ecx_32_with(std::string(laws)));
  derating.rules.hottest_ambient_C = ecx_derating().rules.hottest_ambient_C;
  const PowerOffReport report = power_off_report(derating);
  ASSERT_EQ(report.cases.size(), 4U);
  const CompiledGuard guard(derating, "report");
  const std::size_t nodes = derating.observer.state_count();
  ModelGuard before(guard);
  before.start(100.0F);
  const std::vector<unsigned char> hot = with_temperatures(before.saved(nodes), {report.start_C.begin(), report.start_C.end()});
  const float elapsed_s[] = {0.0F, 2.0F, kUnknown_s, 2.0F};
  for (std::size_t i = 0; i < report.cases.size(); ++i) {
    std::vector<unsigned char> buffer = hot;
    buffer[5] ^= i == 3 ? 1U : 0U;
    ModelGuard motor(guard);
    motor.restore(buffer, elapsed_s[i], 0.0F, 40.0F);
    CompiledGuard::Output out;
    int steps = 0;
    for (std::size_t k = 0; k < kPowerOffMoments_s.size(); ++k) {
      for (; steps < static_cast<int>(std::lround(kPowerOffMoments_s[k] / 0.01)); ++steps) {
        out = motor.step({0.0F, 0.0F, 40.0F});
      }
      EXPECT_NEAR(report.cases[i].allowed_A[k], out.allowed_A, 0.02) << report.cases[i].name << ", " << kPowerOffMoments_s[k] << " s";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Motors, PowerOffReportTest, testing::Values("", kPowerAndExponential));

TEST(PowerOffReport, BeginsWithAMotorAtItsLimit) {
  const PowerOffReport report = power_off_report(ecx_derating());
  EXPECT_NEAR(report.start_C[0], 155.0, 0.5);
  EXPECT_LT(report.start_C[1], report.start_C[0]);
  EXPECT_GT(report.start_C[1], 60.0);
  const auto allowed = [&](std::size_t i) { return report.cases[i].allowed_A; };
  for (std::size_t k = 0; k < kPowerOffMoments_s.size(); ++k) {
    EXPECT_GT(allowed(1)[k], allowed(0)[k]) << "it has cooled for 2 s";
    EXPECT_LE(allowed(2)[k], allowed(0)[k]) << "power may have returned at once";
    EXPECT_LT(allowed(3)[k], allowed(2)[k]) << "everything at the limit";
  }
}

}  // namespace
}  // namespace heatsoak::derate
