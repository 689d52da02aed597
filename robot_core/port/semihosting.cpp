#include "robot_core/port/semihosting.h"

#include <cstdint>

namespace robot_core::port {
namespace {

enum class Operation : std::uint32_t {
  open = 0x01,
  close = 0x02,
  write_text = 0x04,
  write = 0x05,
  read = 0x06,
  exit_extended = 0x20,
};

constexpr std::uintptr_t kApplicationExit = 0x20026;

/// Calls the host. On M-profile cores the host handles the breakpoint 0xAB and reads r0 and r1.
std::uintptr_t call(Operation operation, const void* arguments) {
  register std::uintptr_t r0 asm("r0") = static_cast<std::uintptr_t>(operation);
  register const void* r1 asm("r1") = arguments;
  asm volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
  return r0;
}

std::uintptr_t address(const void* pointer) { return reinterpret_cast<std::uintptr_t>(pointer); }

}  // namespace

int open(const char* path, OpenMode mode) {
  std::uintptr_t length = 0;
  while (path[length] != '\0') {
    ++length;
  }
  const std::uintptr_t arguments[] = {address(path), static_cast<std::uintptr_t>(mode), length};
  return static_cast<int>(call(Operation::open, arguments));
}

std::size_t read(int file, void* bytes, std::size_t size) {
  const std::uintptr_t arguments[] = {static_cast<std::uintptr_t>(file), address(bytes), size};
  const std::uintptr_t not_read = call(Operation::read, arguments);
  return not_read <= size ? size - not_read : 0;
}

bool write(int file, const void* bytes, std::size_t size) {
  const std::uintptr_t arguments[] = {static_cast<std::uintptr_t>(file), address(bytes), size};
  return call(Operation::write, arguments) == 0;
}

bool close(int file) {
  const std::uintptr_t arguments[] = {static_cast<std::uintptr_t>(file)};
  return call(Operation::close, arguments) == 0;
}

void print(const char* text) { call(Operation::write_text, text); }

void exit(int code) {
  const std::uintptr_t arguments[] = {kApplicationExit, static_cast<std::uintptr_t>(code)};
  for (;;) {
    call(Operation::exit_extended, arguments);
  }
}

}  // namespace robot_core::port
