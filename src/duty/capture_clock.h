// Converts times of capture to a common time base, across jumps of the capture clocks.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

namespace heatsoak::duty {

/// A frame has a time of capture (exact, but its clock may be reset) and a time of reception (late and uneven, but of one clock). If the
/// difference of both changes by more than kTolerance_s in kConfirmed consecutive frames, the clock of that camera has jumped. Later
/// capture times are then shifted to match the reception again.
class CaptureClock {
 public:
  struct Reading {
    double time_s = 0.0;  ///< time since the first frame
    bool jumped = false;  ///< true if the clock jumped: earlier frames are not continuous with this one
  };
  /// Returns the time of a frame; nothing if its time of capture is not credible.
  std::optional<Reading> read(int camera, double capture_s, std::int64_t received_ns);
  /// Returns the Unix time of the first frame; nothing before it.
  [[nodiscard]] std::optional<double> start_unix_s() const { return start_s_; }

  static constexpr double kTolerance_s = 0.5;
  static constexpr int kConfirmed = 10;  ///< number of consecutive frames that confirm a jump

 private:
  struct Camera {
    double ahead_s = 0.0;    ///< capture minus reception, slowly filtered
    double shift_s = 0.0;    ///< correction of the capture time
    double pending_s = 0.0;  ///< ahead_s of an unconfirmed jump
    int pending = 0;         ///< frames that agree on the unconfirmed jump
  };
  double reception_s(double capture_s, std::int64_t received_ns);

  std::map<int, Camera> cameras_;
  std::optional<double> start_s_;
  double first_ahead_s_ = 0.0;
  double reception_s_ = 0.0;  // substitute for missing reception times: capture time without its jumps
  double last_capture_s_ = 0.0;
};

}  // namespace heatsoak::duty
