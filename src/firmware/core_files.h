// `heatsoak generate core`: the drive core of one robot and motor as a folder of source files that compiles on its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "derate/provenance.h"
#include "firmware/core_config.h"
#include "firmware/core_notes.h"
#include "firmware/host_guard.h"

namespace heatsoak::firmware {

struct CoreFile {
  std::string path;  ///< within the folder
  std::string content;
};

/// File of the folder that lists the paths of all generated files, one per line.
inline constexpr const char* kGeneratedFiles = "generated_files.txt";

struct CoreFolder {
  std::vector<CoreFile> files;         ///< sorted by path
  std::string hash;                    ///< kInputHash over the texts of robot and motor file and the options
  std::uint32_t config_check_sum = 0;  ///< robot_core::config_check_sum()
  double limp_current_A = 0.0;
  double braking_reserve_K = 0.0;
  std::vector<CoreNote> notes;
};

/// Inputs common to all file generators.
struct CoreSource {
  const robot::Robot& robot;
  const motor::Motor& motor;
  const derate::Derating& derating;
  CoreOptions options;
  robot_core::Config config;  ///< its guard is the model below
  robot_core::GuardModel guard;
  std::string version;       ///< version of this program
  std::string options_text;  ///< all options that matter, as on the command line
  std::string hash;
};

/// Guard period of a control period: the whole multiple nearest to 10 ms.
double guard_period_s(double period_s);

/// Longest control period of a generated core, rounded down to 0.01 ms. The watchdog of firmware/board_default.c ends within
/// robot_core::kWatchdog_s at the slowest rate of its oscillator, 17 kHz. At the fastest, 47 kHz, it ends after 7.15 ms and must not end
/// within two periods.
inline constexpr double kLongestWatched_s = 3.57e-3;
static_assert(2.0 * kLongestWatched_s <= 84 * 4 / 47e3);

/// Returns the folder; equal inputs give equal bytes. The derating must have guard_period_s(). Reads the files of robot and motor again for
/// the hash. Throws Failure (bad_input) as make_core_config() and HostGuard do, if the period is above kLongestWatched_s, or if a file
/// cannot be read.
CoreFolder core_files(const robot::Robot& robot, const motor::Motor& motor, const CoreOptions& options, const derate::Derating& derating,
                      std::string_view version);

/// Returns the size of a C or C++ file without comments and empty lines, so that a longer comment does not count; 0 for another file.
std::size_t code_bytes(std::string_view path, std::string_view content);

/// Returns code_bytes() of all texts of which core_files() builds a folder, and of a guard table of `table_bytes` as text. The few texts
/// that depend on robot and motor do not count.
std::size_t largest_core_bytes(std::size_t table_bytes);

struct GeneratedCore {
  derate::Derating derating;
  CoreFolder folder;
};
/// Derates the motor for the core's guard and generates the folder. The guard's period follows from that of the core, not from
/// `derate_options`. Throws Failure as make_core_config() does, before the derating, which takes seconds; and as derate() and core_files()
/// do.
GeneratedCore generate_core(const robot::Robot& robot, const motor::Motor& motor, const CoreOptions& options,
                            derate::DerateOptions derate_options, std::string_view version, const base::Progress& progress = {});

// The generated files that are no templates.
std::string core_config_header(const CoreSource& source);
std::string motor_guard_header(const CoreSource& source);
std::string motor_guard_source(const CoreSource& source);

/// Shortest decimal that reads back as the same float, "0.01F". The value must be finite.
std::string float_literal(float value);
/// Returns the text without line breaks, so that no comment ends early.
std::string in_one_line(std::string text);

}  // namespace heatsoak::firmware
