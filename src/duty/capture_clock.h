// Times of capture, followed over jumps of the clocks that stamped them.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

namespace heatsoak::duty {

/// Frames carry the time of capture (exact, but its clock may be set anew) and a time of reception (late and
/// uneven, but of one clock). Where the two part by more than kTolerance_s, and frames agree on it, the clock of
/// that camera has jumped, and its times are shifted back into line with the reception.
class CaptureClock {
 public:
  struct Reading {
    double time_s = 0.0;  ///< since the first frame
    bool jumped = false;  ///< nothing before this frame connects to it
  };
  /// Nothing where the time of capture is not to be trusted.
  std::optional<Reading> read(int camera, double capture_s, std::int64_t received_ns);
  /// Unix time of the first frame.
  [[nodiscard]] double start_unix_s() const { return start_s_.value_or(0.0); }

  static constexpr double kTolerance_s = 0.5;
  static constexpr int kConfirmed = 10;  ///< so many frames in a row make a jump

 private:
  struct Camera {
    double ahead_s = 0.0;  ///< capture before reception, negative; slowly followed
    double shift_s = 0.0;
    double pending_s = 0.0;
    int pending = 0;
  };
  double reception_s(double capture_s, std::int64_t received_ns);

  std::map<int, Camera> cameras_;
  std::optional<double> start_s_;
  double first_ahead_s_ = 0.0;
  double reception_s_ = 0.0;  // without a time of reception: capture, less its jumps
  double last_capture_s_ = 0.0;
};

}  // namespace heatsoak::duty
