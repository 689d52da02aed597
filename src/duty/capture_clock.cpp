#include "duty/capture_clock.h"

#include <cmath>

namespace heatsoak::duty {
namespace {

constexpr double kLatest_s = 1e11;
constexpr double kLongestPause_s = 3600.0;
constexpr double kFollow = 0.01;
constexpr std::size_t kMostCameras = 64;

}  // namespace

/// Returns the time of reception. A log without such times gets them from the times of capture, where steps back and long pauses count as
/// zero.
double CaptureClock::reception_s(double capture_s, std::int64_t received_ns) {
  if (received_ns > 0) {
    return static_cast<double>(received_ns) * 1e-9;
  }
  const double step_s = capture_s - last_capture_s_;
  reception_s_ = !start_s_ ? capture_s : reception_s_ + (step_s > 0.0 && step_s < kLongestPause_s ? step_s : 0.0);
  last_capture_s_ = capture_s;
  return reception_s_;
}

std::optional<CaptureClock::Reading> CaptureClock::read(int camera, double capture_s, std::int64_t received_ns) {
  if (!std::isfinite(capture_s) || std::abs(capture_s) > kLatest_s || (cameras_.size() >= kMostCameras && !cameras_.contains(camera))) {
    return std::nullopt;
  }
  if (capture_s <= 0.0) {
    capture_s = static_cast<double>(received_ns) * 1e-9;
  }
  const double ahead_s = capture_s - reception_s(capture_s, received_ns);
  if (!start_s_) {
    start_s_ = capture_s;
    first_ahead_s_ = ahead_s;
  }
  const auto [found, is_new] = cameras_.try_emplace(camera);
  Camera& clock = found->second;
  if (is_new) {
    clock.ahead_s = ahead_s;
    clock.shift_s = std::abs(ahead_s - first_ahead_s_) > kTolerance_s ? first_ahead_s_ - ahead_s : 0.0;
  }
  Reading reading;
  const double off_s = ahead_s - clock.ahead_s;
  if (std::abs(off_s) <= kTolerance_s) {
    clock.ahead_s += kFollow * off_s;
    clock.pending = 0;
  } else {
    clock.pending = clock.pending > 0 && std::abs(ahead_s - clock.pending_s) <= kTolerance_s ? clock.pending + 1 : 1;
    clock.pending_s = ahead_s;
    if (clock.pending < kConfirmed) {
      return std::nullopt;
    }
    clock.shift_s -= ahead_s - clock.ahead_s;
    clock.ahead_s = ahead_s;
    clock.pending = 0;
    reading.jumped = true;
  }
  reading.time_s = capture_s + clock.shift_s - *start_s_;
  return reading;
}

}  // namespace heatsoak::duty
