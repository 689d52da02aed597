// How far the table can be trusted: motors drawn from every declared tolerance, driven with all the current that it allows.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "derate/current_table.h"
#include "derate/held_current.h"
#include "motor/motor.h"
#include "robot/robot.h"
#include "select/evaluate.h"
#include "thermal/transient.h"

namespace heatsoak {

/// Always all that is allowed, at one share of the highest speed, in one of the hot cases: held, or in pulses.
struct Use {
  double speed_share = 0.0;
  double on_s = 0.0;  ///< of a pulse; 0: held
  double off_s = 0.0;
  double off_speed_share = 0.0;  ///< coasting between pulses
  HotCase hot_case = {};
};
/// Held and pulsed at several speeds in the plain case, and some of it in every other one.
std::vector<Use> hardest_uses(const Observer& observer, const BarrierRules& rules);

/// What the firmware lets through in one use, and what its observer saw.
struct UsePlayed {
  Use use;
  std::vector<Interval> intervals;  ///< as the motor's network sees them
  std::vector<double> time_s;       ///< ends of the intervals
  std::vector<double> current_A;    ///< allowed and flowing, rms of the interval
  double winding_peak_C = 0.0;      ///< of the observer
  double stator_peak_C = 0.0;
  std::optional<double> start_C = {};  ///< of every node of the motor; the air of the first interval unless given
};

/// Joins the periods of a use to intervals with their rms current: as long as the current changes by little, and no longer than a second.
class PlayedIntervals {
 public:
  /// `played` holds the use and gets the intervals; all must outlive this.
  PlayedIntervals(UsePlayed& played, const Motor& motor, const Robot& robot, const BarrierRules& rules)
      : played_(played), motor_(motor), robot_(robot), rules_(rules) {}

  /// A period that begins at `time_s`.
  void take(double time_s, double current_A, double speed_rad_per_s, double period_s);
  /// Ends the last interval.
  void end(double time_s);

 private:
  UsePlayed& played_;
  const Motor& motor_;
  const Robot& robot_;
  const BarrierRules& rules_;
  HeldCurrent held_;
};

/// Four of the slowest time constants of the nominal motor, 900 s at least and 4 h at most.
double use_duration_s(const MotorValues& motor);

/// From a motor as warm as the air until the slowest body has settled, with the arithmetic of the firmware.
UsePlayed play(const Observer& observer, const CurrentTable& table, const BarrierRules& rules, const Motor& motor, const Robot& robot,
               const Use& use, double period_s);

/// The hottest moments of one motor.
struct MotorPeak {
  double winding_C = 0.0;
  bool is_over = false;  ///< winding or stator
};
/// Each of kLanes motors, networks of one form, through every use.
std::array<MotorPeak, kLanes> peaks(std::span<const Network> motors, const TemperatureLimits& limits, std::span<const UsePlayed> uses);

/// Of the promise: how sure the bounds of shares are.
inline constexpr double kCertainty_share = 0.95;

struct GuaranteeOptions {
  double confidence = 0.95;  ///< least share of motors that keep every limit in every use, shown with kCertainty_share
  int samples = 400;         ///< fresh ones that it is checked on; as many others find the reserve
  std::uint64_t seed = 1;
  int threads = 0;
};

/// Of fresh samples.
struct Guarantee {
  int samples = 0;
  int over = 0;  ///< pass a limit in one of the uses
  Interval95 over_share;
  /// Lower bound of the share of motors that keep every limit, one-sided with kCertainty_share, exact (Clopper and Pearson 1934).
  double least_kept_share = 0.0;
  double winding_p50_C = 0.0;  ///< of the hottest moment of the hottest use
  double winding_p95_C = 0.0;
  double winding_most_C = 0.0;
};

/// Peaks of drawn motors under what was let through; streams of chance from `first_stream` on.
Guarantee check(const Motor& motor, const TemperatureLimits& limits, std::span<const UsePlayed> uses, const GuaranteeOptions& options,
                std::uint64_t first_stream, const Progress& progress = {});

}  // namespace heatsoak
