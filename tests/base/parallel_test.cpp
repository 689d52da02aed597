#include "base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

namespace heatsoak::base {
namespace {

TEST(InParallel, RunsEveryJobOnceForAnyNumberOfThreads) {
  for (const int threads : {0, 1, 2, 64}) {
    std::vector<int> runs(1000, 0);
    std::vector<std::size_t> reported;
    in_parallel(
        runs.size(), threads, 5, 1005,
        [&](std::size_t done, std::size_t total) {
          reported.push_back(done);
          EXPECT_EQ(total, 1005U);
        },
        [&](std::size_t i) { ++runs[i]; });
    EXPECT_EQ(runs, std::vector<int>(1000, 1)) << threads;
    ASSERT_EQ(reported.size(), 1000U);
    EXPECT_EQ(reported.front(), 6U);
    EXPECT_EQ(reported.back(), 1005U);
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

/// A thread that waits for nested jobs must not start an outer job, which would wait for a lock that the thread holds.
TEST(InParallel, JobsMayHoldALockWhileTheirOwnJobsRun) {
  std::mutex mutex;
  std::atomic<int> done = 0;
  in_parallel(200, 0, [&](std::size_t) {
    const std::lock_guard lock(mutex);
    in_parallel(20, 0, [&](std::size_t) { ++done; });
  });
  EXPECT_EQ(done, 4000);
}

/// A caller that continues after its own jobs relies on their results.
TEST(InParallel, AJobThatThrowsDoesNotCutShortTheJobsOfAnother) {
  std::atomic<bool> has_thrown = false;
  std::atomic<bool> is_begun = false;
  std::atomic<int> done = 0;
  std::atomic<int> done_when_it_went_on = -1;
  constexpr int kJobs = 2000;
  const auto job = [&](std::size_t i) {
    if (i == 0) {
      while (!is_begun) {
        std::this_thread::yield();
      }
      has_thrown = true;
      throw std::runtime_error("of another");
    }
    in_parallel(kJobs, 0, [&](std::size_t) {
      is_begun = true;
      while (!has_thrown) {
        std::this_thread::yield();
      }
      std::this_thread::sleep_for(std::chrono::microseconds(20));
      ++done;
    });
    done_when_it_went_on = done.load();
  };
  if (std::thread::hardware_concurrency() < 2) {
    GTEST_SKIP() << "two jobs at a time need two cores";
  }
  EXPECT_THROW(in_parallel(2, 0, job), std::runtime_error);
  EXPECT_EQ(done_when_it_went_on, kJobs);
}

}  // namespace
}  // namespace heatsoak::base
