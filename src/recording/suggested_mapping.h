// Mapping file to start from, derived from the header of a foreign log.
#pragma once

#include <span>
#include <string>

namespace heatsoak::recording {

/// Returns the text of a mapping file for a log with these columns. Columns whose names state a quantity are mapped, with the unit of the
/// name: "winding_F", "speed_rpm", "Time [ms]". Every other column is a comment with its name, to be completed. read_mapping() accepts the
/// text if a column has the time.
std::string suggested_mapping(std::span<const std::string> header);

}  // namespace heatsoak::recording
