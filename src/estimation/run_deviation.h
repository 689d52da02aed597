// Run deviations: heat input, cooling or contact that differs in some runs although no signal of the log shows it.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/parameter.h"
#include "estimation/measured_run.h"
#include "thermal/network.h"

namespace heatsoak::estimation {

/// Property that some runs share: "cooling" -> "fan", or "run" -> "run4".
using Condition = std::map<std::string, std::string>;

/// Returns "cooling=fan", or the value alone for the condition "run"; conditions of several keys are separated by commas.
std::string in_words(const Condition& condition);
/// Returns all conditions that divide the runs in two, without duplicates. A stated condition has priority over the name of a single run.
std::vector<Condition> conditions_of(std::span<const MeasuredRun> runs);

/// Returns the conditions of other stated keys that hold in exactly the same runs: the data do not show which of them matters.
std::vector<Condition> same_as(const Condition& condition, std::span<const MeasuredRun> runs);
/// Returns whether conditions ask one question: values of the same stated keys, as in "cooling=a" and "cooling=b", or of the same runs, or
/// of exactly the others. An effect of one value may then be replaced by an opposite effect of another value.
bool are_related(const Condition& a, const Condition& b, std::span<const MeasuredRun> runs);

/// A kind of deviation: it multiplies parameters of the network by 1 + d in runs with a condition.
struct RunDeviationType {
  std::string_view name;
  base::ParameterSpec size;  ///< d, dimensionless
  double usual = 0.1;        ///< typical size of d
  std::string_view node;
  std::string_view summary;
  std::string_view equation;
  std::string_view family;
  std::string_view confounded_with;
  std::string_view experiment;
  /// True for effects whose first parameter is multiplied.
  bool (*concerns)(const thermal::Network& network, const thermal::EffectInPlace& effect) = nullptr;
  /// Additional heat (negative: less) as a fraction of the heat of those effects with the deviation.
  double (*part_ratio)(double deviation_share) = nullptr;

  /// Returns the indices of the multiplied parameters in the network's list.
  [[nodiscard]] std::vector<int> places_in(const thermal::Network& network) const;
};

/// Returns all kinds. The list lives as long as the program.
const std::vector<RunDeviationType>& all_run_deviations();

/// One deviation in the runs with a condition.
struct RunDeviation {
  const RunDeviationType* type = nullptr;
  Condition condition;
  double deviation_share = 0.0;
  double spread_sd = 0.2;  ///< prior standard deviation around 0

  [[nodiscard]] bool is_same(const RunDeviationType* other, const Condition& where) const { return type == other && condition == where; }
};

}  // namespace heatsoak::estimation
