#include "drive_records.h"
#include "replay.h"

namespace {

using namespace heatsoak::target;

DriveRun& drive_run() {
  static Room<DriveRun, 1> room;
  return *room.values();
}

void run_step(const robot_core::Input& input, DriveResult&) {
  DriveRun& run = drive_run();
  robot_core::step(run.config, run.state, input, run.output);
}

void copy_result(DriveResult& result) { copy_output(drive_run().output, drive_run().state, result); }

}  // namespace

int main() {
  begin(drive_run());
  replay<robot_core::Input, DriveResult>(run_step, copy_result, sizeof(robot_core::Config) + sizeof(robot_core::State));
  return 0;
}
