// Notes about motor files: effects whose inputs a prediction does not know, values without a stated tolerance.
#pragma once

#include <span>
#include <string>

#include "motor/motor.h"
#include "present/document.h"

namespace heatsoak::present {

/// Knowledge of the neighbours: a prediction of all motors of a robot has their temperatures, one of a single motor does not.
enum class Neighbours {
  unknown,              ///< one motor on a duty
  known,                ///< all motors in closed loop
  known_in_closed_loop  ///< both: games in closed loop, and one motor on the duty for comparison
};

/// Adds the notes that apply to every prediction with these motors: value_warnings() as warnings, inactive_effects() as notes.
void add_motor_notes(Document& document, std::span<const motor::Motor> motors, Neighbours neighbours = Neighbours::unknown);

/// Returns a line for each effect with an unknown input and how it is treated; empty if there is none.
std::string inactive_effects(std::span<const motor::Motor> motors, Neighbours neighbours = Neighbours::unknown);

/// Returns the lines of effects that depend on a log column; these use the value of the curve that gives the highest temperature.
std::string columns_at_their_hottest(std::span<const motor::Motor> motors);

/// Returns a line for each condition that was stated, and for each effect whose condition is unknown: it acts if it heats, not if it cools.
std::string effects_under_conditions(std::span<const motor::Motor> motors);

/// Returns a line for each reason why values of a motor's file may be wrong; empty if there is none: motor::doubtful_values(), a
/// calibration that found heat that the model lacks, and a fit to heat from measured power, which no duty states.
std::string value_warnings(std::span<const motor::Motor> motors);

/// Returns a line for each motor with a value that got a default spread; empty if there is none.
std::string default_spreads_text(std::span<const motor::Motor> motors);

}  // namespace heatsoak::present
