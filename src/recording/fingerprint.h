// Fingerprints that identify rows of measurements. They do not depend on the file name or the origin of time, and also identify parts
// (LOG@0-60%). Rows copied to a separate file have another fingerprint; is_cut_from() finds them, but needs the original.
#pragma once

#include <string>
#include <string_view>

#include "recording/recording.h"

namespace heatsoak::recording {

/// Hash of all channels and of the times since the first row, as 16 hexadecimal digits.
std::string content_hash(const Recording& recording);

/// Content hash and time range since the first row of the content: "5f0c31d2a7e94b68 0-1800 s".
std::string fingerprint_of(const Recording& recording);

/// Name and fingerprint, "match_1 (5f0c31d2a7e94b68 0-1800 s)", as stored in fitted motor files.
std::string name_and_fingerprint(const Recording& recording);

/// Returns true if two fingerprints have the same content hash and overlapping times. False if one of them is not a fingerprint.
bool share_rows(std::string_view fingerprint, std::string_view other);

/// Returns true if most rows of `part` occur in `whole` in the same order, at any time. Needs a common temperature channel. Compares
/// windows of 60 rows and ignores those with few changing rows, so a `part` with only such windows is not found.
bool is_cut_from(const Recording& part, const Recording& whole);

/// Returns true if the recording shares rows with `run`, a name_and_fingerprint(). If `run` has no fingerprint, compares the names.
bool is_of_run(const Recording& recording, std::string_view run);

}  // namespace heatsoak::recording
