#include "derate/integer_form/quantised_table.h"

#include <algorithm>
#include <cmath>

namespace heatsoak::derate::integer_form {
namespace {

constexpr double kPerUnit = 1000.0;
constexpr int kRatioBits = 20;
constexpr int kRiseBits = 40;

std::int32_t thousandths_down(double value) { return static_cast<std::int32_t>(std::floor(kPerUnit * value)); }
std::int32_t thousandths_up(double value) { return static_cast<std::int32_t>(std::ceil(kPerUnit * value)); }

std::vector<std::int32_t> axis_of(const std::vector<double>& places) {
  std::vector<std::int32_t> points(places.size());
  std::ranges::transform(places, points.begin(), thousandths_down);
  return points;
}

}  // namespace

QuantisedTable::QuantisedTable(const CurrentTable& exact)
    : speed_mrad_per_s(axis_of(exact.speed_rad_per_s)),
      stator_mC(axis_of(exact.stator_C)),
      winding_mC(axis_of(exact.winding_C)),
      resistance_at_first(static_cast<std::int32_t>(std::ceil(std::ldexp(exact.resistance_ratio(exact.winding_C.front()), kRatioBits)))),
      resistance_per_mK(static_cast<std::int32_t>(std::ceil(std::ldexp(exact.resistance_ratio_per_K / kPerUnit, kRiseBits)))),
      most_current_mA(thousandths_down(exact.most_current_A)),
      straight_below_mA(thousandths_up(exact.straight_below_A)),
      most_speed_mrad_per_s(thousandths_down(exact.most_speed_rad_per_s)),
      no_current_speed_mrad_per_s(thousandths_down(exact.no_current_speed_rad_per_s)),
      winding_per_stator_K(static_cast<std::int32_t>(std::ceil(exact.winding_per_stator_K))) {
  constexpr double kMost = 32767.0;
  constexpr double kMostHeat_A2 = 8e6;  // the reader's product fits in 64 bits; a lower heat is on the safe side
  std::vector<double> heats_mA2;
  for (const double heat_A2 : exact.heat_per_ohm_A2) {
    heats_mA2.push_back(kPerUnit * kPerUnit * std::min(heat_A2, kMostHeat_A2));
  }
  double largest_mA2 = 0.0;
  for (const double heat_mA2 : heats_mA2) {
    largest_mA2 = std::max(largest_mA2, std::abs(heat_mA2));
  }
  unit_mA2 = static_cast<std::uint32_t>(std::ceil(largest_mA2 / (kMost - 1.0)));
  for (const double heat_mA2 : heats_mA2) {
    // Subtract one unit, because the breakpoints are rounded to thousandths.
    heat.push_back(static_cast<std::int16_t>(std::floor(heat_mA2 / unit_mA2) - 1.0));
  }
}

heatsoak_integer_table QuantisedTable::table() const {
  const auto axis = [](const std::vector<std::int32_t>& points) {
    return heatsoak_integer_axis{points.data(), static_cast<std::int32_t>(points.size())};
  };
  return {.speed_mrad_per_s = axis(speed_mrad_per_s),
          .stator_mC = axis(stator_mC),
          .winding_mC = axis(winding_mC),
          .heat = heat.data(),
          .unit_mA2 = unit_mA2,
          .resistance_at_first = resistance_at_first,
          .resistance_per_mK = resistance_per_mK,
          .most_current_mA = most_current_mA,
          .straight_below_mA = straight_below_mA,
          .most_speed_mrad_per_s = most_speed_mrad_per_s,
          .no_current_speed_mrad_per_s = no_current_speed_mrad_per_s,
          .winding_per_stator_K = winding_per_stator_K};
}

CurrentTable QuantisedTable::in_units() const {
  const auto in_ones = [](const std::vector<std::int32_t>& thousandths) {
    std::vector<double> values(thousandths.size());
    std::ranges::transform(thousandths, values.begin(), [](std::int32_t each) { return each / kPerUnit; });
    return values;
  };
  CurrentTable exact{.speed_rad_per_s = in_ones(speed_mrad_per_s),
                     .stator_C = in_ones(stator_mC),
                     .winding_C = in_ones(winding_mC),
                     .heat_per_ohm_A2 = {},
                     .resistance_at_0C_ratio = 0.0,
                     .resistance_ratio_per_K = std::ldexp(kPerUnit * resistance_per_mK, -kRiseBits),
                     .most_current_A = most_current_mA / kPerUnit,
                     .straight_below_A = straight_below_mA / kPerUnit,
                     .most_speed_rad_per_s = most_speed_mrad_per_s / kPerUnit,
                     .no_current_speed_rad_per_s = no_current_speed_mrad_per_s / kPerUnit,
                     .winding_per_stator_K = static_cast<double>(winding_per_stator_K)};
  exact.resistance_at_0C_ratio = std::ldexp(1.0 * resistance_at_first, -kRatioBits) - exact.resistance_ratio(exact.winding_C.front());
  for (const std::int16_t each : heat) {
    exact.heat_per_ohm_A2.push_back(static_cast<double>(each) * unit_mA2 / (kPerUnit * kPerUnit));
  }
  return exact;
}

double quantised_shortfall_ratio(const CurrentTable& exact, const QuantisedTable& quantised) {
  constexpr int kSpeeds = 10;
  constexpr int kStators = 24;
  constexpr double kStep_K = 0.5;
  const heatsoak_integer_table table = quantised.table();
  double most_ratio = 0.0;
  for (const double speed_rad_per_s : evenly(0.0, exact.most_speed_rad_per_s, kSpeeds)) {
    for (const double stator_C : evenly(exact.stator_C.front(), exact.stator_C.back(), kStators)) {
      for (double winding_C = exact.winding_C.front(); winding_C < exact.winding_C.back(); winding_C += kStep_K) {
        const double exact_A = exact.allowed_A(speed_rad_per_s, stator_C, winding_C);
        if (exact_A >= exact.straight_below_A) {
          const double shown_A =
              heatsoak_integer_allowed_mA(&table, thousandths_up(speed_rad_per_s), thousandths_up(stator_C), thousandths_up(winding_C)) /
              kPerUnit;
          most_ratio = std::max(most_ratio, 1.0 - shown_A / exact_A);
        }
      }
    }
  }
  return most_ratio;
}

}  // namespace heatsoak::derate::integer_form
