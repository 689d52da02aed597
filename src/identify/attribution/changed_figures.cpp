#include "identify/attribution/changed_figures.h"

#include <cmath>

#include "identify/calibration/motor_model.h"

namespace heatsoak {
namespace {

/// Better known than this (of the logarithm) is more than a sheet tells.
constexpr double kWellKnown_sd = 0.5 * kSheet_sd;

}  // namespace

Prior with_doubt(const Prior& prior, Eigen::Index coordinate) {
  // The inverse of (Λ⁻¹ + s²·e·eᵀ), which needs no Λ⁻¹ (Sherman and Morrison 1950).
  Prior doubted = prior;
  const Eigen::VectorXd column = prior.precision.col(coordinate);
  doubted.precision -= column * column.transpose() * (kSheet_sd * kSheet_sd / (1.0 + kSheet_sd * kSheet_sd * column[coordinate]));
  return doubted;
}

std::optional<ChangedFigure> most_contradicted(const ExtendedModel& model, EvidenceTable& table, const SetScore& base, double least_nats) {
  std::optional<ChangedFigure> most;
  const Prior own = model.prior();
  const Eigen::VectorXd theta = model.theta();
  const std::span<const NetworkParameter> parameters = model.model.network.parameters();
  for (Eigen::Index i = 0; i < model.model.free_count(); ++i) {
    const FreeParameter& free = model.model.free[static_cast<std::size_t>(i)];
    if (!free.by_log || !(own.precision(i, i) * kWellKnown_sd * kWellKnown_sd > 1.0)) {
      continue;
    }
    const Prior doubted = with_doubt(own, i);
    const double gain_nats = table.best_nats_with({doubted.precision, doubted.mean - theta}, base) - base.evidence_nats;
    if (gain_nats >= (most ? most->gain_nats : least_nats)) {
      const auto place = static_cast<std::size_t>(free.place);
      most = ChangedFigure{i, parameters[place].name, std::string(parameters[place].unit), gain_nats, model.model.values[place]};
    }
  }
  return most;
}

}  // namespace heatsoak
