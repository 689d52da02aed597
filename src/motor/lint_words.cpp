// Sentences of the lint checks. Failures of other verbs contain them, too, so they stand below the layer of the answers.
#include <fmt/args.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include "base/quantity.h"
#include "motor/lint_clause.h"

namespace heatsoak::motor {
namespace {

struct Sentence {
  LintWords words;
  std::string_view text;  ///< one {} for each fact
};
constexpr std::array kSentences = std::to_array<Sentence>({
    {LintWords::contradictory_conventions, "these are contradictory conventions: the factor is that of {}"},
    {LintWords::speed_constant_is_wrong,
     "the no-load speed of {} agrees with the torque constant, so the speed constant should be {}; take it from the sheet"},
    {LintWords::speed_constant_is_right, "the no-load speed of {} agrees with the speed constant; {}"},
    {LintWords::constants_product, "torque constant {} times speed constant {} is {}, expected 1 within 1.5 %; {}"},
    {LintWords::mechanical_time_constant, "{} is listed, but R·J/K_t² is {} with {} and {}; expected within 2 %{}"},
    {LintWords::speed_torque_gradient, "{} is listed, but R/K_t² is {} with {} and {}; expected within 2 %{}"},
    {LintWords::stall_current, "{} is listed, but {} through {} is {}; expected within {}{}"},
    {LintWords::stall_torque, "{} is listed, K_t·U/R is {}"},
    {LintWords::no_load_speed,
     "{} is listed, but {} and {} less I_0·R give {}; expected 0.99 to 1.03 times the listed speed; check the {} constant and the voltage "
     "that the speed holds for"},
    {LintWords::max_efficiency,
     "{} % is listed, but (1 - sqrt(I_0·R/U))² is {} %; expected 0.9 to 1.015 times that; check no-load current and resistance"},
    {LintWords::heat_capacity, "{} ({} at a mass of {})"},
    {LintWords::lasting_current,
     "{} heat the motor to its winding limit in the steady state, which is {} times the stall current of {} ({} over {}); expected 0.015 "
     "to "
     "0.5 times; check the units of resistance, voltage and thermal resistances (mohm or ohm?)"},
    {LintWords::ideal_speed,
     "{} over {} is a speed without load of {}, expected 200 to 60000 rpm; check the units of both (mN m/A or N m/A?)"},
    {LintWords::no_load_heating,
     "without load {} at {} heat the stator by {} (thermal resistance {}), expected less than the {} from 25 degC to the winding limit; "
     "check the units of all three (mA or A?)"},
    {LintWords::thermal_resistance_ratio,
     "{} from stator to ambient is {} times the {} from winding to stator, expected 0.05 to 20 times; check both and their units"},
    {LintWords::heat_capacity_ratio,
     "time constant over thermal resistance gives the stator {} and the winding {}, expected at most 100 times as much in the stator, "
     "because copper is at least 3 % of a motor's mass; check the units of both time constants (s or h?) and thermal resistances"},
    {LintWords::winding_heat_capacity,
     "time constant over thermal resistance gives the winding {}, expected 10 to 150 J/(kg K) for copper and resin; check time constant, "
     "R_th1 and mass"},
    {LintWords::stator_heat_capacity,
     "time constant over thermal resistance gives the stator {}, expected 100 to 900 J/(kg K) for steel and aluminium; check time "
     "constant, R_th2 and mass"},
    {LintWords::heat_capacities_swapped,
     "the winding would store {} and the stator {}, expected more in the stator, which is heavier; are the values of winding and stator "
     "swapped?"},
    {LintWords::electrical_time_constant, "{} over {} is {}, expected 0.02 to 5 ms; check the units of both"},
    {LintWords::density, "{} in a body of {} diameter and {} length are {} kg/m3"},
    {LintWords::inertia_too_large,
     "{} is more than half of {}, which the whole mass of {} would have at the radius of {}; check unit and mass"},
    {LintWords::external_inertia_too_small,
     "{} is too little for an external rotor of a motor of {} and {} diameter, expected at least {}; {}"},
    {LintWords::temperatures_out_of_order, "{} {} is not below the {} {}; check both"},
    {LintWords::stator_limit_above_winding, "the stator limit {} is above the winding limit {}; are they swapped?"},
    {LintWords::nominal_speed_above_highest, "nominal speed {} is above the highest permissible speed {}; check both"},
    {LintWords::no_load_speed_above_highest,
     "no-load speed {} at nominal voltage is above the highest permissible speed {}: limit the voltage"},
    {LintWords::no_load_current_above_nominal, "no-load current {} is not below the nominal current {}; check both"},
    {LintWords::nominal_torque_of_current,
     "nominal torque {} is {} times K_t·I_n = {} (with {} and {}), expected 0.85 to 1.2 times; check the nominal current and the "
     "convention of the torque constant"},
    {LintWords::peak_torque_below_nominal, "peak torque {} is less than the nominal torque {}; check both"},
    {LintWords::peak_current_below_nominal, "peak current {} is less than the nominal current {}; check both"},
    {LintWords::peak_torque_of_current,
     "peak torque {} is {} times K_t·I_peak = {}, expected 0.2 (saturated) to 1.2 times; check the peak current and the convention of the "
     "torque constant"},
    {LintWords::nominal_power, "at the nominal point {} go in (U·I_n) and {} come out at the shaft (T_n·ω_n)"},
    {LintWords::nominal_power_above_input,
     "{}, but with {} of copper loss at 25 °C it takes {}, expected at most the input within 3 %; check nominal current, speed, torque and "
     "resistance"},
    {LintWords::nominal_losses_too_large,
     "{}; with {} lost in a winding at its limit and by drag it takes {} times the input, expected at most 1.08 times; check resistance, "
     "nominal current, speed and torque"},
    {LintWords::nominal_losses_too_small,
     "{}; hot copper and drag lose {}, which leaves {} unexplained, expected at most 15 % of the input; check nominal current, speed and "
     "torque"},
    {LintWords::assigned_power_too_large,
     "the assigned power is {}, but the nominal torque {} at the highest speed {} gives only {}, expected at least the assigned power; "
     "check "
     "whether it is the electrical input"},
    {LintWords::assigned_power_of_type,
     "the assigned power of the type is {}, but at {} and {} this winding takes {} and loses {} of it in the copper, so it cannot give "
     "that "
     "power at its nominal voltage; use torque and speed instead"},
    {LintWords::nominal_speed_too_high,
     "{} is listed, but from {} without load a torque of {} at {} leaves at most {}, even with cold copper; expected at most 3 % more; "
     "check resistance (between terminals?), nominal torque and speed"},
    {LintWords::nominal_speed_too_low,
     "{} is listed, but from {} without load a torque of {} at {} leaves at least {}, with hot copper and commutation of {}; expected at "
     "most 3 % less; {}"},
    {LintWords::resistance_needed, "it would take {}: check resistance, nominal torque and speed"},
    {LintWords::resistance_of_one_phase,
     "it would take {}, about twice as much: if the resistance is that of one phase, set conventions.terminal_resistance = "
     "\"phase_to_star\""},
    {LintWords::heat_without_current,
     "iron and friction loss at {} bring the winding to its limit of {} without any current, expected a nominal point of {} at {} to be "
     "possible; check no-load current and thermal resistances"},
    {LintWords::nominal_heat,
     "the nominal torque {} and the drag take {}, {} times the {} that bring the winding to {} at 25 °C ambient, expected {}; check "
     "thermal resistances, winding limit, resistance and nominal point"},
    {LintWords::copper_heat,
     "nominal current {} is {} times the {} that bring the winding to {} by copper loss alone at 25 °C ambient, expected 0.65 to 1.05 "
     "times; check thermal resistances, winding limit and resistance"},
    {LintWords::no_source,
     "{} of {} names no source; expected the ids of the sources of its derivation, or a source that states your own judgement"},
    {LintWords::confirmation_differs, "{} is {}, but {} says {}, expected agreement within the tolerance; one of the two is wrong"},
    {LintWords::estimated, "{} is estimated ({})"},
    {LintWords::no_spread,
     "{} of {} has neither tolerance nor range; expected one of the two (see motor_db/README.md). Until then a default by its origin is "
     "assumed"},
    {LintWords::zero_spread,
     "{} of {} has a tolerance or range of zero, expected the spread of real motors; state that, or leave tolerance and range out to "
     "assume a default by its origin"},
    {LintWords::narrow_spread, "{} of {} ({}) has a spread of -{} to +{} %, expected at least -{} to +{} % for a value of this origin; {}"},
    {LintWords::loss_counted_twice,
     "effects.{} is a {}, which the file's own parameters already contain, so its heat counts twice; expected only effects that the "
     "network does not have"},
    {LintWords::input_power_counted_twice,
     "effects.{} is an input_power_loss, which contains the copper loss and the no-load loss of the file's own parameters, so their heat "
     "counts twice wherever the current is known; expected it only in a file for logs without a current"},
    {LintWords::share_counted_twice,
     "effects.{} takes a share of the copper loss from the winding, but the thermal resistance between winding and stator of a data sheet "
     "refers to the whole loss, so the share counts twice and the winding appears cooler than it is; expected a resistance that was fitted "
     "together with the share"},
    {LintWords::effect_size,
     "effects.{}.{} of {} is {} times {}, expected {} to {} times; check its unit, or the logs and the effect if it was fitted"},
    {LintWords::own_conductance, "the {} of the motor's own conductances together"},
    {LintWords::room_of_stator, "the {} that bring the stator from 25 degC to the winding limit"},
    {LintWords::own_resistance, "the motor's own resistance of {}"},
    {LintWords::own_heat_capacity, "the {} of winding and stator together"},
    {LintWords::contact_radius_large, "of {} is large for wheels with a radius of {}; expected at most {}. Is {} the diameter?"},
    {LintWords::wheels_too_large, "wheels with a radius of {} {} on a circle of {}; expected at most {}. Is {} the diameter?"},
    {LintWords::nominal_above_full, "{:.4g} V is more than the full battery's {:.4g} V; expected a value between empty and full"},
    {LintWords::nominal_below_empty, "{:.4g} V is less than the empty battery's {:.4g} V; expected a value between empty and full"},
    {LintWords::empty_above_full, "{:.4g} V is not less than the full battery's {:.4g} V"},
    {LintWords::voltage_above_small_robots,
     "{:.4g} V is more than the battery of a small robot has; expected at most {:.0f} V. Six LiPo cells have 22.2 V"},
    {LintWords::mass_large,
     "{:.3g} kg are {:.0f} kg/m3 in the volume of a robot with these wheels ({} diameter); expected at most {:.0f} kg/m3, which is {:.2g} "
     "kg; check the unit"},
    {LintWords::voltage_limit_above_full, "{:.4g} V is more than the full battery's {:.4g} V; expected at most that; check the unit"},
    {LintWords::gear_ratio_small,
     "{:.4g} motor turns per wheel turn; expected at least {}: a motor that turns 3.6 times as fast as the wheel has \"3.6\""},
    {LintWords::gear_ratio_large, "{:.4g} motor turns per wheel turn; expected at most {:.0f}: 3.6 to 1 is \"3.6\""},
    {LintWords::yaw_inertia,
     "is {:.3g} times mass times contact radius squared; expected {} to {} times. Check the unit (1 kg m2 is 10 000 000 g cm2), mass and "
     "wheels.contact_radius"},
    {LintWords::wheel_inertia,
     "is {:.3g} times the robot's mass times wheel radius squared; expected at most {}. Check the unit: 1 kg cm2 is 1000 g cm2"},
    {LintWords::center_of_gravity_high, "{} is more than three times the contact radius of {}; check the unit, mm or cm"},
    {LintWords::wheel_torque_large,
     "{:.3g} mN m is {:.2g} times the weight on a wheel times its radius; expected at most {} times. Check the unit: mN m or N m"},
    {LintWords::speed_large, "{:.3g} m/s is more than small robots reach; expected at most {:.0f} m/s"},
    {LintWords::jerk_small, "{:.3g} m/s3 reaches the acceleration of {:.3g} m/s2 only after {:.1f} s; expected at most {:.0f} s"},
    {LintWords::acceleration_large, "{:.3g} m/s2 is more than the grip of wheels allows; expected at most {:.0f} m/s2"},
    {LintWords::missing_value, "{}{}"},
    {LintWords::unknown_motor,
     "there is no motor '{}'; expected an id of `heatsoak list motors`, a path such as \"./my_motor.toml\", or \"none\"{}"},
    {LintWords::no_motor_file, "there is no file {}; expected the motor's file, relative to the folder of this one"},
    {LintWords::emf_peak_of_phase, "the peak EMF of one phase (V s/rad); multiply it by sqrt(3)*3/pi = 1.654"},
    {LintWords::emf_rms_of_phase, "the RMS EMF of one phase; multiply it by 2.339"},
    {LintWords::emf_rms_between_terminals, "the RMS EMF between terminals; multiply it by 1.35"},
    {LintWords::emf_peak_between_terminals, "the peak EMF between terminals; multiply it by 3/pi = 0.955"},
    {LintWords::per_phase_peak, "a torque constant per ampere of phase peak; set conventions.torque_constant = \"per_peak_phase_ampere\""},
    {LintWords::per_phase_rms, "a torque constant per ampere of phase RMS; set conventions.torque_constant = \"per_rms_phase_ampere\""},
    {LintWords::declared_per_phase_peak,
     "a torque constant per DC ampere where the file declares per_peak_phase_ampere; set conventions.torque_constant = \"per_dc_ampere\""},
    {LintWords::declared_per_phase_rms,
     "a torque constant per DC ampere where the file declares per_rms_phase_ampere; set conventions.torque_constant = \"per_dc_ampere\""},
    {LintWords::terminals_over_phase, "sqrt(3) between phase and terminals; divide it by 1.732"},
    {LintWords::phase_over_terminals, "sqrt(3) between terminals and phase; multiply it by 1.732"},
    {LintWords::sinusoidal_current, "2/sqrt(3) between two conventions of sinusoidal current; divide it by 1.155"},
    {LintWords::sinusoidal_current_inverse, "sqrt(3)/2 between two conventions of sinusoidal current; multiply it by 1.155"},
    {LintWords::peak_over_rms, "sqrt(2) between peak and RMS; divide it by 1.414"},
    {LintWords::rms_over_peak, "sqrt(2) between RMS and peak; multiply it by 1.414"},
    {LintWords::one_phase_of_two, "2 between one phase and two in series; halve it"},
    {LintWords::two_phases_of_one, "2 between two phases in series and one; double it"},
    {LintWords::no_convention,
     "no known convention explains this factor, so one of the two was misread or badly identified; take both from one sheet"},
    {LintWords::resistance_is_of_one_phase,
     "; the factor 2 means that the resistance is of one phase: set conventions.terminal_resistance = \"phase_to_star\""},
    {LintWords::resistance_is_between_terminals,
     "; the factor 2 means that the resistance was between terminals already: set conventions.terminal_resistance = \"between_terminals\""},
    {LintWords::check_resistance, "; check resistance, torque constant and their conventions"},
    {LintWords::stall_torque_without_saturation,
     "{}; with saturation, which conventions.stall_includes_saturation declares, expected less; set it to false if the sheet's line is "
     "straight"},
    {LintWords::stall_torque_differs, "{}, expected the same within 1.5 %{}"},
    {LintWords::stall_torque_looks_saturated,
     "{}, expected the same within 1.5 %; this looks like a torque with saturation: set conventions.stall_includes_saturation = true, or "
     "check torque constant and resistance"},
    {LintWords::stall_torque_too_large, "{}, expected the same within 1.5 %; check torque constant, resistance and their conventions"},
    {LintWords::speed, "speed"},
    {LintWords::torque, "torque"},
    {LintWords::density_impossible,
     "{}, expected 1500 to 7500 kg/m3 (solid steel has 7850); check mass and dimensions of the body without shaft"},
    {LintWords::density_unusual,
     "{}, motors have 3000 to 6500 kg/m3; check the mass, and whether the length is that of the body without shaft"},
    {LintWords::check_external_rotor, "check it, and whether rotor = \"external\" is right"},
    {LintWords::check_flat_rotor, "check it, or set rotor = \"internal\" if this flat motor's rotor runs inside"},
    {LintWords::sheet_ambient, "the ambient temperature of nominal values"},
    {LintWords::winding_limit, "winding limit"},
    {LintWords::ambient_max, "highest ambient temperature"},
    {LintWords::ambient_min, "lowest ambient temperature"},
    {LintWords::highest, "highest"},
    {LintWords::possible_heat, "0.85 to 1.1 times"},
    {LintWords::usual_heat, "0.94 to 1.05 times, as on known sheets"},
    {LintWords::thermal_estimate,
     "{}: the temperature depends on it, expected a data sheet value; measure it or calibrate before you rely on it"},
    {LintWords::nominal_estimate, "{}: the nominal point depends on it, expected a data sheet value; take it from there"},
    {LintWords::spread_is_assumed, "this spread is assumed"},
    {LintWords::state_spread, "state that, or leave tolerance and range out to assume a default by its origin"},
    {LintWords::length, "{:.0f} mm"},
    {LintWords::overlap, "overlap"},
    {LintWords::are_large, "are large"},
    {LintWords::same_angle, "two wheels have the same angle; expected a different one for each wheel"},
    {LintWords::angle_above_turn, "an angle is more than a full turn; check the unit, deg or rad"},
    {LintWords::friction_missing, "is missing; a match assumes it. `heatsoak friction` measures it from a log"},
    {LintWords::match_needs_it, "; a match needs it, a prescribed duty does not"},
    {LintWords::closed_loop_needs_it, "; a match in closed loop needs it (`simulate`, `evaluate --closed-loop`, `generate core`)"},
    {LintWords::rotor_inertia_missing, "is missing{}"},
});

consteval bool is_in_order() {
  for (std::size_t i = 0; i < kSentences.size(); ++i) {
    if (kSentences[i].words != static_cast<LintWords>(i)) {
      return false;
    }
  }
  return true;
}
static_assert(is_in_order() && kSentences.back().words == LintWords::rotor_inertia_missing, "each of LintWords has a sentence");

/// Data sheets print speeds in whole rpm: 9999 rpm must not become 10000 rpm.
int digits_of(const LintQuantity& quantity) {
  constexpr int kUsual = 3;
  const int whole = std::abs(quantity.value) >= 1.0 ? 1 + static_cast<int>(std::log10(std::abs(quantity.value))) : 1;
  return quantity.unit == "rpm" ? std::max(kUsual, whole) : kUsual;
}

}  // namespace

std::string text_of(const LintClause& clause) {
  fmt::dynamic_format_arg_store<fmt::format_context> facts;
  for (const LintFact& fact : clause.facts) {
    std::visit(
        [&facts](const auto& each) {
          using Kind = std::decay_t<decltype(each)>;
          if constexpr (std::is_same_v<Kind, LintQuantity>) {
            facts.push_back(fmt::format("{} {}", base::significant(each.value, digits_of(each)), base::unit_for_display(each.unit)));
          } else if constexpr (std::is_same_v<Kind, LintNumber>) {
            facts.push_back(base::significant(each.value, each.digits));
          } else if constexpr (std::is_same_v<Kind, LintClause>) {
            facts.push_back(text_of(each));
          } else {
            facts.push_back(each);
          }
        },
        fact.is);
  }
  return fmt::vformat(kSentences.at(static_cast<std::size_t>(clause.words)).text, facts);
}

}  // namespace heatsoak::motor
