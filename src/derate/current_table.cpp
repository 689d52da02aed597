#include "derate/current_table.h"

#include <algorithm>
#include <cmath>

namespace heatsoak::derate {

/// Two neighbouring breakpoints and the position between them, 0 to 1. Values outside of the axis are clamped to its ends. Not in the
/// anonymous namespace, because closures of a member template, which has external linkage, capture it.
template <class Number>
struct Between {
  std::size_t below = 0;
  std::size_t above = 0;
  Number share{0};
};

namespace {

template <class Number>
Between<Number> between(const std::vector<double>& axis, Number x) {
  if (axis.size() < 2 || !(x > static_cast<Number>(axis.front()))) {
    return {};
  }
  std::size_t above = 1;
  while (above + 1 < axis.size() && x > static_cast<Number>(axis[above])) {
    ++above;
  }
  const auto low = static_cast<Number>(axis[above - 1]);
  const auto high = static_cast<Number>(axis[above]);
  return {above - 1, above, x < high ? (x - low) / (high - low) : Number{1}};
}

}  // namespace

template <class Number>
Number CurrentTable::current_of_A(Number square) const {
  const auto straight_A = static_cast<Number>(straight_below_A);
  const auto most_A = static_cast<Number>(most_current_A);
  if (!(square > Number{0})) {
    return Number{0};
  }
  const Number current = square < straight_A * straight_A ? square / straight_A : std::sqrt(square);
  return current < most_A ? current : most_A;
}

template <class Number>
Number CurrentTable::allowed_A(Number speed, Number stator, Number winding) const {
  const auto most_speed = static_cast<Number>(most_speed_rad_per_s);
  const auto last_speed = static_cast<Number>(no_current_speed_rad_per_s);
  const auto last_stator = static_cast<Number>(stator_C.back());
  if (!(speed < last_speed)) {
    return Number{0};
  }
  const auto first_winding = static_cast<Number>(winding_C.front());
  winding = winding < first_winding ? first_winding : winding;
  if (stator > last_stator) {
    winding += static_cast<Number>(winding_per_stator_K) * (stator - last_stator);
  }
  if (!(winding <= static_cast<Number>(winding_C.back())) || !(stator < Number{1e6F})) {
    return Number{0};
  }
  const Between<Number> at_speed = between(speed_rad_per_s, speed);
  const Between<Number> at_stator = between(stator_C, stator);
  const Between<Number> at_winding = between(winding_C, winding);
  const auto along_winding = [&](std::size_t i, std::size_t j) {
    const auto low = static_cast<Number>(heat_per_ohm_A2[place(i, j, at_winding.below)]);
    const auto high = static_cast<Number>(heat_per_ohm_A2[place(i, j, at_winding.above)]);
    return low + at_winding.share * (high - low);
  };
  const auto along_stator = [&](std::size_t i) {
    const Number low = along_winding(i, at_stator.below);
    return low + at_stator.share * (along_winding(i, at_stator.above) - low);
  };
  const Number low = along_stator(at_speed.below);
  const Number heat = low + at_speed.share * (along_stator(at_speed.above) - low);
  const Number current = current_of_A(heat / resistance_ratio(winding));
  return speed > most_speed ? current * ((last_speed - speed) / (last_speed - most_speed)) : current;
}

double CurrentTable::largest_A() const {
  double most_A2 = 0.0;
  for (std::size_t place = 0; place < heat_per_ohm_A2.size(); ++place) {
    most_A2 = std::max(most_A2, square_A2(place));
  }
  return current_of_A(most_A2);
}

template float CurrentTable::allowed_A<float>(float, float, float) const;
template double CurrentTable::allowed_A<double>(double, double, double) const;
template double CurrentTable::current_of_A<double>(double) const;

}  // namespace heatsoak::derate
