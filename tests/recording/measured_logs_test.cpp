// Third-party recordings with the example mappings, compared with values read directly from the files. Skipped if the recordings are not
// available.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "../support/measured_data.h"
#include "read_log.h"
#include "recording/quality.h"
#include "recording/read_recording.h"
#include "support/source_folder.h"

namespace heatsoak::recording {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class MeasuredLogs : public testing::Test {
 protected:
  void SetUp() override { SKIP_WITHOUT_MEASURED_DATA(""); }

  Recording read(const std::string& folder, const std::string& file) {
    const fs::path log = *measured_data() / folder / file;
    report_ = {};
    Recording recording = read_recording(log, read_mapping(kSource / "tests/data/mappings" / (folder + ".map.toml"), log), report_);
    quality_ = assess(recording, report_);
    return recording;
  }
  [[nodiscard]] const ChannelQuality& channel(const std::string& key) const {
    return *std::ranges::find_if(quality_.channels, [&key](const ChannelQuality& each) { return each.quantity.key == key; });
  }
  [[nodiscard]] std::size_t left_out(const std::string& key, LeftOutReason reason) const {
    const LeftOut* const entry = report_.find(key, reason);
    return entry == nullptr ? 0 : entry->count;
  }

  RecordingReport report_;
  DataQuality quality_;
};

TEST_F(MeasuredLogs, UavMotor) {
  const Recording fan = read("tasrv_uav_motor", "run4.csv");
  EXPECT_EQ(fan.rows(), 1274U);
  EXPECT_EQ(fan.conditions.at("cooling"), "fan");
  EXPECT_NEAR(quality_.sampling.usual_period_s, 0.302, 1e-6);
  EXPECT_NEAR(quality_.sampling.duration_s, 384.4, 0.05);
  EXPECT_NEAR(channel("winding_C").high, 169.9, 0.1);
  EXPECT_EQ(left_out("bus_V", LeftOutReason::not_recorded), 86U);
  EXPECT_LT(left_out("winding_C", LeftOutReason::outlier) + left_out("stator_C", LeftOutReason::outlier), 10U);
  EXPECT_TRUE(quality_.thermal.is_good());

  // The motor controller's log ends before the temperatures do, so that power is unknown.
  const Recording hot = read("tasrv_uav_motor", "run2.csv");
  EXPECT_EQ(hot.rows(), 586U);
  EXPECT_EQ(left_out("power_in_W", LeftOutReason::not_recorded), 105U);
  EXPECT_EQ(report_.find("power_in_W", LeftOutReason::not_recorded)->lines.front().first, 483);
  EXPECT_TRUE(std::isnan(hot.find("power_in_W")->values.back()));
  EXPECT_EQ(hot.find("power_in_W")->values.front(), 0.0);
  for (const auto& [file, rows] :
       std::vector<std::pair<const char*, std::size_t>>{{"run1.csv", 1659}, {"run3.csv", 709}, {"run5.csv", 663}}) {
    EXPECT_EQ(read("tasrv_uav_motor", file).rows(), rows);
    EXPECT_EQ(quality_.gaps.size(), 0U);
    EXPECT_THAT(quality_.suspicions, IsEmpty());
  }
}

TEST_F(MeasuredLogs, FramelessMotorStalledAndSpinning) {
  const Recording stall = read("umich_ri50", "stall_staircase.csv");
  EXPECT_EQ(stall.rows(), 7268U);
  EXPECT_EQ(stall.line.front(), 18);
  EXPECT_NEAR(channel("winding_C").high, 82.3, 0.1);
  EXPECT_THAT(quality_.suspicions, IsEmpty());
  const Recording spin = read("umich_ri50", "no_load_staircase.csv");
  EXPECT_EQ(spin.rows(), 7766U);
  EXPECT_EQ(spin.run_begins.size(), 1U) << "the mapping bridges the bus's hiccups of 20 ms";
  EXPECT_NEAR(channel("speed_rad_per_s").high, 134.4, 0.1);
  Mapping strict = read_mapping(kSource / "tests/data/mappings/umich_ri50.map.toml", spin.file);
  strict.longest_gap_s.reset();
  RecordingReport report;
  EXPECT_EQ(read_recording(spin.file, strict, report).run_begins.size(), 1U + 194U) << "gaps of more than three usual periods";
}

TEST_F(MeasuredLogs, PropellerBench) {
  const Recording cooling = read("ksu_propeller_bench", "cooling_slopes__Spike-P80-1700_2020-03-09_185035.csv");
  EXPECT_EQ(report_.rows_in_file, 1293U);
  EXPECT_EQ(cooling.rows(), 1292U);
  EXPECT_EQ(left_out("", LeftOutReason::time_does_not_increase), 1U);
  EXPECT_EQ(report_.find("", LeftOutReason::time_does_not_increase)->lines.front().first, 3);
  EXPECT_GT(left_out("speed_rad_per_s", LeftOutReason::not_valid), 400U) << "0 rpm while the propeller pulls is no speed";
  EXPECT_NEAR(channel("power_in_W").high, 822.3, 0.1);
  for (const char* file : {"cooling_slopes__Spike-Mega-1700_2020-01-27_105922.csv", "cooling_slopes__Spike-Mega-1700_2020-03-05_145559.csv",
                           "cooling_slopes__Spike-P80-1700_2020-02-11_162559.csv", "cooling_slopes__Spike-P80-1700_2020-03-10_133951.csv",
                           "custom_head_testing__HeadBaseline-KDE-2000_2020-02-13_160050.csv"}) {
    const Recording recording = read("ksu_propeller_bench", file);
    EXPECT_GE(recording.rows(), 1200U);
    EXPECT_LE(left_out("winding_C", LeftOutReason::frozen) + left_out("winding_C", LeftOutReason::outlier), 2U) << file;
    // Seen by eye: two readings 0.3 to 0.4 K below a line that the others follow to 0.05 K.
    const auto by_eye = std::string_view(file).starts_with("custom") ? std::vector{3509, 3519} : std::vector<int>();
    EXPECT_THAT(lines_of(report_.find("winding_C", LeftOutReason::outlier)), testing::IsSupersetOf(by_eye)) << file;
    EXPECT_EQ(left_out("ambient_C", LeftOutReason::frozen), 0U) << file << ": a coarse sensor in still air is not frozen";
    EXPECT_THAT(quality_.suspicions, IsEmpty()) << file;
  }
}

TEST_F(MeasuredLogs, TractionMotor) {
  const Recording profile = read("paderborn_pmsm", "profile24_2.5s.csv");
  EXPECT_EQ(profile.rows(), 3003U);
  EXPECT_EQ(profile.run_begins.size(), 1U);
  EXPECT_NEAR(quality_.sampling.usual_period_s, 2.5, 1e-9);
  EXPECT_NEAR(channel("speed_rad_per_s").high, 576.0, 0.1) << "5500 rpm";
  // Line 4: -1.3188 A along the field, 0.7276 A across it; the motor works as a generator.
  EXPECT_NEAR(profile.find("current_A")->values[2],
              -std::sqrt((1.318769931793213 * 1.318769931793213 + 0.727579712867737 * 0.727579712867737) / 2.0), 1e-9);
  EXPECT_THAT(quality_.suspicions, IsEmpty());
}

TEST_F(MeasuredLogs, WheelMotors) {
  EXPECT_EQ(read("ateam_wheel_motor", "Model1_pos.csv").rows(), 9338U);
  EXPECT_NEAR(quality_.sampling.usual_period_s, 0.01, 1e-6);
  EXPECT_TRUE(quality_.drive.is_good());
  EXPECT_FALSE(quality_.thermal.is_good());
  EXPECT_EQ(read("ateam_wheel_motor", "Model2_neg.csv").rows(), 7597U);
  EXPECT_NEAR(channel("wheel_modulation_ratio_1").high, 0.089153, 1e-9);
}

TEST_F(MeasuredLogs, EveryFileOfTheOmniRobot) {
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(*measured_data() / "robotino_omni")) {
    if (entry.path().extension() != ".csv") {
      continue;
    }
    const Recording recording = read("robotino_omni", fs::relative(entry.path(), *measured_data() / "robotino_omni").string());
    ++files;
    EXPECT_EQ(recording.rows(), report_.rows_in_file) << entry.path();
    EXPECT_TRUE(quality_.drive.is_good()) << entry.path();
    EXPECT_NEAR(quality_.sampling.usual_period_s, 0.031, 0.002) << entry.path();
    EXPECT_THAT(quality_.suspicions, IsEmpty()) << entry.path();
  }
  EXPECT_GT(files, 200U);
  const Recording heading = read("robotino_omni", "green_surface/exp30.csv");
  EXPECT_EQ(heading.rows(), 584U);
  EXPECT_NEAR(heading.find("wheel_speed_rad_per_s_1")->values[5], 33.9292, 1e-9);
  EXPECT_NEAR(heading.find("wheel_angle_rad_1")->values[5], 378.0 * 6.283185307179586 / 2000.0, 1e-9);
}

}  // namespace
}  // namespace heatsoak::recording
