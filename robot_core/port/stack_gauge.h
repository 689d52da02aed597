// Measures the stack use of a call: fills the free stack with a pattern and checks how much of it is left.
#pragma once

#include <cstdint>

extern "C" unsigned char port_stack_begin[];  // from the linker script

namespace robot_core::port {

inline std::uint32_t stack_pointer() {
  std::uint32_t value = 0;
  asm volatile("mov %0, sp" : "=r"(value));
  return value;
}

namespace detail {

inline constexpr std::uint32_t kStackPattern = 0x5AA55AA5U;

inline volatile std::uint32_t* stack_word(std::uint32_t address) {
  return reinterpret_cast<volatile std::uint32_t*>(static_cast<std::uintptr_t>(address));
}
inline std::uint32_t lowest_stack_address() { return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(port_stack_begin)); }

}  // namespace detail

/// Fills the stack below this call. Words that earlier calls of the caller left there no longer count as used.
[[gnu::noinline]] inline void fill_stack() {
  const std::uint32_t end = stack_pointer();
  for (std::uint32_t address = detail::lowest_stack_address(); address < end; address += sizeof(std::uint32_t)) {
    *detail::stack_word(address) = detail::kStackPattern;
  }
}

/// Returns the bytes between `top`, a stack pointer, and the deepest word written since fill_stack().
inline std::uint32_t stack_bytes_below(std::uint32_t top) {
  std::uint32_t address = detail::lowest_stack_address();
  while (address < top && *detail::stack_word(address) == detail::kStackPattern) {
    address += sizeof(std::uint32_t);
  }
  return top - address;
}

}  // namespace robot_core::port
