// Writes the synthetic log of reports/friction_test: the paper's robot drives the steady-state test. The rollers of wheel 3 have twice the
// drag of the others. Every run writes the same bytes.
//   heatsoak_friction_example FOLDER
#include <fstream>

#include "support/shipped.h"
#include "support/study_words.h"
#include "test_drive.h"

namespace heatsoak::friction {
namespace {

constexpr double kPlantPeriod_s = 0.001;
constexpr std::size_t kEvery = 2;  ///< every second row of the drive is in the log, as a radio link would send it

/// Friction at the wheel: 20 mN m that varies with the wheel's direction, plus 5 mN m constant, as in README.md of the folder.
robot::Robot with_dirty_wheel(robot::Robot robot) {
  robot.friction.heading.double_angle_Nm = 0.0;
  for (const double axis_rad : robot.wheels.axis_rad) {
    robot.friction.heading.wheels.push_back({.constant_Nm = 0.005, .sine_Nm = 0.020, .phase_rad = -axis_rad});
  }
  robot.friction.heading.wheels[2].sine_Nm = 0.040;
  return robot;
}

TestDrive headings_of_a_circle() {
  TestDrive drive;
  for (int i = 0; i < 12; ++i) {
    drive.headings_rad.push_back(0.2 + i * std::numbers::pi / 6.0);
  }
  drive.speeds_m_per_s = {0.5, 1.0};
  drive.hold_s = 2.5;
  drive.bad_row_share = 0.02;
  return drive;
}

std::vector<DriveRow> thinned(const std::vector<DriveRow>& rows) {
  std::vector<DriveRow> some;
  for (std::size_t i = 0; i < rows.size(); i += kEvery) {
    some.push_back(rows[i]);
  }
  return some;
}

}  // namespace
}  // namespace heatsoak::friction

int main(int argc, char** argv) {
  using namespace heatsoak;
  return run_study(argc, argv, "usage: heatsoak_friction_example FOLDER\n", 1, [](const StudyWords& words) {
    const robot::PlantConfig plant = robot::make_plant(friction::with_dirty_wheel(twente()), ecx_32().nominal, friction::kPlantPeriod_s);
    const std::filesystem::path folder(words.required(0, "FOLDER"));
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "steady_state_test.csv") << friction::csv_of(
        friction::thinned(friction::DriveOnPlant(plant, friction::headings_of_a_circle(), 7).rows()), plant.body.kinematics.wheel_count);
    return 0;
  });
}
