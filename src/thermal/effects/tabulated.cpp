#include <algorithm>
#include <array>

#include "thermal/law.h"

namespace heatsoak::thermal::effects {
namespace {

enum Node { hot, cold, watched, reference };
enum Parameter { input, form, first_knot, last_knot, first_value };
constexpr int kKnots = 7;

/// Input signals that are no single quantity; they follow the others.
enum Regressor {
  current_speed_squared = base::kCurveSignalCount,
  temperature,
  temperature_difference,
  neighbour_difference,
  column,
  input_count = column + kLogColumns
};
constexpr std::array<base::Choice, input_count> kInputs = [] {
  std::array<base::Choice, input_count> choices{};
  for (std::size_t i = 0; i < base::kCurveSignalCount; ++i) {
    const base::SignalRow& row = base::kSignals[base::kCurveSignals[i]];
    choices[i] = {row.name, row.unit, row.curve_meaning};
  }
  choices[current_speed_squared] = {"current_speed_squared", "A rad2/s2", "product |I|·ω²"};
  choices[temperature] = {"temperature", "degC", "temperature of the node 'watched'"};
  choices[temperature_difference] = {"temperature_difference", "K", "temperature difference of the node 'watched' above 'reference'"};
  choices[neighbour_difference] = {"neighbour_difference", "K", "temperature difference of the next motor above the node 'watched'"};
  // The further places distinguish several columns of one network; a motor file always writes 'column', so they have no description.
  for (std::size_t place = 0; place < kLogColumns; ++place) {
    choices[column + place] = {
        kColumnChoices[place], "",
        place == 0 ? "column of a log, named by 'column'; if it is not known, the hottest value of the curve is used" : ""};
  }
  return choices;
}();
constexpr int speed = 0;
static_assert(kInputs[speed].name == "speed");

enum Form { heat_into, per_copper_loss, per_difference, per_current, per_speed };
constexpr std::array kForms{
    base::Choice{"heat", "W", "curve of the heat into 'hot'"},
    base::Choice{"per_copper_loss", "", "curve of the heat into 'hot' per copper loss"},
    base::Choice{"per_difference", "W/K", "curve of the conductance from 'hot' to 'cold'"},
    base::Choice{"per_current", "W/A", "curve of the heat into 'hot' per rms current"},
    base::Choice{"per_speed", "W s/rad", "curve of the heat into 'hot' per mean of |ω|"},
};

template <class S>
S value_of_input(const Situation<S>& x) {
  const int chosen_input = chosen(x.parameter(input));
  switch (chosen_input) {
    case current_speed_squared:
      return x.at.current_rms_A * x.at.speed_rms_rad_per_s * x.at.speed_rms_rad_per_s;
    case temperature:
      return x.temperature_C(watched);
    case temperature_difference:
      return x.difference_K(watched, reference);
    case neighbour_difference:
      return x.at.knows(kNeighbour) ? S(difference_K(x.at.neighbour_C, x.temperature_C(watched))) : S(0.0);
    default:
      if (chosen_input >= column) {
        return x.at.*kQuantities<S>[column_row(static_cast<std::size_t>(chosen_input - column))].value;
      }
      return x.at.*kQuantities<S>[base::kCurveSignals[static_cast<std::size_t>(chosen_input)]].value;
  }
}

/// The value of the curve that gives the highest temperature: the largest heat, or the smallest conductance.
template <class S>
S hottest(const Situation<S>& x) {
  const double sign = chosen(x.parameter(form)) == per_difference ? -1.0 : 1.0;
  S most = sign * x.parameter(first_value);
  for (int knot = 1; knot < kKnots; ++knot) {
    most += positive_part(sign * x.parameter(first_value + knot) - most);
  }
  return sign * most;
}

/// Share of a knot's value in the curve, at a distance in knots.
template <class S>
S knot_weight(const S& distance) {
  return named("knot_weight_ratio", positive_part(named("one_minus_knot_distance_ratio", 1.0 - distance)));
}

struct Tabulated {
  template <class S>
  static void book(const Situation<S>& x, HeatBook<S>& heat) {
    constexpr double kLast = kKnots - 1;
    constexpr double kNoSpan = 1e-30;  // avoids 0/0 if the first and last knot coincide; the curve is then its first value
    const S span = x.parameter(last_knot) - x.parameter(first_knot);
    const S place = named("curve_place_ratio", kLast * (value_of_input(x) - x.parameter(first_knot)) * span / (span * span + kNoSpan));
    const S before_end = named("places_before_end_ratio", kLast - named("place_after_start_ratio", positive_part(place)));
    const S within = named("place_within_knots_ratio", kLast - named("places_left_ratio", positive_part(before_end)));
    S curve = x.parameter(first_value) * knot_weight(within);
    for (int knot = 1; knot < kKnots; ++knot) {
      const S offset = named("knot_offset_ratio", within - static_cast<double>(knot));
      curve += x.parameter(first_value + knot) * knot_weight(S(named("knot_distance_ratio", magnitude(offset))));
    }
    if (const int own = chosen(x.parameter(input)) - column; own >= 0 && !x.at.knows(column_bit(static_cast<std::size_t>(own)))) {
      curve = hottest(x);
    }
    switch (chosen(x.parameter(form))) {
      case heat_into:
        heat.source(hot, curve);
        break;
      case per_copper_loss:
        heat.source(hot, named("curve_loss_ratio", curve) * x.at.copper_loss_W);
        break;
      case per_current:
        heat.source(hot, named("curve_voltage_V", curve) * x.at.current_rms_A);
        break;
      case per_speed:
        heat.source(hot, named("curve_torque_Nm", curve) * x.at.speed_mean_rad_per_s);
        break;
      default:
        heat.flow(hot, cold, named("curve_conductance_W_per_K", curve) * x.difference_K(hot, cold));
    }
  }
};

/// Signals of the input signal, plus those of the form.
std::vector<Signal> needs_of(std::span<const double> values) {
  static const std::array<std::vector<Signal>, kForms.size()> kOfForm{{{}, {Signal::current}, {}, {Signal::current}, {Signal::speed}}};
  const auto chosen_input = static_cast<std::size_t>(values[input]);
  std::vector<Signal> needed;
  if (chosen_input < base::kCurveSignalCount) {
    needed = {base::kSignals[base::kCurveSignals[chosen_input]].signal.value()};
  } else if (chosen_input == current_speed_squared) {
    needed = {Signal::current, Signal::speed};
  } else if (chosen_input == neighbour_difference) {
    needed = {Signal::neighbour_temperature};
  }
  const std::vector<Signal>& besides = kOfForm[static_cast<std::size_t>(values[form])];
  needed.insert(needed.end(), besides.begin(), besides.end());
  return needed;
}

std::vector<Signal> all_signals() {
  std::vector<Signal> all;
  for (std::size_t i = 0; i < kSignalCount; ++i) {
    all.push_back(static_cast<Signal>(i));
  }
  return all;
}

std::vector<base::ParameterSpec> parameters() {
  std::vector<base::ParameterSpec> specs{
      base::ParameterSpec::choice("driver", kInputs, "input signal of the curve"),
      base::ParameterSpec::choice("form", kForms, "meaning of the curve's values"),
      {"first_knot", "", base::Range::any(), "input signal at value_1", {}, input},
      {"last_knot", "", base::Range::any(), "input signal at value_7; the others are evenly spaced between", {}, input}};
  constexpr std::array<std::string_view, kKnots> kKeys{"value_1", "value_2", "value_3", "value_4", "value_5", "value_6", "value_7"};
  for (const std::string_view key : kKeys) {
    specs.push_back({key, "", base::Range::non_negative(), "value of the curve", {}, form});
  }
  return specs;
}

}  // namespace

EffectType tabulated() {
  return {
      .name = {},
      .summary = "A measured curve over one signal, for an effect that has no law yet. Outside its knots the curve keeps its end values.",
      .equation =
          "P = g(d), g(d)·P_copper, g(d)·I, g(d)·|ω| or g(d)·(T_hot − T_cold); g ≥ 0 is linear between seven knots and constant outside",
      .reference = "linear interpolation; a curve that is nowhere negative can only generate heat, or move it from hot to cold",
      .nodes = {{"hot", "stator"}, {"cold", "ambient"}, {"watched", "stator"}, {"reference", "ambient"}},
      .parameters = parameters(),
      .typical = "0.1 to 3 W, 0.05 to 1 of the copper loss, 0.02 to 0.3 W/K",
      .confounded_with =
          "Confounded with every effect over the same signal: the curve fits where a law does, but is not valid beyond the values at which "
          "it was measured.",
      // 2.5 rad/s of 10 lie at knot 1.5 of 6, half way between value_2 = 1 W/K and value_3 = 3 W/K: 2 W/K · (60 − 50) K = 20 W
      .example = {.parameters = {speed, per_difference, 0.0, 10.0, 0.0, 1.0, 3.0, 3.0, 3.0, 3.0, 3.0},
                  .at = {.speed_mean_rad_per_s = 2.5},
                  .temperature_C = {60.0, 50.0, 60.0, 50.0},
                  .expected_heat_W = {-20.0, 20.0, 0.0, 0.0}},
      .laws = laws<Tabulated>(),
      .needs = all_signals(),
      .candidacy = {.size_parameter = {},
                    .variants = {{speed, heat_into, 0.0, 600.0, 0.0, 0.2, 0.5, 1.0, 1.5, 2.0, 2.5}},
                    .family = {},
                    .experiment = {}},
      .needs_of = needs_of,
  };
}

}  // namespace heatsoak::thermal::effects
