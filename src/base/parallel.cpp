#include "base/parallel.h"

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <mutex>

namespace heatsoak {

void in_parallel(std::size_t count, int threads, std::size_t done, std::size_t total, const Progress& progress,
                 const std::function<void(std::size_t)>& job) {
  std::mutex mutex;
  const auto work = [&](std::size_t i) {
    job(i);
    if (progress) {
      const std::lock_guard lock(mutex);
      progress(++done, total);
    }
  };
  // A job elsewhere that throws ends jobs beside it, not halves of those that have begun: who waits for their results would go on without.
  tbb::task_group_context own(tbb::task_group_context::isolated);
  const auto all = [&] { tbb::parallel_for(std::size_t{0}, count, work, tbb::simple_partitioner(), own); };
  if (threads > 0) {
    tbb::task_arena(std::min(threads, tbb::info::default_concurrency())).execute(all);
  } else {
    // Or a thread that waits for its part could begin another job of ours while it holds a lock.
    tbb::this_task_arena::isolate(all);
  }
}

}  // namespace heatsoak
