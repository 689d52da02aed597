// Mistakes in a robot file that `lint` finds: lengths, batteries and inertias in wrong units.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <regex>

#include "base/diagnostic.h"
#include "robot/robot.h"
#include "robot/robot_lint.h"
#include "support/source_folder.h"

namespace heatsoak::robot {
namespace {

const std::filesystem::path kRobotFiles = kSource / "robot_core/robots";

std::string content_of_robot(const char* name) {
  std::ifstream stream(kRobotFiles / name);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Returns the findings for a robot file with `pattern` replaced, as "check level".
std::vector<std::string> findings_with(const std::string& pattern, const std::string& by) {
  const std::string text = content_of_robot("roboteam_twente_v2024.toml");
  const std::string changed = std::regex_replace(text, std::regex(pattern), by, std::regex_constants::format_first_only);
  EXPECT_NE(changed, text) << pattern;
  std::vector<std::string> found;
  for (const motor::LintFinding& each : lint(parse_robot(changed, "robot.toml"), std::vector<std::string>{"maxon_ecx_flat_32l_48v"})) {
    found.push_back(each.check + " " + std::string(motor::to_string(each.level)));
  }
  return found;
}

using testing::Contains;
using testing::IsEmpty;

TEST(RobotPlausibility, diameter_in_place_of_the_radius_makes_wheels_overlap) {
  EXPECT_THAT(findings_with("\nradius = \"28 mm\"", "\nradius = \"56 mm\""), Contains("wheels error"));
  EXPECT_THAT(findings_with("\nradius = \"28 mm\"", "\nradius = \"62 mm\""), Contains("wheels error"));
}

// Robots of the Small Size League weigh 2 to 3.5 kg. A heavy one is a warning and no error: nothing contradicts it.
TEST(RobotPlausibility, a_mass_that_its_volume_cannot_have_is_a_warning) {
  EXPECT_THAT(findings_with("\nmass = \"2.632 kg\"", "\nmass = \"9 kg\""), Contains("mass warning"));
  for (const char* mass : {"2 kg", "3.5 kg", "4.5 kg"}) {
    EXPECT_THAT(findings_with("\nmass = \"2.632 kg\"", "\nmass = \"" + std::string(mass) + "\""), testing::Not(Contains("mass warning")))
        << mass;
  }
}

// Not their radius, which is right, but their angles are wrong.
TEST(RobotPlausibility, two_wheels_at_one_angle_are_named) {
  EXPECT_THAT(findings_with("axis_angles = \\[\"-30 deg\", \"30 deg\"", "axis_angles = [\"30 deg\", \"30 deg\""), Contains("axes error"));
}

TEST(RobotPlausibility, slip_factors_belong_to_wheels) {
  const std::string text = content_of_robot("roboteam_twente_v2024.toml");
  const auto with = [&](const std::string& factors) {
    return parse_robot(std::regex_replace(text, std::regex("\n\\[wheels\\]\n"), "\n[wheels]\nslip_factors = " + factors + "\n"),
                       "robot.toml");
  };
  EXPECT_THAT(with("[\"1.01\", \"1.02\", \"1.03\", \"1.04\"]").wheels.slip_factor, testing::ElementsAre(1.01, 1.02, 1.03, 1.04));
  EXPECT_THAT([&] { with("[\"1.01\", \"1.02\"]"); },
              testing::ThrowsMessage<base::Failure>(testing::HasSubstr("names 2 wheels, axis_angles 4")));
  EXPECT_THAT([&] { with("[\"1\", \"1\", \"1\", \"102\"]"); }, testing::Throws<base::Failure>());
}

TEST(RobotPlausibility, slip_factors_can_state_origin_and_source) {
  const std::string text = content_of_robot("roboteam_twente_v2024.toml");
  const auto with = [&](const std::string& given) {
    return parse_robot(std::regex_replace(text, std::regex("\n\\[wheels\\]\n"), "\n[wheels]\nslip_factors = { " + given + " }\n"),
                       "robot.toml");
  };
  const std::string list = "value = [\"1.01\", \"1.02\", \"1.03\", \"1.04\"]";
  const Robot robot = with(list + ", origin = \"measured\", source = \"drive of May\", tolerance = \"1 %\"");
  EXPECT_THAT(robot.wheels.slip_factor, testing::ElementsAre(1.01, 1.02, 1.03, 1.04));
  const base::ParameterValue& last = robot.parameters.at("wheels.slip_factors[3]");
  EXPECT_EQ(last.value, 1.04);
  EXPECT_EQ(last.origin, base::Origin::measured);
  EXPECT_EQ(last.source, "drive of May");
  const auto problem = [&](const std::string& given) {
    try {
      with(given);
    } catch (const base::Failure& failure) {
      return std::string(failure.what());
    }
    return std::string("nothing was wrong");
  };
  EXPECT_THAT(problem(list + ", source = \"x\""), testing::HasSubstr("wheels.slip_factors.origin: is missing"));
  EXPECT_THAT(problem("value = \"1.01\", origin = \"measured\", source = \"x\""), testing::HasSubstr("expected one factor per wheel"));
  EXPECT_THAT(problem("value = [\"1.01\"], origin = \"measured\", source = \"x\""), testing::HasSubstr("names 1 wheels, axis_angles 4"));
  EXPECT_THAT(problem("value = [\"1.01\", \"9\", \"1\", \"1\"], origin = \"measured\", source = \"x\""), testing::HasSubstr("9"));
  EXPECT_THAT(problem(list + ", orign = \"measured\", source = \"x\""), testing::HasSubstr("did you mean 'origin'"));
}

// Two wheels at ±30° on a circle of 80.4 mm touch if their radius is 80.4 mm · tan 30° = 46.4 mm.
TEST(RobotPlausibility, wheels_overlap_from_the_radius_of_geometry_on) {
  EXPECT_THAT(findings_with("\nradius = \"28 mm\"", "\nradius = \"46 mm\""), IsEmpty());
  EXPECT_THAT(findings_with("\nradius = \"28 mm\"", "\nradius = \"47 mm\""), Contains("wheels error"));
}

TEST(RobotPlausibility, large_wheels_far_apart_get_a_warning) {
  EXPECT_THAT(findings_with(
                  "\nradius = \"28 mm\"\ncontact_radius = \"80.4 mm\"\naxis_angles = \\[[^\\]]*\\]",
                  "\nradius = \"62 mm\"\ncontact_radius = \"80.4 mm\"\naxis_angles = [\"-45 deg\", \"45 deg\", \"135 deg\", \"-135 deg\"]"),
              Contains("wheels warning"));
}

TEST(RobotPlausibility, nominal_voltage_lies_between_empty_and_full) {
  EXPECT_THAT(findings_with("nominal_voltage = \"22.2 V\"", "nominal_voltage = \"222 V\""), Contains("battery error"));
  EXPECT_THAT(findings_with("nominal_voltage = \"22.2 V\"", "nominal_voltage = \"2.22 V\""), Contains("battery error"));
}

TEST(RobotPlausibility, yaw_inertia_fits_mass_and_size) {
  EXPECT_THAT(findings_with("yaw_inertia = \\{ value = \"0.011 kg m2\", origin = \"estimated\", range = \\[[^\\]]*\\]",
                            "yaw_inertia = { value = \"1100 g cm2\", origin = \"estimated\""),
              Contains("inertia warning"));
}

TEST(RobotPlausibility, values_in_other_units_get_a_warning) {
  EXPECT_THAT(findings_with("axis_angles = \\[\"-30 deg\"", "axis_angles = [\"-30 rad\""), Contains("motion warning"));
  EXPECT_THAT(findings_with("inertia = \\{ value = \"220 g cm2\", origin = \"estimated\", range = \\[\"100 g cm2\", \"450 g cm2\"\\]",
                            "inertia = { value = \"22 kg cm2\", origin = \"estimated\", range = [\"10 kg cm2\", \"45 kg cm2\"]"),
              Contains("motion warning"));
  EXPECT_THAT(findings_with("center_of_gravity_height = \\{ value = \"50 mm\", origin = \"estimated\", range = \\[\"35 mm\", \"65 mm\"\\]",
                            "center_of_gravity_height = { value = \"50 cm\", origin = \"estimated\", range = [\"35 cm\", \"65 cm\"]"),
              Contains("motion warning"));
  EXPECT_THAT(findings_with("acceleration = \\{ value = \"2 m/s2\"", "acceleration = { value = \"200 m/s2\""), Contains("motion warning"));
}

// The slips of a team that fills in its first file: a diameter, a missing decimal point, the inverse of a ratio.
TEST(RobotPlausibility, slips_of_a_first_file_get_a_warning) {
  EXPECT_THAT(findings_with("contact_radius = \"80.4 mm\"", "contact_radius = \"160.8 mm\""), Contains("wheels warning"));
  EXPECT_THAT(findings_with("gear_ratio = \"1\"", "gear_ratio = \"0.1\""), Contains("drive warning"));
  EXPECT_THAT(findings_with("\nspeed = \\{ value = \"2 m/s\", origin = \"third_party\", source = \"([^\"]*)\", range = \\[[^\\]]*\\]",
                            "\nspeed = { value = \"30 m/s\", origin = \"third_party\", source = \"$1\""),
              Contains("motion warning"));
  EXPECT_THAT(findings_with("jerk = \\{ value = \"6 m/s3\"", "jerk = { value = \"0.3 m/s3\""), Contains("motion warning"));
}

TEST(RobotPlausibility, a_voltage_without_those_of_the_cells_is_compared_too) {
  Robot robot = parse_robot(content_of_robot("roboteam_twente_v2024.toml"), "robot.toml");
  robot.battery.full_V = robot.battery.empty_V = {};
  EXPECT_THAT(implausible_values(robot), IsEmpty());
  robot.battery.nominal_V = 222.0;
  EXPECT_EQ(implausible_values(robot).size(), 1U);
}

TEST(RobotPlausibility, friction_of_a_blocked_wheel_gets_a_warning) {
  Robot robot = parse_robot(content_of_robot("roboteam_twente_v2024.toml"), "robot.toml");
  robot.friction.wheel_torque_Nm = 0.3;
  ASSERT_EQ(implausible_values(robot).size(), 1U);
  EXPECT_EQ(implausible_values(robot).front().key, "friction.wheel_torque");
}

TEST(RobotPlausibility, shipped_robots_are_plausible) {
  for (const char* name : {"roboteam_twente_v2024.toml", "roboteam_twente_v2025.toml", "tigers_v2020.toml"}) {
    EXPECT_THAT(implausible_values(read_robot(kRobotFiles / name)), IsEmpty()) << name;
  }
}

// Nothing that a match needs may be found only by its simulation.
TEST(RobotPlausibility, lint_lists_what_a_closed_loop_still_needs) {
  Robot robot = parse_robot(content_of_robot("roboteam_twente_v2024.toml"), "robot.toml");
  robot.drive.driver_resistance_ohm = {};
  robot.battery.capacity_A_s = {};
  robot.limits.jerk_m_per_s3 = {};
  std::vector<std::string> keys;
  for (const motor::LintFinding& each : lint(robot, std::vector<std::string>{"maxon_ecx_flat_32l_48v"})) {
    EXPECT_EQ(each.level, motor::LintFinding::Level::note);
    keys.push_back(each.key);
  }
  EXPECT_THAT(keys, testing::UnorderedElementsAre("limits.jerk", "drive.driver_resistance", "battery.capacity"));
}

// The computations refuse such a robot like a file with an error, at the same place and in the words of lint.
TEST(RobotPlausibility, errors_are_refused_with_their_place_and_warnings_are_not) {
  const std::string text = content_of_robot("roboteam_twente_v2024.toml");
  const auto with = [&](const std::string& pattern, const std::string& by) {
    return parse_robot(std::regex_replace(text, std::regex(pattern), by, std::regex_constants::format_first_only), "robot.toml");
  };
  Robot wrong = with("\nradius = \"28 mm\"", "\nradius = \"62 mm\"");
  wrong.battery.nominal_V = 222.0;
  try {
    require_sound(wrong);
    FAIL() << "is not refused";
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
    std::vector<std::string> keys;
    for (const base::Diagnostic& each : failure.diagnostics()) {
      keys.push_back(each.key);
      EXPECT_EQ(each.at.file, "robot.toml");
    }
    EXPECT_THAT(keys, testing::UnorderedElementsAre("wheels.radius", "battery.nominal_voltage"));
  }
  const Robot doubtful = with("acceleration = \\{ value = \"2 m/s2\"", "acceleration = { value = \"200 m/s2\"");
  EXPECT_THAT(implausible_values(doubtful), testing::Not(IsEmpty()));
  EXPECT_NO_THROW(require_sound(doubtful));
}

TEST(RobotPlausibility, robots_of_the_project_pass) {
  for (const auto& entry : std::filesystem::directory_iterator(kRobotFiles)) {
    if (entry.path().extension() != ".toml") {
      continue;
    }
    const Robot robot = read_robot(entry.path());
    EXPECT_THAT(lint(robot, std::vector<std::string>{robot.drive.motor}), IsEmpty()) << entry.path();
  }
}

}  // namespace
}  // namespace heatsoak::robot
