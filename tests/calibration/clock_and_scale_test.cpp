// Clock errors, unit scales that show only at the end of a run, and samples that are outliers or only look like outliers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calibration/admission.h"
#include "read_log.h"
#include "recording/clock_offset.h"
#include "support/shipped.h"

namespace heatsoak::calibration {
namespace {

using recording::RespondsEarly;
using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::IsEmpty;
using ::testing::VariantWith;

/// A sensor with a resolution of 1 K in a calm room occasionally changes by one or two steps.
TEST(Screening, CoarseSensorAtRestKeepsItsNeighbouringSteps) {
  for (const double step_K : {1.0, -1.0}) {
    for (const int steps : {1, 2}) {
      const recording::Read result = recording::read_text(recording::changed({}, [=](int row, std::vector<double>& cells) {
        cells[recording::ambient] = 21.0 + (row % 500 == 250 ? step_K : row % 700 == 350 ? steps * step_K : 0.0);
      }));
      EXPECT_TRUE(result.report.left_out.empty()) << step_K << " K";
      EXPECT_EQ(result.quality.channels[2].samples, 1800U);
    }
  }
}

TEST(Screening, SingleWildCurrentIsLeftOutByLine) {
  const recording::Read result = recording::read_text(recording::changed(
      {}, [](int row, std::vector<double>& cells) { cells[recording::current] = row == 700 ? 1e9 : cells[recording::current]; }));
  EXPECT_THAT(recording::lines_of(result.report.find("current_A", recording::LeftOutReason::outlier)), ElementsAre(702));
  EXPECT_TRUE(std::isnan(result.recording.find("current_A")->values[700]));
  EXPECT_THAT(result.quality.suspicions, IsEmpty());
}

/// Tests of an unsteady load take the seeds 1 to kLoads, which decide load and noise.
constexpr std::uint64_t kLoads = 4;

recording::SyntheticLog unsteady(double delay_s, std::uint64_t seed) {
  recording::SyntheticLog log;
  log.seed = seed;
  log.delay_s = delay_s;
  log.current_A = [seed](double time_s) {
    base::Random random(static_cast<std::uint64_t>(std::max(time_s, 0.0) / 20.0), seed);
    return random.uniform() < 0.4 ? 0.0 : 6.0 * random.uniform();
  };
  return log;
}

TEST(ClockOffsets, TemperatureBeforeItsHeatSpoils) {
  for (std::uint64_t seed = 1; seed <= kLoads; ++seed) {
    for (const auto& [delay_s, is_one_row] : {std::pair(-1.0, true), std::pair(-4.0, false)}) {
      const recording::Read result = recording::read_text(unsteady(delay_s, seed).csv());
      const auto is_early = ElementsAre(VariantWith<RespondsEarly>(AllOf(Field(&RespondsEarly::temperature, "winding_C"),
                                                                         Field(&RespondsEarly::delay_s, testing::Lt(0.0)),
                                                                         Field(&RespondsEarly::is_one_row, is_one_row))));
      EXPECT_THAT(result.quality.blocking, is_early) << delay_s << ", seed " << seed;
      EXPECT_THAT(result.quality.suspicions, is_early) << delay_s << ", seed " << seed;
    }
  }
}

testing::Matcher<recording::RespondsLate> is_late(double delay_s) {
  return AllOf(Field(&recording::RespondsLate::temperature, "winding_C"), Field(&recording::RespondsLate::heat_input, "current_A"),
               Field(&recording::RespondsLate::delay_s, AllOf(testing::Ge(delay_s - 0.05), testing::Lt(delay_s + 0.95))));
}

TEST(ClockOffsets, TemperatureAfterItsHeatIsSaidByTheAdmission) {
  for (std::uint64_t seed = 1; seed <= kLoads; ++seed) {
    for (const double delay_s : {0.0, 3.0}) {
      SCOPED_TRACE(testing::Message() << delay_s << " s, seed " << seed);
      const recording::Read result = recording::read_text(unsteady(delay_s, seed).csv());
      EXPECT_THAT(result.quality.suspicions, IsEmpty()) << "sensors lag";
      const Admission admission = admit(shipped_motor("maxon_ec45_flat_70w_24v"), std::vector{result.recording}, {}, false);
      if (delay_s > 0.0) {
        EXPECT_THAT(
            admission.notes,
            ElementsAre(VariantWith<SensorLags>(AllOf(Field(&SensorLags::log, "log"), Field(&SensorLags::response, is_late(delay_s))))));
        EXPECT_THAT(admission.lagging, ElementsAre("winding_C"));
      } else {
        EXPECT_THAT(admission.notes, IsEmpty());
        EXPECT_THAT(admission.lagging, IsEmpty());
      }
    }
  }
}

/// A part may look wrong by itself, for example if it only cools down. If the whole log looks wrong in the same way, the part is reported.
TEST(Suspicions, OfAPartCountIfTheWholeLogHasThem) {
  const recording::Read whole =
      recording::read_text(recording::changed({}, [](int, std::vector<double>& cells) { cells[recording::current] *= 1000.0; }));
  recording::Recording part = recording::part_of(whole.recording, 0.0, 0.6);
  const motor::Motor motor = shipped_motor("maxon_ec45_flat_70w_24v");
  const auto is_reported = testing::Contains(VariantWith<recording::SuspicionOfLog>(
      Field(&recording::SuspicionOfLog::suspicion, VariantWith<recording::CurrentTooLarge>(testing::_))));
  part.blocking_of_whole = whole.quality.blocking;
  EXPECT_THAT(admit(motor, std::vector{part}, {}, true).notes, is_reported);
  part.blocking_of_whole->clear();
  EXPECT_THAT(admit(motor, std::vector{part}, {}, true).notes, testing::Not(is_reported));
}

/// Without a second temperature, the heat that leaves the winding is confounded with an offset.
TEST(ClockOffsets, WindingAloneIsNotJudged) {
  recording::ClockOffset offset{.temperature = "winding_C",
                                .heat_input = "current_A",
                                .delay_s = -3.0,
                                .delay_uncertainty_s = 0.1,
                                .misfit_ratio = 50.0,
                                .why_not = {}};
  EXPECT_FALSE(recording::early_answer(offset, 1.0));
  offset.explains_flow = true;
  EXPECT_TRUE(recording::early_answer(offset, 1.0));
  EXPECT_FALSE(recording::late_answer(offset, 1.0));
  offset.misfit_ratio = 2.0;
  EXPECT_FALSE(recording::early_answer(offset, 1.0)) << "little better than no delay: another heat makes that";
  offset.misfit_ratio = 50.0;
  offset.delay_s = -0.25;
  EXPECT_FALSE(recording::early_answer(offset, 1.0)) << "less than one sample";
}

/// The motor turns for minutes without load. The iron heats the winding, which is never the hottest node and does not follow the current.
TEST(ClockOffsets, WindingThatFollowsTheIronIsNotJudged) {
  std::string text = "time_s,winding_C,stator_C,ambient_C,current_A\n";
  double winding_C = 22.0;
  double stator_C = 22.0;
  for (int row = 0; row < 1800; ++row) {
    const double current_A = (row / 120) % 2 == 0 ? 0.0 : 0.23;
    text += fmt::format("{},{:.1f},{:.1f},22.0,{}\n", row, winding_C, stator_C, current_A);
    const double flow_W = (winding_C - stator_C) / 4.0;
    winding_C += (0.6 * current_A * current_A - flow_W) / 7.0;
    stator_C += ((row / 120) % 4 == 1 ? 6.0 : 0.5) / 50.0 + (flow_W - (stator_C - 22.0) / 3.5) / 50.0;
  }
  const recording::Read result = recording::read_text(text);
  EXPECT_THAT(result.quality.suspicions, IsEmpty());
  for (const recording::ClockOffset& offset : result.quality.clock_offsets) {
    EXPECT_EQ(offset.explains_flow, offset.temperature == "stator_C");
  }
  EXPECT_TRUE(
      std::ranges::any_of(recording::read_text(unsteady(0.0, 1).csv()).quality.clock_offsets, &recording::ClockOffset::explains_flow));
}

/// Log of a cool-down from `from_s` on, after heating for `heated_s`. Motor temperatures may be in Fahrenheit; the air is in Celsius.
std::string cooling(double heated_s, int from_s, bool is_fahrenheit) {
  recording::SyntheticLog log;
  log.rows = from_s + 1800;
  log.current_A = [heated_s](double time_s) { return time_s < heated_s ? 8.0 : 0.0; };
  const auto rows_C = log.temperatures_C();
  const auto shown = [is_fahrenheit](double value_C) { return is_fahrenheit ? 1.8 * value_C + 32.0 : value_C; };
  std::string text = "time_s,winding_C,stator_C,ambient_C,current_A\n";
  for (std::size_t row = static_cast<std::size_t>(from_s); row < rows_C.size(); ++row) {
    const auto& [winding_C, stator_C] = rows_C[row];
    text += fmt::format("{},{:.2f},{:.2f},22,{}\n", row, shown(winding_C), shown(stator_C), log.current_A(static_cast<double>(row)));
  }
  return text;
}

TEST(Suspicion, FahrenheitByWhereACoolingMotorComesToRest) {
  for (const auto& [heated_s, from_s] :
       {std::pair(300.0, 310), std::pair(1500.0, 1500), std::pair(1500.0, 1000), std::pair(1500.0, 1600)}) {
    EXPECT_THAT(recording::read_text(cooling(heated_s, from_s, true)).quality.blocking,
                ElementsAre(AnyOf(VariantWith<recording::MotorCoolsInFahrenheit>(testing::_),
                                  VariantWith<recording::MotorStartsInFahrenheit>(testing::_),
                                  VariantWith<recording::StartsInOtherScale>(
                                      Field(&recording::StartsInOtherScale::suspected, recording::TemperatureScale::fahrenheit)))))
        << from_s;
    EXPECT_THAT(recording::read_text(cooling(heated_s, from_s, false)).quality.suspicions, IsEmpty()) << from_s;
  }
}

}  // namespace
}  // namespace heatsoak::calibration
