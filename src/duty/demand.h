// What the wheels of a robot have to do, in the form that a motor's heat depends on.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace heatsoak::duty {

/// Means over a segment of time at one wheel. With I = (M + M_drag·sign ω)/K_t the mean of I² is
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
  // Only of duties that are given as current:
  double current_rms_A = 0.0;
  double current_along_motion_A = 0.0;   ///< mean of I·sign ω: positive drives, negative brakes
  double current_mean_A = 0.0;           ///< signed
  double power_mean_W = 0.0;             ///< mean of M·ω
  double acceleration_rad_per_s2 = 0.0;  ///< mean of |dω/dt|; jumps between segments of constant speed are not in it
};

/// A wheel that turns more slowly has no direction, 3 mm/s at a rim of 30 mm: what planners, smoothers and number formats leave of a
/// zero has a sign, and the motor's whole drag would follow it.
inline constexpr double kStandstill_rad_per_s = 0.1;

/// A segment with one torque and speed.
LoadBin constant_bin(double duration_s, double torque_Nm, double speed_rad_per_s, double current_A);

/// How long a wheel is asked for a torque at a speed: tells what voltage and current are needed, and how often.
/// speed_rad_per_s ≥ 0; a torque or current < 0 brakes.
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
  double slip_share = 0.0;  ///< of the time: the ground cannot pass on what the robot's motion takes, and wheels would slide

  [[nodiscard]] double duration_s() const;
};

/// The wheel with the largest ∫M²dt: it stands for the hottest one, which is known only for a motor. Expects at least one.
WheelDemand hardest(std::vector<WheelDemand> wheels);

/// So long are the bins into which moments are merged: short against a winding's time constant.
inline constexpr double kBin_s = 0.25;

/// Means over moments as they come.
class LoadMeans {
 public:
  /// What is given holds for `duration_s`; torque · speed > 0 drives, and so does current · speed > 0.
  void add(double duration_s, double torque_Nm, double speed_rad_per_s, double current_A = 0.0);
  [[nodiscard]] double time_s() const { return integrals_[time]; }
  /// What came since the last bin; the next one begins.
  LoadBin close();
  /// What comes does not follow on what came.
  void cut() { last_speed_rad_per_s_.reset(); }

 private:
  /// Time integrals over the open bin.
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

/// Merges moments into bins and points as they come; memory grows with the number of bins only.
/// Points are gathered on a grid of torque, speed and current and stand for the edge of their cell that asks more. The grid gets
/// coarser where loads are so large or so many that it would have more than kMostSteps to a side or kMostCells in all.
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

  /// What is given holds for `duration_s`; torque · speed > 0 drives.
  void add(double duration_s, double torque_Nm, double speed_rad_per_s, double current_A = 0.0);
  /// The same, kept as a bin and a point of its own.
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
  Cell cell_{};  ///< where the load is now; it seldom leaves a cell within milliseconds
  double stay_s_ = 0.0;
};

}  // namespace heatsoak::duty
