// Start-up of a Cortex-M7: vector table, FPU, contents of .data and .bss, then main().
#include <cstddef>
#include <cstdint>

#include "robot_core/port/memory.h"
#include "robot_core/port/semihosting.h"

int main();

extern "C" {

// Symbols of the linker script; only their addresses have a meaning.
extern unsigned char port_data_begin[];
extern unsigned char port_data_end[];
extern const unsigned char port_data_contents[];
extern unsigned char port_bss_begin[];
extern unsigned char port_bss_end[];
extern unsigned char port_stack_end[];

[[noreturn]] void port_reset();
[[noreturn]] void port_exception();
}

namespace robot_core::port {
namespace {

constexpr std::uint32_t kFullAccessToFpu = 0xFU << 20U;  // coprocessors 10 and 11

/// Coprocessor Access Control Register (Armv7-M Architecture Reference Manual, B3.2.20).
volatile std::uint32_t& cpacr() { return *reinterpret_cast<volatile std::uint32_t*>(0xE000ED88U); }

/// Interrupt Control and State Register. The low nine bits are the number of the active exception.
volatile std::uint32_t& icsr() { return *reinterpret_cast<volatile std::uint32_t*>(0xE000ED04U); }

/// Vector Table Offset Register.
volatile std::uint32_t& vtor() { return *reinterpret_cast<volatile std::uint32_t*>(0xE000ED08U); }

// Not inlined, so that no floating-point instruction moves before the FPU is enabled.
[[noreturn, gnu::noinline]] void run() {
  memcpy(port_data_begin, port_data_contents, static_cast<std::size_t>(port_data_end - port_data_begin));
  memset(port_bss_begin, 0, static_cast<std::size_t>(port_bss_end - port_bss_begin));
  exit(main());
}

union Vector {
  unsigned char* stack;
  void (*handler)();
};

constexpr int kVectors = 16;  // exceptions of the core; no interrupt is used

[[gnu::section(".vectors"), gnu::used]] const Vector vectors[kVectors] = {
    {.stack = port_stack_end},   {.handler = port_reset},     {.handler = port_exception}, {.handler = port_exception},
    {.handler = port_exception}, {.handler = port_exception}, {.handler = port_exception}, {.handler = port_exception},
    {.handler = port_exception}, {.handler = port_exception}, {.handler = port_exception}, {.handler = port_exception},
    {.handler = port_exception}, {.handler = port_exception}, {.handler = port_exception}, {.handler = port_exception}};

}  // namespace
}  // namespace robot_core::port

void port_reset() {
  using namespace robot_core::port;
  vtor() = reinterpret_cast<std::uintptr_t>(vectors);
  cpacr() = cpacr() | kFullAccessToFpu;
  asm volatile("dsb\n\tisb" ::: "memory");
  run();
}

void port_exception() {
  using namespace robot_core::port;
  // Exceptions 2 to 15, for example 3 hard fault, 6 usage fault.
  exit(kExceptionExitCode + static_cast<int>(icsr() & 0x1FFU));
}
