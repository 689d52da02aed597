#include "calibration/identifiability.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "calibration/loss_at_stator.h"

namespace heatsoak::calibration {
namespace {

/// A direction is open if the data leave more than this fraction of its prior variance.
constexpr double kIdentifiableShare = 0.5;

struct Look {
  bool winding_is_sensed = false;
  bool stator_is_sensed = false;
  bool has_heat = false;
  bool is_ever_at_speed = false;
  double longest_s = 0.0;
};

Look look(const MotorModel& motor, std::span<const estimation::MeasuredRun> runs) {
  Look seen;
  seen.has_heat = is_heated(motor, runs);
  for (const estimation::MeasuredRun& run : runs) {
    seen.longest_s = std::max(seen.longest_s, run.time_s.back() - run.time_s.front());
    seen.winding_is_sensed = seen.winding_is_sensed || run.sensor_at("winding");
    seen.stator_is_sensed = seen.stator_is_sensed || run.sensor_at("stator");
    for (const thermal::OperatingPoint<double>& at : run.at) {
      seen.is_ever_at_speed = seen.is_ever_at_speed || at.speed_mean_rad_per_s > 1.0;
    }
  }
  return seen;
}

/// Indices of the free parameters by role; empty if not free.
struct Roles {
  std::optional<Eigen::Index> winding_capacity;
  std::optional<Eigen::Index> winding_stator;
  std::optional<Eigen::Index> stator_capacity;
  std::optional<Eigen::Index> stator_ambient;
  std::optional<Eigen::Index> resistance;
  std::optional<Eigen::Index> drag;
};

Roles roles_of(const estimation::Model& model) {
  const auto find = [&](std::string_view name) -> std::optional<Eigen::Index> {
    for (Eigen::Index i = 0; i < model.free_count(); ++i) {
      if (model.name(i) == name) {
        return i;
      }
    }
    return std::nullopt;
  };
  return {find("winding.heat_capacity"),
          find("winding_stator.thermal_resistance"),
          find("stator.heat_capacity"),
          find("stator_ambient.thermal_resistance"),
          find("copper_loss.terminal_resistance"),
          std::max(find("no_load_loss.drag_torque"), find(kDragAtStator))};
}

Remedy remedy_for(OpenReason reason) {
  switch (reason) {
    case OpenReason::no_heat:
      return Remedy::heated_run;
    case OpenReason::common_factor:
      return Remedy::four_wire_resistance;
    case OpenReason::only_stator_measured:
      return Remedy::winding_sensor;
    case OpenReason::only_winding_measured:
      return Remedy::stator_sensor;
    case OpenReason::motor_hardly_turns:
    case OpenReason::small_loss_at_speed:
      return Remedy::no_load_run;
    case OpenReason::speed_not_logged:
      return Remedy::logged_speed;
    case OpenReason::winding_not_stepped:
      return Remedy::current_steps;
    case OpenReason::not_excited:
    case OpenReason::stator_not_settled:
    case OpenReason::stator_beside_unknown_heat:
      break;
  }
  return Remedy::long_run;
}

/// Approximate working time.
double working_time_min(Remedy remedy) {
  switch (remedy) {
    case Remedy::logged_speed:
      return 0.0;
    case Remedy::four_wire_resistance:
      return 5.0;
    case Remedy::no_load_run:
      return 15.0;
    case Remedy::heated_run:
    case Remedy::current_steps:
      return 20.0;
    case Remedy::winding_sensor:
      return 45.0;
    case Remedy::stator_sensor:
      return 60.0;
    case Remedy::long_run:
      break;
  }
  return 90.0;
}

OpenReason loss_hidden(const Look& seen) {
  return seen.is_ever_at_speed ? OpenReason::small_loss_at_speed : OpenReason::motor_hardly_turns;
}

OpenDirection open_for(OpenReason reason) {
  OpenDirection open;
  open.reason = reason;
  open.remedy = remedy_for(reason);
  return open;
}

double component(const Eigen::VectorXd& direction, std::optional<Eigen::Index> place) { return place ? direction[*place] : 0.0; }

/// Returns the exponent of a common factor on all heat in a free parameter: 1 for heat, heat capacities and conductances, -1 for thermal
/// resistances, 0 for shares and times.
double scale_exponent(const estimation::Model& model, Eigen::Index place, const Roles& roles) {
  if (place == roles.resistance || place == roles.drag) {
    return 1.0;
  }
  const std::string_view unit =
      model.network.parameters()[static_cast<std::size_t>(model.free[static_cast<std::size_t>(place)].place)].unit;
  const bool is_of_heat = unit == "W/K" || unit == "J/K" || unit == "W";
  return is_of_heat ? 1.0 : unit == "K/W" ? -1.0 : 0.0;
}

/// Returns |cos| of the angle between `direction` and the scale direction: one factor on all heat and heat capacities, its inverse on all
/// thermal resistances. Along the scale direction no temperature changes.
double likeness_to_scale(const estimation::Model& model, const Eigen::VectorXd& direction, const Roles& roles) {
  Eigen::VectorXd scale(direction.size());
  for (Eigen::Index i = 0; i < scale.size(); ++i) {
    scale[i] = scale_exponent(model, i, roles);
  }
  return std::abs(direction.dot(scale.normalized()));
}

/// Adds the parameters that change most along the direction, if there are several. The one that changes most is raised.
void add_movement(const estimation::Model& model, const Eigen::VectorXd& direction, OpenDirection& open) {
  const double largest = direction.cwiseAbs().maxCoeff();
  Eigen::Index first = 0;
  direction.cwiseAbs().maxCoeff(&first);
  const double sign = direction[first] > 0.0 ? 1.0 : -1.0;
  for (Eigen::Index i = 0; i < direction.size(); ++i) {
    if (std::abs(direction[i]) > 0.3 * largest) {
      open.together.push_back({std::string(model.name(i)), sign * direction[i] > 0.0});
    }
  }
  if (open.together.size() == 1) {
    open.together.clear();
  }
}

OpenReason reason_of(const MotorModel& motor, const Eigen::VectorXd& direction, const Look& seen) {
  const Roles roles = roles_of(motor.model);
  constexpr double kAlike = 0.9;
  if (seen.has_heat && likeness_to_scale(motor.model, direction, roles) > kAlike) {
    return OpenReason::common_factor;
  }
  const double in_winding = std::hypot(component(direction, roles.winding_capacity), component(direction, roles.winding_stator));
  const double in_stator = std::hypot(component(direction, roles.stator_capacity), component(direction, roles.stator_ambient));
  constexpr double kMostly = 0.7;
  // If capacities and resistances change oppositely, at constant time constants, the runs lack heat.
  constexpr double kSame = 0.3;
  const double winding_moves = component(direction, roles.winding_capacity) + component(direction, roles.winding_stator);
  const double stator_moves = component(direction, roles.stator_capacity) + component(direction, roles.stator_ambient);
  if (!seen.has_heat && std::hypot(winding_moves, stator_moves) < kSame) {
    return OpenReason::no_heat;
  }
  if (!seen.winding_is_sensed && in_winding > kMostly) {
    return OpenReason::only_stator_measured;
  }
  if (!seen.stator_is_sensed && in_stator > kMostly) {
    return OpenReason::only_winding_measured;
  }
  return std::abs(component(direction, roles.drag)) > kMostly ? loss_hidden(seen) : OpenReason::not_excited;
}

bool is_of_stator(const MotorModel& motor, const CalibratedValue& parameter) {
  const Roles roles = roles_of(motor.model);
  return component(parameter.exponents, roles.stator_capacity) != 0.0 || component(parameter.exponents, roles.stator_ambient) != 0.0;
}

/// Reason why a single parameter is not identifiable although no open direction contains it.
OpenReason reason_of(const MotorModel& motor, const CalibratedValue& parameter, const Look& seen) {
  const Roles roles = roles_of(motor.model);
  const auto holds = [&](std::optional<Eigen::Index> place) { return component(parameter.exponents, place) != 0.0; };
  if (!seen.has_heat && (holds(roles.resistance) || holds(roles.drag) || depends_on_heat(motor, parameter))) {
    return OpenReason::no_heat;
  }
  if (holds(roles.resistance)) {
    return OpenReason::common_factor;
  }
  if (holds(roles.drag)) {
    return loss_hidden(seen);
  }
  if (is_of_stator(motor, parameter) && !seen.stator_is_sensed) {
    return OpenReason::only_winding_measured;
  }
  if (is_of_stator(motor, parameter)) {
    return OpenReason::stator_not_settled;
  }
  if ((holds(roles.winding_capacity) || holds(roles.winding_stator)) && !seen.winding_is_sensed) {
    return OpenReason::only_stator_measured;
  }
  if (holds(roles.winding_capacity) || holds(roles.winding_stator)) {
    return OpenReason::winding_not_stepped;
  }
  return OpenReason::not_excited;
}

/// A combination of parameters that the data leave undetermined, and its remaining standard deviation per free parameter.
struct Combination {
  OpenDirection open;
  Eigen::VectorXd left_sd;
};

/// Adds a reason for a parameter that is not identifiable and that no combination explains.
void name_alone(const MotorModel& motor, const estimation::Fit& fit, const Look& seen, const CalibratedValue& parameter,
                std::vector<OpenDirection>& open) {
  // 98 % of a change.
  constexpr double kSettled_ratio = 4.0;
  const Roles roles = roles_of(motor.model);
  const double stator_s = std::exp(component(fit.theta, roles.stator_capacity) + component(fit.theta, roles.stator_ambient));
  const bool has_unlogged_speed = !motor.nuisances.empty();
  OpenReason reason = has_unlogged_speed && is_of_stator(motor, parameter) ? OpenReason::speed_not_logged : reason_of(motor, parameter, seen);
  if (reason == OpenReason::stator_not_settled && seen.longest_s > kSettled_ratio * stator_s) {
    reason = OpenReason::stator_beside_unknown_heat;
  }
  auto same = std::ranges::find(open, reason, &OpenDirection::reason);
  if (same == open.end()) {
    same = open.insert(open.end(), open_for(reason));
  }
  same->longest_run_s = seen.longest_s;
  same->stator_s = stator_s;
  same->parameters.push_back(parameter.name);
  same->left_sd = std::max(same->left_sd, std::sqrt(parameter.exponents.dot(fit.covariance * parameter.exponents)));
}

/// Names every parameter that is not identifiable, with the combination that contributes most to its variance, or with a reason of its own.
/// A combination that explains none of them is left out: `parameters` decides what is identifiable.
void name_parameters(const MotorModel& motor, const estimation::Fit& fit, const Look& seen, std::span<const CalibratedParameter> parameters,
                     std::vector<Combination> combinations, std::vector<OpenDirection>& open) {
  constexpr double kExplains_share = 0.25;
  std::vector<const CalibratedValue*> alone;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const CalibratedValue& parameter = motor.parameters[i];
    if (parameters[i].is_identifiable) {
      continue;
    }
    const auto part = [&](const Combination& each) { return std::abs(each.left_sd.dot(parameter.exponents)); };
    const auto most = std::ranges::max_element(combinations, {}, part);
    const double variance = parameter.exponents.dot(fit.covariance * parameter.exponents);
    if (most != combinations.end() && part(*most) * part(*most) > kExplains_share * variance) {
      most->open.parameters.push_back(parameter.name);
    } else {
      alone.push_back(&parameter);
    }
  }
  for (Combination& each : combinations) {
    if (!each.open.parameters.empty()) {
      open.push_back(std::move(each.open));
    }
  }
  for (const CalibratedValue* const parameter : alone) {
    name_alone(motor, fit, seen, *parameter, open);
  }
}

}  // namespace

NothingLearned::NothingLearned(std::vector<OpenDirection> open, bool has_heat_input)
    : base::Failure(base::ExitCode::cannot_answer, "no parameter of this motor is identifiable from these logs"),
      open_(std::move(open)),
      has_heat_input_(has_heat_input) {}

bool is_heated(const MotorModel& motor, std::span<const estimation::MeasuredRun> runs) {
  // The offset of a current sensor must not count as heat.
  constexpr double kNothing_K = 1.0;
  const auto value = [&](std::string_view name) {
    const auto parameters = motor.model.network.parameters();
    return motor.model
        .values[static_cast<std::size_t>(std::ranges::find(parameters, name, &thermal::NetworkParameter::name) - parameters.begin())];
  };
  const double across_K_per_W = value("winding_stator.thermal_resistance") + value("stator_ambient.thermal_resistance");
  const double slowest_s = across_K_per_W * value("winding.heat_capacity");
  const double by_current_ohm = motor.heat != HeatInput::input_power ? value("copper_loss.terminal_resistance") : 0.0;
  // Upper bound of the temperature rise: the winding alone, with the whole resistance to ambient.
  return std::ranges::any_of(runs, [&](const estimation::MeasuredRun& run) {
    double rise_K = 0.0;
    for (std::size_t k = 0; k < run.at.size() && rise_K < kNothing_K; ++k) {
      const thermal::OperatingPoint<double>& at = run.at[k];
      const double heat_W = motor.heat != HeatInput::input_power ? at.current_rms_A * at.current_rms_A * by_current_ohm : at.input_power_W;
      const double stays_share = std::exp(-(run.time_s[k + 1] - run.time_s[k]) / slowest_s);
      rise_K = stays_share * rise_K + (1.0 - stays_share) * heat_W * across_K_per_W;
    }
    return rise_K >= kNothing_K;
  });
}

bool depends_on_heat(const MotorModel& motor, const CalibratedValue& parameter) {
  const Roles roles = roles_of(motor.model);
  const double by_scale = component(parameter.exponents, roles.winding_capacity) - component(parameter.exponents, roles.winding_stator) +
                          component(parameter.exponents, roles.stator_capacity) - component(parameter.exponents, roles.stator_ambient);
  return std::abs(by_scale) > 0.5;
}

std::vector<OpenDirection> open_directions(const MotorModel& motor, const estimation::Fit& fit,
                                           std::span<const estimation::MeasuredRun> runs, std::span<const CalibratedParameter> parameters) {
  const Eigen::Index count = motor.model.free_count();
  Eigen::MatrixXd data = fit.information;
  const Eigen::MatrixXd known = motor.model.prior.precision.inverse();
  std::vector<Eigen::Index> asked;
  for (Eigen::Index i = 0; i < count; ++i) {
    // A parameter without any sensitivity would mix arbitrarily with the other undetermined directions.
    constexpr double kNothing = 1e-9;
    const bool is_nuisance = std::ranges::find(motor.nuisances, static_cast<int>(i)) != motor.nuisances.end();
    if (is_nuisance) {
      data(i, i) += motor.model.prior.precision(i, i);
      data -= data.col(i).eval() * data.row(i).eval() / data(i, i);
    } else if (data(i, i) * known(i, i) > kNothing) {
      asked.push_back(i);
    }
  }
  const Eigen::MatrixXd prior_covariance = known(asked, asked);
  const Eigen::MatrixXd root = prior_covariance.llt().matrixL();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(root.transpose() * data(asked, asked) * root);
  const Look seen = look(motor, runs);
  const bool was_fitted = std::ranges::find(motor.parameters, base::Origin::measured, &CalibratedValue::origin) != motor.parameters.end();
  std::vector<OpenDirection> open;
  if (!motor.nuisances.empty()) {
    open.push_back(open_for(OpenReason::speed_not_logged));
    open.back().parameters.emplace_back(kLossAtUnloggedSpeed);
    // Rank this first, because the information in the other runs depends on it.
    open.back().left_sd = std::numeric_limits<double>::infinity();
  }
  std::vector<Combination> combinations;
  for (Eigen::Index i = 0; i < solver.eigenvalues().size(); ++i) {
    const double information = std::max(0.0, solver.eigenvalues()[i]);
    // Remaining uncertainty along this direction. An earlier fit may have determined what these runs do not.
    Eigen::VectorXd left = Eigen::VectorXd::Zero(count);
    left(asked) = root * solver.eigenvectors().col(i) / std::sqrt(1.0 + information);
    constexpr double kWellKnown = 0.03;
    const bool is_known = was_fitted && left.cwiseAbs().maxCoeff() < kWellKnown;
    if (1.0 / (1.0 + information) > kIdentifiableShare && !is_known) {
      OpenDirection direction = open_for(reason_of(motor, left.normalized(), seen));
      add_movement(motor.model, left.normalized(), direction);
      direction.left_sd = left.norm();
      combinations.push_back({std::move(direction), left});
    }
  }
  name_parameters(motor, fit, seen, parameters, std::move(combinations), open);
  return open;
}

std::optional<Remedy> next_experiment(std::span<const OpenDirection> open) {
  // Ignore directions that are open by much less than the most uncertain one.
  constexpr double kWeighs_share = 0.5;
  double most_sd = 0.0;
  for (const OpenDirection& each : open) {
    most_sd = std::max(most_sd, each.left_sd);
  }
  const OpenDirection* best = nullptr;
  for (const OpenDirection& each : open) {
    if (each.left_sd >= kWeighs_share * most_sd && (!best || working_time_min(each.remedy) < working_time_min(best->remedy))) {
      best = &each;
    }
  }
  return best ? std::optional(best->remedy) : std::nullopt;
}

}  // namespace heatsoak::calibration
