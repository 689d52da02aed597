#include "duty/duty.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <numeric>

namespace heatsoak::duty {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

class DutyTest : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  void write(const std::string& name, const std::string& content) { std::ofstream(folder_ / name, std::ios::binary) << content; }
  Duty read(const std::string& shape, const std::string& lines) {
    write("mine.toml", "summary = \"a test\"\norigin = \"made up\"\nshape = \"" + shape +
                           "\"\nambient = { value = \"25 degC\", origin = \"estimated\", derivation = \"made up\" }\n[" + shape + "]\n" +
                           lines);
    return read_duty(folder_ / "mine.toml");
  }
  std::string problem(const std::string& shape, const std::string& lines) {
    try {
      read(shape, lines);
    } catch (const base::Failure& failure) {
      return failure.what();
    }
    return "";
  }

  std::filesystem::path folder_ = std::filesystem::temp_directory_path() / ("heatsoak_duty_" + std::to_string(::getpid()));
};

/// Returns the only wheel of a duty that does not distinguish wheels.
WheelDemand wheel_of(const Duty& duty) { return duty.demand({}, 1).at(0); }

double time_on_s(const Duty& duty) {
  double sum_s = 0.0;
  for (const LoadBin& bin : wheel_of(duty).bins) {
    sum_s += bin.torque_rms_Nm != 0.0 || bin.current_rms_A != 0.0 ? bin.duration_s : 0.0;
  }
  return sum_s;
}

TEST_F(DutyTest, intermittent_sums_to_its_cycles) {
  const Duty duty = read("intermittent",
                         "torque_on = { value = \"120 mN m\", origin = \"estimated\", derivation = \"x\" }\n"
                         "speed_on = \"600 rpm\"\ntime_on = \"4 s\"\ntime_off = \"0.1 min\"\nrepeats = \"240\"\n");
  EXPECT_EQ(duty.id, "mine");
  EXPECT_EQ(duty.kind, DutyKind::torque);
  EXPECT_THAT(wheel_of(duty).bins, SizeIs(480));
  EXPECT_NEAR(wheel_of(duty).duration_s(), 2400.0, 1e-9);
  EXPECT_NEAR(time_on_s(duty), 960.0, 1e-9);
  EXPECT_DOUBLE_EQ(wheel_of(duty).bins.at(0).torque_mean_Nm, 0.12);
  EXPECT_NEAR(wheel_of(duty).bins.at(0).velocity_mean_rad_per_s, 62.83185307, 1e-6);
  EXPECT_EQ(wheel_of(duty).bins.at(0).current_rms_A, 0.0);
  EXPECT_EQ(wheel_of(duty).bins.at(1).torque_mean_Nm, 0.0);
  EXPECT_EQ(wheel_of(duty).bins.at(1).velocity_mean_rad_per_s, 0.0);
  EXPECT_DOUBLE_EQ(duty.load.value, 1.0);
  EXPECT_FALSE(duty.load.spread);
}

TEST_F(DutyTest, intermittent_without_a_pause_has_no_pieces_of_no_length) {
  const Duty duty = read("intermittent",
                         "current_on = { value = \"3 A\", origin = \"estimated\", derivation = \"x\" }\n"
                         "speed_on = \"0 rpm\"\ntime_on = \"4 s\"\ntime_off = \"0 s\"\nrepeats = \"5\"\n");
  EXPECT_EQ(duty.kind, DutyKind::current);
  EXPECT_THAT(wheel_of(duty).bins, SizeIs(5));
  EXPECT_DOUBLE_EQ(wheel_of(duty).bins.at(0).current_rms_A, 3.0);
  EXPECT_DOUBLE_EQ(wheel_of(duty).duration_s(), 20.0);
}

TEST_F(DutyTest, the_spread_of_the_demand_becomes_a_factor) {
  const std::string rest = "speed_on = \"0 rpm\"\ntime_on = \"4 s\"\ntime_off = \"6 s\"\nrepeats = \"2\"\n";
  const Duty range = read(
      "intermittent",
      "torque_on = { value = \"100 mN m\", origin = \"estimated\", derivation = \"x\", range = [\"50 mN m\", \"0.13 N m\"] }\n" + rest);
  ASSERT_TRUE(range.load.spread);
  EXPECT_DOUBLE_EQ(range.load.value, 1.0);
  EXPECT_DOUBLE_EQ(range.load.spread->low, 0.5);
  EXPECT_DOUBLE_EQ(range.load.spread->high, 1.3);
  EXPECT_NEAR(range.load.quantile(0.5), 1.0, 1e-12);
  EXPECT_NEAR(range.load.quantile(1e-12), 0.5, 1e-6);
  EXPECT_NEAR(range.load.quantile(1.0 - 1e-12), 1.3, 1e-6);
  const Duty tolerance =
      read("intermittent", "current_on = { value = \"2 A\", origin = \"estimated\", derivation = \"x\", tolerance = \"20 %\" }\n" + rest);
  ASSERT_TRUE(tolerance.load.spread);
  EXPECT_NEAR(tolerance.load.spread->low, 0.8, 1e-12);
  EXPECT_NEAR(tolerance.load.spread->high, 1.2, 1e-12);
}

TEST_F(DutyTest, a_recorded_row_holds_until_the_next) {
  write("log.csv", "speed_rad_per_s,time_s,torque_Nm,note\n10,5,0.1,a\n-20,7,-0.2,b\n30,7.5,0.3,c\n99,10,9,only the end\n");
  const Duty duty = read("recorded", "file = \"log.csv\"\nquantity = \"torque\"\n");
  ASSERT_THAT(wheel_of(duty).bins, SizeIs(3));
  EXPECT_DOUBLE_EQ(wheel_of(duty).bins.at(0).duration_s, 2.0);
  EXPECT_DOUBLE_EQ(wheel_of(duty).bins.at(1).duration_s, 0.5);
  EXPECT_DOUBLE_EQ(wheel_of(duty).bins.at(2).duration_s, 2.5);
  EXPECT_DOUBLE_EQ(wheel_of(duty).bins.at(1).torque_mean_Nm, -0.2);
  EXPECT_DOUBLE_EQ(wheel_of(duty).bins.at(1).velocity_mean_rad_per_s, -20.0);
  EXPECT_DOUBLE_EQ(wheel_of(duty).bins.at(2).torque_mean_Nm, 0.3);
  EXPECT_DOUBLE_EQ(wheel_of(duty).duration_s(), 5.0);
}

TEST_F(DutyTest, a_recording_of_several_wheels_has_all_up_to_the_last) {
  write("log.csv", "time_s,speed_2_rad_per_s,\"torque_2_Nm\",torque_1_Nm,speed_1_rad_per_s\n0,4,3,1,2\n1,8,7,5,6\n2,0,0,0,0\n");
  const std::vector<WheelDemand> wheels = read("recorded", "file = \"log.csv\"\nquantity = \"torque\"\n").demand({}, 1);
  ASSERT_THAT(wheels, SizeIs(2));
  EXPECT_DOUBLE_EQ(wheels[0].bins.at(1).torque_mean_Nm, 5.0);
  EXPECT_DOUBLE_EQ(wheels[1].bins.at(0).torque_mean_Nm, 3.0);
  EXPECT_DOUBLE_EQ(wheels[1].bins.at(1).velocity_mean_rad_per_s, 8.0);
  write("log.csv", "time_s,torque_1_Nm,speed_1_rad_per_s,torque_3_Nm,speed_3_rad_per_s\n0,1,1,1,1\n1,0,0,0,0\n");
  const std::string said = problem("recorded", "file = \"log.csv\"\nquantity = \"torque\"\n");
  EXPECT_THAT(said, HasSubstr("torque_2_Nm: there is no such column"));
  EXPECT_THAT(said, HasSubstr("speed_2_rad_per_s: there is no such column"));
}

TEST_F(DutyTest, a_recording_of_current_is_repeated_whole) {
  write("log.csv", "time_s,current_A,speed_rad_per_s\n0,1,10\n2,3,20\n3,0,0\n");
  const Duty duty = read("recorded", "file = \"log.csv\"\nquantity = \"current\"\nrepeats = \"3\"\n");
  EXPECT_EQ(duty.kind, DutyKind::current);
  ASSERT_THAT(wheel_of(duty).bins, SizeIs(6));
  EXPECT_DOUBLE_EQ(wheel_of(duty).duration_s(), 9.0);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_DOUBLE_EQ(wheel_of(duty).bins.at(i).current_rms_A, i % 2 == 0 ? 1.0 : 3.0);
    EXPECT_DOUBLE_EQ(wheel_of(duty).bins.at(i).duration_s, i % 2 == 0 ? 2.0 : 1.0);
  }
}

/// Rows of 10 ms of two sines, as text and as the integrals that determine the heat.
struct ShortRows {
  std::string text;
  double square_s = 0.0;  ///< ∫M²dt, or ∫I²dt
  double along_s = 0.0;   ///< ∫M·sign ω dt
  double power_s = 0.0;   ///< ∫M·ω dt
  double duration_s = 0.0;
};
ShortRows short_rows(const std::string& header) {
  ShortRows rows{header + "\n"};
  for (int i = 0; i <= 6000; ++i) {
    const double load = 0.25 * std::sin(0.037 * i);
    const double speed_rad_per_s = 40.0 * std::sin(0.011 * i + 1.0);
    rows.text += fmt::format("{:.10g},{:.17g},{:.17g}\n", 0.01 * i, load, speed_rad_per_s);
    if (i < 6000) {
      const double direction = std::abs(speed_rad_per_s) < kStandstill_rad_per_s ? 0.0 : std::copysign(1.0, speed_rad_per_s);
      rows.square_s += 0.01 * load * load;
      rows.along_s += 0.01 * load * direction;
      rows.power_s += 0.01 * load * speed_rad_per_s;
      rows.duration_s += 0.01;
    }
  }
  return rows;
}

double integral(const WheelDemand& wheel, double (*of)(const LoadBin&)) {
  return std::accumulate(wheel.bins.begin(), wheel.bins.end(), 0.0,
                         [of](double sum, const LoadBin& bin) { return sum + of(bin) * bin.duration_s; });
}

TEST_F(DutyTest, short_rows_are_merged_and_keep_their_heat) {
  const ShortRows rows = short_rows("time_s,torque_Nm,speed_rad_per_s");
  write("log.csv", rows.text);
  const WheelDemand wheel = wheel_of(read("recorded", "file = \"log.csv\"\nquantity = \"torque\"\n"));
  EXPECT_THAT(wheel.bins, SizeIs(600));
  EXPECT_LT(wheel.points.size(), 3000U);
  EXPECT_NEAR(wheel.duration_s(), rows.duration_s, 1e-9);
  EXPECT_NEAR(integral(wheel, [](const LoadBin& bin) { return bin.torque_rms_Nm * bin.torque_rms_Nm; }), rows.square_s, 1e-12);
  EXPECT_NEAR(integral(wheel, [](const LoadBin& bin) { return bin.torque_along_motion_Nm; }), rows.along_s, 1e-12);
  EXPECT_NEAR(integral(wheel, [](const LoadBin& bin) { return bin.power_mean_W; }), rows.power_s, 1e-9);
}

TEST_F(DutyTest, short_rows_of_current_keep_their_heat_and_their_largest_current) {
  const ShortRows rows = short_rows("time_s,current_A,speed_rad_per_s");
  write("log.csv", rows.text);
  const WheelDemand wheel = wheel_of(read("recorded", "file = \"log.csv\"\nquantity = \"current\"\nrepeats = \"2\"\n"));
  EXPECT_THAT(wheel.bins, SizeIs(1200));
  EXPECT_NEAR(integral(wheel, [](const LoadBin& bin) { return bin.current_rms_A * bin.current_rms_A; }), 2.0 * rows.square_s, 1e-12);
  double largest_A = 0.0;
  double time_s = 0.0;
  for (const LoadPoint& each : wheel.points) {
    EXPECT_EQ(each.torque_Nm, 0.0);
    largest_A = std::max(largest_A, each.current_A);
    time_s += each.time_s;
  }
  EXPECT_GE(largest_A, 0.2499);
  EXPECT_LE(largest_A, 0.27);
  EXPECT_NEAR(time_s, 120.0, 1e-6);
}

TEST_F(DutyTest, a_long_row_among_short_ones_stays_what_it_is) {
  write("log.csv", "time_s,torque_Nm,speed_rad_per_s\n0,0.1,10\n0.05,0.3,10\n0.1,-0.2,30\n5.1,0.4,10\n5.2,0,0\n");
  const WheelDemand wheel = wheel_of(read("recorded", "file = \"log.csv\"\nquantity = \"torque\"\n"));
  ASSERT_THAT(wheel.bins, SizeIs(3));
  EXPECT_NEAR(wheel.bins.at(0).torque_rms_Nm, std::sqrt(0.05), 1e-12);
  EXPECT_DOUBLE_EQ(wheel.bins.at(1).torque_mean_Nm, -0.2);
  EXPECT_NEAR(wheel.bins.at(1).duration_s, 5.0, 1e-12);
  EXPECT_NEAR(wheel.bins.at(2).duration_s, 0.1, 1e-12);
}

TEST_F(DutyTest, problems_of_the_log_have_their_place_in_the_log) {
  write("log.csv", "time_s,current_A,speed_rad_per_s\n0,1,10\n2,x,20\n1,0,0\n");
  const std::string said = problem("recorded", "file = \"log.csv\"\nquantity = \"current\"\nrepeats = \"1.5\"\n");
  EXPECT_THAT(said, HasSubstr((folder_ / "log.csv").string() + ":3:3: error: current_A: \"x\""));
  EXPECT_THAT(said, HasSubstr((folder_ / "mine.toml").string() + ":8:11: error: recorded.repeats: is not a whole number"));
}

TEST_F(DutyTest, a_recording_too_long_for_the_memory_is_refused) {
  std::string content = "time_s,current_A,speed_rad_per_s\n";
  for (int i = 0; i <= 1000; ++i) {
    content += std::to_string(i) + ",1,10\n";
  }
  write("log.csv", content);
  EXPECT_THAT(problem("recorded", "file = \"log.csv\"\nquantity = \"current\"\nrepeats = \"10000\"\n"),
              HasSubstr("recorded.repeats: makes more than"));
}

}  // namespace
}  // namespace heatsoak::duty
