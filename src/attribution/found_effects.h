// What a selection took in, described in figures with intervals, in watts and in the catalogue's words.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "attribution/selection.h"

namespace heatsoak {

struct FittedParameter {
  std::string name;
  std::string unit;
  double value = 0.0;
  double low = 0.0;  ///< of the 95 % interval; both the value where there is none
  double high = 0.0;
  bool is_at_bound = false;  ///< of what is looked for: the search ended there, not the runs
};

struct FoundEffect {
  std::string id;    ///< of the catalogue; "tabulated" and the like for curves
  std::string name;  ///< of the instance in the model file; empty for faults of sensors and deviations of runs
  std::string node;
  std::string description;  ///< one line in words
  std::vector<FittedParameter> parameters;
  std::map<std::string, std::string> condition;  ///< the effect acts only in runs with this condition; empty: in all runs
  std::vector<std::string> drivers;              ///< of a curve
  double mean_W = 0.0;                           ///< of the magnitude over the time of the runs in which it acts
  double peak_W = 0.0;                           ///< 99 % of the magnitude
  bool has_heat = true;                          ///< false: a fault of a sensor
  double gain_nats = 0.0;                        ///< that the final model would lose without it
  double delta_bic = 0.0;                        ///< −2 · gain
  double p_value = 1.0;                          ///< of the size being 0; of a curve, of its surest knot
  double visibility_ratio = 0.0;
  std::vector<std::string> confusable_with;  ///< on these runs
  std::string confounded_with;               ///< in general, and what tells them apart: the catalogue's own words
  bool is_from_catalogue = true;
};

/// Null where there is none of that name.
const EffectInPlace* effect_named(const Network& network, const std::string& name);

/// `runs` are those of the selection.
FoundEffect found_effect(const AcceptedTerm& term, const Selection& selection, const std::vector<MeasuredRun>& runs);

}  // namespace heatsoak
