// Counts the memory allocations of this program. Inner loops without any allocation can run for hours.
#pragma once

namespace heatsoak {

/// Returns the number of calls of malloc and similar functions so far, in C and by operator new; always 0 if a sanitizer replaces malloc.
long allocation_count();

/// True if this build can count them.
bool allocations_are_counted();

}  // namespace heatsoak
