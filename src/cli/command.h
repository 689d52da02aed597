// What a verb is, and what all verbs share. One file in src/cli/commands each.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"
#include "base/files.h"
#include "cli/terminal.h"
#include "input/data_folders.h"
#include "present/document.h"
#include "select/evaluate.h"

namespace CLI {
class App;
}

namespace heatsoak {

/// The options that every verb has, and where answers go.
class Session {
 public:
  void add_data_option(CLI::App& app);   ///< --db
  void add_json_option(CLI::App& app);   ///< --json
  void add_text_options(CLI::App& app);  ///< --explain, --quiet and --report, for verbs that show() documents

  [[nodiscard]] DataFolders folders() const;
  // What a verb has to tell is kept until it is done: finish() puts out all of it or, where a file cannot be written, none.

  /// Text for people: stdout, or stderr where the JSON takes stdout. Control characters are shown as '?'.
  void say(std::string_view text);
  /// The same as a document: as wide as the terminal, with its notes as --explain and --quiet say, and as a file for --report.
  void show(const present::Document& document);
  /// A file that the user asked for.
  void write(const std::filesystem::path& path, std::string content) { files_.push_back({path, std::move(content)}); }
  /// A file of the user's that this command has read and changes in place, because it was asked to.
  void rewrite(const std::filesystem::path& path, std::string content) { rewritten_.push_back({path, std::move(content)}); }
  /// The same for content that is put out as it is made. Lives as long as the session.
  StreamedFile& stream(const std::filesystem::path& path) { return *streams_.emplace_back(std::make_unique<StreamedFile>(path)); }
  /// A folder for files, made with them or not at all.
  void make_folder(std::filesystem::path path) { folders_.push_back(std::move(path)); }
  /// Runs once all files are written, before the text: for the rename that completes a folder.
  void complete_with(std::function<void()> last) { last_ = std::move(last); }
  /// The answer, for where --json asks for it; nothing without --json. The program's version is added behind its schema.
  void answer(const nlohmann::ordered_json& json);
  void finish();
  /// Instead of everything else.
  void answer_failure(const Failure& failure);
  void set_json_target(std::string target) { json_target_ = std::move(target); }

 private:
  std::string database_;
  std::string json_target_;
  std::string report_;
  bool explains_ = false;
  bool is_quiet_ = false;
  std::string text_;       ///< free of control characters but those that colour it
  std::string json_text_;  ///< for stdout
  std::vector<std::filesystem::path> folders_;
  std::vector<OutputFile> files_;
  std::vector<OutputFile> rewritten_;
  std::vector<std::unique_ptr<StreamedFile>> streams_;
  std::function<void()> last_;
};

/// An effect that a verb's answers may name and that is none of the network's.
struct Topic {
  std::string id;
  std::string summary;
  std::string text;  ///< for people
  std::function<nlohmann::ordered_json()> json;
};

struct Command {
  std::string_view name;  ///< the file's name without a trailing "_command"; set by all_commands()
  std::string_view summary;
  std::string_view example;  ///< a command line that can be pasted
  /// Declares the options on `app` and returns what runs once they are parsed.
  std::function<std::function<ExitCode()>(CLI::App& app, Session& session)> declare;
  std::function<std::vector<Topic>()> topics{};  ///< for `list` and `describe`
};
std::vector<Command> all_commands();

/// "1 file", "2 files".
std::string counted(std::size_t count, std::string_view what);

/// The value of a JSON number that may be unknown: null for NaN, else rounded to `decimals`.
nlohmann::ordered_json rounded(double value, int decimals);

/// The whole program. Never throws.
int run_program(int argc, const char* const* argv);

}  // namespace heatsoak
