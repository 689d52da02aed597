#include "base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <stdexcept>
#include <vector>

namespace heatsoak {
namespace {

TEST(InParallel, RunsEveryJobOnceForAnyNumberOfThreads) {
  for (const int threads : {0, 1, 2, 64}) {
    std::vector<int> runs(1000, 0);
    std::vector<std::size_t> told;
    in_parallel(
        runs.size(), threads, 5, 1005,
        [&](std::size_t done, std::size_t total) {
          told.push_back(done);
          EXPECT_EQ(total, 1005U);
        },
        [&](std::size_t i) { ++runs[i]; });
    EXPECT_EQ(runs, std::vector<int>(1000, 1)) << threads;
    ASSERT_EQ(told.size(), 1000U);
    EXPECT_EQ(told.front(), 6U);
    EXPECT_EQ(told.back(), 1005U);
  }
}

TEST(InParallel, ThrowsWhatAJobThrows) {
  std::atomic<int> begun = 0;
  const auto job = [&](std::size_t i) {
    ++begun;
    if (i == 17) {
      throw std::runtime_error("of the seventeenth");
    }
  };
  try {
    in_parallel(1000000, 2, job);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "of the seventeenth");
  }
  EXPECT_LT(begun, 1000000);
}

/// A thread that waits for the jobs of its job must not begin another one, which would wait for its own lock.
TEST(InParallel, JobsMayHoldALockWhileTheirOwnJobsRun) {
  std::mutex mutex;
  std::atomic<int> done = 0;
  in_parallel(200, 0, [&](std::size_t) {
    const std::lock_guard lock(mutex);
    in_parallel(20, 0, [&](std::size_t) { ++done; });
  });
  EXPECT_EQ(done, 4000);
}

}  // namespace
}  // namespace heatsoak
