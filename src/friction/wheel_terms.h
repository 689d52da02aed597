// Regression of a wheel's friction: rows from steady parts, and the terms that these rows determine.
#pragma once

#include <Eigen/Core>
#include <string>
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

struct WheelPoints {
  std::vector<WheelPoint> points;
  int standing = 0;
};

enum class WheelTerm { damping, sine, cosine, constant, rotation };

bool is_used(const SteadyPart& part, const FitSettings& settings);
WheelPoints points_of(const std::vector<SteadyPart>& parts, const robot::Kinematics& kinematics, int wheel, const FitSettings& settings);

/// Returns the points for the phase φ_0 + offset. The signs of the measured speeds stay.
std::vector<WheelPoint> turned(std::vector<WheelPoint> points, double offset_rad);

/// Terms that the points determine, or the reason why there are none.
struct ChosenTerms {
  std::vector<WheelTerm> terms;
  bool damping_is_given = false;
  bool phase_is_given = false;
  std::string problem;
};

ChosenTerms chosen_terms(const std::vector<WheelPoint>& points, int wheel, const FitSettings& settings);

/// Linear regression of a wheel: voltage_V = X · coefficients. `given_V_s_per_rad` is the known damping, whose voltage is subtracted.
struct WheelRegression {
  Eigen::MatrixXd X;
  Eigen::VectorXd voltage_V;
  std::vector<int> legs;
};

WheelRegression regression_of(const std::vector<WheelPoint>& points, int wheel, const std::vector<WheelTerm>& terms,
                              double given_V_s_per_rad);

}  // namespace heatsoak::friction
