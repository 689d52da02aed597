// How problems reach the user: where, what, and what to do. One channel for every verb.
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace heatsoak {

/// What the process tells the shell.
enum class ExitCode {
  done = 0,
  limit_exceeded = 1,   ///< a limit or threshold is exceeded
  bad_input = 2,        ///< a file, an option or the environment is wrong
  cannot_answer = 3,    ///< the data cannot answer the question
  numerics_failed = 4,  ///< an integration or a fit did not converge
  bug = 70
};

/// A place in a file of the user; line and column count from 1, 0 where there is none.
struct Location {
  std::string file;
  int line = 0;
  int column = 0;
};

struct Diagnostic {
  Location at;
  std::string key;      ///< dotted path of the value, "figures.torque_constant"; may be empty
  std::string message;  ///< what is wrong, what was expected, what to do
};

/// `file:line:column: error: key: message`, so that editors can jump.
std::string to_string(const Diagnostic& diagnostic);

/// Ends a command: every problem at once, and the exit code.
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

/// One problem of one file.
Failure bad_input(Location at, std::string key, std::string message);

/// Collects problems so that all of them are reported, not only the first.
class Diagnostics {
 public:
  void add(Location at, std::string key, std::string message);
  [[nodiscard]] bool empty() const { return list_.empty(); }
  [[nodiscard]] std::span<const Diagnostic> list() const { return list_; }
  /// Throws Failure (bad_input) with all of them, sorted by place, if there are any.
  void throw_if_any() const;

 private:
  std::vector<Diagnostic> list_;
};

/// `; did you mean 'x'?` for the nearest of the candidates, or nothing where none is near.
std::string did_you_mean(std::string_view written, std::span<const std::string> candidates);

}  // namespace heatsoak
