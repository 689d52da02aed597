#include "identify/calibration/unlogged_speed.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "motor/datasheet_network.h"
#include "thermal/effect.h"

namespace heatsoak {
namespace {

/// Of the loss at no-load speed: the part of it that is there throughout, and what comes with the current. Standing still and turning
/// at no-load speed, at all times or whenever current flows, are all within reach.
constexpr double kMean_share = 0.2;
constexpr double kMean_sd_share = 0.3;
/// How far it comes and goes besides, within a run and from run to run.
constexpr double kComesAndGoes_share = 0.25;
/// Less than this share of the no-load current turns no motor.
constexpr double kDrives_share = 0.5;

/// Of two operating quantities that only a speed column would give a meaning (fill_loss_at_speed).
struct LossAtUnloggedSpeed {
  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    heat.source(0, x.parameter(0) * x.at.input_power_W + x.parameter(1) * x.at.shaft_power_W);
  }
};

const EffectType& loss_at_unlogged_speed() {
  static const EffectType type{
      .name = kLossAtUnloggedSpeed,
      .summary = "Loss at a speed that no log tells.",
      .equation = "P_stator = (k + k_driven · [current flows]) · P_most",
      .reference = "",
      .nodes = {{"stator", "stator"}},
      .parameters = {{"share", "", Range::any(), "of the loss at no-load speed, throughout"},
                     {"share_with_current", "", Range::any(), "of the loss at no-load speed, while current flows"}},
      .typical = "",
      .look_alike = "",
      .example = {},
      .laws = laws<LossAtUnloggedSpeed>(),
  };
  return type;
}

}  // namespace

double most_loss_at_speed_W(const Motor& motor) {
  const MotorValues& values = motor.nominal;
  const double no_load_rad_per_s = std::isnan(values.no_load_speed_rad_per_s) ? values.nominal_voltage_V / values.torque_constant_Nm_per_A
                                                                              : values.no_load_speed_rad_per_s;
  const double most_W = drag_torque_Nm(values) * no_load_rad_per_s;
  return most_W > 0.0 ? most_W : 0.0;
}

bool turns_unseen(const MeasuredRun& run) {
  return !run.has(Signal::speed) && std::ranges::any_of(run.at, [](const OperatingPoint<double>& at) { return at.current_rms_A > 0.0; });
}

void open_loss_at_speed(MotorModel& motor, double most_W) {
  Model& model = motor.model;
  const std::vector<double> shares(loss_at_unlogged_speed().parameters.size(), kMean_share);
  model.network.add_effect(std::string(kLossAtUnloggedSpeed), loss_at_unlogged_speed(), std::vector<std::string>{"stator"}, shares);
  for (const double share : shares) {
    model.values.push_back(share);
    motor.nuisances.push_back(static_cast<int>(model.free.size()));
    // Below 0 too: a bound would push what it cannot take onto the figures.
    constexpr double kFar = 10.0;
    model.set_free({.place = static_cast<int>(model.values.size()) - 1, .by_log = false, .scale = 1.0, .low = -kFar, .high = kFar},
                   kMean_sd_share);
  }
  for (FittedFigure& each : motor.figures) {
    each.exponents.conservativeResizeLike(Eigen::VectorXd::Zero(model.free_count()));
  }
  model.least_flux_W = {0.0, kComesAndGoes_share * most_W};
}

void fill_loss_at_speed(std::span<MeasuredRun> runs, const Motor& motor) {
  const double most_W = most_loss_at_speed_W(motor);
  for (MeasuredRun& run : runs) {
    const bool turns = turns_unseen(run);
    for (OperatingPoint<double>& at : run.at) {
      const bool is_driven = at.current_rms_A > kDrives_share * motor.nominal.no_load_current_A;
      at.input_power_W = turns ? most_W : 0.0;
      at.shaft_power_W = turns && is_driven ? most_W : 0.0;
    }
  }
}

}  // namespace heatsoak
