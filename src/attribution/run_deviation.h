// What a run may have more or less of than the model says, where no signal of its log tells: heat that goes in, cooling.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/parameter.h"
#include "estimation/measured_run.h"
#include "thermal/network.h"

namespace heatsoak {

/// What runs have in common that others lack: "cooling" -> "fan", or "run" -> "run4".
using Condition = std::map<std::string, std::string>;

/// Parameters of the network that are worth 1 + d times as much under a condition.
struct RunDeviationType {
  std::string_view name;
  ParameterSpec size;    ///< d
  double usual = 0.1;    ///< of d
  bool is_rare = false;  ///< named for unmistakable evidence of its own only
  std::string_view node;
  std::string_view summary;
  std::string_view equation;
  std::string_view family;
  std::string_view confounded_with;
  std::string_view experiment;
  /// Effects whose first parameter it is.
  bool (*concerns)(const Network& network, const EffectInPlace& effect) = nullptr;
  /// Heat that is more (or, negative, less) than without it, as a share of what those effects book with it.
  double (*part_ratio)(double deviation_share) = nullptr;

  [[nodiscard]] std::vector<int> places_in(const Network& network) const;
};

/// The list lives as long as the program.
const std::vector<RunDeviationType>& all_run_deviations();

/// One of them in the runs of a condition.
struct RunDeviation {
  const RunDeviationType* type = nullptr;
  Condition condition;
  double deviation_share = 0.0;
  double spread_sd = 0.2;  ///< known before, around 0

  [[nodiscard]] bool is_same(const RunDeviationType* other, const Condition& where) const { return type == other && condition == where; }
};

}  // namespace heatsoak
