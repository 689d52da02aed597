#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <utility>

#include "base/collected_failures.h"
#include "base/files.h"
#include "cli/command.h"
#include "cli/terminal.h"
#include "cli/usage.h"
#include "present/failure_words.h"
#include "present/json.h"
#include "present/renderer.h"
#include "present/written_files.h"
#include "report/chart.h"

namespace heatsoak::cli {
namespace {

/// Returns whether a JSON answer may replace the file. A user who takes --json for a switch may have named another file after it.
bool may_take_json(const std::filesystem::path& path) {
  std::error_code unreadable;
  if (path.extension() == ".json" || !std::filesystem::is_regular_file(path, unreadable)) {
    return true;
  }
  std::ifstream file(path);
  const auto first = (file >> std::ws).peek();
  return first == '{' || first == std::ifstream::traits_type::eof();
}

/// Creates missing folders and returns those that were created, the innermost first.
std::vector<std::filesystem::path> made_folders(const std::vector<std::filesystem::path>& wanted) {
  std::vector<std::filesystem::path> made;
  for (const std::filesystem::path& folder : wanted) {
    std::vector<std::filesystem::path> missing;
    for (std::filesystem::path each = folder; !each.empty() && !std::filesystem::exists(each); each = each.parent_path()) {
      missing.push_back(each);
    }
    std::error_code problem;
    std::filesystem::create_directories(folder, problem);
    if (problem) {
      throw base::Failure(base::ExitCode::bad_input, fmt::format("{}: the folder cannot be made: {}", folder.string(), problem.message()));
    }
    made.insert(made.begin(), missing.begin(), missing.end());
  }
  return made;
}

}  // namespace

void Session::add_data_option(CLI::App& app) {
  app.add_option("--db", database_, "folder with motor_db/ (and duty_profiles/, robots/), or with motor files itself")->type_name("DIR");
}

void Session::add_answer_options(CLI::App& app) {
  const auto names_a_file = [](const std::string& word) {
    return is_output(word) ? "" : fmt::format("{} is not the name of a file; expected one, or - for stdout", word);
  };
  app.add_flag("--explain", explains_, "show every note, not only the three most important ones");
  app.add_flag("--quiet", is_quiet_, "show only the first lines, which contain the answer; a list shows only its names");
  app.add_option("--report", report_,
                 "write the whole answer as a document, with every column and note, as Markdown, HTML or JSON by the file's ending; - is "
                 "stdout, with Markdown in place of the text")
      ->type_name("FILE");
  app.add_option("--json", json_target_, "write the answer as JSON; - is stdout, the text then goes to stderr")
      ->type_name("FILE")
      ->check(names_a_file);
}

void Session::say(std::string_view text) { (report_ == "-" ? beside_ : text_) += printable(text); }

std::vector<std::string> Session::names_of_added() const {
  std::vector<std::filesystem::path> all = completed_files_;
  std::ranges::transform(streams_, std::back_inserter(all), [](const auto& each) { return each->path(); });
  std::ranges::transform(files_, std::back_inserter(all), &base::OutputFile::path);
  std::ranges::transform(rewritten_, std::back_inserter(all), &base::OutputFile::path);
  std::vector<std::filesystem::path> folders = folders_;
  folders.push_back(completed_folder_);
  return present::names_of_written(all, folders);
}

void Session::show(present::Document document) {
  add_json(document);
  document.files = names_of_added();
  const int descriptor = json_target_ == "-" ? STDERR_FILENO : STDOUT_FILENO;
  if (report_ == "-") {
    text_ += present::rendered_as("markdown", document);
    return;
  }
  if (!report_.empty()) {
    write(report_, present::rendered_for(report_, document));
    document.files = names_of_added();
  }
  text_ += present::terminal_text(document, {.width = terminal_width(descriptor),
                                             .with_colors = takes_colors(descriptor),
                                             .is_terminal = isatty(descriptor) == 1,
                                             .breaks_rows = known_width(descriptor).has_value(),
                                             .explains = explains_,
                                             .is_quiet = is_quiet_});
}

void Session::draw(present::Document& document, const std::string& plot, report::Chart chart) {
  if (!plot.empty()) {
    write(plot, report::draw_picture(chart, plot));
  }
  document.charts.push_back(std::move(chart));
}

input::DataFolders Session::folders() const { return input::DataFolders::find(database_); }

void Session::require_readable(const std::vector<std::string>& names) const {
  if (!stops_at_computation_) {
    return;
  }
  base::Diagnostics missing;
  for (const std::string& name : names) {
    const std::filesystem::path path = input::log_named(folders(), name);
    if (!std::ifstream(path)) {
      missing.add({path.string()}, "", fmt::format("cannot be read: {}", std::strerror(errno)));
    }
  }
  missing.throw_if_any();
}

void Session::add_json(const present::Document& document) {
  if (json_target_ == "-") {
    json_text_ = present::rendered_as("json", document);
  } else if (!json_target_.empty()) {
    files_.push_back({json_target_, present::rendered_as("json", document)});
  }
}

/// Throws Failure (bad_input) with all files that the command has read, and with a JSON target that is another file of the user.
void Session::refuse_to_overwrite(const std::vector<std::filesystem::path>& files) const {
  std::vector<base::Diagnostic> read;
  for (const std::filesystem::path& path : files) {
    if (base::is_input(path)) {
      read.push_back({{path.string()}, {}, "this command reads the file and would overwrite it; give the output another name"});
    }
  }
  if (read.empty() && !json_target_.empty() && !may_take_json(json_target_)) {
    read.push_back({{json_target_}, {}, "is not an answer of this program, and --json would overwrite it; give the answer another name"});
  }
  if (!read.empty()) {
    throw base::Failure(base::ExitCode::bad_input, "", std::move(read));
  }
}

void Session::begin_computation() const {
  if (stops_at_computation_) {
    throw InputsRead();
  }
  if (!writes_files_) {
    return;
  }
  refuse_to_overwrite(expected_files_);
  const std::vector<std::filesystem::path> made =
      expected_folder_.empty() ? std::vector<std::filesystem::path>{} : made_folders({expected_folder_});
  base::CollectedFailures failures;
  for (const std::filesystem::path& each : expected_files_) {
    failures.attempt([&each] { base::require_writable(each); });
  }
  for (const std::filesystem::path& folder : made) {
    std::error_code in_use;
    std::filesystem::remove(folder, in_use);
  }
  failures.throw_if_any();
}

void Session::finish() {
  after_failure_.clear();  // a failure from here on concerns the files themselves
  std::vector<std::filesystem::path> written;
  std::ranges::transform(streams_, std::back_inserter(written), [](const auto& each) { return each->path(); });
  std::ranges::transform(files_, std::back_inserter(written), &base::OutputFile::path);
  refuse_to_overwrite(written);
  const std::vector<std::filesystem::path> made = made_folders(folders_);
  files_.insert(files_.end(), rewritten_.begin(), rewritten_.end());
  try {
    base::write_files(files_, streams_);
    if (last_) {
      last_();
    }
  } catch (...) {
    for (const std::filesystem::path& folder : made) {
      std::error_code in_use;
      std::filesystem::remove(folder, in_use);
    }
    throw;
  }
  put(json_target_ == "-" ? stderr : stdout, text_);
  put(stderr, beside_);
  put(stdout, json_text_);
}

void Session::answer_failure(const base::Failure& failure) {
  text_.clear();
  beside_.clear();
  json_text_.clear();
  folders_.clear();
  files_.clear();
  rewritten_.clear();
  streams_.clear();
  last_ = nullptr;
  completed_folder_.clear();
  completed_files_.clear();
  for (const auto& [path, text] : std::exchange(after_failure_, {})) {
    files_.push_back({path, text(failure)});
  }
  const present::Document error{.data = present::failure_json(failure)};
  add_json(error);
  if (report_.ends_with(".json")) {
    write(report_, present::rendered_for(report_, error));
  }
  try {
    finish();
  } catch (const base::Failure& unwritable) {
    if (std::string_view(unwritable.what()) != failure.what()) {
      put(stderr, printable(unwritable.what()) + "\n");
    }
  }
}

present::Json Session::stdout_json() const { return json_text_.empty() ? present::Json() : present::Json::parse(json_text_); }

}  // namespace heatsoak::cli
