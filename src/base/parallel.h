// Many independent jobs on all cores. Each writes to a place of its own, so that the result does not depend on their number.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace heatsoak {

/// Calls job(i) for every i < count, on `threads` threads (0: all cores); `done` is called after each of them, one at a time.
/// The first exception ends the rest and is thrown here.
template <class Job, class Done>
void in_parallel(std::size_t count, int threads, const Job& job, const Done& done) {
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::exception_ptr error;
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        job(i);
      } catch (...) {
        const std::lock_guard lock(mutex);
        error = error ? error : std::current_exception();
        next = count;
      }
      const std::lock_guard lock(mutex);
      done();
    }
  };
  const std::size_t all = threads > 0 ? static_cast<std::size_t>(threads) : std::max(1U, std::thread::hardware_concurrency());
  {
    std::vector<std::jthread> helpers;
    for (std::size_t i = 1; i < std::min(all, count); ++i) {
      helpers.emplace_back(work);
    }
    work();
  }
  if (error) {
    std::rethrow_exception(error);
  }
}

template <class Job>
void in_parallel(std::size_t count, int threads, const Job& job) {
  in_parallel(count, threads, job, [] {});
}

}  // namespace heatsoak
