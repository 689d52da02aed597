// Events of functional mock-up units: event mode and early return of FMI 3.0, and what importers without them see.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <tuple>

#include "exported_motor.h"
#include "fmu_unit.h"
#include "robot/motor_drive.h"
#include "thermal/transient.h"

namespace heatsoak::derate {
namespace {

using testing::HasSubstr;

constexpr double kAmbient_C = 30.0;
constexpr double kOverload_A = 8.0;
constexpr FmuUnit::Importer kEarly{.has_event_mode = true, .takes_early_return = true};
constexpr FmuUnit::Importer kWholeSteps{.has_event_mode = true, .takes_early_return = false};

/// Bytes of a unit with its binary, built once.
const std::string& unit_bytes(const std::string& form) {
  static std::map<std::string, std::string> bytes;
  if (!bytes.contains(form)) {
    bytes[form] = compiled(form);
  }
  return bytes.at(form);
}

void give(FmuUnit& unit, double current_A) {
  EXPECT_EQ(unit.set("current_A", current_A), 0);
  EXPECT_EQ(unit.set("speed_rad_per_s", 200.0), 0);
  EXPECT_EQ(unit.set("ambient_C", kAmbient_C), 0);
}

void end_event(FmuUnit& unit, double* next_s) {
  EXPECT_EQ(unit.update_discrete_states(next_s), 0);
  EXPECT_EQ(unit.enter_step_mode(), 0);
}

/// Initialised and in step mode.
void start(FmuUnit& unit, bool has_event_mode) {
  EXPECT_EQ(unit.enter(), 0);
  EXPECT_EQ(unit.run(), 0);
  if (has_event_mode) {
    double next_s = 0.0;
    end_event(unit, &next_s);
  }
}

/// The motor by CVODES with tight tolerances: `heat_s` at the overload, then `rest_s` without current.
std::vector<double> reference_C(double heat_s, double rest_s) {
  const thermal::Network network = motor::datasheet_network(ecx_32(), motor::nominal_sample(ecx_32()));
  std::vector<thermal::Interval> intervals;
  for (const auto& [duration_s, current_A] : {std::pair(heat_s, kOverload_A), std::pair(rest_s, 0.0)}) {
    if (duration_s > 0.0) {
      const std::array<double, observed::kSignalCount> signals{current_A, 200.0, kAmbient_C, 0.0, kAmbient_C, 0.0, 0.0};
      intervals.push_back({duration_s, operating_point<double>(ecx_32().nominal, twente(), signals)});
    }
  }
  thermal::TransientOptions options;
  options.method = ode::OdeMethod::cvodes_bdf;
  options.tolerances = {.relative = 1e-10, .absolute = 1e-10};
  options.start_C.assign(static_cast<std::size_t>(network.state_count()), 25.0);
  return thermal::run_transient(network, network.values(), intervals, options).end_C;
}

constexpr double kLimit_C = 155.0;
constexpr double kMillisecond_s = 1e-3;

TEST(FmuEvents, MotorStopsWhereALimitIsCrossedToAMillisecond) {
  FmuUnit unit(unit_bytes("fmi3_motor"), 3, {}, kEarly);
  start(unit, true);
  give(unit, kOverload_A);
  const FmuUnit::Step up = unit.step_to_event(0.0, 200.0);
  EXPECT_EQ(up.status, 0);
  EXPECT_TRUE(up.is_event);
  EXPECT_TRUE(up.is_early);
  EXPECT_LT(reference_C(up.last_s - kMillisecond_s, 0.0)[motor::states::winding], kLimit_C);
  EXPECT_GT(reference_C(up.last_s + kMillisecond_s, 0.0)[motor::states::winding], kLimit_C);
  EXPECT_EQ(unit.get("time_s"), up.last_s);
  EXPECT_FALSE(unit.get_boolean("over_limit")) << "a discrete output changes in event mode only";
  double next_s = 0.0;
  EXPECT_EQ(unit.enter_event_mode(), 0);
  EXPECT_TRUE(unit.get_boolean("over_limit"));
  EXPECT_EQ(unit.get("limit_crossing_s"), up.last_s);
  EXPECT_NE(unit.enter_step_mode(), 0) << "the discrete states were not updated";
  end_event(unit, &next_s);
  EXPECT_TRUE(std::isnan(next_s)) << "nobody knows when the next limit is crossed";
  // The winding heats up further and then cools down: the falling crossing must be an event, too.
  const FmuUnit::Step hotter = unit.step_to_event(up.last_s, 1.0);
  EXPECT_FALSE(hotter.is_event) << "the same crossing must not be found again";
  give(unit, 0.0);
  const FmuUnit::Step down = unit.step_to_event(hotter.last_s, 200.0);
  EXPECT_TRUE(down.is_event);
  EXPECT_TRUE(down.is_early);
  const double rest_s = down.last_s - hotter.last_s;
  EXPECT_GT(rest_s, kMillisecond_s);
  EXPECT_GT(reference_C(hotter.last_s, rest_s - kMillisecond_s)[motor::states::winding], kLimit_C);
  EXPECT_LT(reference_C(hotter.last_s, rest_s + kMillisecond_s)[motor::states::winding], kLimit_C);
  EXPECT_EQ(unit.enter_event_mode(), 0);
  end_event(unit, &next_s);
  EXPECT_FALSE(unit.get_boolean("over_limit"));
  const FmuUnit::Step calm = unit.step_to_event(down.last_s, 50.0);
  EXPECT_FALSE(calm.is_event);
  EXPECT_FALSE(calm.is_early);
  EXPECT_EQ(calm.last_s, down.last_s + 50.0);
}

TEST(FmuEvents, MotorWithoutEarlyReturnSaysItAfterTheStep) {
  FmuUnit early(unit_bytes("fmi3_motor"), 3, {}, kEarly);
  start(early, true);
  give(early, kOverload_A);
  const double crossing_s = early.step_to_event(0.0, 200.0).last_s;
  FmuUnit unit(unit_bytes("fmi3_motor"), 3, {}, kWholeSteps);
  start(unit, true);
  give(unit, kOverload_A);
  EXPECT_EQ(unit.get("limit_crossing_s"), -1.0);
  const FmuUnit::Step step = unit.step_to_event(0.0, 200.0);
  EXPECT_TRUE(step.is_event);
  EXPECT_FALSE(step.is_early);
  EXPECT_EQ(step.last_s, 200.0);
  EXPECT_FALSE(unit.get_boolean("over_limit"));
  double next_s = 0.0;
  EXPECT_EQ(unit.enter_event_mode(), 0);
  end_event(unit, &next_s);
  EXPECT_TRUE(unit.get_boolean("over_limit"));
  EXPECT_NEAR(unit.get("limit_crossing_s"), crossing_s, 1e-5);
}

// FMI 2.0 has no events for co-simulation, and an importer of FMI 3.0 may do without.
class WithoutEvents : public testing::TestWithParam<int> {};

TEST_P(WithoutEvents, MotorGivesTheTimeOfTheCrossing) {
  FmuUnit unit(unit_bytes(fmt::format("fmi{}_motor", GetParam())), GetParam());
  start(unit, false);
  give(unit, kOverload_A);
  EXPECT_EQ(unit.step(0.0, 200.0), 0);
  EXPECT_TRUE(unit.get_boolean("over_limit"));
  const double crossing_s = unit.get("limit_crossing_s");
  EXPECT_LT(reference_C(crossing_s - kMillisecond_s, 0.0)[motor::states::winding], kLimit_C);
  EXPECT_GT(reference_C(crossing_s + kMillisecond_s, 0.0)[motor::states::winding], kLimit_C);
}

TEST_P(WithoutEvents, GuardSaysThatItLimits) {
  FmuUnit unit(unit_bytes(fmt::format("fmi{}_guard", GetParam())), GetParam());
  start(unit, false);
  constexpr int kFull = 0;
  give(unit, 0.0);
  EXPECT_EQ(unit.step(0.0, 0.05), 0);
  EXPECT_EQ(unit.get_item("reason"), kFull) << "a cold motor without current";
  EXPECT_FALSE(unit.get_boolean("is_limiting"));
  double now_s = 0.05;
  for (int i = 0; i < 300; ++i) {
    give(unit, kOverload_A);
    EXPECT_EQ(unit.step(now_s, 0.05), 0);
    now_s += 0.05;
    ASSERT_EQ(unit.get_boolean("is_limiting"), unit.get_item("reason") != kFull);
  }
  EXPECT_TRUE(unit.get_boolean("is_limiting"));
}

INSTANTIATE_TEST_SUITE_P(Versions, WithoutEvents, testing::Values(2, 3));

/// Outputs of the guard.
using GuardOutputs = std::tuple<double, double, double, int, bool>;
GuardOutputs outputs(FmuUnit& unit) {
  return {unit.get("allowed_current_A"), unit.get("guarded_winding_C"), unit.get("nominal_winding_C"), unit.get_item("reason"),
          unit.get_boolean("is_limiting")};
}

constexpr double kPeriod_s = 0.01;

double load_A(int step) { return step % 400 < 250 ? 7.0 : -1.5; }

// If inputs change in step mode only, the outputs with events equal those without.
TEST(FmuEvents, GuardIsCalledAtItsPeriodWhateverTheStep) {
  FmuUnit plain(unit_bytes("fmi3_guard"), 3);
  start(plain, false);
  FmuUnit early(unit_bytes("fmi3_guard"), 3, {}, kEarly);
  FmuUnit whole(unit_bytes("fmi3_guard"), 3, {}, kWholeSteps);
  for (FmuUnit* unit : {&early, &whole}) {
    EXPECT_EQ(unit->enter(), 0);
    EXPECT_EQ(unit->run(), 0);
    double next_s = 0.0;
    end_event(*unit, &next_s);
    EXPECT_NEAR(next_s, kPeriod_s, 1e-12);
  }
  constexpr double kStep_s = 0.035;
  GuardOutputs held = outputs(early);
  int changes = 0;
  for (int step = 0; step < 400; ++step) {
    const double begin_s = step * kStep_s;
    const double end_s = (step + 1) * kStep_s;
    for (FmuUnit* unit : {&plain, &early, &whole}) {
      give(*unit, load_A(step));
    }
    EXPECT_EQ(plain.step(begin_s, end_s - begin_s), 0);
    const FmuUnit::Step one = whole.step_to_event(begin_s, end_s - begin_s);
    EXPECT_TRUE(one.is_event);
    EXPECT_FALSE(one.is_early);
    double next_s = 0.0;
    EXPECT_EQ(whole.enter_event_mode(), 0);
    end_event(whole, &next_s);
    ASSERT_EQ(outputs(whole), outputs(plain)) << step;
    double now_s = begin_s;
    for (int events = 0; now_s < end_s; ++events) {
      ASSERT_LT(events, 5);
      const FmuUnit::Step part = early.step_to_event(now_s, end_s - now_s);
      ASSERT_EQ(part.status, 0);
      EXPECT_EQ(part.is_early, part.last_s < end_s - 1e-9);
      if (part.is_event) {
        EXPECT_NEAR(std::remainder(part.last_s, kPeriod_s), 0.0, 1e-9);
        EXPECT_EQ(outputs(early), held) << "outputs change in event mode only";
        EXPECT_EQ(early.enter_event_mode(), 0);
        changes += outputs(early) != held ? 1 : 0;
        held = outputs(early);
        end_event(early, &next_s);
        EXPECT_EQ(outputs(early), held);
        EXPECT_NEAR(next_s, part.last_s + kPeriod_s, 1e-9);
      }
      now_s = part.is_early ? part.last_s : end_s;
    }
    ASSERT_EQ(outputs(early), outputs(plain)) << step;
  }
  EXPECT_GT(changes, 1300) << "of 1400 calls";
  EXPECT_TRUE(plain.get_boolean("is_limiting")) << "the load must make the guard work";
}

TEST(FmuEvents, GuardSeesTheInputsOfItsEvent) {
  FmuUnit unit(unit_bytes("fmi3_guard"), 3, {}, kEarly);
  start(unit, true);
  give(unit, 1.0);
  EXPECT_TRUE(unit.step_to_event(0.0, kPeriod_s).is_event);
  EXPECT_EQ(unit.enter_event_mode(), 0);
  const double cool_C = unit.get("guarded_winding_C");
  give(unit, 20.0);
  const double hot_C = unit.get("guarded_winding_C");
  EXPECT_GT(hot_C, cool_C);
  EXPECT_EQ(unit.set("current_A", 1.0), 0);
  EXPECT_EQ(unit.get("guarded_winding_C"), cool_C) << "asking for outputs must not call the guard";
  EXPECT_EQ(unit.set("current_A", 20.0), 0);
  double next_s = 0.0;
  end_event(unit, &next_s);
  EXPECT_EQ(unit.get("guarded_winding_C"), hot_C);
  // An event that only the importer has between two calls changes nothing.
  EXPECT_FALSE(unit.step_to_event(kPeriod_s, 0.4 * kPeriod_s).is_event);
  EXPECT_EQ(unit.enter_event_mode(), 0);
  end_event(unit, &next_s);
  EXPECT_EQ(unit.get("guarded_winding_C"), hot_C);
  EXPECT_NEAR(next_s, 2.0 * kPeriod_s, 1e-12);
}

TEST(FmuEvents, StatesAreRestoredAcrossAnEvent) {
  for (const char* kind : {"motor", "guard"}) {
    const bool is_motor = *kind == 'm';
    FmuUnit unit(unit_bytes(fmt::format("fmi3_{}", kind)), 3, {}, kEarly);
    start(unit, true);
    give(unit, kOverload_A);
    const double first_s = is_motor ? 5.0 : 0.4 * kPeriod_s;
    const double long_s = is_motor ? 200.0 : 2.0 * kPeriod_s;
    EXPECT_FALSE(unit.step_to_event(0.0, first_s).is_event);
    void* const before = unit.keep();
    const auto across = [&](FmuUnit& of) {
      std::vector<double> seen;
      double next_s = 0.0;
      FmuUnit::Step step = of.step_to_event(first_s, long_s);
      EXPECT_TRUE(step.is_event);
      seen.push_back(step.last_s);
      EXPECT_EQ(of.enter_event_mode(), 0);
      end_event(of, &next_s);
      give(of, 0.0);
      step = of.step_to_event(step.last_s, long_s);
      seen.push_back(step.last_s);
      seen.push_back(of.get(is_motor ? "winding_C" : "guarded_winding_C"));
      return seen;
    };
    const std::vector<double> once = across(unit);
    EXPECT_EQ(unit.bring_back(before), 0);
    give(unit, kOverload_A);
    EXPECT_EQ(across(unit), once) << kind;
    // A state that was saved in event mode can be restored, also in another instance.
    EXPECT_EQ(unit.bring_back(before), 0);
    give(unit, kOverload_A);
    const double event_s = unit.step_to_event(first_s, long_s).last_s;
    EXPECT_EQ(unit.enter_event_mode(), 0);
    void* const in_event = unit.keep();
    FmuUnit other(unit_bytes(fmt::format("fmi3_{}", kind)), 3, {}, kWholeSteps);
    void* restored = nullptr;
    EXPECT_EQ(other.from_bytes(unit.bytes_of(in_event), &restored), 0);
    EXPECT_EQ(other.bring_back(restored), 0);
    EXPECT_NE(other.step_to_event(event_s, 1.0).status, 0) << "event mode";
    double next_s = 0.0;
    end_event(other, &next_s);
    end_event(unit, &next_s);
    EXPECT_EQ(other.get(is_motor ? "winding_C" : "guarded_winding_C"), unit.get(is_motor ? "winding_C" : "guarded_winding_C"));
    const FmuUnit::Step whole = other.step_to_event(event_s, long_s);
    EXPECT_FALSE(whole.is_early) << "how events are handled belongs to the instance";
    FmuUnit plain(unit_bytes(fmt::format("fmi3_{}", kind)), 3);
    EXPECT_NE(plain.bring_back(in_event), 0) << "without event mode nobody could leave it";
    EXPECT_THAT(fmu_log().back(), HasSubstr("event mode"));
    other.forget(restored);
    unit.forget(in_event);
    unit.forget(before);
  }
}

TEST(FmuEvents, EventModeIsRefusedWhereTheImporterAnnouncedNone) {
  FmuUnit unit(unit_bytes("fmi3_motor"), 3);
  start(unit, false);
  fmu_log().clear();
  EXPECT_NE(unit.enter_event_mode(), 0);
  EXPECT_NE(unit.enter_step_mode(), 0);
  EXPECT_EQ(fmu_log().size(), 2U);
  EXPECT_EQ(unit.step(0.0, 0.1), 0) << "a refused call changes nothing";
}

TEST(FmuEvents, DescriptionAnnouncesThem) {
  for (const char* form : {"fmi3_motor", "fmi3_guard"}) {
    const Attributes can = elements_with(unpacked(exported(form)).at("modelDescription.xml"), "modelIdentifier").at(0);
    EXPECT_EQ(can.at("hasEventMode"), "true");
    EXPECT_EQ(can.at("mightReturnEarlyFromDoStep"), "true");
  }
}

}  // namespace
}  // namespace heatsoak::derate
