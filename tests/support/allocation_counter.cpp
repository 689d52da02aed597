#include "support/allocation_counter.h"

#include <atomic>
#include <cstddef>

// SUNDIALS allocates in C, so operator new does not count it.
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
namespace {
std::atomic<long> count = 0;
}
extern "C" {
// NOLINTBEGIN(bugprone-reserved-identifier, cert-dcl37-c, cert-dcl51-cpp, readability-inconsistent-declaration-parameter-name): glibc's
// names
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t items, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void* malloc(std::size_t size) {
  ++count;
  return __libc_malloc(size);
}
void* calloc(std::size_t items, std::size_t size) {
  ++count;
  return __libc_calloc(items, size);
}
void* realloc(void* old, std::size_t size) {
  ++count;
  return __libc_realloc(old, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {  // operator new calls it for Lanes
  ++count;
  return __libc_memalign(alignment, size);
}
// NOLINTEND(bugprone-reserved-identifier, cert-dcl37-c, cert-dcl51-cpp, readability-inconsistent-declaration-parameter-name)
}

namespace heatsoak {
long allocation_count() { return count; }
bool allocations_are_counted() { return true; }
}  // namespace heatsoak
#else
namespace heatsoak {
long allocation_count() { return 0; }
bool allocations_are_counted() { return false; }
}  // namespace heatsoak
#endif
