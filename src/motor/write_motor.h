// A motor as the text of a motor file.
#pragma once

#include <string>

#include "motor/motor.h"

namespace heatsoak {

/// read_motor() of it gives the same motor, in this program's conventions. Figures keep the text of their file where they have one.
std::string to_toml(const Motor& motor);

}  // namespace heatsoak
