// A wheel motor whose stator is bolted to a chassis that absorbs heat. The data sheet's two-node model lacks the chassis.
#pragma once

#include <cstdint>
#include <filesystem>

namespace heatsoak::attribution::truth {

/// Id of its motor file.
inline constexpr const char* kSoakMotor = "maxon_ec45_flat_70w_24v";

/// Writes the logs match_1.csv to match_3.csv of 20 min and then bench.csv of 30 min, which a user would have. Another seed gives other
/// loads, noise and unknown heat. Creates the folder.
void write_soak_logs(std::uint64_t seed, const std::filesystem::path& folder);

}  // namespace heatsoak::attribution::truth
