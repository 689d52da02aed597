// Counts the instructions of a call under QEMU.
//
// With `-icount shift=N` QEMU advances its virtual clock by 2^N ns per instruction. SysTick counts that clock at 25 MHz in 24 bits, one
// tick per 40 ns. With shift=0 a tick is 40 instructions. With shift=8 an instruction takes 256 ns = 6.4 ticks. Two reads, each rounded to
// a tick, then give the exact number of instructions, up to 2.6 million. Checked with 0 to 300 instructions in a row and with loops of
// known length (QEMU 7.2).
//
// Every instruction counts as one: a move, a division or a push of eight registers. In an IT block it also counts if its condition is
// false. This is no cycle count: a Cortex-M7 needs several cycles for some instructions and executes others in pairs.
#pragma once

#include <cstdint>

namespace robot_core::port {

/// Value of `-icount shift=` that the counter needs.
inline constexpr std::uint32_t kInstructionShift = 8;

/// Result of a call with more instructions than the counter can hold.
inline constexpr std::uint32_t kTooManyInstructions = 0xFFFFFFFFU;

namespace detail {

inline constexpr std::uint32_t kTickNanoseconds = 40;
inline constexpr std::uint32_t kReload = 0xFFFFFFU;

// SysTick (Armv7-M Architecture Reference Manual, B3.3).
inline volatile std::uint32_t& systick_control() { return *reinterpret_cast<volatile std::uint32_t*>(0xE000E010U); }
inline volatile std::uint32_t& systick_reload() { return *reinterpret_cast<volatile std::uint32_t*>(0xE000E014U); }
inline volatile std::uint32_t& systick_value() { return *reinterpret_cast<volatile std::uint32_t*>(0xE000E018U); }

inline constexpr std::uint32_t kEnable = 1U;
inline constexpr std::uint32_t kProcessorClock = 1U << 2U;
inline constexpr std::uint32_t kHasWrapped = 1U << 16U;  // cleared by a read

/// SysTick ticks between two reads with `run` between them.
template <typename Run>
std::uint32_t ticks(Run&& run) {
  systick_reload() = kReload;
  systick_value() = 0;  // the counter restarts at kReload
  systick_control() = kEnable | kProcessorClock;
  // The first tick loads the counter.
  while (systick_value() == 0) {
  }
  asm volatile("" ::: "memory");
  const std::uint32_t before = systick_value();
  run();
  const std::uint32_t after = systick_value();
  asm volatile("" ::: "memory");
  const bool has_wrapped = (systick_control() & kHasWrapped) != 0;
  systick_control() = 0;
  return has_wrapped ? kTooManyInstructions : before - after;
}

}  // namespace detail

/// Returns the instructions of `run` beyond an empty call, rounded to the nearest.
template <typename Run>
std::uint32_t count_instructions(Run&& run) {
  const std::uint32_t ticks = detail::ticks(run);
  const std::uint32_t ticks_of_nothing = detail::ticks([] {});
  if (ticks == kTooManyInstructions) {
    return kTooManyInstructions;
  }
  constexpr std::uint32_t kInstructionNanoseconds = 1U << kInstructionShift;
  return ((ticks - ticks_of_nothing) * detail::kTickNanoseconds + kInstructionNanoseconds / 2) / kInstructionNanoseconds;
}

}  // namespace robot_core::port
