#include "identify/calibration/identifiability.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace heatsoak {
namespace {

/// Data that halve the variance at least have told something.
constexpr double kToldShare = 0.5;

struct Look {
  bool winding_is_sensed = false;
  bool stator_is_sensed = false;
  bool has_heat = false;
  bool is_ever_at_speed = false;
};

Look look(const MotorModel& motor, std::span<const MeasuredRun> runs) {
  Look seen;
  for (const MeasuredRun& run : runs) {
    seen.winding_is_sensed = seen.winding_is_sensed || run.sensor_at("winding") >= 0;
    seen.stator_is_sensed = seen.stator_is_sensed || run.sensor_at("stator") >= 0;
    for (const OperatingPoint<double>& at : run.at) {
      seen.has_heat = seen.has_heat || (motor.heat == HeatInput::current ? at.current_rms_A : at.input_power_W) > 0.0;
      seen.is_ever_at_speed = seen.is_ever_at_speed || at.speed_mean_rad_per_s > 1.0;
    }
  }
  return seen;
}

/// Places of free parameters by role; −1 where not free.
struct Roles {
  int winding_capacity = -1;
  int winding_stator = -1;
  int stator_capacity = -1;
  int stator_ambient = -1;
  int resistance = -1;
  int drag = -1;
};

Roles roles_of(const Model& model) {
  const auto find = [&](std::string_view name) {
    for (Eigen::Index i = 0; i < model.free_count(); ++i) {
      if (model.name(i) == name) {
        return static_cast<int>(i);
      }
    }
    return -1;
  };
  return {find("winding.heat_capacity"),
          find("winding_stator.thermal_resistance"),
          find("stator.heat_capacity"),
          find("stator_ambient.thermal_resistance"),
          find("copper_loss.terminal_resistance"),
          find("no_load_loss.drag_torque")};
}

double component(const Eigen::VectorXd& direction, int place) { return place >= 0 ? direction[place] : 0.0; }

/// All heat capacities up, all thermal resistances down, all heat up by one factor: no temperature changes.
double likeness_to_scale(const Eigen::VectorXd& direction, const Roles& roles) {
  Eigen::VectorXd scale = Eigen::VectorXd::Zero(direction.size());
  for (const auto& [place, sign] :
       {std::pair(roles.winding_capacity, 1.0), std::pair(roles.winding_stator, -1.0), std::pair(roles.stator_capacity, 1.0),
        std::pair(roles.stator_ambient, -1.0), std::pair(roles.resistance, 1.0), std::pair(roles.drag, 1.0)}) {
    if (place >= 0) {
      scale[place] = sign;
    }
  }
  return std::abs(direction.dot(scale.normalized()));
}

std::string movement(const Model& model, const Eigen::VectorXd& direction) {
  std::vector<std::string> parts;
  const double largest = direction.cwiseAbs().maxCoeff();
  Eigen::Index first = 0;
  direction.cwiseAbs().maxCoeff(&first);
  const double sign = direction[first] > 0.0 ? 1.0 : -1.0;
  for (Eigen::Index i = 0; i < direction.size(); ++i) {
    if (std::abs(direction[i]) > 0.3 * largest) {
      parts.push_back(fmt::format("{} {}", model.name(i), sign * direction[i] > 0.0 ? "up" : "down"));
    }
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

OpenDirection in_words(const MotorModel& motor, const Eigen::VectorXd& direction, const Look& seen) {
  const Roles roles = roles_of(motor.model);
  OpenDirection open{.what = movement(motor.model, direction), .why = {}, .experiment = {}, .experiment_min = 0.0};
  constexpr double kAlike = 0.9;
  if (likeness_to_scale(direction, roles) > kAlike) {
    if (!seen.has_heat) {
      open.why = "no heat goes in during these runs: cooling tells time constants, never watts";
      open.experiment = "one run with a constant current at standstill, 10 minutes, current and terminal voltage measured";
      open.experiment_min = 20.0;
    } else {
      open.why =
          "a common factor on all heat, all heat capacities and all conductances changes no temperature: the scale rests on the stated "
          "terminal resistance";
      open.experiment = "measure the terminal resistance at a known temperature with four wires (minutes, no run needed)";
      open.experiment_min = 5.0;
    }
    return open;
  }
  const double in_winding = std::hypot(component(direction, roles.winding_capacity), component(direction, roles.winding_stator));
  if (!seen.winding_is_sensed && in_winding > 0.7) {
    open.why = "only the stator is sensed: a larger winding behind a smaller resistance to the stator looks the same from there";
    open.experiment =
        "a thermocouple at the winding, or the winding's resistance from voltage and current right after switching off, during one warm-up";
    open.experiment_min = 45.0;
    return open;
  }
  if (!seen.stator_is_sensed && std::hypot(component(direction, roles.stator_capacity), component(direction, roles.stator_ambient)) > 0.7) {
    open.why = "only the winding is sensed and the runs are short against the stator's time constant, or never cool down";
    open.experiment = "a thermocouple on the housing, or one long warm-up with its cool-down to ambient";
    open.experiment_min = 60.0;
    return open;
  }
  if (std::abs(component(direction, roles.drag)) > 0.7) {
    open.why = seen.is_ever_at_speed ? "the loss at speed hardly shows beside the copper loss" : "the motor hardly turns in these runs";
    open.experiment = "10 minutes at no load and full speed";
    open.experiment_min = 15.0;
    return open;
  }
  open.why = "the runs do not excite it: what they measure hardly changes when these parameters move together";
  open.experiment = "one run from cold with a constant current until the temperatures level out, then the cool-down";
  open.experiment_min = 90.0;
  return open;
}

}  // namespace

std::vector<OpenDirection> open_directions(const MotorModel& motor, const Fit& fit, std::span<const MeasuredRun> runs) {
  const Eigen::Index count = motor.model.free_count();
  const Eigen::MatrixXd data = fit.data_triangle.topLeftCorner(count, count);
  // In units of what was known before, each direction's information adds to 1.
  const Eigen::LLT<Eigen::MatrixXd> prior(motor.model.prior.precision);
  const Eigen::MatrixXd inverse_root = prior.matrixU().solve(Eigen::MatrixXd::Identity(count, count));
  const Eigen::MatrixXd relative = data * inverse_root;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(relative.transpose() * relative);
  const Look seen = look(motor, runs);
  const bool was_fitted = std::ranges::find(motor.figures, Origin::measured, &FittedFigure::origin) != motor.figures.end();
  std::vector<OpenDirection> open;
  for (Eigen::Index i = 0; i < count; ++i) {
    const double information = std::max(0.0, solver.eigenvalues()[i]);
    // By how much parameters may still move together: a fit before this one can have told what these runs do not.
    const Eigen::VectorXd left = inverse_root * solver.eigenvectors().col(i) / std::sqrt(1.0 + information);
    constexpr double kWellKnown = 0.03;
    const bool is_known = was_fitted && left.cwiseAbs().maxCoeff() < kWellKnown;
    if (1.0 / (1.0 + information) > kToldShare && !is_known) {
      open.push_back(in_words(motor, left.normalized(), seen));
    }
  }
  return open;
}

}  // namespace heatsoak
