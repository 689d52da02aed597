// Folders of the shipped motors, robots and duties.
#pragma once

#include "input/data_folders.h"
#include "support/source_folder.h"

namespace heatsoak {

inline const input::DataFolders kShippedFolders{kSource / "motor_db", kSource / "robot_core/robots", kSource / "duty_profiles", kSource};

}  // namespace heatsoak
