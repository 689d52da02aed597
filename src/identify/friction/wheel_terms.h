// What the steady parts of a wheel say of its friction, as rows of a regression, and which terms they can tell apart.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "identify/friction/friction_fit.h"

namespace heatsoak {

/// One steady part seen by one wheel.
struct WheelPoint {
  const SteadyPart* part = nullptr;
  double sine_ratio = 0.0;    ///< of θ + φ_0; 0 in rotation
  double cosine_ratio = 0.0;  ///< likewise
  int side = 0;               ///< of the wheel's speed, 1 or −1
};

struct WheelPoints {
  std::vector<WheelPoint> points;
  int standing = 0;
};

enum class WheelTerm { damping, sine, cosine, constant, rotation };

bool is_used(const SteadyPart& part, const FitSettings& settings);
WheelPoints points_of(const std::vector<SteadyPart>& parts, const Kinematics& kinematics, int wheel, const FitSettings& settings);

/// As if the wheel's phase were φ_0 + offset; it turns the way it was seen to.
std::vector<WheelPoint> turned(std::vector<WheelPoint> points, double offset_rad);

/// Terms that these points can tell apart, or why not.
struct ChosenTerms {
  std::vector<WheelTerm> terms;
  bool damping_is_given = false;
  bool phase_is_given = false;
  std::string problem;
};

ChosenTerms chosen_terms(const std::vector<WheelPoint>& points, int wheel, const FitSettings& settings);

/// What a wheel's points ask of its terms; `given_V_s_per_rad` is the damping that is taken as known.
struct WheelRegression {
  Eigen::MatrixXd X;
  Eigen::VectorXd voltage_V;
  std::vector<int> legs;
};

WheelRegression regression_of(const std::vector<WheelPoint>& points, int wheel, const std::vector<WheelTerm>& terms,
                              double given_V_s_per_rad);

}  // namespace heatsoak
