#include "calibration/unlogged_speed.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "motor/datasheet_network.h"
#include "thermal/law.h"

namespace heatsoak::calibration {
namespace {

/// Prior mean and standard deviation of both shares of the loss at no-load speed (at all times, and additionally while current flows). The
/// prior allows standstill and no-load speed, at all times or only while current flows.
constexpr double kMean_share = 0.2;
constexpr double kMean_sd_share = 0.3;
/// RMS variation of the loss within a run and between runs, as a share of the loss at no-load speed.
constexpr double kComesAndGoes_share = 0.25;
/// Smallest current that turns the motor, as a share of the no-load current.
constexpr double kDrives_share = 0.5;
constexpr double kStepsPerCurrent = 20.0;

struct LossAtUnloggedSpeed {
  enum { share, share_with_current, most_W, least_current_A };
  template <class S>
  static void book(const thermal::Situation<S>& x, thermal::HeatBook<S>& heat) {
    const S is_driven = thermal::soft_step(kStepsPerCurrent * (x.at.current_rms_A / x.parameter(least_current_A) - 1.0));
    heat.source(0, (x.parameter(share) + x.parameter(share_with_current) * is_driven) * x.parameter(most_W) * x.at.unlogged_speed_share);
  }
};

const thermal::EffectType& loss_at_unlogged_speed() {
  static const thermal::EffectType type{
      .name = kLossAtUnloggedSpeed,
      .summary = "Loss at an unlogged speed.",
      .equation = "P_stator = (k + k_driven · [I > I_least]) · P_most",
      .reference = "",
      .nodes = {{"stator", "stator"}},
      .parameters = {{"share", "", base::Range::any(), "share of the loss at no-load speed, throughout"},
                     {"share_with_current", "", base::Range::any(), "share of the loss at no-load speed, while current flows"},
                     {"most_loss", "W", base::Range::positive(), "loss at no-load speed"},
                     {"least_current", "A", base::Range::positive(), "smallest current that turns the motor"}},
      .typical = "",
      .confounded_with = "",
      .example = {},
      .laws = thermal::laws<LossAtUnloggedSpeed>(),
  };
  return type;
}

}  // namespace

double most_loss_at_speed_W(const motor::Motor& motor) {
  const motor::MotorValues& values = motor.nominal;
  const double no_load_rad_per_s = values.no_load_speed_rad_per_s.value_or(values.nominal_voltage_V / values.torque_constant_Nm_per_A);
  const double most_W = motor::drag_torque_Nm(values) * no_load_rad_per_s;
  return most_W > 0.0 ? most_W : 0.0;
}

double expected_loss_at_speed_W(const motor::Motor& motor, bool is_driven) {
  return (is_driven ? 2.0 : 1.0) * kMean_share * most_loss_at_speed_W(motor);
}

bool turns_unseen(const estimation::MeasuredRun& run) {
  return std::ranges::any_of(run.at, [](const thermal::OperatingPoint<double>& at) { return at.unlogged_speed_share > 0.0; });
}

double least_driving_current_A(const motor::Motor& motor) { return kDrives_share * std::max(0.0, motor.nominal.no_load_current_A); }

void open_loss_at_speed(MotorModel& model, const motor::Motor& motor) {
  const double most_W = most_loss_at_speed_W(motor);
  estimation::Model& opened = model.model;
  const std::size_t first = opened.values.size();
  const std::vector<double> values{kMean_share, kMean_share, most_W, least_driving_current_A(motor)};
  opened.network.add_effect(std::string(kLossAtUnloggedSpeed), loss_at_unlogged_speed(), std::vector<std::string>{"stator"}, values);
  opened.values.insert(opened.values.end(), values.begin(), values.end());
  for (const int share : {LossAtUnloggedSpeed::share, LossAtUnloggedSpeed::share_with_current}) {
    model.nuisances.push_back(static_cast<int>(opened.free.size()));
    // Negative values are allowed: a bound at 0 would bias the other parameters.
    constexpr double kFar = 10.0;
    opened.set_free({.place = static_cast<int>(first) + share, .by_log = false, .scale = 1.0, .low = -kFar, .high = kFar}, kMean_sd_share);
  }
  for (CalibratedValue& each : model.parameters) {
    each.exponents.conservativeResizeLike(Eigen::VectorXd::Zero(opened.free_count()));
  }
  opened.least_flux_W = {0.0, kComesAndGoes_share * most_W};
}

}  // namespace heatsoak::calibration
