// What the examination leaves out of the model, by the name that the answer sheet has for it. Each is written here a second time,
// on the parts of the truth motor and, where physics leaves room, with another exponent or place than the tool's law.
#pragma once

#include <string_view>
#include <vector>

#include "truth_motor.h"

namespace heatsoak::truth {

enum class Visibility { visible, faint };  ///< faint: the base parameters or the data swallow it, see the note of each

struct Subject {
  std::string_view name;  ///< on the answer sheet; an effect of the tool
  Visibility visibility;
  /// Other names that are the same heat in the same place: right as well.
  std::vector<std::string_view> same;
  /// `size` 1 is typical for a motor of some 50 W.
  Missing (*make)(double size);
  /// What the tool's size parameter must be at size 1, where both laws have one form; 0 where they differ on purpose.
  double true_value = 0.0;
};
const std::vector<Subject>& subjects();

/// Both at once.
Missing together(Missing one, const Missing& other);

/// Heat that follows a measured signal by a curve that no law of the tool has.
struct Outsider {
  std::string_view name;
  std::string_view node;
  std::vector<std::string_view> drivers;  ///< any of these is right: on these runs they are near copies of each other
  Missing (*make)(double size);
  std::string_view times = "";  ///< signal that it goes with besides
};
const std::vector<Outsider>& outsiders();
/// Heat that comes and goes by nothing that is logged: no driver is right.
const std::vector<Outsider>& strangers();

}  // namespace heatsoak::truth
