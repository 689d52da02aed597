// Report of an accepted effect: parameters with intervals, heat in watts, and the catalogue's description.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "attribution/selection.h"

namespace heatsoak::diagnosis {

struct FittedParameter {
  std::string name;
  std::string unit;
  double value = 0.0;
  double low = 0.0;  ///< lower end of the 95 % interval; equal to the value if there is no interval
  double high = 0.0;
  bool is_at_bound = false;  ///< the search stopped at its own bound; there is no interval
};

struct FoundEffect {
  std::string id;    ///< name in the catalogue; "tabulated" for curves
  std::string name;  ///< name of the instance in the model file; empty for sensor errors and run deviations
  std::string node;
  std::string description;  ///< one line from the catalogue
  std::vector<FittedParameter> parameters;
  std::map<std::string, std::string> condition;             ///< the effect acts only in runs with this condition; empty: in all runs
  std::vector<estimation::Condition> same_conditions = {};  ///< those of other keys that hold in exactly the same runs
  std::vector<std::string> signals;                         ///< signals of a curve; else empty
  double mean_W = 0.0;                                      ///< mean magnitude over the runs in which it acts
  double peak_W = 0.0;                                      ///< 99th percentile of the magnitude
  bool has_heat = true;                                     ///< false: a sensor error
  double probability = 0.0;                                 ///< posterior probability of the effect's family
  double gain_nats = 0.0;                                   ///< loss of ln P without the effect's family
  double delta_bic = 0.0;                                   ///< −2 · gain_nats
  double p_value = 1.0;                                     ///< p-value of the model without the effect's family
  double visibility_ratio = 0.0;
  std::vector<std::string> confusable_with;  ///< effects confounded with it in these runs
  std::string confounded_with;               ///< effects confounded with it in general, from the catalogue
  bool is_from_catalogue = true;
};

/// Returns the effect of that name, or null if there is none.
const thermal::EffectInPlace* effect_named(const thermal::Network& network, const std::string& name);

/// Describes one accepted term. `runs` must be the runs of the selection.
FoundEffect found_effect(const attribution::AcceptedTerm& term, const attribution::Selection& selection,
                         const std::vector<estimation::MeasuredRun>& runs);

}  // namespace heatsoak::diagnosis
