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

#include "present/renderer.h"
#include "present/wrap.h"

namespace heatsoak::cli {
namespace {

std::string_view environment(const char* name) {
  const char* const value = std::getenv(name);
  return value ? value : "";
}

/// Estimates the remaining time of a job from its progress.
class Remaining {
 public:
  /// Time counts from the first finished unit: work before it, such as reading files, is of a different kind.
  void start(std::size_t done) {
    if (begin_ == Clock::time_point()) {
      begin_ = Clock::now();
      before_ = done;
    }
  }
  /// Returns "12 s left"; empty until enough is done for an estimate within a factor of two.
  [[nodiscard]] std::string text(std::size_t done, std::size_t total) const {
    constexpr double kLeastElapsed_s = 1.0;
    constexpr double kLeastShare = 0.02;
    const double elapsed_s = std::chrono::duration<double>(Clock::now() - begin_).count();
    const auto finished = static_cast<double>(done - before_);
    if (elapsed_s < kLeastElapsed_s || finished < 2.0 || finished < kLeastShare * static_cast<double>(total - before_)) {
      return "";
    }
    return fmt::format(", {:.0f} s left", std::ceil(elapsed_s * static_cast<double>(total - done) / finished));
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begin_;
  std::size_t before_ = 0;
};

}  // namespace

std::size_t terminal_width(int descriptor) {
  constexpr std::size_t kUsual = 80;
  static constexpr std::size_t kMost = 1000;
  const auto within = [](std::size_t width) { return std::clamp(width, present::kLeastWidth, kMost); };
  const std::string_view columns = environment("COLUMNS");
  std::size_t wanted = 0;
  const auto [end, problem] = std::from_chars(columns.data(), columns.data() + columns.size(), wanted);
  if (problem == std::errc() && end == columns.data() + columns.size() && wanted > 0) {
    return within(wanted);
  }
  winsize size{};
  return ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? within(size.ws_col) : kUsual;
}

bool takes_colors(int descriptor) { return isatty(descriptor) == 1 && environment("NO_COLOR").empty() && environment("TERM") != "dumb"; }

namespace {

/// Overwrites the line of stderr. A text that filled the line would leave copies of itself.
void overwrite_line(std::string_view text) { fmt::print(stderr, "\r\x1b[K{}", present::leading(text, terminal_width(STDERR_FILENO) - 1)); }

/// A line on stderr that is overwritten and removed at the end, even if the work ends early.
class Bar {
 public:
  explicit Bar(std::string what) : what_(std::move(what)) {}
  Bar(const Bar&) = delete;
  Bar& operator=(const Bar&) = delete;
  ~Bar() { clear(); }

  void show(std::size_t done, std::size_t total) {
    constexpr std::chrono::milliseconds kBetween(200);
    remaining_.start(done);
    if (done == total) {
      clear();
    } else if (const Clock::time_point now = Clock::now(); now - shown_ > kBetween) {
      shown_ = now;
      is_visible_ = true;
      // A job that turns out to be longer keeps its percentage until the work has caught up; the remaining time grows.
      most_share_ = std::max(most_share_, static_cast<double>(done) / static_cast<double>(total));
      overwrite_line(fmt::format("{}: {:.0f} %{}", what_, 100.0 * most_share_, remaining_.text(done, total)));
    }
  }

 private:
  using Clock = std::chrono::steady_clock;
  void clear() {
    if (is_visible_) {
      // A failing stderr is ignored: the result matters more.
      static_cast<void>(std::fputs("\r\x1b[K", stderr));
      is_visible_ = false;
    }
  }
  std::string what_;
  Remaining remaining_;
  Clock::time_point shown_ = Clock::now();
  double most_share_ = 0.0;
  bool is_visible_ = false;
};

/// A thread that overwrites one line on stderr every second, and removes it at the end.
class ElapsedLine {
 public:
  explicit ElapsedLine(std::string what) : thread_([this, what = std::move(what)](const std::stop_token& stop) { run(what, stop); }) {}

 private:
  void run(const std::string& what, const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    int elapsed_s = 0;
    // True if the wait ended because of the stop.
    while (!changed_.wait_for(lock, stop, std::chrono::seconds(1), [&] { return stop.stop_requested(); })) {
      overwrite_line(fmt::format("{}: {} s", what, ++elapsed_s));
    }
    if (elapsed_s > 0) {
      static_cast<void>(std::fputs("\r\x1b[K", stderr));
    }
  }
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::jthread thread_;
};

}  // namespace

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

std::shared_ptr<void> elapsed_line(std::string what) {
  return isatty(STDERR_FILENO) == 0 ? nullptr : std::make_shared<ElapsedLine>(std::move(what));
}

base::Progress progress_bar(std::string what) {
  if (isatty(STDERR_FILENO) == 0) {
    return {};
  }
  return [bar = std::make_shared<Bar>(std::move(what))](std::size_t done, std::size_t total) { bar->show(done, total); };
}

}  // namespace heatsoak::cli
