#include "base/delayed_signals.h"

#include <array>
#include <csignal>
#include <utility>

namespace heatsoak::base {
namespace {

constexpr std::array kDelayed{SIGINT, SIGTERM, SIGHUP};
volatile std::sig_atomic_t received = 0;

void remember(int signal) { received = signal; }

}  // namespace

struct DelayedSignals::State {
  std::array<struct sigaction, kDelayed.size()> before{};
  std::sig_atomic_t received_before = 0;
};

DelayedSignals::DelayedSignals() : state_(std::make_unique<State>()) {
  state_->received_before = std::exchange(received, 0);
  struct sigaction action {};
  action.sa_handler = remember;
  action.sa_flags = SA_RESTART;
  for (std::size_t i = 0; i < kDelayed.size(); ++i) {
    sigaction(kDelayed[i], nullptr, &state_->before[i]);
    // A signal that is ignored, as by nohup, stays ignored.
    if (state_->before[i].sa_handler != SIG_IGN) {
      sigaction(kDelayed[i], &action, nullptr);
    }
  }
}

DelayedSignals::~DelayedSignals() {
  for (std::size_t i = 0; i < kDelayed.size(); ++i) {
    sigaction(kDelayed[i], &state_->before[i], nullptr);
  }
  const std::sig_atomic_t last = std::exchange(received, state_->received_before);
  if (last != 0) {
    static_cast<void>(std::raise(last));
  }
}

}  // namespace heatsoak::base
