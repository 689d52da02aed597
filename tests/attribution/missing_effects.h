// Effects that the examination omits from the model, with their names on the answer sheet. Each effect is implemented a second time here,
// on the parts of the truth motor. If physics permits, it uses another exponent or place than the tool's law.
#pragma once

#include <string_view>
#include <vector>

#include "truth_motor.h"

namespace heatsoak::attribution::truth {

enum class Visibility { visible, faint };  ///< faint: the base parameters or the noise hide the effect, see the note of each

struct Subject {
  std::string_view name;  ///< name on the answer sheet; an effect of the tool
  Visibility visibility;
  /// Other names for the same heat in the same place, which are also right.
  std::vector<std::string_view> same;
  /// Creates the effect; `size` 1 is typical for a motor of about 50 W.
  Missing (*make)(double size);
  /// True value of the tool's size parameter at size 1, or 0 if the two laws differ in form on purpose.
  double true_value = 0.0;
};
const std::vector<Subject>& subjects();

/// Combines both effects.
Missing together(Missing one, const Missing& other);

/// Heat that follows a measured signal by a curve that no law of the tool can represent.
struct Outsider {
  std::string_view name;
  std::string_view node;
  std::vector<std::string_view> regressors;  ///< right answers: these signals are nearly proportional to each other in the runs
  Missing (*make)(double size);
  std::string_view times = "";  ///< second signal that the heat is proportional to
};
const std::vector<Outsider>& outsiders();
/// Heat that follows no logged signal: every named signal is wrong.
const std::vector<Outsider>& strangers();

}  // namespace heatsoak::attribution::truth
