// Which rows of which measurements: known again under another file name, on another clock, or as a part that LOG@0-60% takes. Rows cut out
// into a file of their own are another content, and known again only beside what they were cut out of.
#pragma once

#include <string>
#include <string_view>

#include "identify/measurement/recording.h"

namespace heatsoak {

/// Of all channels and of the times since the first row, as 16 hexadecimal digits.
std::string content_hash(const Recording& recording);

/// Content and seconds since its first row: "5f0c31d2a7e94b68 0-1800 s".
std::string fingerprint_of(const Recording& recording);

/// "match_1 (5f0c31d2a7e94b68 0-1800 s)", for files that keep what was fitted.
std::string name_and_fingerprint(const Recording& recording);

/// Whether rows of one content are meant and their times overlap. False for what is no fingerprint.
bool share_rows(std::string_view fingerprint, std::string_view other);

/// Most of the rows of `part` stand in `whole` in the same order, whatever their times: it was cut out of it. Sixty rows of which
/// few differ prove nothing: a `part` that has only such is not found.
bool is_cut_from(const Recording& part, const Recording& whole);

/// Whether the recording shares rows with `run`, a name_and_fingerprint(); where that is a name alone, by the name.
bool is_of_run(const Recording& recording, std::string_view run);

}  // namespace heatsoak
