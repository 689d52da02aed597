// Lets a job remove its temporary files before Ctrl-C ends the program.
#pragma once

#include <memory>

namespace heatsoak::base {

/// Delays SIGINT, SIGTERM and SIGHUP during its lifetime, so that temporary files are removed first. The last one received is raised at the
/// end. Programs that are started meanwhile still receive them.
class DelayedSignals {
 public:
  DelayedSignals();
  DelayedSignals(const DelayedSignals&) = delete;
  DelayedSignals& operator=(const DelayedSignals&) = delete;
  ~DelayedSignals();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace heatsoak::base
