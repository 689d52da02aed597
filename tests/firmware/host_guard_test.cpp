// Compares the host's guard with the generated C header of the same derating, so that simulations match the controller.
#include "firmware/host_guard.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "derate/exporter.h"
#include "derate/guarded_motor.h"
#include "firmware/core_config.h"
#include "support/skip_reasons.h"

namespace heatsoak::firmware {
namespace {

using Record = std::array<float, derate::observed::kSignalCount>;

derate::Derating derating_of(const motor::Motor& motor) {
  return derate::derating_of(derate::GuardedMotor(motor, derate::rules_for(ecx_32()), 1.5));
}

/// Laws with exponential, power and square root over every signal, and a third node.
constexpr const char* kManyLaws = R"([effects.knee]
type = "saturation"
excess = { value = "0.3", origin = "estimated", derivation = "a test" }
knee_current = { value = "7 A", origin = "estimated", derivation = "a test" }
knee_width = { value = "0.1", origin = "estimated", derivation = "a test" }

[effects.air]
type = "natural_convection"
conductance = { value = "0.05 W/K", origin = "estimated", derivation = "a test" }
exponent = { value = "0.25", origin = "estimated", derivation = "a test" }

[effects.wind]
type = "vehicle_airflow"
conductance = { value = "0.03 W/K", origin = "estimated", derivation = "a test" }
exponent = { value = "0.6", origin = "estimated", derivation = "a test" }

[effects.fan]
type = "speed_dependent_convection"
conductance = { value = "0.04 W/K", origin = "estimated", derivation = "a test" }
exponent = { value = "0.5", origin = "estimated", derivation = "a test" }

[effects.contact]
type = "contact_ageing"
conductance = { value = "0.05 W/K", origin = "estimated", derivation = "a test" }
time_constant = { value = "20 h", origin = "estimated", derivation = "a test" }
fresh_share = { value = "0.5", origin = "estimated", derivation = "a test" }

[effects.next]
type = "neighbour_coupling"
conductance = { value = "0.05 W/K", origin = "estimated", derivation = "a test" }

[effects.jolt]
type = "tabulated"
driver = "acceleration"
form = "heat"
hot = "stator"
first_knot = { value = "0 rad/s2", origin = "estimated", derivation = "a test" }
last_knot = { value = "6000 rad/s2", origin = "estimated", derivation = "a test" }
value_1 = { value = "0 W", origin = "estimated", derivation = "a test" }
value_2 = { value = "0.5 W", origin = "estimated", derivation = "a test" }
value_3 = { value = "1 W", origin = "estimated", derivation = "a test" }
value_4 = { value = "1 W", origin = "estimated", derivation = "a test" }
value_5 = { value = "1 W", origin = "estimated", derivation = "a test" }
value_6 = { value = "0.7 W", origin = "estimated", derivation = "a test" }
value_7 = { value = "0.7 W", origin = "estimated", derivation = "a test" }

[effects.magnet]
type = "magnet_weakening"
temperature_coefficient = { value = "0.1 %/K", origin = "estimated", derivation = "a test" }

[effects.mount]
type = "third_node"
conductance = { value = "0.4 W/K", origin = "estimated", derivation = "a test" }
leak_ratio = { value = "0.5", origin = "estimated", derivation = "a test" }
heat_capacity = { value = "60 J/K", origin = "estimated", derivation = "a test" }
)";

/// Simulates a robot: drifting signals, currents close to the allowed one, and occasionally a faulty sensor for a while.
class Play {
 public:
  explicit Play(const derate::Derating& derating) : rules_(derating.rules), reachable_rad_per_s_(derating.reachable_speed_rad_per_s) {}

  Record next(float allowed_A) {
    if (left_-- <= 0) {
      left_ = static_cast<int>(200.0 * uniform());
      broken_ = uniform() < 0.25 ? static_cast<int>(uniform() * derate::observed::kSignalCount) : -1;
      share_ = uniform() < 0.6 ? 1.0 : uniform();
      sign_ = uniform() < 0.3 ? -1.0 : 1.0;
      signals_ = {0.0F,
                  static_cast<float>((uniform() - 0.5) * 2.2 * reachable_rad_per_s_),
                  static_cast<float>(5.0 + 35.0 * uniform()),
                  static_cast<float>(uniform() * rules_.most_vehicle_speed_m_per_s),
                  static_cast<float>(30.0 + 100.0 * uniform()),
                  static_cast<float>(100.0 * uniform()),
                  static_cast<float>(9000.0 * uniform())};
    }
    Record record = signals_;
    record[derate::observed::current] = static_cast<float>(sign_ * share_ * (0.9 + 0.2 * uniform()) * std::max(allowed_A, 0.2F));
    record[derate::observed::speed] *= static_cast<float>(0.95 + 0.1 * uniform());
    if (broken_ >= 0) {
      static constexpr std::array<float, 7> kBroken{std::numeric_limits<float>::quiet_NaN(),
                                                    std::numeric_limits<float>::infinity(),
                                                    -std::numeric_limits<float>::infinity(),
                                                    -55.0F,
                                                    1e30F,
                                                    -1e6F,
                                                    0.0F};
      record[static_cast<std::size_t>(broken_)] = kBroken[static_cast<std::size_t>(uniform() * kBroken.size())];
    }
    return record;
  }

 private:
  double uniform() { return std::uniform_real_distribution<double>()(engine_); }

  std::mt19937_64 engine_{20};
  derate::BarrierRules rules_;
  double reachable_rad_per_s_;
  Record signals_{};
  int left_ = 0;
  int broken_ = -1;
  double share_ = 1.0;
  double sign_ = 1.0;
};

struct Row {
  std::vector<std::uint32_t> bits;  ///< allowed current, temperatures, compensated rounding errors
  bool is_unknown_input = false;
};

/// Returns a program that reads records in single precision and answers each with the bits of Row.
std::string program(const derate::Derating& derating) {
  std::string fields;
  for (std::size_t i = 0; i < derate::observed::kSignalCount; ++i) {
    if (derating.observer.uses(static_cast<derate::observed::Signal>(i))) {
      fields += fmt::format("    in.{} = record[{}];\n", derate::observed::signals()[i].name, i);
    }
  }
  return fmt::format(R"(#include "guard.h"
#include <stdio.h>
#include <string.h>
int main(void) {{
  guarded_state state;
  guarded_input in;
  float record[{0}];
  memset(&state, 0, sizeof state);
  while (fread(record, sizeof record, 1, stdin) == 1) {{
    guarded_output out;
    unsigned reason;
{1}    out = guarded_step(&state, &in);
    reason = (unsigned)out.reason;
    fwrite(&out.allowed_current_A, 4, 1, stdout);
    fwrite(state.state_C, 4, {2}, stdout);
    fwrite(state.carry_K, 4, {2}, stdout);
    fwrite(&reason, 4, 1, stdout);
  }}
  return 0;
}}
)",
                     derate::observed::kSignalCount, fields, derating.observer.state_count());
}

/// Returns the answers of the compiled header.
std::vector<Row> by_header(const derate::Derating& derating, const std::vector<Record>& records) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / ("heatsoak_host_guard_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const auto header = std::ranges::find(derate::all_exporters(), "c_header", &derate::ExporterType::name);
  std::ofstream(folder / "guard.h") << header->write(derating);
  std::ofstream(folder / "main.c") << program(derating);
  std::ofstream(folder / "asked", std::ios::binary)
      .write(reinterpret_cast<const char*>(records.data()), static_cast<std::streamsize>(records.size() * sizeof(Record)));
  const auto quoted = [&](const char* file) { return fmt::format("'{}'", (folder / file).string()); };
  const std::string build = fmt::format(
      "cc -std=c99 -O2 -Wall -Wextra -Wpedantic -Wshadow -Wconversion "
      "-Wsign-conversion -Wdouble-promotion -Werror -ffp-contract=off -o {} {} -lm",
      quoted("guard"), quoted("main.c"));
  EXPECT_EQ(std::system(build.c_str()), 0);
  EXPECT_EQ(std::system(fmt::format("{} < {} > {}", quoted("guard"), quoted("asked"), quoted("answered")).c_str()), 0);
  std::ifstream answered(folder / "answered", std::ios::binary);
  const std::size_t words = 2 + 2 * derating.observer.state_count();
  std::vector<Row> rows;
  constexpr std::uint32_t kInputUnknown = 3;
  for (std::vector<std::uint32_t> read(words);
       answered.read(reinterpret_cast<char*>(read.data()), static_cast<std::streamsize>(4 * words));) {
    rows.push_back({{read.begin(), read.end() - 1}, read.back() == kInputUnknown});
  }
  std::filesystem::remove_all(folder);
  return rows;
}

/// Steps the guard of the drive core. The answer to the last record determines the next one.
std::vector<Row> by_host(const HostGuard& guard, Play play, std::size_t steps, std::vector<Record>& records) {
  const robot_core::GuardModel& model = guard.model();
  robot_core::GuardState state;
  std::vector<Row> rows;
  float allowed_A = 0.0F;
  for (std::size_t i = 0; i < steps; ++i) {
    records.push_back(play.next(allowed_A));
    const robot_core::GuardOutput out = robot_core::step_guard(model, state, records.back().data(), 0.0F);
    allowed_A = out.allowed_A;
    Row row{{std::bit_cast<std::uint32_t>(out.allowed_A)}, out.is_unknown_input && out.was_started};
    for (int node = 0; node < model.node_count; ++node) {
      row.bits.push_back(std::bit_cast<std::uint32_t>(state.state_C[node]));
    }
    for (int node = 0; node < model.node_count; ++node) {
      row.bits.push_back(std::bit_cast<std::uint32_t>(state.carry_K[node]));
    }
    rows.push_back(row);
  }
  return rows;
}

/// Checks that the bits agree and that the records cover the intended situations.
void expect_same_bits(const derate::Derating& derating, const std::string& text) {
  constexpr std::size_t kSteps = 100'000;
  const HostGuard guard(derating);
  std::vector<Record> records;
  const std::vector<Row> host = by_host(guard, Play(derating), kSteps, records);
  const std::vector<Row> header = by_header(derating, records);
  ASSERT_EQ(header.size(), host.size()) << text;
  float hottest_C = 0.0F;
  float coldest_C = 1000.0F;
  std::size_t unknown = 0;
  for (std::size_t i = 0; i < kSteps; ++i) {
    ASSERT_EQ(header[i].bits, host[i].bits) << text << ", step " << i;
    ASSERT_EQ(header[i].is_unknown_input, host[i].is_unknown_input) << text << ", step " << i;
    hottest_C = std::max(hottest_C, std::bit_cast<float>(host[i].bits[1]));
    coldest_C = std::min(coldest_C, std::bit_cast<float>(host[i].bits[1]));
    unknown += host[i].is_unknown_input ? 1U : 0U;
  }
  EXPECT_GT(hottest_C, 154.0F) << text;
  EXPECT_LT(coldest_C, hottest_C - 20.0F) << text;
  EXPECT_GT(unknown, kSteps / 100) << text;
  EXPECT_LT(unknown, kSteps / 2) << text;
}

class HostGuardBits : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("cc --version > /dev/null 2>&1") != 0) {
      GTEST_SKIP() << HEATSOAK_FAILS_CI "no compiler here";
    }
  }
};

// Beyond every temperature that a motor can have: no heat is forgotten.
TEST_F(HostGuardBits, EqualThoseOfTheHeaderUnderAnImpossibleOvercurrent) {
  const derate::Derating derating = derating_of(ecx_32());
  const HostGuard guard(derating);
  std::vector<Record> records(6000, Record{});
  std::vector<std::uint32_t> winding;
  for (std::size_t i = 0; i < records.size(); ++i) {
    records[i][derate::observed::current] = i < 4000 ? 60.0F : 0.0F;
    records[i][derate::observed::ambient] = 40.0F;
  }
  robot_core::GuardState state;  // started by the first step, as that of the header
  float last_C = 0.0F;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const robot_core::GuardOutput out = robot_core::step_guard(guard.model(), state, records[i].data(), 0.0F);
    winding.push_back(std::bit_cast<std::uint32_t>(state.state_C[0]));
    ASSERT_EQ(out.was_started, i > 0) << i;
    if (i < 4000) {
      ASSERT_GE(out.winding_C, last_C) << i;
    }
    last_C = out.winding_C;
    if (i == 3999) {
      EXPECT_EQ(out.winding_C, 1000.0F);
    }
  }
  const std::vector<Row> header = by_header(derating, records);
  ASSERT_EQ(header.size(), records.size());
  for (std::size_t i = 0; i < records.size(); ++i) {
    ASSERT_EQ(header[i].bits[1], winding[i]) << i;
  }
}

TEST_F(HostGuardBits, EqualThoseOfTheHeaderOfADataSheetMotor) { expect_same_bits(derating_of(ecx_32()), "data sheet"); }

TEST_F(HostGuardBits, EqualThoseOfTheHeaderOfAMotorWithManyLaws) {
  const derate::Derating derating = derating_of(derate::ecx_32_with(kManyLaws));
  for (std::size_t i = 0; i < derate::observed::kSignalCount; ++i) {
    EXPECT_TRUE(derating.observer.uses(static_cast<derate::observed::Signal>(i))) << derate::observed::signals()[i].name;
  }
  const auto makes = [&](thermal::Operation operation) {
    return std::ranges::any_of(derating.observer.formula().steps(),
                               [&](const thermal::Formula::Step& step) { return step.operation == operation; });
  };
  EXPECT_TRUE(makes(thermal::Operation::exponential) && makes(thermal::Operation::power) && makes(thermal::Operation::square_root));
  expect_same_bits(derating, "many laws");
}

TEST(HostGuard, ReadsItsTableAsTheDeratingDoes) {
  const derate::Derating derating = derating_of(ecx_32());
  const HostGuard guard(derating);
  std::mt19937_64 engine(3);
  std::uniform_real_distribution<float> uniform;
  for (int i = 0; i < 20'000; ++i) {
    const float speed_rad_per_s = 1.1F * static_cast<float>(derating.rules.most_speed_rad_per_s) * uniform(engine);
    const float stator_C = 170.0F * uniform(engine);
    const float winding_C = 170.0F * uniform(engine);
    ASSERT_EQ(robot_core::allowed_current_A(guard.model(), speed_rad_per_s, stator_C, winding_C),
              derating.table.allowed_A(speed_rad_per_s, stator_C, winding_C));
  }
}

// Each thread uses a copy, which must stay valid without the original.
TEST(HostGuard, CopyStandsOnItsOwn) {
  const derate::Derating derating = derating_of(ecx_32());
  auto original = std::make_unique<HostGuard>(derating);
  const HostGuard copy(*original);
  HostGuard assigned(derating);
  assigned = *original;
  std::vector<Record> records;
  const std::vector<Row> expected = by_host(*original, Play(derating), 500, records);
  EXPECT_NE(copy.model().context, original->model().context);
  EXPECT_NE(copy.model().table.heat_per_ohm_A2, original->model().table.heat_per_ohm_A2);
  EXPECT_NE(assigned.model().plausible_range[0].possible, original->model().plausible_range[0].possible);
  original.reset();
  for (const HostGuard* const each : {&copy, static_cast<const HostGuard*>(&assigned)}) {
    const std::vector<Row> again = by_host(*each, Play(derating), 500, records);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      ASSERT_EQ(again[i].bits, expected[i].bits) << i;
    }
  }
}

// The squared current is curved between the axis points, which are 115 K apart.
TEST(HostGuard, TimeToLimitEndsWhereTheTableAllowsOnlyTheLoad) {
  const HostGuard guard(derating_of(ecx_32()));
  const robot_core::GuardModel& model = guard.model();
  for (const float body_C : {40.0F, 80.0F, 110.0F}) {
    for (const float load_A : {4.0F, 6.0F, 8.0F}) {
      robot_core::GuardState state;
      robot_core::start_guard(model, state, body_C);
      state.heating_K_per_s = 1.0F;
      state.load_squared_A2 = load_A * load_A;
      robot_core::seal(state);
      robot_core::estimate_time_to_limit(model, state, 0.0F);
      ASSERT_GT(state.time_to_limit_s, 0.0F);
      EXPECT_NEAR(robot_core::allowed_current_A(model, 0.0F, body_C, body_C + state.time_to_limit_s), load_A, 1e-3F) << body_C;
    }
  }
}

TEST(HostGuard, CoreRefusesATableWithoutAPositiveResistance) {
  const HostGuard guard(derating_of(ecx_32()));
  robot_core::GuardModel model = guard.model();
  robot_core::Config config = make_core_config(twente(), ecx_32().nominal, {});
  config.guard = &model;
  robot_core::complete(config);
  EXPECT_TRUE(robot_core::is_possible(config));
  for (const float ratio : {-1.0F, std::numeric_limits<float>::quiet_NaN()}) {
    model.table = guard.model().table;
    model.table.resistance_at_0C_ratio = ratio;
    EXPECT_FALSE(robot_core::is_possible(config)) << ratio;
    model.table = guard.model().table;
    model.table.resistance_ratio_per_K = ratio;
    EXPECT_FALSE(robot_core::is_possible(config)) << ratio;
  }
}

TEST(HostGuard, RefusesMoreNodesThanTheCoreTakes) {
  std::string bodies;
  for (int i = 0; i < robot_core::kMostGuardNodes; ++i) {
    bodies += fmt::format("[effects.mount_{}]\ntype = \"third_node\"\n", i) +
              "conductance = { value = \"0.1 W/K\", origin = \"estimated\", derivation = \"a test\" }\n"
              "leak_ratio = { value = \"0.5\", origin = \"estimated\", derivation = \"a test\" }\n"
              "heat_capacity = { value = \"60 J/K\", origin = \"estimated\", derivation = \"a test\" }\n";
  }
  derate::Derating derating = derating_of(ecx_32());
  const motor::Motor motor = derate::ecx_32_with(bodies);
  const thermal::Network network = motor::datasheet_network(motor, motor::nominal_sample(motor));
  derating.observer = derate::Observer(network, motor.nominal, twente(), 1.5);
  try {
    const HostGuard guard(derating);
    FAIL() << "no failure";
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
    EXPECT_NE(failure.message().find("8 nodes"), std::string::npos) << failure.message();
  }
}

}  // namespace
}  // namespace heatsoak::firmware
