#include "present/measured/friction_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <type_traits>

#include "base/quantity.h"
#include "present/measured/log_words.h"

namespace heatsoak::present {
namespace {

std::string say(const friction::VoltageFrom& from) {
  switch (from.source) {
    case friction::VoltageFrom::Source::log:
      return "voltage: as the log has it";
    case friction::VoltageFrom::Source::modulation:
      return "voltage: modulation × battery voltage";
    case friction::VoltageFrom::Source::modulation_with_nominal_battery:
      return fmt::format(
          "voltage: modulation × {} V, the robot's nominal battery voltage, because the log has none; every value in V scales with it, "
          "beyond its interval",
          base::significant(from.battery_V, 3));
    case friction::VoltageFrom::Source::current:
      return "voltage: from currents, with the motor's resistance and torque constant";
    case friction::VoltageFrom::Source::current_without_sign:
      return "voltage: from currents without sign (that of the speed is used), with the motor's resistance and torque constant";
  }
  return "";
}

std::string say(const friction::DragExceedsOffset& of) {
  return fmt::format("0 is written for b of wheel {}: the drag of the motor alone, {:.3f} V by its data sheet, is larger than b", of.wheel,
                     of.drag_V);
}

std::string say(const friction::BackEmfExceedsDamping& of) {
  return fmt::format("0 is written for d of wheel {}: the back-EMF of the motor alone, {:.4f} V s/rad by its data sheet, is larger than d",
                     of.wheel, of.back_emf_V_s_per_rad);
}

std::string say(const friction::DirectionFrom& from) {
  switch (from.source) {
    case friction::DirectionFrom::Source::commanded:
      return "direction of travel: as commanded";
    case friction::DirectionFrom::Source::measured:
      return "direction of travel: as measured";
    case friction::DirectionFrom::Source::wheels:
      return "direction of travel: from the wheels' speeds";
  }
  return "";
}

std::string say(const friction::DirectionDiffers& of) {
  return fmt::format(
      "the direction of travel is {:.0f}° off the direction that follows from the wheels' speeds: are the wheels in another order than in "
      "the robot's file, or is an angle in degrees or in another frame?",
      of.off_deg);
}

std::string say(const friction::SpeedsContradict& of) {
  return fmt::format("{:.0f} % of the wheels' speeds fit no motion of the robot: do their order or signs differ from the robot's file?",
                     100.0 * of.share);
}

std::string say(const friction::VoltageFallsWithSpeed& /*of*/) {
  return "voltage falls as the wheels turn faster: does one of them have the wrong sign?";
}

std::string say(const friction::DampingDiffersFromBackEmf& of) {
  return fmt::format(
      "d (voltage per speed) is {} times the motor's back-EMF, expected 1 to 2 times: is a speed in rpm or of the wheel, a modulation in "
      "percent, a voltage in millivolts, or is it another motor?",
      base::significant(of.ratio, 2));
}

std::string say(const friction::MoreWheelsThanRobot& of) {
  return fmt::format("the log has values of wheel {}, but the robot's file has {} wheels: is it the log of another robot?", of.logged,
                     of.of_robot);
}

std::string say(const friction::WheelWithoutVoltage& of) {
  return fmt::format("wheel {} turns with hardly any voltage: is its modulation missing from the log?", of.wheel);
}

std::string say(const friction::WheelVoltageFallsWithSpeed& of) {
  return fmt::format("voltage of wheel {} falls as it turns faster: does its speed or its modulation have the wrong sign?", of.wheel);
}

std::string say(const friction::FrictionDrivesWheel& of) {
  return fmt::format(
      "friction of wheel {} would drive it (a = {} V, b = {} V): is its modulation that of another wheel, or of the wrong sign?", of.wheel,
      base::significant(of.sine_V, 2), base::significant(of.constant_V, 2));
}

std::string say(const friction::WheelVoltageUnexplained& of) {
  return fmt::format("voltage of wheel {} hardly follows its speed and direction (R² {:.2f}): is its modulation that of another wheel?",
                     of.wheel, of.r2_ratio);
}

std::string say(const friction::WheelDampingDiffers& of) {
  return fmt::format(
      "the fitted voltage per speed (d) of wheel {} is {} times the back-EMF of the motor, expected 1 to 2 times: is its speed or "
      "modulation in "
      "another unit?",
      of.wheel, base::significant(of.ratio, 2));
}

}  // namespace

std::string words_of(const friction::FrictionFinding& finding) {
  return std::visit([](const auto& each) { return say(each); }, finding);
}

std::string words_of(const friction::FrictionSuspicion& suspicion) {
  return std::visit(
      [](const auto& each) {
        if constexpr (std::is_same_v<std::decay_t<decltype(each)>, recording::Suspicion>) {
          return words_of(each);
        } else {
          return say(each);
        }
      },
      suspicion);
}

std::string words_of(const friction::WrittenAsZero& finding) {
  return std::visit([](const auto& each) { return say(each); }, finding);
}

std::vector<std::string> words_of(const std::vector<friction::SuspicionOfTest>& suspicions) {
  std::vector<std::string> words;
  std::ranges::transform(suspicions, std::back_inserter(words), [](const friction::SuspicionOfTest& each) {
    return each.log.empty() ? words_of(each.suspicion) : fmt::format("{}: {}", each.log, words_of(each.suspicion));
  });
  return words;
}

std::string_view words_of(friction::WheelProblem problem) {
  switch (problem) {
    case friction::WheelProblem::hardly_turns:
      return "it hardly turns in any steady leg";
    case friction::WheelProblem::constant_voltage:
      return "its voltage is the same in all legs";
    case friction::WheelProblem::one_speed:
      return "all its legs have one speed, so damping and friction are indistinguishable; drive at two speeds or more";
    case friction::WheelProblem::too_few_headings:
      return "too few headings to determine how friction depends on the direction; drive at least six directions all around";
    case friction::WheelProblem::too_few_legs:
      break;
  }
  return "it has too few steady legs";
}

std::string_view words_of(friction::Repeats repeats) {
  switch (repeats) {
    case friction::Repeats::legs_on_one_heading:
      return "legs on one heading";
    case friction::Repeats::speeds_of_one_leg:
      return "speeds of one leg";
    case friction::Repeats::neighbouring_headings:
      break;
  }
  return "neighbouring headings";
}

std::string_view words_of(friction::ExpectedFrom source) {
  return source == friction::ExpectedFrom::robot_file ? "the robot's file" : "the motor's data sheet";
}

}  // namespace heatsoak::present
