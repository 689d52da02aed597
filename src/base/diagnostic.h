// Problems as they are reported to the user: place, problem and remedy. All commands use these types.
#pragma once

#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace heatsoak::base {

/// Exit codes of the process.
enum class ExitCode {
  done = 0,
  limit_exceeded = 1,   ///< a limit or threshold is exceeded
  bad_input = 2,        ///< a file, an option or the environment is wrong
  cannot_answer = 3,    ///< the data cannot answer the question
  numerics_failed = 4,  ///< an integration or a fit did not converge
  bug = 70
};

/// A place in one of the user's files. Line and column count from 1. Without them it is the file as a whole.
struct Location {
  std::string file;
  std::optional<int> line = {};
  std::optional<int> column = {};
};

/// Formats as `file:line:column`, as far as they are known.
std::string to_string(const Location& at);

struct Diagnostic {
  Location at;
  std::string key;      ///< dotted path of the value in the file; may be empty
  std::string message;  ///< problem, expectation and remedy
};

/// Formats as `file:line:column: error: key: message`, the form from which editors jump to the place.
std::string to_string(const Diagnostic& diagnostic);

/// Thrown to end a command: an exit code, a summary and the list of all problems found.
class Failure : public std::runtime_error {
 public:
  Failure(ExitCode code, std::string message, std::vector<Diagnostic> diagnostics = {});

  [[nodiscard]] ExitCode code() const { return code_; }
  /// The summary without the list of diagnostics; what() has both.
  [[nodiscard]] const std::string& message() const { return message_; }
  [[nodiscard]] std::span<const Diagnostic> diagnostics() const { return diagnostics_; }

 private:
  ExitCode code_;
  std::string message_;
  std::vector<Diagnostic> diagnostics_;
};

/// Returns a Failure with exit code bad_input and one diagnostic.
Failure bad_input(Location at, std::string key, std::string message);

/// Collects problems so that all of them are reported, not only the first.
class Diagnostics {
 public:
  void add(Location at, std::string key, std::string message);
  [[nodiscard]] bool empty() const { return list_.empty(); }
  [[nodiscard]] std::span<const Diagnostic> list() const { return list_; }
  /// Throws a Failure (bad_input) with all collected problems, sorted by file, line and column. Does nothing if there are none.
  void throw_if_any() const;

 private:
  std::vector<Diagnostic> list_;
};

/// Returns `; did you mean 'x'?` with the candidate closest to `written`, or an empty string if none is close.
std::string did_you_mean(std::string_view written, std::span<const std::string> candidates);

}  // namespace heatsoak::base
