#include "calibration/forecast/forecast_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "estimation/evidence.h"
#include "estimation/spans.h"
#include "motor/sensor_effect.h"

namespace heatsoak::calibration {
namespace {

/// Effects whose heat is proportional to their first parameter.
constexpr std::array<std::string_view, 4> kHeatEffects{"copper_loss", "no_load_loss", "input_power_loss", "remaining_loss"};

/// Lower bound of a fault's size as a share of its prior median. The declared lower bound may be 0, which has no logarithm.
constexpr double kLeast_share = 0.02;

const thermal::EffectInPlace* effect_named(const thermal::Network& network, std::string_view name) {
  const auto found = std::ranges::find(network.effects(), name, &thermal::EffectInPlace::name);
  return found == network.effects().end() ? nullptr : &*found;
}

}  // namespace

ForecastModel::ForecastModel(MotorModel model, std::vector<FreeFault> faults)
    : motor_(std::move(model)), faults_(std::move(faults)) {
  find_ties();
  find_heat();
  for (const estimation::FreeParameter& free : motor_.model.free) {
    wanted_.push_back(free.place);
  }
  std::ranges::transform(ties_, std::back_inserter(wanted_), &Tie::place);
  wanted_.insert(wanted_.end(), heat_places_.begin(), heat_places_.end());
  const Eigen::Index inner = motor_.model.free_count();
  const auto all = inner + static_cast<Eigen::Index>(faults_.size());
  prior_ = {Eigen::VectorXd::Zero(all), Eigen::MatrixXd::Zero(all, all)};
  prior_.mean.head(inner) = motor_.model.prior.mean;
  prior_.precision.topLeftCorner(inner, inner) = motor_.model.prior.precision;
  for (std::size_t i = 0; i < faults_.size(); ++i) {
    const Eigen::Index own = inner + static_cast<Eigen::Index>(i);
    prior_.mean[own] = std::log(faults_[i].size);
    prior_.precision(own, own) = 1.0 / (faults_[i].prior_sd * faults_[i].prior_sd);
  }
}

void ForecastModel::find_ties() {
  const thermal::EffectInPlace* const implicit = effect_named(network(), kImplicitPowerLoss);
  for (const thermal::EffectInPlace& effect : network().effects()) {
    // Only one other effect may take a share of the input power; with more, all shares stay as in the file.
    if (implicit && &effect != implicit && effect.type == implicit->type) {
      ties_.push_back({implicit->parameter_index.front(), effect.parameter_index.front()});
    }
  }
}

void ForecastModel::find_heat() {
  for (const thermal::EffectInPlace& effect : network().effects()) {
    if (std::ranges::find(kHeatEffects, effect.type->name) != kHeatEffects.end()) {
      heat_places_.push_back(effect.parameter_index.front());
    }
  }
}

Eigen::VectorXd ForecastModel::start() const {
  Eigen::VectorXd theta = prior_.mean;
  theta.head(motor_.model.free_count()) = motor_.model.theta();
  return theta;
}

Eigen::VectorXd ForecastModel::within_bounds(Eigen::VectorXd theta) const {
  const estimation::Model& model = motor_.model;
  for (Eigen::Index i = 0; i < model.free_count(); ++i) {
    const estimation::FreeParameter& free = model.free[static_cast<std::size_t>(i)];
    theta[i] = std::clamp(theta[i], model.theta_of(i, free.low), model.theta_of(i, free.high));
  }
  for (std::size_t i = 0; i < faults_.size(); ++i) {
    const base::Range& range = faults_[i].type->size.range;
    double& own = theta[model.free_count() + static_cast<Eigen::Index>(i)];
    own = std::clamp(own, std::log(std::max(range.low, kLeast_share * faults_[i].size)), std::log(range.high));
  }
  return theta;
}

std::vector<double> ForecastModel::values_in(const estimation::MeasuredRun& run, const Eigen::VectorXd& theta,
                                             double log_heat_ratio) const {
  std::vector<double> values = motor_.model.values_at(theta.head(motor_.model.free_count()));
  const auto at = [&](int place) -> double& { return values[static_cast<std::size_t>(place)]; };
  for (const Tie& tie : ties_) {
    at(tie.place) = 1.0 - at(tie.of);
  }
  for (const int place : heat_places_) {
    at(place) *= std::exp(log_heat_ratio);
  }
  for (const estimation::ConditionalTerm& each : motor_.model.conditional) {
    at(each.place) = run.has(each.condition) ? at(each.place) : each.off_value;
  }
  return values;
}

estimation::LinearisedRun ForecastModel::along(const estimation::MeasuredRun& run, const Eigen::VectorXd& theta, double log_heat_ratio,
                                               std::span<const double> start_C) const {
  const estimation::Model& model = motor_.model;
  const Eigen::Index inner = model.free_count();
  const std::vector<double> values = values_in(run, theta, log_heat_ratio);
  estimation::LinearisedRun out = estimation::linearise(network(), values, wanted_, model.flux_nodes, start_C, run);
  const estimation::Columns by_value = std::move(out.by_parameter);
  out.by_parameter.setZero(by_value.rows(), count() + 1);
  out.by_parameter.leftCols(inner) = estimation::by_theta(model, theta.head(inner), by_value.leftCols(inner));
  const auto position = [&](int place) { return std::ranges::find(wanted_.begin(), wanted_.begin() + inner, place) - wanted_.begin(); };
  // These columns are multiplied by exp(log_heat_ratio) below.
  for (std::size_t i = 0; i < ties_.size(); ++i) {
    if (const Eigen::Index of = position(ties_[i].of); of < inner) {
      out.by_parameter.col(of) -= model.slope_of(of, theta[of]) * by_value.col(inner + static_cast<Eigen::Index>(i));
    }
  }
  const Eigen::Index first_heat = inner + static_cast<Eigen::Index>(ties_.size());
  for (std::size_t i = 0; i < heat_places_.size(); ++i) {
    const Eigen::Index column = first_heat + static_cast<Eigen::Index>(i);
    if (const Eigen::Index own = position(heat_places_[i]); own < inner) {
      out.by_parameter.col(own) *= std::exp(log_heat_ratio);
    }
    out.by_parameter.col(count()) += values[static_cast<std::size_t>(heat_places_[i])] * by_value.col(column);
  }
  for (const estimation::ConditionalTerm& each : motor_.model.conditional) {
    if (const Eigen::Index own = position(each.place); own < inner && !run.has(each.condition)) {
      out.by_parameter.col(own).setZero();
    }
  }
  for (std::size_t i = 0; i < faults_.size(); ++i) {
    const Eigen::Index own = inner + static_cast<Eigen::Index>(i);
    const motor::SensorFault fault{faults_[i].type, std::exp(theta[own])};
    for (Eigen::Index sensor = 0; sensor < out.sensors(); ++sensor) {
      if (run.sensors[static_cast<std::size_t>(sensor)].signal == fault.type->signal) {
        const std::vector<double> by_size = fault.type->law.by_size(run.time_s, fault.size, estimation::as_span(out.sensor_C.col(sensor)));
        estimation::add_fault(fault, sensor, run, out);
        out.by_parameter(Eigen::seq(sensor, out.residual_K.size() - 1, out.sensors()), own) = fault.size * estimation::as_vector(by_size);
      }
    }
  }
  return out;
}

estimation::DecidedStart ForecastModel::decided_start(const estimation::MeasuredRun& run, const Eigen::VectorXd& theta) const {
  const estimation::RunFrom from = [&](std::span<const double> start_C, const estimation::MeasuredRun& part) {
    return along(part, theta, 0.0, start_C);
  };
  return estimation::decided_start(network(), estimation::start_of(network(), run), run, from);
}

}  // namespace heatsoak::calibration
