#include "derate/derating_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "base/number_ranges.h"
#include "derate/export_text.h"
#include "derate/power_off.h"
#include "derate/rate_lines.h"
#include "motor/datasheet_network.h"

namespace heatsoak::derate {
namespace {

using Json = nlohmann::ordered_json;

Json rounded(double value, int decimals) {
  const double scale = std::pow(10.0, decimals);
  return std::isfinite(value) ? Json(std::round(value * scale) / scale) : Json();
}

bool is_datasheet_alone(const Derating& derating) {
  return derating.observer.state_count() == 2 && std::ranges::all_of(derating.effects, [](const ActingEffect& effect) {
           return std::ranges::find(motor::kDatasheetEffects, effect.name) != motor::kDatasheetEffects.end();
         });
}

/// Shortest decimal that reads back as the same number; in parentheses if negative.
std::string number_text(double value) {
  std::string text = fmt::format("{}", value);
  text += text.find_first_of(".e") == std::string::npos ? ".0" : "";
  return value < 0.0 ? fmt::format("({})", text) : text;
}

/// The laws of a motor with effects of its own as statements of C, traced as for every generated guard.
Json rate_lines_json(const Derating& derating) {
  static const LineStyle kStyle{
      .literal = number_text,
      .signal = [](observed::Signal signal) { return std::string(observed::signals()[static_cast<std::size_t>(signal)].name); },
      .square_root = "sqrt",
      .number = "double",
      .exponential = "exp",
      .power = "positive_power"};
  const std::string text = RateLines(derating.observer, derating.observer.rate_steps(), kStyle).text();
  Json lines = Json::array();
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    lines.push_back(text.substr(text.find_first_not_of(' ', begin), end - text.find_first_not_of(' ', begin)));
    begin = end + 1;
  }
  return {
      {"language",
       "C with <math.h>, in order; state_C in the order of 'nodes', other inputs as in 'signals'; positive_power(x, y) is pow(x, y) for "
       "x > 0, else 0"},
      {"heat_reserve_ratio_r", rounded_to_12_digits(derating.observer.heat_safety_factor())},
      {"rate_lines", lines}};
}

Json effect_json(const ActingEffect& effect) {
  Json parameters = Json::array();
  for (const EffectParameter& each : effect.parameters) {
    parameters.push_back({{"key", each.key},
                          {"value", each.choice.empty() ? Json(rounded_to_12_digits(each.value)) : Json(each.choice)},
                          {"unit", each.unit}});
  }
  return {{"id", effect.name},           {"type", effect.type},
          {"equation", effect.equation}, {"nodes", effect.nodes},
          {"parameters", parameters},    {"column_at_its_hottest", effect.column.empty() ? Json() : Json(effect.column)}};
}

/// The equations are included, so that the numbers can be used without another file.
Json observer_json(const Derating& derating) {
  if (!is_datasheet_alone(derating)) {
    return rate_lines_json(derating);
  }
  const motor::MotorValues& motor = derating.nominal;
  return {
      {"winding_K_per_s", "(r*R25*(1+alpha*(T_winding-25))*(k*I)^2 - (T_winding-T_stator)/R_winding_stator)/C_winding"},
      {"stator_K_per_s",
       "(r*torque_constant*no_load_current*|w| + (T_winding-T_stator)/R_winding_stator - (T_stator-T_ambient)/R_stator_ambient)/C_stator"},
      {"heat_reserve_ratio_r", rounded_to_12_digits(derating.observer.heat_safety_factor())},
      {"heating_current_ratio_k", rounded_to_12_digits(derating.heating_current_ratio)},
      {"terminal_resistance_25C_ohm", rounded_to_12_digits(motor.terminal_resistance_ohm)},
      {"temperature_coefficient_per_K", rounded_to_12_digits(motor.temperature_coefficient_per_K)},
      {"torque_constant_Nm_per_A", rounded_to_12_digits(motor.torque_constant_Nm_per_A)},
      {"no_load_current_A", rounded_to_12_digits(motor.no_load_current_A)},
      {"thermal_resistance_winding_stator_K_per_W", rounded_to_12_digits(motor.thermal_resistance_winding_stator_K_per_W)},
      {"thermal_resistance_stator_ambient_K_per_W", rounded_to_12_digits(motor.thermal_resistance_stator_ambient_K_per_W)},
      {"heat_capacity_winding_J_per_K",
       rounded_to_12_digits(motor.thermal_time_constant_winding_s / motor.thermal_resistance_winding_stator_K_per_W)},
      {"heat_capacity_stator_J_per_K",
       rounded_to_12_digits(motor.thermal_time_constant_stator_s / motor.thermal_resistance_stator_ambient_K_per_W)}};
}

Json words_of(const std::vector<motor::LintFinding>& findings) {
  Json all = Json::array();
  for (const motor::LintFinding& each : findings) {
    all.push_back(motor::words_of(each));
  }
  return all;
}

Json default_spreads(const Derating& derating) {
  Json rows = Json::array();
  for (const motor::DefaultSpread& each : derating.default_spreads) {
    rows.push_back({{"motor", derating.motor_id},
                    {"key", each.key},
                    {"origin", base::to_string(each.origin)},
                    {"low_ratio", rounded(each.spread.low / each.value, 4)},
                    {"high_ratio", rounded(each.spread.high / each.value, 4)}});
  }
  return rows;
}

/// Returns the shortest decimal number that is the same in single precision, in which the controller computes.
double in_single_precision(double value) { return std::strtod(fmt::format("{}", static_cast<float>(value)).c_str(), nullptr); }

Json table_json(const CurrentTable& table) {
  // Rounded down, so that a table read back from the file never allows more current.
  const auto rounded_down = [](double value) { return std::floor(value * 1e4) / 1e4; };
  Json current = Json::array();
  Json heat = Json::array();
  for (std::size_t place = 0; place < table.heat_per_ohm_A2.size(); ++place) {
    current.push_back(rounded_down(table.current_of_A(table.square_A2(place))));
    heat.push_back(rounded_down(table.heat_per_ohm_A2[place]));
  }
  const auto rounded_up = [](double value, double per_unit) { return std::ceil(value * per_unit) / per_unit; };
  const TableBound& bound = table.bound;
  return {
      {"order", {"speed_rad_per_s", "stator_C", "winding_C"}},
      {"units",
       {{"speed_rad_per_s", "rad/s"}, {"stator_C", "degC"}, {"winding_C", "degC"}, {"current_A", "A"}, {"heat_per_ohm_A2", "A^2"}}},
      {"interpolation",
       "Interpolate heat_per_ohm_A2 linearly between grid points and hold it below the first one; an axis with one grid point has no "
       "influence. Divide by the resistance of the winding as a ratio to "
       "that at 25 degC, resistance_at_0C_ratio + resistance_ratio_per_K * winding_C; a winding below its first grid point counts as that "
       "point. The current is the square root of the quotient, "
       "or quotient/straight_below_A if that is below straight_below_A; it is at most most_current_A. A stator temperature above the last "
       "grid point adds winding_per_stator_K times the excess to the "
       "winding temperature; above the last grid point of the winding the current is 0 A. Above most_speed_rad_per_s the current falls "
       "linearly to 0 A at no_current_speed_rad_per_s. current_A holds at the grid points only: they are too far apart to interpolate it."},
      {"resistance_at_0C_ratio", in_single_precision(table.resistance_at_0C_ratio)},
      {"resistance_ratio_per_K", in_single_precision(table.resistance_ratio_per_K)},
      {"most_current_A", rounded_down(table.most_current_A)},
      {"straight_below_A", in_single_precision(table.straight_below_A)},
      {"most_speed_rad_per_s", table.most_speed_rad_per_s},
      {"no_current_speed_rad_per_s", table.no_current_speed_rad_per_s},
      {"winding_per_stator_K", table.winding_per_stator_K},
      {"bound",
       {{"shortfall_ratio", bound.shortfall_ratio},
        {"winding_slope_A_per_K", rounded_up(bound.winding_slope_A_per_K, 1e3)},
        {"stator_slope_A_per_K", rounded_up(bound.stator_slope_A_per_K, 1e3)},
        {"speed_slope_A_s_per_rad", rounded_up(bound.speed_slope_A_s_per_rad, 1e4)}}},
      {"speed_rad_per_s", table.speed_rad_per_s},
      {"stator_C", table.stator_C},
      {"winding_C", table.winding_C},
      {"current_A", current},
      {"heat_per_ohm_A2", heat}};
}

Json guarantee_json(const Derating& derating, const Guarantee& checked) {
  return {{"confidence", derating.options.guarantee.required_share},
          {"certainty", kCertainty_share},
          {"least_kept_share", derating.options.guarantee.required_share},
          {"samples", checked.samples},
          {"least_samples", least_samples(derating.options.guarantee)},
          {"over", checked.over},
          {"winding_peak_C",
           {{"p50", rounded(checked.winding_p50_C, 2)},
            {"p95", rounded(checked.winding_p95_C, 2)},
            {"most", rounded(checked.winding_most_C, 2)}}}};
}

Json sensor_json(const Derating& derating) {
  if (!derating.sensor) {
    return nullptr;
  }
  const SensorPlan& plan = *derating.sensor;
  Json lasting = Json::array();
  for (const LastingCurrent& each : plan.lasting) {
    lasting.push_back({{"speed_rad_per_s", rounded(each.speed_rad_per_s, 2)},
                       {"without_sensor_A", rounded(each.without_A, 3)},
                       {"with_sensor_A", rounded(each.with_A, 3)}});
  }
  return {{"kind", plan.options.kind == SensorKind::thermistor ? "thermistor" : "winding_resistance"},
          {"node", plan.observer.state_names()[static_cast<std::size_t>(plan.options.node)]},
          {"accuracy_K", plan.options.accuracy_K},
          {"lag_s", plan.options.lag_s},
          {"heat_reserve_ratio", rounded(plan.observer.heat_safety_factor(), 4)},
          {"winding_speed_ratio", rounded(plan.winding_speed_ratio, 4)},
          {"guarantee", guarantee_json(derating, plan.guarantee)},
          {"samples", plan.guarantee.samples},
          {"over", plan.guarantee.over},
          {"winding_peak_C", {{"p95", rounded(plan.guarantee.winding_p95_C, 2)}, {"most", rounded(plan.guarantee.winding_most_C, 2)}}},
          {"table", table_json(plan.table)},
          {"honest_dropped", plan.dropped},
          {"lying",
           {{"most_gain_A", rounded(plan.most_gain_A, 3)},
            {"nominal_winding_C", rounded(plan.sensor_fault_nominal_C, 1)},
            {"over", plan.sensor_fault_over}}},
          {"lasting_current", lasting}};
}

Json power_off_json(const Derating& derating) {
  const PowerOffReport report = power_off_report(derating);
  Json cases = Json::array();
  for (const PowerOffCase& each : report.cases) {
    Json allowed = Json::array();
    for (const double current_A : each.allowed_A) {
      allowed.push_back(rounded(current_A, 3));
    }
    cases.push_back({{"after", each.name}, {"off_s", each.off_s ? Json(*each.off_s) : Json()}, {"allowed_A", allowed}});
  }
  Json start_C = Json::array();
  for (const double node_C : report.start_C) {
    start_C.push_back(rounded(node_C, 2));
  }
  return {{"before_C", start_C}, {"allowed_after_s", kPowerOffMoments_s}, {"cases", cases}};
}

}  // namespace

nlohmann::ordered_json derating_json(const Derating& derating) {
  Json effects = Json::array();
  for (const ActingEffect& effect : derating.effects) {
    effects.push_back(effect_json(effect));
  }
  Json signals = Json::array();
  for (std::size_t i = 0; i < observed::kSignalCount; ++i) {
    if (derating.observer.uses(static_cast<observed::Signal>(i))) {
      signals.push_back({{"name", observed::signals()[i].name}, {"meaning", observed::signals()[i].meaning}});
    }
  }
  Json answer{{"schema", "heatsoak.derating/2"},
              {"program", derating.provenance.program_version},
              {"input_hash", {{"name", kInputHash}, {"value", derating.provenance.input_hash}}},
              {"motor", derating.motor_id},
              {"robot", derating.robot_id},
              {"data_quality", derating.data_quality},
              {"seed", derating.options.guarantee.seed},
              {"winding_limit_C", derating.rules.limits.winding_C},
              {"stator_limit_C", derating.rules.limits.stator_C ? Json(*derating.rules.limits.stator_C) : Json()},
              {"hottest_ambient_C", derating.rules.hottest_ambient_C},
              {"period_s", derating.options.period_s},
              {"approach_s", derating.rules.approach_s},
              {"heat_reserve_ratio", rounded(derating.observer.heat_safety_factor(), 4)},
              {"current_per_iq", derating.is_brushless ? Json(std::numbers::sqrt3 * std::numbers::pi / 6.0) : Json()},
              {"limp_current_A", rounded(limp_current_A(derating), 4)},
              {"conditions", derating.assumed},
              {"default_spreads", default_spreads(derating)},
              {"doubtful_values", words_of(derating.doubtful_values)},
              {"measured_power", derating.measured_power ? Json(motor::name_of(*derating.measured_power)) : Json()},
              {"unmodelled_heat_share", derating.unmodelled_heat_share ? Json(*derating.unmodelled_heat_share) : Json()},
              {"fit_conditions", derating.fit_conditions},
              {"nodes", std::vector<std::string>(derating.observer.state_names().begin(), derating.observer.state_names().end())},
              {"signals", signals},
              {"effects", effects},
              {"observer", observer_json(derating)},
              {"power_off", power_off_json(derating)},
              {"guarantee", guarantee_json(derating, derating.guarantee)},
              {"sensor", sensor_json(derating)},
              {"table", table_json(derating.table)}};
  return base::with_ranges(std::move(answer), {{"period_s", base::kNotNegative},
                                               {"approach_s", base::kNotNegative},
                                               {"limp_current_A", base::kNotNegative},
                                               {"unmodelled_heat_share", base::kShare},
                                               {"off_s", base::kNotNegative},
                                               {"allowed_after_s", base::kNotNegative},
                                               {"allowed_A", base::kNotNegative},
                                               {"confidence", base::kShare},
                                               {"certainty", base::kShare},
                                               {"least_kept_share", base::kShare},
                                               {"over_share_ci95", base::kShare},
                                               {"accuracy_K", base::kNotNegative},
                                               {"lag_s", base::kNotNegative},
                                               {"shortfall_ratio", base::kShare}});
}

}  // namespace heatsoak::derate
