// Independent jobs on all cores.
#pragma once

#include <cstddef>
#include <functional>

namespace heatsoak {

/// `done` of `total` units of work are finished.
using Progress = std::function<void(std::size_t done, std::size_t total)>;

/// Runs job(0) … job(count − 1) on `threads` threads, 0: all cores. The first exception ends the rest and is thrown here. A job may
/// run jobs of its own and hold a lock meanwhile.
/// For the progress, which is called from one thread at a time, they are the ones after `done` of `total`.
void in_parallel(std::size_t count, int threads, std::size_t done, std::size_t total, const Progress& progress,
                 const std::function<void(std::size_t)>& job);
/// The same without a word about progress.
inline void in_parallel(std::size_t count, int threads, const std::function<void(std::size_t)>& job) {
  in_parallel(count, threads, 0, count, {}, job);
}

}  // namespace heatsoak
