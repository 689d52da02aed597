// What the wheels of a robot have to do, in the form that a motor's heat depends on.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace heatsoak {

/// Means over a stretch of time at one wheel. With I = (M + M_drag·sign ω)/K_t the mean of I² is
/// (⟨M²⟩ + 2·M_drag·⟨M·sign ω⟩ + M_drag²·⟨sign² ω⟩)/K_t², so that these means give the copper heat of every motor exactly,
/// however many moments were merged into the bin.
struct LoadBin {
  double duration_s = 0.0;
  double torque_rms_Nm = 0.0;
  double torque_along_motion_Nm = 0.0;  ///< mean of M·sign ω (see kStandstill_rad_per_s): positive drives, negative brakes
  double moving_share = 0.0;            ///< part of the time with a direction
  double speed_mean_rad_per_s = 0.0;    ///< mean of |ω|
  double speed_rms_rad_per_s = 0.0;
  double torque_mean_Nm = 0.0;           ///< signed
  double velocity_mean_rad_per_s = 0.0;  ///< signed mean of ω
  double current_rms_A = 0.0;            ///< only of duties that are given as current
  double power_mean_W = 0.0;             ///< mean of M·ω
  double acceleration_rad_per_s2 = 0.0;  ///< mean of |dω/dt|; jumps between stretches of constant speed are not in it
};

/// A wheel that turns more slowly has no direction, 3 mm/s at a rim of 30 mm: what planners, smoothers and number formats leave of a
/// zero has a sign, and the motor's whole drag would follow it.
inline constexpr double kStandstill_rad_per_s = 0.1;

/// A stretch with one torque and speed.
LoadBin constant_bin(double duration_s, double torque_Nm, double speed_rad_per_s, double current_A);

/// How long a wheel is asked for a torque at a speed: tells what voltage and current are needed, and how often.
/// speed_rad_per_s ≥ 0; a torque < 0 brakes.
struct LoadPoint {
  double torque_Nm = 0.0;
  double speed_rad_per_s = 0.0;
  double current_A = 0.0;  ///< only of duties that are given as current
  double time_s = 0.0;
};

struct WheelDemand {
  std::string wheel;  ///< "wheel 1 (front right)"
  std::vector<LoadBin> bins;
  std::vector<LoadPoint> points;

  [[nodiscard]] double duration_s() const;
};

/// Merges moments into bins and points as they come; memory grows with the number of bins only.
/// Points are gathered on a grid of torque and speed and stand for the edge of their cell that asks more.
class DemandGatherer {
 public:
  struct Grid {
    double torque_step_Nm = 0.005;
    double speed_step_rad_per_s = 5.0;
  };
  DemandGatherer(std::string wheel, double bin_s, Grid grid);

  /// `speed_rad_per_s` and `torque_Nm` hold for `duration_s`; torque · speed > 0 drives.
  void add(double duration_s, double torque_Nm, double speed_rad_per_s);
  [[nodiscard]] WheelDemand finish();

 private:
  /// Time integrals over the open bin.
  enum Integral { time, torque, torque_squared, torque_along_motion, moving, velocity, speed, speed_squared, power, integral_count };
  void close_bin();
  void close_stay();

  WheelDemand demand_;
  double bin_s_;
  Grid grid_;
  std::array<double, integral_count> integrals_{};
  struct CellHash {
    std::size_t operator()(const std::pair<int, int>& cell) const {
      return static_cast<std::size_t>(cell.first) * 0x9e3779b97f4a7c15U + static_cast<std::size_t>(cell.second);
    }
  };
  std::unordered_map<std::pair<int, int>, double, CellHash> time_at_s_;
  double travelled_rad_per_s_ = 0.0;  ///< Σ|Δω| over the open bin
  std::optional<double> last_speed_rad_per_s_;
  std::pair<int, int> cell_{0, 0};  ///< where the load is now; it seldom leaves a cell within milliseconds
  double stay_s_ = 0.0;
};

}  // namespace heatsoak
