// Memory over power-off in the integer header, with the promises of the single-precision header: as warm as before after a short loss of
// power, never colder than the network, and at its limit if the buffer is damaged.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/crc.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "compiled_guard.h"
#include "derate/c_header/c_text.h"
#include "exported_motor.h"
#include "powered_off_motor.h"
#include "thermal/transient.h"

namespace heatsoak::derate {
namespace {

constexpr int kUnknownTime_ms = -1;
constexpr int kLongest_ms = std::numeric_limits<int>::max() - 1;
constexpr double kPerK = 4294967296.0;

constexpr const char* kIntegerWrapper = R"(#include "guard.h"
int q15_size(void) { return (int)sizeof(@_q15_state); }
int q15_saved_size(void) { return #_Q15_SAVED_SIZE; }
void q15_start(void *state, int32_t body_mC) { @_q15_start(state, body_mC); }
void q15_stored(const void *state, int64_t *to) {
  unsigned i;
  for (i = 0; i < sizeof ((const @_q15_state *)state)->stored / sizeof(int64_t); ++i) to[i] = ((const @_q15_state *)state)->stored[i];
}
int32_t q15_step(void *state, int32_t current_mA, int32_t speed_mrad_per_s, int32_t ambient_mC) {
  const @_q15_input in = {current_mA, speed_mrad_per_s, ambient_mC};
  return @_q15_step(state, &in).allowed_current_mA;
}
void q15_save(const void *state, unsigned char *buffer) { @_q15_save(state, buffer); }
int q15_restore(void *state, const unsigned char *buffer, int32_t elapsed_ms, int32_t unsaved_ms, int32_t board_mC) {
  return (int)@_q15_restore(state, buffer, elapsed_ms, unsaved_ms, board_mC);
}
)";

/// Integer header of a motor as a shared library.
class IntegerGuard {
 public:
  IntegerGuard(const Derating& derating, std::size_t nodes, std::string_view name = "") : nodes_(nodes) {
    const std::filesystem::path folder =
        std::filesystem::path(testing::TempDir()) / fmt::format("heatsoak_q15_memory_{}{}_{}", nodes, name, static_cast<int>(getpid()));
    std::filesystem::create_directories(folder);
    std::string text = kIntegerWrapper;
    const std::string prefix = identifier(derating.motor_id);
    for (std::size_t at = text.find('@'); at != std::string::npos; at = text.find('@', at)) {
      text.replace(at, 1, prefix);
    }
    text.replace(text.find("#_Q15"), 1, c_header::in_capitals(prefix));
    std::ofstream(folder / "guard.h") << exported("c_header_q15", derating);
    std::ofstream(folder / "guard.c") << text;
    const std::string command = fmt::format(
        "cc -std=c99 -O2 -shared -fPIC -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Werror -o '{0}/guard.so' "
        "'{0}/guard.c' 2> '{0}/errors'",
        folder.string());
    const int code = std::system(command.c_str());
    std::stringstream errors;
    errors << std::ifstream(folder / "errors").rdbuf();
    EXPECT_EQ(code, 0) << errors.str();
    library_ = dlopen((folder / "guard.so").c_str(), RTLD_NOW | RTLD_LOCAL);
    EXPECT_NE(library_, nullptr);
    std::filesystem::remove_all(folder);
  }
  IntegerGuard(const IntegerGuard&) = delete;
  IntegerGuard& operator=(const IntegerGuard&) = delete;
  ~IntegerGuard() {
    if (library_ != nullptr) {
      dlclose(library_);
    }
  }
  template <class Function>
  [[nodiscard]] Function* function(const char* name) const {
    return reinterpret_cast<Function*>(dlsym(library_, name));
  }
  [[nodiscard]] std::size_t nodes() const { return nodes_; }

 private:
  std::size_t nodes_;
  void* library_ = nullptr;
};

/// State of one integer guard.
class IntegerMotor {
 public:
  explicit IntegerMotor(const IntegerGuard& guard)
      : guard_(guard), state_(static_cast<std::size_t>(guard.function<int()>("q15_size")()) / sizeof(std::int64_t)) {}

  void start(int body_mC) { guard_.function<void(void*, std::int32_t)>("q15_start")(state_.data(), body_mC); }
  int step(int current_mA, int speed_mrad_per_s, int ambient_mC) { return step_(state_.data(), current_mA, speed_mrad_per_s, ambient_mC); }
  [[nodiscard]] std::vector<double> temperatures_C() const {
    std::vector<std::int64_t> stored(guard_.nodes());
    guard_.function<void(const void*, std::int64_t*)>("q15_stored")(state_.data(), stored.data());
    std::vector<double> found;
    for (const std::int64_t each : stored) {
      found.push_back(static_cast<double>(each) / kPerK);
    }
    return found;
  }
  [[nodiscard]] std::vector<unsigned char> saved() const {
    std::vector<unsigned char> buffer(static_cast<std::size_t>(guard_.function<int()>("q15_saved_size")()));
    guard_.function<void(const void*, unsigned char*)>("q15_save")(state_.data(), buffer.data());
    return buffer;
  }
  int restore(const std::vector<unsigned char>& buffer, int elapsed_ms, int unsaved_ms, int board_mC) {
    return guard_.function<int(void*, const unsigned char*, std::int32_t, std::int32_t, std::int32_t)>("q15_restore")(
        state_.data(), buffer.data(), elapsed_ms, unsaved_ms, board_mC);
  }

 private:
  const IntegerGuard& guard_;
  std::vector<std::int64_t> state_;
  std::int32_t (*step_)(void*, std::int32_t, std::int32_t,
                        std::int32_t) = guard_.function<std::int32_t(void*, std::int32_t, std::int32_t, std::int32_t)>("q15_step");
};

/// Returns a buffer of the same guard with these temperatures and a valid check sum.
std::vector<unsigned char> with_stored(std::vector<unsigned char> buffer, const std::vector<double>& state_C) {
  for (std::size_t node = 0; node < state_C.size(); ++node) {
    const std::int64_t stored = std::llround(state_C[node] * kPerK);
    std::memcpy(&buffer[4 + 8 * node], &stored, sizeof(stored));
  }
  boost::crc_32_type sum;
  sum.process_bytes(buffer.data(), buffer.size() - 4);
  const std::uint32_t word = sum.checksum();
  std::memcpy(&buffer[buffer.size() - 4], &word, sizeof(word));
  return buffer;
}

/// Temperatures of a network after a time without current in air of 40 °C.
std::vector<double> cooled_exactly_C(const thermal::Network& network, const std::vector<double>& before_C, double elapsed_s) {
  thermal::OperatingPoint<double> at;
  at.ambient_C = 40.0;
  thermal::TransientOptions options;
  options.start_C = before_C;
  return thermal::run_transient(network, network.values(), std::vector<thermal::Interval>{{std::min(elapsed_s, 1e4), at}}, options).end_C;
}

class Q15Memory : public testing::Test {
 protected:
  static const IntegerGuard& guard() {
    static const IntegerGuard made(ecx_derating(), 2);
    return made;
  }
  static IntegerMotor driven(int steps) {
    IntegerMotor motor(guard());
    motor.start(25'000);
    int allowed_mA = 0;
    for (int i = 0; i < steps; ++i) {
      allowed_mA = motor.step(allowed_mA, 100'000, 30'000);
    }
    return motor;
  }
};

TEST_F(Q15Memory, WithoutTimeItIsWhatWasSaved) {
  const IntegerMotor motor = driven(8000);
  IntegerMotor after(guard());
  ASSERT_EQ(after.restore(motor.saved(), 0, 0, 25'000), CompiledGuard::restored);
  EXPECT_EQ(after.temperatures_C(), motor.temperatures_C());
}

TEST_F(Q15Memory, ATwoSecondResetChangesNothingThatTwoSecondsWouldNot) {
  IntegerMotor motor = driven(8000);
  IntegerMotor after(guard());
  after.restore(motor.saved(), 2000, 0, 25'000);
  for (int i = 0; i < 200; ++i) {
    motor.step(0, 0, 40'000);
  }
  for (std::size_t node = 0; node < 2; ++node) {
    EXPECT_GE(after.temperatures_C()[node], motor.temperatures_C()[node] - 0.01) << node;
    EXPECT_LE(after.temperatures_C()[node], motor.temperatures_C()[node] + 1.0) << node;
  }
}

TEST_F(Q15Memory, CoolsAsTheNetworkDoesAndNoFaster) {
  const IntegerMotor motor = driven(12'000);
  const thermal::Network network = motor::datasheet_network(ecx_32(), motor::nominal_sample(ecx_32()));
  for (const int elapsed_ms : {1, 500, 2000, 10'000, 45'000, 120'000, 600'000, 3'600'000, kLongest_ms}) {
    const std::vector<double> exact_C = cooled_exactly_C(network, motor.temperatures_C(), 1e-3 * elapsed_ms);
    IntegerMotor after(guard());
    after.restore(motor.saved(), elapsed_ms, 0, 20'000);
    for (std::size_t node = 0; node < 2; ++node) {
      EXPECT_GE(after.temperatures_C()[node], exact_C[node] - 0.001) << elapsed_ms << " " << node;
      EXPECT_LE(after.temperatures_C()[node], exact_C[node] + 0.15) << elapsed_ms << " " << node;
    }
  }
}

TEST_F(Q15Memory, AfterAnUnknownTimeNoNodeIsColderThanItMayBe) {
  const IntegerMotor motor = driven(3000);
  for (const int unknown_ms : {kUnknownTime_ms, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()}) {
    IntegerMotor unknown(guard());
    EXPECT_EQ(unknown.restore(motor.saved(), unknown_ms, 0, 20'000), CompiledGuard::time_unknown);
    const std::vector<double> assumed_C = unknown.temperatures_C();
    bool is_reached = false;
    for (const int elapsed_ms : {0, 1000, 3000, 6000, 10'000, 20'000, 40'000, 100'000, 1'000'000}) {
      IntegerMotor after(guard());
      after.restore(motor.saved(), elapsed_ms, 0, 20'000);
      EXPECT_GE(assumed_C[0], after.temperatures_C()[0] - 1e-3) << elapsed_ms;
      EXPECT_GE(assumed_C[1], after.temperatures_C()[1] - 0.05) << elapsed_ms;
      is_reached = is_reached || after.temperatures_C()[1] > assumed_C[1] - 0.5;
    }
    EXPECT_TRUE(is_reached) << "the assumption is one that can happen";
    EXPECT_EQ(assumed_C[0], motor.temperatures_C()[0]);
  }
}

TEST_F(Q15Memory, NoNodeIsColderThanTheBoard) {
  const IntegerMotor motor = driven(100);
  IntegerMotor after(guard());
  after.restore(motor.saved(), 100'000'000, 0, 70'000);
  EXPECT_NEAR(after.temperatures_C()[0], 70.0, 1e-6);
  EXPECT_NEAR(after.temperatures_C()[1], 70.0, 1e-6);
  for (const int board_mC : {-273'150, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()}) {
    IntegerMotor dead_sensor(guard());
    dead_sensor.restore(motor.saved(), 100'000'000, 0, board_mC);
    EXPECT_GE(dead_sensor.temperatures_C()[1], 40.0) << board_mC;
    EXPECT_LE(dead_sensor.temperatures_C()[1], 41.0) << board_mC;
  }
}

TEST_F(Q15Memory, UnsavedTimeCountsAsTheHardestDriving) {
  for (const int before : {10, 500, 8000}) {
    IntegerMotor motor = driven(before);
    const std::vector<unsigned char> buffer = motor.saved();
    int allowed_mA = 0;
    for (int i = 0; i < 100; ++i) {
      allowed_mA = motor.step(allowed_mA, 250'000, 40'000);
    }
    IntegerMotor after(guard());
    after.restore(buffer, 0, 1000, 25'000);
    EXPECT_GE(after.temperatures_C()[0], motor.temperatures_C()[0] - 0.001);
    EXPECT_GE(after.temperatures_C()[1], motor.temperatures_C()[1] - 0.001);
  }
  for (const int long_ms : {-1, std::numeric_limits<int>::max()}) {
    IntegerMotor after(guard());
    after.restore(driven(10).saved(), 0, long_ms, 25'000);
    EXPECT_NEAR(after.temperatures_C()[1], 155.0, 1e-6) << long_ms;
  }
}

// More unsaved time never makes a node colder, also above the limit and at any time without power.
TEST_F(Q15Memory, UnsavedTimeOnlyHeats) {
  const std::vector<unsigned char> whole = driven(10).saved();
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> temperature_C(10.0, 260.0);
  for (int draw = 0; draw < 100; ++draw) {
    const std::vector<double> state_C = {temperature_C(engine), temperature_C(engine)};
    for (const int elapsed_ms : {0, 2000, 60'000, kUnknownTime_ms}) {
      std::vector<double> before_C = {0.0, 0.0};
      for (const int unsaved_ms : {0, 1, 100, 1000, 5000, 60'000, 100'000'000}) {
        IntegerMotor after(guard());
        ASSERT_NE(after.restore(with_stored(whole, state_C), elapsed_ms, unsaved_ms, 20'000), CompiledGuard::nothing_restored);
        for (std::size_t node = 0; node < 2; ++node) {
          // The length of the cooling steps depends on the temperatures.
          EXPECT_GE(after.temperatures_C()[node], before_C[node] - (elapsed_ms == 0 ? 0.0 : 0.02))
              << draw << ": node " << node << ", " << elapsed_ms << " ms without power, " << unsaved_ms << " ms unsaved";
        }
        before_C = after.temperatures_C();
      }
    }
  }
}

// A chassis warms after the save while winding and stator cool.
TEST(Q15MemoryOfThreeNodes, NoNodeIsColderThanTheNetwork) {
  const motor::Motor motor = ecx_32_with_chassis("60 J/K", "0.3 W/K", "0.2");
  const IntegerGuard guard(derating_of(motor), 3);
  const thermal::Network network = motor::datasheet_network(motor, motor::nominal_sample(motor));
  ASSERT_EQ(network.state_count(), 3);
  IntegerMotor cold(guard);
  cold.start(40'000);
  for (const std::vector<double>& saved_C : {std::vector<double>{120.0, 80.0, 42.0}, {150.0, 60.0, 40.0}, {60.0, 58.0, 50.0}}) {
    for (const int elapsed_ms : {500, 2000, 10'000, 30'000, 60'000, 120'000, 300'000, 1'000'000, 5'000'000}) {
      const std::vector<double> exact_C = cooled_exactly_C(network, saved_C, 1e-3 * elapsed_ms);
      IntegerMotor after(guard);
      after.restore(with_stored(cold.saved(), saved_C), elapsed_ms, 0, 20'000);
      for (std::size_t node = 0; node < 3; ++node) {
        EXPECT_GE(after.temperatures_C()[node], exact_C[node] - 0.001) << elapsed_ms << " ms, node " << node;
        EXPECT_LE(after.temperatures_C()[node], exact_C[node] + (elapsed_ms > 1'000'000 ? 0.3 : 0.15)) << elapsed_ms << " ms, node " << node;
      }
    }
  }
}

TEST(Q15MemoryOfAnyMotor, NoNodeIsColderThanTheNetwork) {
  for (const PoweredOffCase& each : powered_off_cases()) {
    if (!each.fits_integers) {
      continue;
    }
    const PoweredOffMotor motor(each);
    const IntegerGuard guard(motor.derating, motor.nodes(), each.name);
    IntegerMotor cold(guard);
    cold.start(40'000);
    expect_safe_and_useful(motor, [&](const std::vector<double>& saved_C, double elapsed_s) {
      IntegerMotor after(guard);
      after.restore(with_stored(cold.saved(), saved_C), elapsed_s < 0.0 ? kUnknownTime_ms : static_cast<int>(1000.0 * elapsed_s), 0, 0);
      return after.temperatures_C();
    });
  }
}

TEST_F(Q15Memory, EveryFlippedBitCountsAsAtTheLimit) {
  const std::vector<unsigned char> whole = driven(3000).saved();
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    std::vector<unsigned char> broken = whole;
    broken[bit / 8] ^= static_cast<unsigned char>(1U << (bit % 8));
    IntegerMotor after(guard());
    ASSERT_EQ(after.restore(broken, 10'000, 0, 25'000), CompiledGuard::nothing_restored) << bit;
    EXPECT_NEAR(after.temperatures_C()[0], 155.0, 1e-6);
    EXPECT_LT(after.step(0, 0, 40'000), 50);
  }
  for (const int fill : {0x00, 0xff}) {
    IntegerMotor after(guard());
    EXPECT_EQ(after.restore(std::vector<unsigned char>(whole.size(), static_cast<unsigned char>(fill)), 1000, 0, 25'000),
              CompiledGuard::nothing_restored);
  }
}

TEST_F(Q15Memory, OtherBuffersAreRefused) {
  const IntegerMotor never_started(guard());
  IntegerMotor after(guard());
  EXPECT_EQ(after.restore(never_started.saved(), 1000, 0, 25'000), CompiledGuard::nothing_restored);
  Derating other = ecx_derating();
  other.robot_id = "another";
  const IntegerGuard another(other, 2, "another");
  IntegerMotor motor(another);
  motor.start(30'000);
  EXPECT_EQ(after.restore(motor.saved(), 1000, 0, 25'000), CompiledGuard::nothing_restored);
  const CompiledGuard single(ecx_derating(), "q15_other");
  ModelGuard of_single(single);
  of_single.start(30.0F);
  EXPECT_EQ(after.restore(of_single.saved(2), 1000, 0, 25'000), CompiledGuard::nothing_restored) << "the single-precision header's";
  for (const double impossible_C : {-200.0, 1200.0}) {
    EXPECT_EQ(after.restore(with_stored(driven(10).saved(), {impossible_C, 50.0}), 1000, 0, 25'000), CompiledGuard::nothing_restored);
  }
}

}  // namespace
}  // namespace heatsoak::derate
