#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "base/version.h"
#include "check/check_text.h"
#include "check/limit.h"
#include "check/rewrite.h"
#include "check/run_checks.h"
#include "cli/command.h"
#include "cli/quantity_option.h"
#include "present/check.h"

namespace heatsoak::commands {
namespace {

constexpr std::size_t kLargestFile_bytes = 1'000'000;

struct Options {
  std::vector<std::string> files;
  std::string junit;
  bool is_update = false;
  double margin_share = 0.05;
  int threads = 0;
};

std::string environment(const char* name) {
  const char* const value = std::getenv(name);
  return value ? value : "";
}

/// Reads all files and reports the problems of all of them together.
std::vector<CheckFile> read_files(const std::vector<std::string>& names, const DataFolders& folders) {
  std::vector<CheckFile> files;
  std::string message;
  std::vector<Diagnostic> problems;
  for (const std::string& name : names) {
    try {
      // The example in the help is a file that came with the program.
      files.push_back(read_check_file(log_named(folders, name), folders));
    } catch (const Failure& failure) {
      if (failure.code() != ExitCode::bad_input) {
        throw;
      }
      message += failure.message();
      problems.insert(problems.end(), failure.diagnostics().begin(), failure.diagnostics().end());
    }
  }
  if (!problems.empty() || !message.empty()) {
    throw Failure(ExitCode::bad_input, std::move(message), std::move(problems));
  }
  return files;
}

/// Throws if the file was found beside the program, because it is not the user's.
void refuse_shipped(const std::filesystem::path& path, const Options& options) {
  if (std::ranges::find(options.files, path.string()) == options.files.end()) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{} is part of the installed program and is not rewritten; copy it first", path.string()));
  }
}

/// For GitHub Actions: adds an annotation for each violated limit and a table on the page of the run. If the page cannot be written, the
/// command only warns.
void write_github(const std::vector<Outcome>& outcomes, Session& session) {
  if (environment("GITHUB_ACTIONS") == "true") {
    session.say(annotations(outcomes, environment("GITHUB_WORKSPACE")));
  }
  if (const std::string page = environment("GITHUB_STEP_SUMMARY"); !page.empty()) {
    session.complete_with([page, text = summary_markdown(outcomes, program_version())] {
      std::ofstream file(page, std::ios::app | std::ios::binary);
      if (!(file << text).flush()) {
        fmt::print(stderr, "warning: the summary of the run is missing: {} cannot be written\n", page);
      }
    });
  }
}

ExitCode run(const Options& options, Session& session) {
  const std::vector<CheckFile> files = read_files(options.files, session.folders());
  std::vector<Outcome> outcomes;
  for (const CheckFile& file : files) {
    std::vector<Outcome> of_file = run_checks(file, options.threads, progress_bar("checking"));
    if (options.is_update) {
      refuse_shipped(file.path, options);
      const std::string before = read_file(file.path, kLargestFile_bytes);
      if (std::string after = with_new_limits(before, of_file, options.margin_share); after != before) {
        session.rewrite(file.path, std::move(after));
      }
    }
    std::ranges::move(of_file, std::back_inserter(outcomes));
  }
  if (!options.junit.empty()) {
    session.write(options.junit, junit_xml(outcomes, program_version()));
  }
  present::Document document = present::check_document(outcomes, options.is_update);
  document.add_file(options.junit);
  session.show(document);
  write_github(outcomes, session);
  const bool passed = std::ranges::all_of(outcomes, &Outcome::passed);
  session.answer(present::check_json(outcomes, options.files));
  return passed ? ExitCode::done : ExitCode::limit_exceeded;
}

}  // namespace

Command check_command() {
  return {.name = {},
          .summary = "Compares what is computed with limits of your own, for CI; exit 1 if one does not hold or cannot be evaluated",
          .example = "heatsoak check reports/check/twente.check.toml --junit check.xml",
          .declare = [](CLI::App& app, Session& session) -> std::function<ExitCode()> {
            const auto options = std::make_shared<Options>();
            app.add_option("files", options->files, "check files (`heatsoak list thresholds` shows what can have a limit)")
                ->required()
                ->type_name("FILE.toml");
            app.add_option("--junit", options->junit, "write the result as JUnit XML, for CI services")->type_name("FILE.xml");
            app.add_flag(
                "--update", options->is_update,
                "rewrite the limits in the files to the present values with some room; limits that cannot be evaluated stay unchanged");
            add_quantity(app, "--margin", options->margin_share,
                         {"margin", "", Range::between(0.0, 10.0),
                          "of --update: room as a share of the value, or of the rise over the air for a temperature; 5 % unless given"})
                ->type_name("SHARE");
            app.add_option("--threads", options->threads, "0: all cores; the result does not depend on it")
                ->check(whole_number(1024))
                ->capture_default_str();
            session.add_data_option(app);
            session.add_answer_options(app);
            return [options, &session] { return run(*options, session); };
          }};
}

}  // namespace heatsoak::commands
