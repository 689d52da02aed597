// Figures of the file that the runs contradict: another mounting, another motor of the type, a terminal that has worked loose. A file that
// was calibrated knows its figures well, and what has changed since then must not pass for an effect.
#pragma once

#include <optional>
#include <string>

#include "identify/attribution/evidence_table.h"
#include "identify/attribution/extended_model.h"

namespace heatsoak {

/// A free parameter of the model that is better known than a sheet knows it, given back the doubt of a sheet.
struct ChangedFigure {
  Eigen::Index coordinate = 0;  ///< of θ
  std::string name;             ///< of the network's parameter, "stator_ambient.thermal_resistance"
  std::string unit;
  double gain_nats = 0.0;  ///< of the doubt, beside the file's own prior
  double before = 0.0;
  double value = 0.0;  ///< of the final fit, with its 95 % interval
  double low = 0.0;
  double high = 0.0;
};

/// Prior with the doubt of a data sheet added to one coordinate.
Prior with_doubt(const Prior& prior, Eigen::Index coordinate);

/// The figure whose doubt explains the runs best, from a table whose first columns are the model's coordinates; nothing where none does by
/// `least_nats`.
std::optional<ChangedFigure> most_contradicted(const ExtendedModel& model, EvidenceTable& table, const SetScore& base, double least_nats);

}  // namespace heatsoak
