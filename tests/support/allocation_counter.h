// How often this program has asked for memory: an inner loop that never does can run for hours.
#pragma once

namespace heatsoak {

/// Calls of malloc and its relatives so far, by C and by operator new; always 0 where a sanitizer brings its own malloc.
long allocation_count();

/// Whether they can be counted here.
bool allocations_are_counted();

}  // namespace heatsoak
