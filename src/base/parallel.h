// Runs independent jobs on several cores.
#pragma once

#include <cstddef>
#include <functional>

namespace heatsoak::base {

/// Called when `done` of `total` units of work are finished.
using Progress = std::function<void(std::size_t done, std::size_t total)>;

/// Runs job(0) … job(count − 1) on `threads` threads; 0 means all cores. The first exception stops the remaining jobs and is rethrown here.
/// A job may hold a lock and call in_parallel() itself.
/// Each finished job calls `progress` with `done` increased by one. The calls come from one thread at a time.
void in_parallel(std::size_t count, int threads, std::size_t done, std::size_t total, const Progress& progress,
                 const std::function<void(std::size_t)>& job);
/// Runs job(0) … job(count − 1) on `threads` threads without progress reports.
inline void in_parallel(std::size_t count, int threads, const std::function<void(std::size_t)>& job) {
  in_parallel(count, threads, 0, count, {}, job);
}

}  // namespace heatsoak::base
