#include "cli/terminal.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <string_view>
#include <thread>
#include <utility>

#include "present/progress_words.h"
#include "present/renderer.h"
#include "present/wrap.h"

namespace heatsoak::cli {
namespace {

std::string_view environment(const char* name) {
  const char* const value = std::getenv(name);
  return value ? value : "";
}

}  // namespace

std::optional<std::size_t> known_width(int descriptor) {
  static constexpr std::size_t kMost = 1000;
  const auto within = [](std::size_t width) { return std::clamp(width, present::kLeastWidth, kMost); };
  const std::string_view columns = environment("COLUMNS");
  std::size_t wanted = 0;
  const auto [end, problem] = std::from_chars(columns.data(), columns.data() + columns.size(), wanted);
  if (problem == std::errc() && end == columns.data() + columns.size() && wanted > 0) {
    return within(wanted);
  }
  winsize size{};
  return ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? std::optional(within(size.ws_col)) : std::nullopt;
}

std::size_t terminal_width(int descriptor) {
  constexpr std::size_t kUsual = 80;
  return known_width(descriptor).value_or(kUsual);
}

std::string printable(std::string_view text) {
  std::string result(text);
  std::ranges::replace_if(
      result, [](unsigned char c) { return (c < ' ' && c != '\n' && c != '\t') || c == 0x7f; }, '?');
  return result;
}

void put(std::FILE* file, std::string_view text) { static_cast<void>(std::fwrite(text.data(), 1, text.size(), file)); }

bool takes_colors(int descriptor) { return isatty(descriptor) == 1 && environment("NO_COLOR").empty() && environment("TERM") != "dumb"; }

namespace {

/// Overwrites the line of stderr. A text that filled the line would leave copies of itself.
void overwrite_line(std::string_view text) { fmt::print(stderr, "\r\x1b[K{}", present::leading(text, terminal_width(STDERR_FILENO) - 1)); }

}  // namespace

/// A thread that overwrites one line on stderr several times per second, and removes it at the end.
class JobLine::Painter {
 public:
  explicit Painter(base::JobProgress progress)
      : thread_([this, progress = std::move(progress)](const std::stop_token& stop) { run(progress, stop); }) {}

 private:
  void run(const base::JobProgress& progress, const std::stop_token& stop) {
    constexpr std::chrono::milliseconds kBetween(300);
    constexpr double kFirst_s = 1.0;
    std::unique_lock lock(mutex_);
    bool is_visible = false;
    double most_share = 0.0;
    // True if the wait ended because of the stop.
    while (!changed_.wait_for(lock, stop, kBetween, [&] { return stop.stop_requested(); })) {
      const base::JobEstimate estimate = progress.estimate();
      if (estimate.elapsed_s >= kFirst_s && estimate.remaining) {
        overwrite_line(present::progress_words(estimate, most_share));
        is_visible = true;
      }
    }
    if (is_visible) {
      // A failing stderr is ignored: the result matters more.
      static_cast<void>(std::fputs("\r\x1b[K", stderr));
    }
  }
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::jthread thread_;
};

JobLine::JobLine() {
  if (isatty(STDERR_FILENO) == 1) {
    progress_ =
        base::JobProgress([] { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); });
    painter_ = std::make_unique<Painter>(progress_);
  }
}

JobLine::~JobLine() = default;

namespace {

/// Only functions that are safe in a signal handler may be called here.
void end_by(int signal) {
  constexpr std::string_view kWords = "\r\x1b[Kinterrupted\n";
  (void)!write(STDERR_FILENO, kWords.data(), kWords.size());
  (void)std::signal(signal, SIG_DFL);
  (void)std::raise(signal);
}

}  // namespace

void announce_interrupts() {
  if (isatty(STDERR_FILENO) == 1 && std::signal(SIGINT, end_by) == SIG_IGN) {
    (void)std::signal(SIGINT, SIG_IGN);
  }
}

}  // namespace heatsoak::cli
