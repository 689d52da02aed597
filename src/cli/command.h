// Definition of a command, and what all commands share. One file in src/cli/commands each.
#pragma once

#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/counted.h"
#include "base/diagnostic.h"
#include "base/files.h"
#include "cli/terminal.h"
#include "input/data_folders.h"
#include "present/document.h"

namespace CLI {
class App;
}

namespace heatsoak::cli {

/// Thrown in place of a computation if only the inputs of a command are read: see Session::stop_at_computation().
class InputsRead : public std::exception {};

/// Options that every command has, and the destinations of its output.
class Session {
 public:
  void add_data_option(CLI::App& app);     ///< --db
  void add_answer_options(CLI::App& app);  ///< --explain, --quiet, --report and --json, for commands that show() a document

  [[nodiscard]] input::DataFolders folders() const;
  // All output is kept until the command has finished: finish() writes all of it, or nothing if a file cannot be written.

  /// Adds text for other programs, such as a script: to stdout, or to stderr if the JSON or a report goes to stdout. Control characters are
  /// replaced by '?'. Answers for people are documents: see show().
  void say(std::string_view text);
  /// Adds the answer: in the width of the terminal, with the notes selected by --explain and --quiet, and as files for --report and --json.
  /// It ends with a list of all files that the command writes, so all of them are added before.
  void show(present::Document document);
  /// Adds a file that the user requested.
  void write(const std::filesystem::path& path, std::string content) { files_.push_back({path, std::move(content)}); }
  /// Returns whether the chart of an answer is requested: for the file of --plot, which may be empty, or for an HTML report.
  [[nodiscard]] bool draws(const std::string& plot) const { return !plot.empty() || report_.ends_with(".html"); }
  /// True if only the headline of the answer is shown or written.
  [[nodiscard]] bool shows_only_headline() const { return is_quiet_ && report_.empty() && json_target_.empty(); }
  /// Adds the chart to the document, and its picture to the file of --plot.
  void draw(present::Document& document, const std::string& plot, report::Chart chart);
  /// Adds a file of the user that this command was asked to change in place.
  void rewrite(const std::filesystem::path& path, std::string content) { rewritten_.push_back({path, std::move(content)}); }
  /// Returns a requested file whose content is written piece by piece. It lives as long as the session.
  base::StreamedFile& stream(const std::filesystem::path& path) {
    return *streams_.emplace_back(std::make_unique<base::StreamedFile>(path));
  }
  /// Adds a folder for files; it is created together with them or not at all.
  void make_folder(std::filesystem::path path) { folders_.push_back(std::move(path)); }
  /// Sets a function that runs after all files are written and before the text.
  void complete_with(std::function<void()> last) { last_ = std::move(last); }
  /// Does the same with a function that gives a folder, whose files exist under another name, its name.
  void complete_folder(std::function<void()> rename, std::filesystem::path folder, std::vector<std::filesystem::path> files) {
    complete_with(std::move(rename));
    completed_folder_ = std::move(folder);
    completed_files_ = std::move(files);
  }
  /// Adds a file that is written only if the command fails, in place of all its other files.
  void write_after_failure(std::filesystem::path path, std::function<std::string(const base::Failure&)> text) {
    after_failure_.emplace_back(std::move(path), std::move(text));
  }
  /// If only the inputs are read, throws Failure (bad_input) with all the files that cannot be read; otherwise they are reported when they
  /// are read. `names` as input::log_named() resolves them.
  void require_readable(const std::vector<std::string>& names) const;
  /// Adds a file that the command will write after its computation, in `folder` if that is a folder of its own.
  void expect_output(const std::filesystem::path& path, const std::filesystem::path& folder = {}) {
    expected_files_.push_back(path);
    expected_folder_ = folder.empty() ? expected_folder_ : folder;
  }
  /// Declares that no file is written, whatever the options name.
  void write_no_files() { writes_files_ = false; }
  /// Marks the end of a command's inputs: their mistakes are reported, and the computation begins. Throws Failure (bad_input) if an expected
  /// output cannot be written or would overwrite an input: a computation of minutes must not be lost at its end.
  void begin_computation() const;
  void stop_at_computation() { stops_at_computation_ = true; }
  [[nodiscard]] bool stops_at_computation() const { return stops_at_computation_; }
  void finish();
  /// Reports the failure instead of all other output.
  void answer_failure(const base::Failure& failure);
  void set_json_target(std::string target) { json_target_ = std::move(target); }
  [[nodiscard]] bool gives_json() const { return !json_target_.empty(); }
  [[nodiscard]] bool gives_json_on_stdout() const { return json_target_ == "-"; }
  /// Returns the answer for stdout; null if there is none.
  [[nodiscard]] present::Json stdout_json() const;
  /// Returns the folder of --db; empty without it.
  [[nodiscard]] const std::string& database() const { return database_; }

 private:
  void add_json(const present::Document& document);
  void refuse_to_overwrite(const std::vector<std::filesystem::path>& files) const;
  /// Returns the names of all files that are added so far.
  [[nodiscard]] std::vector<std::string> names_of_added() const;

  std::string database_;
  std::string json_target_;
  std::string report_;
  bool explains_ = false;
  bool is_quiet_ = false;
  bool stops_at_computation_ = false;
  std::string text_;       ///< contains no control characters except colours
  std::string beside_;     ///< text of say() beside a report on stdout: for stderr
  std::string json_text_;  ///< for stdout
  std::vector<std::filesystem::path> expected_files_;
  std::filesystem::path expected_folder_;
  bool writes_files_ = true;
  std::vector<std::filesystem::path> folders_;
  std::vector<base::OutputFile> files_;
  std::vector<base::OutputFile> rewritten_;
  std::vector<std::unique_ptr<base::StreamedFile>> streams_;
  std::function<void()> last_;
  std::filesystem::path completed_folder_;
  std::vector<std::filesystem::path> completed_files_;
  std::vector<std::pair<std::filesystem::path, std::function<std::string(const base::Failure&)>>> after_failure_;
};

/// Begins the computation of a command, shows its progress and returns its result.
template <class Run>
auto with_progress(const Session& session, const Run& run) {
  session.begin_computation();
  const JobLine line;
  return run(line.progress());
}
/// Does the same with a job of one phase, named `what`, which gets a base::Progress. `usual_s`: its usual duration.
template <class Run>
auto with_progress(const Session& session, const std::string& what, double usual_s, const Run& run) {
  session.begin_computation();
  const JobLine line;
  line.progress().expect({{what, usual_s}});
  return run(line.progress().begin(what));
}

struct Command {
  std::string_view name;  ///< name of its source file without a trailing "_command"; set by all_commands()
  std::string_view summary;
  std::string_view example;  ///< a command line that can be pasted and run
  /// Declares the options on `app` and returns the function that runs after they are parsed.
  std::function<std::function<base::ExitCode()>(CLI::App& app, Session& session)> declare;
};
std::vector<Command> all_commands();

/// Runs a command in a folder and returns its JSON answer; prints nothing and writes no file. `database`: folder for --db unless the words
/// name one; may be empty. Throws Failure like the command, and if it has no JSON answer. Changes the working directory while it runs.
present::Json answer_of(const std::vector<std::string>& words, const std::filesystem::path& folder, const std::string& database);
/// Parses the words and reads the inputs of a command that answer_of() can run, but does not compute. Throws Failure (bad_input) with
/// mistakes in them; other failures are those of the answer.
void check_inputs_of(const std::vector<std::string>& words, const std::filesystem::path& folder, const std::string& database);

/// Runs the whole program and returns the exit code. Never throws.
int run_program(int argc, const char* const* argv);

}  // namespace heatsoak::cli
