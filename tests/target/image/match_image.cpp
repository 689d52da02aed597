// The drive core in the middle of a recorded match: continues from the State in kStartFile with generated configuration and guard.
#include "core_config.h"
#include "drive_records.h"
#include "replay.h"

namespace {

using namespace heatsoak::target;

DriveRun& drive_run() {
  static Room<DriveRun, 1> room;
  return *room.values();
}

void take_start() {
  static Room<MatchStart, 1> room;
  MatchStart& start = *room.values();
  if (robot_core::port::read(open_or_give_up(kStartFile, robot_core::port::OpenMode::read), &start, sizeof(start)) != sizeof(start)) {
    give_up("the start is too short\n");
  }
  DriveRun& run = drive_run();
  run.config = kCoreConfig;
  run.state = start.state;
  if (start.config_check_sum != kCoreConfig.check_sum || config_check_sum(kCoreConfig) != kCoreConfig.check_sum) {
    give_up("the configuration is not the recorded one\n");
  }
}

void run_step(const robot_core::Input& input, DriveResult&) {
  DriveRun& run = drive_run();
  robot_core::step(run.config, run.state, input, run.output);
}

void copy_result(DriveResult& result) { copy_output(drive_run().output, drive_run().state, result); }

}  // namespace

int main() {
  take_start();
  replay<robot_core::Input, DriveResult>(run_step, copy_result, sizeof(robot_core::Config) + sizeof(robot_core::State));
  return 0;
}
