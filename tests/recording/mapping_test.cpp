// Third-party logs with mappings: units, expressions, clocks, filled gaps, and every problem with its place.
#include "recording/mapping.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "base/diagnostic.h"
#include "log_files.h"
#include "recording/read_recording.h"
#include "support/source_folder.h"

namespace heatsoak::recording {
namespace {

using ::testing::AllOf;
using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::NanSensitiveDoubleEq;
using ::testing::Pointwise;

const double kNone = std::numeric_limits<double>::quiet_NaN();

Recording read(const std::string& log, const std::string& mapping, RecordingReport& report) {
  const LogFile file("log.csv", log);
  const auto map = file.add("m.map.toml", mapping);
  return read_recording(file.path(), read_mapping(map, file.path()), report);
}
Recording read(const std::string& log, const std::string& mapping) {
  RecordingReport report;
  return read(log, mapping, report);
}
std::string failure_of(const std::string& log, const std::string& mapping) {
  try {
    read(log, mapping);
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
    return failure.what();
  }
  return "nothing";
}
std::vector<double> values(const Recording& recording, const char* key) {
  const Channel* channel = recording.find(key);
  return channel == nullptr ? std::vector<double>{} : channel->values;
}

TEST(Mapping, ConvertsUnitsAndSigns) {
  const Recording recording =
      read("ms,F,mA,rpm,deg\n0,77,1500,60,180\n500,212,-250,-30,90\n",
           "[quantities]\ntime_s = { column = \"ms\", unit = \"ms\" }\nwinding_C = { column = \"F\", unit = \"degF\" }\n"
           "current_A = { column = \"mA\", unit = \"mA\", sign = \"-\" }\nspeed_rad_per_s = { column = \"rpm\", unit = \"rpm\" }\n"
           "yaw_rad = { column = \"deg\", unit = \"deg\" }\n");
  EXPECT_THAT(recording.time_s, ElementsAre(0.0, DoubleNear(0.5, 1e-12)));
  EXPECT_THAT(values(recording, "winding_C"), ElementsAre(DoubleNear(25.0, 1e-9), DoubleNear(100.0, 1e-9)));
  EXPECT_THAT(values(recording, "current_A"), ElementsAre(DoubleNear(-1.5, 1e-12), DoubleNear(0.25, 1e-12)));
  EXPECT_THAT(values(recording, "speed_rad_per_s"), ElementsAre(DoubleNear(6.283185307179586, 1e-9), DoubleNear(-3.141592653589793, 1e-9)));
  EXPECT_THAT(values(recording, "yaw_rad"), ElementsAre(DoubleNear(3.141592653589793, 1e-9), DoubleNear(1.570796326794897, 1e-9)));
}

TEST(Mapping, ExpressionsOfColumnsWithAnyName) {
  const Recording recording = read("t,i d [A],i q [A],T\n0,3,4,20\n1,0,-5,21\n2,,1,22\n",
                                   "[quantities]\ntime_s = { column = \"t\" }\n"
                                   "current_A = { expression = \"where('i q [A]' < 0, -1, 1) * sqrt('i d [A]'^2 + 'i q [A]'^2)\" }\n"
                                   "winding_C = { expression = \"max(T - 0.5, min(20, 30))\" }\n");
  EXPECT_THAT(values(recording, "current_A"), Pointwise(NanSensitiveDoubleEq(), {5.0, -5.0, kNone}));
  EXPECT_THAT(values(recording, "winding_C"), ElementsAre(20.0, 20.5, 21.5));
}

TEST(Mapping, BlankIsUnknownUnlessTheMappingFillsIt) {
  RecordingReport report;
  const Recording recording =
      read("t,P,duty\n0,5,1\n1,,0\n2,,1\n3,,\n",
           "[quantities]\ntime_s = { column = \"t\" }\npower_in_W = { column = \"P\", fill = [{ value = \"0 W\", where = "
           "\"duty == 0\" }] }\n",
           report);
  EXPECT_THAT(values(recording, "power_in_W"), Pointwise(NanSensitiveDoubleEq(), {5.0, 0.0, kNone, kNone}));
  ASSERT_NE(report.find("power_in_W", LeftOutReason::not_recorded), nullptr);
  EXPECT_EQ(report.find("power_in_W", LeftOutReason::not_recorded)->count, 2U);
  EXPECT_EQ(report.find("power_in_W", LeftOutReason::not_recorded)->lines.front().first, 4);
  EXPECT_THAT(report.notes, ElementsAre(testing::VariantWith<BlanksFilled>(
                                AllOf(Field(&BlanksFilled::channel, "power_in_W"), Field(&BlanksFilled::samples, 1U)))));
}

TEST(Mapping, RowsAndSamplesThatCount) {
  RecordingReport report;
  const Recording recording =
      read("t,T,rpm,mode,run\n0,20,0,1,7\n1,21,50,1,7\n2,99,60,0,7\n3,23,70,1,8\n4,150,80,1,8\n",
           "[rows]\nvalid = \"mode == 1\"\n[runs]\ncolumn = \"run\"\nlongest_gap = \"5 s\"\n[quantities]\ntime_s = { column = "
           "\"t\" }\nwinding_C = { column = \"T\", saturates_high = \"150 degC\" }\nspeed_rad_per_s = { column = \"rpm\", valid = \"rpm > "
           "0\" }\n",
           report);
  EXPECT_THAT(recording.line, ElementsAre(2, 3, 5, 6));
  EXPECT_THAT(recording.run_begins, ElementsAre(0U, 2U));
  EXPECT_THAT(values(recording, "winding_C"), Pointwise(NanSensitiveDoubleEq(), {20.0, 21.0, 23.0, kNone}));
  EXPECT_THAT(values(recording, "speed_rad_per_s"), Pointwise(NanSensitiveDoubleEq(), {kNone, 50.0, 70.0, 80.0}));
  EXPECT_EQ(report.find("", LeftOutReason::not_valid)->lines.front().first, 4);
  EXPECT_EQ(report.find("winding_C", LeftOutReason::saturated)->count, 1U);
}

TEST(Mapping, SeparatorsDecimalCommaHeaderRowsAndComments) {
  const Recording recording =
      read("\xEF\xBB\xBF; made by a bench\r\nTime;Temp\r\ns;degC\r\nt;T\r\n0,5;20,25\r\n; pause\r\n1,5;\"21,5\"\r\n\r\n",
           "[file]\nseparator = \";\"\ndecimal = \",\"\ncomment = \"; \"\nheader_rows = \"3\"\nnames_row = \"3\"\n"
           "[quantities]\ntime_s = { column = \"t\" }\nstator_C = { column = \"T\" }\n");
  EXPECT_THAT(recording.time_s, ElementsAre(0.5, 1.5));
  EXPECT_THAT(values(recording, "stator_C"), ElementsAre(20.25, 21.5));
  EXPECT_THAT(recording.line, ElementsAre(5, 7));
}

/// A current that changes linearly from a to b has the mean square (a² + ab + b²)/3; a power has the mean (a + b)/2.
TEST(Mapping, HabitsOfLoggersBecomeIntervals) {
  const std::string log = "t,I,P,T\n0,0,0,20\n1,3,4,21\n2,3,8,22\n";
  const std::string quantities =
      "[quantities]\ntime_s = { column = \"t\" }\ncurrent_A = { column = \"I\" }\npower_in_W = { column = \"P\" }\nwinding_C = { column = "
      "\"T\" }\n";
  const Recording linear = read(log, "inputs = \"linear\"\n" + quantities);
  EXPECT_THAT(values(linear, "current_A"), Pointwise(NanSensitiveDoubleEq(), {std::sqrt(3.0), 3.0, kNone}));
  EXPECT_THAT(values(linear, "power_in_W"), Pointwise(NanSensitiveDoubleEq(), {2.0, 6.0, kNone}));
  EXPECT_THAT(values(linear, "winding_C"), ElementsAre(20.0, 21.0, 22.0));
  const Recording previous = read(log, "inputs = \"previous_interval\"\n" + quantities);
  EXPECT_THAT(values(previous, "power_in_W"), Pointwise(NanSensitiveDoubleEq(), {4.0, 8.0, kNone}));
}

/// A held input moved by a quarter of a period keeps its energy. A linear temperature stays on its line.
TEST(Mapping, ClockOffsetMovesAChannel) {
  const Recording recording =
      read("t,P,T\n0,8,20\n1,0,22\n2,4,24\n3,4,26\n",
           "[quantities]\ntime_s = { column = \"t\" }\npower_in_W = { column = \"P\", clock_offset = \"0.25 s\" }\nwinding_C = { column "
           "= \"T\", clock_offset = \"-0.5 s\" }\n");
  EXPECT_THAT(values(recording, "power_in_W"), Pointwise(NanSensitiveDoubleEq(), {kNone, 2.0, 3.0, kNone}));
  EXPECT_THAT(values(recording, "winding_C"), Pointwise(NanSensitiveDoubleEq(), {21.0, 23.0, 25.0, kNone}));
}

TEST(Mapping, FilesNameTheirMotorAndConditions) {
  const LogFile file("run4.csv", "t,T\n0,20\n1,21\n");
  const auto map =
      file.add("m.toml",
               "motor = \"a\"\napplies_to = [\"run?.csv\"]\n[conditions]\nfan = \"off\"\n[[files]]\nname = \"run4*\"\nconditions = { fan = "
               "\"on\" }\n[quantities]\ntime_s = { column = \"t\" }\nwinding_C = { column = \"T\" }\n");
  EXPECT_EQ(read_mapping(map, file.path()).conditions.at("fan"), "on");
  EXPECT_EQ(read_mapping(map, "run5.csv").conditions.at("fan"), "off");
  EXPECT_EQ(read_mapping(map, "run5.csv").motor, "a");
  EXPECT_THROW(read_mapping(map, "other.csv"), base::Failure);
}

TEST(Mapping, two_files_of_one_name_may_not_contradict_each_other) {
  EXPECT_THAT(failure_of("time_s,winding_C\n0,25\n", R"(
[[files]]
name = "*.csv"
conditions = { fan = "on" }
[[files]]
name = "*.csv"
conditions = { fan = "off" }
[quantities]
time_s = { column = "time_s" }
winding_C = { column = "winding_C" }
)"),
              HasSubstr("contradicts \"on\", which another [[files]] states for *.csv"));
}

TEST(Mapping, IsFoundBesideTheLog) {
  const LogFile file("run.csv", "t,T\n0,20\n");
  EXPECT_TRUE(mapping_for(file.path(), "").is_canonical());
  const auto map = file.add("run.map.toml", "[quantities]\ntime_s = { column = \"t\" }\nwinding_C = { column = \"T\" }\n");
  EXPECT_EQ(mapping_for(file.path(), "").file, map);
}

/// The example of the documentation must be valid.
TEST(Mapping, ExampleOfTheReadme) {
  std::ifstream file(kSource / "docs/file_formats.md");
  const std::string readme{std::istreambuf_iterator<char>(file), {}};
  const std::size_t begin = readme.find("motor = \"ri50\"");
  ASSERT_NE(begin, std::string::npos);
  const LogFile log("bench7.csv",
                    "t;motor temp [F];i_d;i_q;rpm;duty;P;mode;run\nms;F;A;A;;;W;;\n;;;;;;;;\n0;77;0;-2;60;1;;3;1\n100;77;0;2;60;0;;3;1\n"
                    "200;77;0;2;60;0;;2;1\n300;77;0;2;60;0;5;3;2\n");
  const auto map = log.add("m.toml", readme.substr(begin, readme.find("```", begin) - begin));
  RecordingReport report;
  const Mapping mapping = read_mapping(map, log.path());
  const Recording recording = read_recording(log.path(), mapping, report);
  EXPECT_EQ(recording.conditions.at("fan"), "on");
  EXPECT_THAT(recording.line, ElementsAre(4, 5, 7));
  EXPECT_THAT(recording.run_begins, ElementsAre(0U, 2U));
  EXPECT_THAT(values(recording, "winding_C"), ElementsAre(DoubleNear(25.0, 1e-9), DoubleNear(25.0, 1e-9), DoubleNear(25.0, 1e-9)));
  EXPECT_THAT(values(recording, "power_in_W"), Pointwise(NanSensitiveDoubleEq(), {kNone, 0.0, 5.0}));
}

TEST(Mapping, EveryProblemWithItsPlace) {
  const std::string all = failure_of(
      "t,T\n0,20\n",
      "inputs = \"hold\"\n[quantities]\ntime_s = { column = \"t\", unit = \"m\" }\nwindng_C = { column = \"T\", colum = \"x\" }\n"
      "stator_C = { column = \"T\", expression = \"T\" }\nambient = { column = \"T\" }\n"
      "winding_C = { column = \"T\", sign = \"-\" }\n");
  EXPECT_THAT(all, AllOf(HasSubstr("m.map.toml:1:10: error: inputs: 'hold' is not known"), HasSubstr("did you mean 'held'?"),
                         HasSubstr(":3:"), HasSubstr("'m' is not a unit of time_s")));
  EXPECT_THAT(all, AllOf(HasSubstr("m.map.toml:4:"), HasSubstr("colum: is not a key of this table; did you mean 'column'?"),
                         HasSubstr("stator_C: expected one of column"), HasSubstr("ambient: is not a quantity"),
                         HasSubstr("did you mean 'ambient_C'?"), HasSubstr("a temperature has no sign")));
}

TEST(Mapping, OneCauseHasOneMessage) {
  const std::string of_unit =
      failure_of("t,T\n0,20\n",
                 "[quantities]\ntime_s = { column = \"t\" }\nbus_V = { column = \"T\", unit = \"xyz\", sign = \"-\", saturates_low = \"3 "
                 "xyz\", saturates_high = \"3 xyz\", fill = [{ value = \"3 xyz\", where = \"T > 3\" }] }\n");
  EXPECT_THAT(of_unit, HasSubstr("'xyz' is not a unit of bus_V"));
  EXPECT_EQ(std::ranges::count(of_unit, '\n'), 0) << of_unit;
  const std::string of_name = failure_of("t,T\n0,20\n", "[quantities]\ntime = { column = \"t\" }\nwinding_C = { column = \"T\" }\n");
  EXPECT_THAT(of_name, HasSubstr("quantities.time: is not a quantity"));
  EXPECT_EQ(std::ranges::count(of_name, '\n'), 0) << of_name;
}

TEST(Mapping, ColumnsAndExpressionsAreCheckedAgainstTheLog) {
  const std::string all = failure_of("time,Temp,power\n0,20,1\n",
                                     "[quantities]\ntime_s = { column = \"tme\" }\nwinding_C = { expression = \"Temp + offset\" }\n"
                                     "power_in_W = { expression = \"squrt(power)\" }\ncurrent_A = { expression = \"power = 3\" }\n"
                                     "bus_V = { expression = \"(power + 1\" }\n");
  EXPECT_THAT(all,
              AllOf(HasSubstr("m.map.toml:2:21: error: quantities.time_s.column:"), HasSubstr("no column 'tme'; did you mean 'time'?")));
  EXPECT_THAT(all,
              AllOf(HasSubstr("m.map.toml:3:36: error: quantities.winding_C.expression:"), HasSubstr("the log has no column 'offset'")));
  EXPECT_THAT(all, AllOf(HasSubstr("there is no function 'squrt'; did you mean 'sqrt'?"), HasSubstr("write == to compare"),
                         HasSubstr("quantities.bus_V.expression: \"(power + 1\" is not a valid expression")));
}

}  // namespace
}  // namespace heatsoak::recording
