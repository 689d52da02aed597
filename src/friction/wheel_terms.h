// Regression of a wheel's friction: rows from steady parts, and the terms that these rows determine.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "friction/friction_fit.h"

namespace heatsoak::friction {

/// One steady part as data point of one wheel.
struct WheelPoint {
  const SteadyPart* part = nullptr;
  double sine_ratio = 0.0;    ///< sin(θ + φ_0); 0 in rotation
  double cosine_ratio = 0.0;  ///< cos(θ + φ_0); 0 in rotation
  int side = 0;               ///< sign of the wheel's speed, 1 or −1
};

/// Points of one wheel.
struct WheelPoints {
  std::vector<WheelPoint> points;
  int standing = 0;  ///< number of parts in which the wheel stands or should stand, or has no voltage
};

enum class WheelTerm { damping, sine, cosine, constant, rotation };

/// Returns whether the settings admit the part: return legs only with use_return_legs.
bool is_used(const SteadyPart& part, const FitSettings& settings);
/// Returns the points of the parts that the settings admit, for the phase φ_0 of the rolling direction.
WheelPoints points_of(const std::vector<SteadyPart>& parts, const robot::Kinematics& kinematics, int wheel, const FitSettings& settings);

/// Returns the points for the phase φ_0 + offset. The signs of the measured speeds stay.
std::vector<WheelPoint> turned(std::vector<WheelPoint> points, double offset_rad);

/// Terms that the points determine, or the reason why there are none.
struct ChosenTerms {
  std::vector<WheelTerm> terms;
  bool damping_is_given = false;
  bool phase_is_given = false;
  std::optional<WheelProblem> problem;
};

/// Chooses the terms that the points determine. `problem` states the reason if they do not suffice for a fit.
ChosenTerms chosen_terms(const std::vector<WheelPoint>& points, int wheel, const FitSettings& settings);

/// Linear regression of a wheel: voltage_V = X · coefficients. `given_V_s_per_rad` is the known damping, whose voltage is subtracted.
struct WheelRegression {
  Eigen::MatrixXd X;
  Eigen::VectorXd voltage_V;
  std::vector<int> legs;  ///< cluster of each row: its leg, or the row itself if there are few legs
};

/// Sets up the regression of these terms. `given_V_s_per_rad` is 0 if the damping is one of them.
WheelRegression regression_of(const std::vector<WheelPoint>& points, int wheel, const std::vector<WheelTerm>& terms,
                              double given_V_s_per_rad);

}  // namespace heatsoak::friction
