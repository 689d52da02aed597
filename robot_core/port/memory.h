// The two functions of the C library that GCC calls without being asked to.
#pragma once

#include <cstddef>

extern "C" {
void* memcpy(void* __restrict to, const void* __restrict from, std::size_t size);
void* memset(void* to, int value, std::size_t size);
}
