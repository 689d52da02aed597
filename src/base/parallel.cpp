#include "base/parallel.h"

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <mutex>

namespace heatsoak::base {
namespace {

/// Counts the jobs that this thread runs at present, one inside the other.
class RunningJob {
 public:
  RunningJob() { ++count_; }
  ~RunningJob() { --count_; }
  RunningJob(const RunningJob&) = delete;
  RunningJob& operator=(const RunningJob&) = delete;

  static bool is_inside() { return count_ > 0; }

 private:
  static thread_local int count_;
};
thread_local int RunningJob::count_ = 0;

}  // namespace

void in_parallel(std::size_t count, int threads, std::size_t done, std::size_t total, const Progress& progress,
                 const std::function<void(std::size_t)>& job) {
  std::mutex mutex;
  const auto work = [&](std::size_t i) {
    const RunningJob running;
    job(i);
    if (progress) {
      const std::lock_guard lock(mutex);
      progress(++done, total);
    }
  };
  // By default an exception in an enclosing parallel loop would also cancel this one, which would then return with jobs not done.
  tbb::task_group_context own(tbb::task_group_context::isolated);
  const auto all = [&] { tbb::parallel_for(std::size_t{0}, count, work, tbb::simple_partitioner(), own); };
  if (threads > 0) {
    tbb::task_arena(std::min(threads, tbb::info::default_concurrency())).execute(all);
  } else if (RunningJob::is_inside()) {
    // Without isolation a waiting thread could start another of our jobs while it holds a lock, and deadlock.
    tbb::this_task_arena::isolate(all);
  } else {
    all();  // a thread that has finished its outer jobs helps with the loops inside of the others
  }
}

}  // namespace heatsoak::base
