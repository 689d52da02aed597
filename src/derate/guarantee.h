// Monte Carlo check of the derating table: motors drawn from the declared tolerances, driven with the full current that the table allows.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/lanes.h"
#include "base/parallel.h"
#include "derate/current_table.h"
#include "derate/held_current.h"
#include "motor/motor.h"
#include "robot/robot.h"
#include "thermal/transient.h"

namespace heatsoak::derate {

/// A use of the motor that always draws the full allowed current, continuously or in pulses, at constant speed in one hot case. Texts call
/// it a use.
struct LoadPattern {
  double speed_share = 0.0;  ///< speed as a share of the rules' highest speed
  double on_s = 0.0;         ///< length of a pulse; 0: continuous
  double off_s = 0.0;
  double off_speed_share = 0.0;  ///< speed while coasting between pulses, as a share of the rules' highest speed
  HotCase hot_case = {};

  bool operator==(const LoadPattern&) const = default;
};
/// Returns continuous and pulsed patterns at several speeds: all of them in the plain case, a selection in every other hot case.
std::vector<LoadPattern> hardest_patterns(const Observer& observer, const BarrierRules& rules);

/// Simulation of one use: the current that the firmware allows, and the temperatures of its observer.
struct UsePlayed {
  LoadPattern use;
  std::vector<thermal::Interval> intervals;  ///< inputs of the motor's network
  std::vector<double> time_s;                ///< ends of the intervals
  std::vector<double> current_A;             ///< RMS current of each interval, ≥ 0
  double winding_peak_C = 0.0;               ///< observer's estimate
  double stator_peak_C = 0.0;
  std::optional<double> start_C = {};  ///< initial temperature of every node of the motor; by default the air of the first interval
};

/// Merges the periods of a use into intervals with their RMS current. HeldCurrent decides where an interval ends.
class PlayedIntervals {
 public:
  /// Appends the intervals to `played`, which holds the use. All arguments must outlive this object.
  PlayedIntervals(UsePlayed& played, const motor::Motor& motor, const robot::Robot& robot, const BarrierRules& rules)
      : played_(played), motor_(motor), robot_(robot), rules_(rules) {}

  /// Adds a period that begins at `time_s`.
  void take(double time_s, double current_A, double speed_rad_per_s, double period_s);
  /// Ends the last interval.
  void end(double time_s);

 private:
  UsePlayed& played_;
  const motor::Motor& motor_;
  const robot::Robot& robot_;
  const BarrierRules& rules_;
  HeldCurrent held_;
};

/// Duration of a use: four stator time constants of the nominal motor, limited to 900 s to 4 h.
double use_duration_s(const motor::MotorValues& motor);

/// Simulates up to kLanes uses for use_duration_s(), from a motor at the temperature of the hottest air. Single precision, as in the
/// firmware.
std::vector<UsePlayed> play(const Observer& observer, const CurrentTable& table, const BarrierRules& rules, const motor::Motor& motor,
                            const robot::Robot& robot, std::span<const LoadPattern> uses, double period_s);

/// Peak temperature of one motor over all uses.
struct MotorPeak {
  double winding_C = 0.0;
  double limit_use_ratio = 0.0;  ///< rise of winding or stator above the air, relative to the permitted rise; the larger of both
  bool is_over = false;          ///< winding or stator exceeded its limit
};
/// Simulates kLanes motors, whose networks have the same structure, through every use.
std::array<MotorPeak, base::kLanes> peaks(std::span<const thermal::Network> motors, const TemperatureLimits& limits,
                                          std::span<const UsePlayed> uses);

/// Returns kLanes motors drawn from the tolerances, each from its own random stream.
std::vector<thermal::Network> drawn_networks(const motor::Motor& motor, std::uint64_t seed, std::uint64_t first_stream);

/// Confidence level of the one-sided bound on the share of motors that keep their limits.
inline constexpr double kCertainty_share = 0.95;

struct GuaranteeOptions {
  double required_share = 0.95;  ///< share of motors that must keep every limit in every use, shown at the level kCertainty_share
  int samples = 400;             ///< motors drawn for the check; the same number of other motors finds the safety factor
  std::uint64_t seed = 1;
  int threads = 0;
};

/// Result of the check on the motors that determined the safety factor. Because the factor was selected with them, `over` gives no
/// confidence bound of its own: only GuaranteeOptions::required_share is shown.
struct Guarantee {
  int samples = 0;
  int over = 0;                ///< motors that exceed a limit in at least one use
  double winding_p50_C = 0.0;  ///< percentile of the motors' peak temperatures over all uses
  double winding_p95_C = 0.0;
  double winding_most_C = 0.0;
};

/// Returns the largest number of `samples` motors over a limit with which a single check shows the required share: its lower bound is
/// one-sided with kCertainty_share and exact (Clopper and Pearson 1934). Empty if the samples are too few.
std::optional<int> most_over(const GuaranteeOptions& goal);

/// Summarises the peaks of drawn motors, at least one.
Guarantee guarantee(std::span<const MotorPeak> peaks);

/// Draws motors and simulates them with the currents of the uses. Uses the random streams from `first_stream` on.
Guarantee check(const motor::Motor& motor, const TemperatureLimits& limits, std::span<const UsePlayed> uses,
                const GuaranteeOptions& options, std::uint64_t first_stream, const base::Progress& progress = {});

}  // namespace heatsoak::derate
