// Files and exit code of the host, for a program that runs under a debugger or QEMU (Arm, "Semihosting for AArch32 and AArch64",
// 2.0).
#pragma once

#include <cstddef>

namespace robot_core::port {

/// exit() returns this plus the exception number if an exception stopped the program.
inline constexpr int kExceptionExitCode = 64;

enum class OpenMode { read = 1, write = 5 };  // fopen's "rb" and "wb"

/// Opens a file, with a path relative to the folder in which QEMU runs. Returns its handle, or -1 on failure.
int open(const char* path, OpenMode mode);

/// Reads up to `size` bytes and returns how many were read, fewer than `size` at the end of the file.
std::size_t read(int file, void* bytes, std::size_t size);

/// Writes `size` bytes. Returns true if all were written.
bool write(int file, const void* bytes, std::size_t size);

bool close(int file);

/// Prints on the console of the host.
void print(const char* text);

/// Ends the emulation with the exit code `code`.
[[noreturn]] void exit(int code);

}  // namespace robot_core::port
