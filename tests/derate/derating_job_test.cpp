// The answer of `derate`: the text of its file, and the comparison with an earlier table.
#include "derate/derating_job.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "base/diagnostic.h"
#include "base/files.h"
#include "exported_motor.h"

namespace heatsoak::derate {
namespace {

class DeratingJobs : public testing::Test {
 protected:
  ~DeratingJobs() override { std::filesystem::remove(file_); }
  static const ExporterType* form(std::string_view name) { return &*std::ranges::find(all_exporters(), name, &ExporterType::name); }

  std::filesystem::path file_ = std::filesystem::path(testing::TempDir()) / ("derating_job_" + std::to_string(::getpid()) + ".h");
};

// The same motor again must give the same file, which a check of the committed file relies on.
TEST_F(DeratingJobs, repeat_the_table_that_they_wrote) {
  DeratingJob job{.robot = twente(), .motor = ecx_32(), .options = {}};
  job.exporter = form("c_header");
  base::write_file(file_, exported("c_header"));
  job.committed = file_;
  const DeratingAnswer same = run_derating(job);
  EXPECT_EQ(same.text, exported("c_header"));
  ASSERT_TRUE(same.check);
  EXPECT_EQ(same.check->found.excess.difference_A, 0.0);
  EXPECT_EQ(same.check->found.lost.difference_A, 0.0);
  EXPECT_TRUE(same.holds());
  // Beside a much more careful table, the same file allows too much.
  const GuardedMotor careful(ecx_32(), rules_for(ecx_32()), 3.0);
  DeratingAnswer bold = same;
  bold.check->found = compare(bold.check->committed, derating_of(careful));
  EXPECT_GT(bold.check->found.excess.difference_A, 0.5);
  EXPECT_FALSE(bold.holds());
}

// The failure comes before the search, which takes seconds.
TEST_F(DeratingJobs, refuse_a_file_that_is_no_table_before_the_search) {
  DeratingJob job{.robot = twente(), .motor = ecx_32(), .options = {}};
  base::write_file(file_, "int main(void) { return 0; }\n");
  job.committed = file_;
  int reports = 0;
  EXPECT_THROW(run_derating(job, [&reports](std::size_t /*done*/, std::size_t /*total*/) { ++reports; }), base::Failure);
  EXPECT_EQ(reports, 0);
  job.committed = file_.parent_path() / "no_such_file.h";
  EXPECT_THROW(run_derating(job), base::Failure);
}

}  // namespace
}  // namespace heatsoak::derate
