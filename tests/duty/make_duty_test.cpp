// Tests make_duty(): the table and its duty file must give the same load when they are read back.
#include "duty/make_duty.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "base/diagnostic.h"
#include "support/shipped.h"

namespace heatsoak::duty {
namespace {

/// A folder for a table with its description.
class WrittenDuty : public testing::Test {
 protected:
  WrittenDuty() { std::filesystem::create_directories(folder_); }
  ~WrittenDuty() override { std::filesystem::remove_all(folder_); }

  Duty read_back(const DutyAnswer& answer, const std::string& table) const {
    std::ofstream(folder_ / "load.csv") << table;
    std::ofstream(folder_ / "load.toml") << duty_file(answer, folder_ / "load.csv");
    return read_duty(folder_ / "load.toml");
  }

  std::filesystem::path folder_ = std::filesystem::temp_directory_path() / ("make_duty_" + std::to_string(::getpid()) + "_" +
                                                                            testing::UnitTest::GetInstance()->current_test_info()->name());
};

/// Returns the integral of the squared load: torque or current, whichever the duty states.
double effort(const WheelDemand& wheel, DutyKind kind) {
  double sum = 0.0;
  for (const LoadBin& bin : wheel.bins) {
    const double load = kind == DutyKind::torque ? bin.torque_rms_Nm : bin.current_rms_A;
    sum += bin.duration_s * load * load;
  }
  return sum;
}

TEST_F(WrittenDuty, keeps_duration_and_heat_of_a_prescribed_load) {
  DutyJob job{.robot = twente(), .duty = read_duty(kSource / "duty_profiles/paper_intermittent.toml")};
  std::string table;
  job.put_table = [&table](std::string_view text) { table += text; };
  const DutyAnswer answer = make_duty(job);
  const Duty read = read_back(answer, table);
  const WheelDemand before = job.duty->demand(job.robot, 1).front();
  const WheelDemand after = read.demand(job.robot, 1).front();
  EXPECT_EQ(read.kind, job.duty->kind);
  EXPECT_NEAR(after.duration_s(), before.duration_s(), 1e-6);
  EXPECT_NEAR(std::get<PrescribedLoad>(answer.content).duration_s, before.duration_s(), 1e-9);
  EXPECT_GT(effort(before, read.kind), 0.0);
  EXPECT_NEAR(effort(after, read.kind), effort(before, read.kind), 1e-4 * effort(before, read.kind));
}

TEST_F(WrittenDuty, quotes_texts_of_the_original) {
  DutyJob job{.robot = twente(), .duty = read_duty(kSource / "duty_profiles/paper_intermittent.toml")};
  job.duty->summary = "a \"load\" with a \\ and\na second line";
  std::string table;
  job.put_table = [&table](std::string_view text) { table += text; };
  EXPECT_EQ(read_back(make_duty(job), table).summary, job.duty->summary);
}

TEST(MakeDuty, refuses_seed_and_planner_for_a_prescribed_load) {
  DutyJob job{.robot = twente(), .duty = read_duty(kSource / "duty_profiles/paper_intermittent.toml")};
  job.seed = 1;
  EXPECT_THROW(make_duty(job), base::Failure);
  job.seed.reset();
  job.planner = Planner::bang_bang;
  EXPECT_THROW(make_duty(job), base::Failure);
}

TEST(MakeDuty, plays_the_match_of_its_seed_in_every_role) {
  DutyJob job{.robot = twente(), .duty = read_duty(kSource / "duty_profiles/division_b_match.toml"), .seed = 3};
  const DutyAnswer answer = make_duty(job);
  const auto& match = std::get<GeneratedMatch>(answer.content);
  EXPECT_EQ(match.seed, 3U);
  EXPECT_EQ(match.load.distance_m, match.roles.at(static_cast<std::size_t>(match.role)).distance_m);
}

}  // namespace
}  // namespace heatsoak::duty
