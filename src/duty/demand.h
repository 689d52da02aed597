// Demand of a robot's wheels, reduced to the quantities that determine the heat of a motor.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace heatsoak::duty {

/// Means over a time interval at one wheel. With I = (M + M_drag·sign ω)/K_t the mean of I² is
/// (⟨M²⟩ + 2·M_drag·⟨M·sign ω⟩ + M_drag²·⟨sign² ω⟩)/K_t². These means therefore give the exact copper heat of every motor, with
/// any number of moments in the bin.
struct LoadBin {
  double duration_s = 0.0;
  double torque_rms_Nm = 0.0;
  double torque_along_motion_Nm = 0.0;  ///< mean of M·sign ω (see kStandstill_rad_per_s): positive drives, negative brakes
  double moving_share = 0.0;            ///< share of the time with |ω| of at least kStandstill_rad_per_s
  double speed_mean_rad_per_s = 0.0;    ///< mean of |ω|
  double speed_rms_rad_per_s = 0.0;
  double torque_mean_Nm = 0.0;           ///< signed mean
  double velocity_mean_rad_per_s = 0.0;  ///< signed mean of ω
  // Only for duties that are given as current:
  double current_rms_A = 0.0;
  double current_along_motion_A = 0.0;   ///< mean of I·sign ω: positive drives, negative brakes
  double current_mean_A = 0.0;           ///< signed mean
  double power_mean_W = 0.0;             ///< mean of M·ω
  double acceleration_rad_per_s2 = 0.0;  ///< mean of |dω/dt|, without jumps between segments of constant speed
};

/// Below this speed a wheel counts as standing (3 mm/s at a rim of 30 mm). Planners, smoothers and number formats leave rounding errors
/// with a random sign, and the motor's drag would follow this sign.
inline constexpr double kStandstill_rad_per_s = 0.1;

/// Returns the bin of an interval with constant torque, speed and current.
LoadBin constant_bin(double duration_s, double torque_Nm, double speed_rad_per_s, double current_A);

/// Total time for which a wheel needs a torque at a speed. Points determine the required voltage and current and their frequency.
/// speed_rad_per_s ≥ 0; a torque or current < 0 brakes.
struct LoadPoint {
  double torque_Nm = 0.0;
  double speed_rad_per_s = 0.0;
  double current_A = 0.0;  ///< only for duties that are given as current
  double time_s = 0.0;
};

struct WheelDemand {
  std::string wheel;  ///< name, for example "wheel 1"
  std::vector<LoadBin> bins;
  std::vector<LoadPoint> points;
  double slip_share = 0.0;  ///< share of the time in which the ground cannot transmit the required forces

  [[nodiscard]] double duration_s() const;
};

/// Returns the wheel with the largest ∫M²dt, a proxy for the hottest one. Expects at least one wheel.
WheelDemand hardest(std::vector<WheelDemand> wheels);

/// Duration of bins. It is short compared with the time constant of a winding.
inline constexpr double kBin_s = 0.25;

/// Accumulates moments and computes their means.
class LoadMeans {
 public:
  /// Adds a moment that holds for `duration_s`. torque · speed > 0 or current · speed > 0 drives, < 0 brakes.
  void add(double duration_s, double torque_Nm, double speed_rad_per_s, double current_A = 0.0);
  /// Returns the duration of the open bin.
  [[nodiscard]] double time_s() const { return integrals_[time]; }
  /// Returns the means since the last call and begins the next bin.
  LoadBin close();
  /// Starts a new segment: no acceleration is computed across this point.
  void cut() { last_speed_rad_per_s_.reset(); }

 private:
  /// Indices of the time integrals over the open bin.
  enum Integral {
    time,
    torque,
    torque_squared,
    torque_along_motion,
    moving,
    velocity,
    speed,
    speed_squared,
    power,
    current,
    current_squared,
    current_along_motion,
    integral_count
  };
  std::array<double, integral_count> integrals_{};
  double travelled_rad_per_s_ = 0.0;  ///< Σ|Δω| over the open bin
  std::optional<double> last_speed_rad_per_s_;
};

/// Merges moments into bins and points; memory grows only with the number of bins. Points lie on a grid of torque, speed and current. A
/// moment is rounded to the edge of its cell with the larger load. The grid becomes coarser if it would exceed kMostSteps per axis or
/// kMostCells in total.
class DemandGatherer {
 public:
  struct Grid {
    double torque_step_Nm = 0.005;
    double speed_step_rad_per_s = 5.0;
    double current_step_A = 0.05;
  };
  static constexpr int kMostSteps = 1024;
  static constexpr std::size_t kMostCells = 16384;
  DemandGatherer(std::string wheel, double bin_s, Grid grid);

  /// Adds a moment that holds for `duration_s`. torque · speed > 0 or current · speed > 0 drives, < 0 brakes.
  void add(double duration_s, double torque_Nm, double speed_rad_per_s, double current_A = 0.0);
  /// Adds a bin and a point for this moment alone, without merging.
  void add_alone(double duration_s, double torque_Nm, double speed_rad_per_s, double current_A = 0.0);
  [[nodiscard]] WheelDemand finish();

 private:
  enum Axis { torque, speed, current, axis_count };
  using Cell = std::array<int, axis_count>;
  struct CellHash {
    std::size_t operator()(const Cell& cell) const;
  };
  void close_bin();
  void close_stay();
  void coarsen(Axis axis);
  void coarsen_the_finest();

  WheelDemand demand_;
  double bin_s_;
  std::array<double, axis_count> step_;
  LoadMeans means_;
  std::unordered_map<Cell, double, CellHash> time_at_s_;
  Cell cell_{};  ///< cell of the last moment, cached because loads change slowly
  double stay_s_ = 0.0;
};

}  // namespace heatsoak::duty
