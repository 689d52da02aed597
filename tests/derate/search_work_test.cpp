// Progress of a derating: counted work, so that the tests do not depend on the speed of the machine.
#include "derate/search_work.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "derate/derating.h"
#include "support/shipped.h"

namespace heatsoak::derate {
namespace {

using Report = std::pair<std::size_t, std::size_t>;

TEST(SearchWork, ReportsWorkOfTheExpectedStages) {
  Report last;
  const base::Progress progress = [&last](std::size_t done, std::size_t all) { last = {done, all}; };
  SearchWork work(progress);
  work.expect(SearchWork::factor_of_search, 100);
  work.expect(SearchWork::final_check, 50);
  work.add(30);
  EXPECT_EQ(last, Report(30, 151));
  work.add(100);  // longer than expected
  EXPECT_EQ(last, Report(130, 130 + 13 + 50 + 1));
  work.begin(SearchWork::final_check);
  EXPECT_EQ(last, Report(130, 130 + 50 + 1));
  work.add(50);
  EXPECT_EQ(last, Report(180, 181));
}

TEST(SearchWork, AStageThatEndsEarlyCountsForWhatItDid) {
  Report last;
  const base::Progress progress = [&last](std::size_t done, std::size_t all) { last = {done, all}; };
  SearchWork work(progress);
  work.expect(SearchWork::factor_of_search, 1000);
  work.expect(SearchWork::factor_of_promise, 200);
  work.add(10);
  work.begin(SearchWork::factor_of_promise);
  EXPECT_EQ(last, Report(10, 211));
}

/// Until a tenth is left, the remaining work is foreseen within a factor of two. Fewer samples take less than a second.
TEST(SearchWork, IsForeseenWithinAFactorOfTwo) {
  for (const char* const id : {"maxon_ecx_flat_32l_48v", "nanotec_df45l024048_a2"}) {
    for (const int samples : {400, 1000}) {
      std::vector<Report> reports;
      DerateOptions options;
      options.guarantee.samples = samples;
      static_cast<void>(
          derate(shipped_motor(id), twente(), options, [&reports](std::size_t done, std::size_t all) { reports.emplace_back(done, all); }));
      ASSERT_FALSE(reports.empty());
      const double whole = static_cast<double>(reports.back().first);
      EXPECT_TRUE(std::ranges::is_sorted(reports, {}, &Report::first));
      for (const auto& [done, all] : reports) {
        const double left = whole - static_cast<double>(done);
        if (left > 0.1 * whole) {
          EXPECT_LT(static_cast<double>(all - done), 2.0 * left) << id << ", " << samples << " samples, " << done << " of " << whole;
          EXPECT_GT(static_cast<double>(all - done), 0.5 * left) << id << ", " << samples << " samples, " << done << " of " << whole;
        }
      }
    }
  }
}

}  // namespace
}  // namespace heatsoak::derate
