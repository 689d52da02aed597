#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <span>
#include <utility>

#include "base/files.h"
#include "base/version.h"
#include "cli/command.h"
#include "cli/commands_registry.h"
#include "cli/help_text.h"
#include "cli/terminal.h"
#include "cli/usage.h"
#include "input/document.h"
#include "present/failure_words.h"
#include "present/github.h"
#include "present/json.h"
#include "present/renderer.h"
#include "present/wrap.h"
#include "present/written_files.h"
#include "report/chart.h"

namespace heatsoak::cli {
namespace {

constexpr const char* kSummary = "Predicts whether a motor survives a match, and the current that its firmware may allow.";

constexpr std::string_view kFooter =
    "\nExit codes: 0 done and within limits, 1 a limit is exceeded, 2 bad input or\n"
    "usage, 3 the data cannot answer the question, 4 the numerics failed, 70 a bug.\n\n"
    "Start here:\n  heatsoak evaluate --robot roboteam_twente_v2024 --duty division_a_match\n";

constexpr std::string_view kWithoutMeasured =
    "\nThis program was built without log, friction, calibrate, predict and diagnose;\n`./bootstrap build` adds them.\n";

/// Options that name an output file of a command.
constexpr std::array kOutputs{"--out", "--plot", "--json", "--junit", "--report"};

/// CLI11 reports bad usage before it stores any option, so the target of a JSON error is searched for here.
std::string json_target(int argc, const char* const* argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--json" && i + 1 < argc && is_output(argv[i + 1])) {
      return argv[i + 1];
    }
    if (word.starts_with("--json=")) {
      return std::string(word.substr(7));
    }
  }
  return {};
}

/// Returns "heatsoak evaluate", or the program's name alone if the command line names no command.
std::string verb_of(const CLI::App& app) {
  const auto verbs = app.get_subcommands();
  return verbs.empty() ? app.get_name() : fmt::format("{} {}", app.get_name(), verbs.front()->get_name());
}

/// Adds line numbers to diagnostics that have only a file and a key.
base::Failure with_places(const base::Failure& failure) {
  std::vector<base::Diagnostic> all(failure.diagnostics().begin(), failure.diagnostics().end());
  for (base::Diagnostic& each : all) {
    if (!each.at.line && !each.key.empty() && each.at.file.ends_with(".toml")) {
      each.at = input::place_of(each.at.file, each.key);
    }
  }
  return {failure.code(), failure.message(), std::move(all)};
}

/// Returns annotations for GitHub Actions at each line with a problem; empty elsewhere.
std::string annotations_of(const base::Failure& failure) {
  const auto environment = [](const char* name) {
    const char* const value = std::getenv(name);
    return std::string(value ? value : "");
  };
  std::string text;
  for (const base::Diagnostic& each : failure.diagnostics()) {
    if (each.at.line && environment("GITHUB_ACTIONS") == "true") {
      text += present::annotation(each.at, environment("GITHUB_WORKSPACE"), each.key.empty() ? "heatsoak" : each.key, each.message);
    }
  }
  return text;
}

int fail(Session& session, const base::Failure& found) {
  const base::Failure failure = with_places(found);
  const std::string text = printable(std::string(failure.what()) + "\n" + annotations_of(failure));
  put(stderr, isatty(STDERR_FILENO) == 1 ? present::folded(text, terminal_width(STDERR_FILENO)) : text);
  session.answer_failure(failure);
  return static_cast<int>(failure.code());
}

/// Called before any computation. The error goes to stderr only: as JSON it would overwrite the other output.
void refuse_one_file_for_two(const CLI::App& verb, Session& session) {
  std::vector<std::pair<const char*, std::string>> given;
  for (const char* const name : kOutputs) {
    const CLI::Option* const option = verb.get_option_no_throw(name);
    if (!option || option->empty() || option->results().front() == "-") {
      continue;
    }
    const std::string& file = option->results().front();
    for (const auto& [other, taken] : given) {
      if (base::are_one_file(file, taken)) {
        session.set_json_target({});
        throw base::Failure(base::ExitCode::bad_input,
                            fmt::format("{} and {} name one file, {}; give each a file of its own", other, name, file));
      }
    }
    given.emplace_back(name, file);
  }
}

/// Adds the files that the options name; a folder is left to its command, which knows its files.
void expect_outputs(const CLI::App& verb, Session& session) {
  for (const char* const name : kOutputs) {
    const CLI::Option* const option = verb.get_option_no_throw(name);
    if (option && !option->empty() && option->results().front() != "-" && option->get_type_name() != "DIR") {
      session.expect_output(option->results().front());
    }
  }
}

/// Called before any computation: an answer that takes minutes must not be lost because its picture cannot be drawn.
void require_drawing_for(const CLI::App& verb) {
  const CLI::Option* const plot = verb.get_option_no_throw("--plot");
  const CLI::Option* const report = verb.get_option_no_throw("--report");
  if (plot && !plot->empty()) {
    report::require_drawing("--plot", "leave out --plot for the answer without a picture");
  } else if (plot && report && !report->empty() && report->results().front().ends_with(".html")) {
    report::require_drawing("--report", "give a name that ends in .md for the report without a picture");
  }
}

/// Declares all commands; the one that is parsed runs and sets `code`.
void declare_commands(CLI::App& app, Session& session, base::ExitCode& code) {
  app.set_help_flag("-h,--help", "show this help");
  app.set_version_flag("--version", fmt::format("heatsoak {}", base::program_version()), "show the version of the program");
  app.require_subcommand(1);
  const std::size_t width = terminal_width(STDOUT_FILENO);
  app.formatter(std::make_shared<HelpText>(width));
  const std::vector<Command> commands = all_commands();
  const bool reads_logs = std::ranges::find(commands, "log", &Command::name) != commands.end();
  app.footer(fmt::format("{}{}", kFooter, reads_logs ? "" : kWithoutMeasured));
  for (const Command& command : commands) {
    CLI::App* verb = app.add_subcommand(std::string(command.name), std::string(command.summary));
    verb->group("Verbs");
    verb->footer(fmt::format("\nExample:\n{}", folded_commands(command.example, width)));
    const std::function<base::ExitCode()> run = command.declare(*verb, session);
    verb->callback([run, verb, &session, &code] {
      refuse_one_file_for_two(*verb, session);
      require_drawing_for(*verb);
      expect_outputs(*verb, session);
      code = run();
    });
  }
}

/// Returns the exit code of a request for help or the version; otherwise throws Failure with all mistakes.
int code_of(const CLI::ParseError& error, const CLI::App& app, std::span<const char* const> words) {
  if (error.get_exit_code() == 0) {
    return app.exit(error);
  }
  throw base::Failure(base::ExitCode::bad_input,
                      fmt::format("{}\n`{} --help` shows the options and an example", all_mistakes(error, app, words), verb_of(app)));
}

int parse_and_run(int argc, const char* const* argv, Session& session) {
  CLI::App app(kSummary, "heatsoak");
  base::ExitCode code = base::ExitCode::done;
  declare_commands(app, session, code);
  session.set_json_target(json_target(argc, argv));
  const auto words = std::span(argv, static_cast<std::size_t>(argc)).subspan(argc > 0 ? 1 : 0);
  // CLI11 reports a missing option before a misspelt one, so words are checked first.
  check_words(app, words);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return code_of(error, app, words);
  }
  session.finish();
  return static_cast<int>(code);
}

/// Changes the working directory until the destructor.
class WorkingFolder {
 public:
  explicit WorkingFolder(const std::filesystem::path& folder) {
    std::error_code problem;
    std::filesystem::current_path(folder, problem);
    if (problem) {
      throw base::Failure(base::ExitCode::bad_input, fmt::format("{}: cannot be entered: {}", folder.string(), problem.message()));
    }
  }
  WorkingFolder(const WorkingFolder&) = delete;
  WorkingFolder& operator=(const WorkingFolder&) = delete;
  ~WorkingFolder() {
    std::error_code gone;
    std::filesystem::current_path(before_, gone);
  }

 private:
  std::filesystem::path before_ = std::filesystem::current_path();
};

}  // namespace

namespace {

/// Adds --db unless the words have it. Must be called before the working directory changes.
std::vector<std::string> with_database(std::vector<std::string> words, const std::string& database) {
  const bool has_database = std::ranges::any_of(words, [](const std::string& word) { return word == "--db" || word.starts_with("--db="); });
  if (!database.empty() && !has_database) {
    words.insert(words.end(), {"--db", std::filesystem::absolute(database).string()});
  }
  return words;
}

/// Runs a command with its JSON answer on stdout of the session.
void run_words(const std::vector<std::string>& words, Session& session) {
  CLI::App app(kSummary, "heatsoak");
  base::ExitCode code = base::ExitCode::done;
  declare_commands(app, session, code);
  std::vector<const char*> raw{"heatsoak"};
  std::ranges::transform(words, std::back_inserter(raw), [](const std::string& word) { return word.c_str(); });
  const std::span<const char* const> after_name = std::span(raw).subspan(1);
  session.set_json_target("-");
  check_words(app, after_name);
  try {
    app.parse(static_cast<int>(raw.size()), raw.data());
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) {
      static_cast<void>(code_of(error, app, after_name));
    }
  }
}

base::Failure without_answer(const std::vector<std::string>& words) {
  return {base::ExitCode::bad_input,
          fmt::format("`heatsoak {}` has no JSON answer on stdout; expected a command with one, without --json", fmt::join(words, " "))};
}

/// Returns the failure with its message on one line, for the diagnostic of another file.
base::Failure on_one_line(const base::Failure& failure) {
  std::string message;
  for (const char c : failure.message()) {
    message += c == '\n' ? std::string("; ") : std::string(1, c);
  }
  return {failure.code(), std::move(message), {failure.diagnostics().begin(), failure.diagnostics().end()}};
}

}  // namespace

present::Json answer_of(const std::vector<std::string>& words, const std::filesystem::path& folder, const std::string& database) {
  const std::vector<std::string> all = with_database(words, database);
  const WorkingFolder here(folder.empty() ? "." : folder);
  Session session;
  session.write_no_files();
  run_words(all, session);
  present::Json answer = session.stdout_json();
  if (answer.is_null()) {
    throw without_answer(words);
  }
  return answer;
}

void check_inputs_of(const std::vector<std::string>& words, const std::filesystem::path& folder, const std::string& database) {
  const std::vector<std::string> all = with_database(words, database);
  const WorkingFolder here(folder.empty() ? "." : folder);
  Session session;
  session.stop_at_computation();
  bool has_answer = false;
  try {
    run_words(all, session);
    has_answer = !session.stdout_json().is_null();
  } catch (const InputsRead&) {
    has_answer = session.gives_json_on_stdout();
  } catch (const base::Failure& failure) {
    if (failure.code() == base::ExitCode::bad_input) {
      throw with_places(on_one_line(present::in_words(failure)));
    }
    return;
  }
  if (!has_answer) {
    throw without_answer(words);
  }
}

std::vector<Command> all_commands() {
  std::vector<Command> all;
  for (const auto& [name, make] : commands::registry) {
    all.push_back(make());
    // A command whose name is a C++ keyword or clashes with a function has a different file name.
    all.back().name = name.ends_with("_command") ? name.substr(0, name.size() - std::string_view("_command").size()) : name;
  }
  return all;
}

namespace {

/// Returns why stdout could not be written. `error` is 0 if an earlier write failed.
std::string_view stdout_problem(int error) {
  if (error == EBADF || fcntl(STDOUT_FILENO, F_GETFD) == -1) {
    return "stdout is closed, so the answer is lost; expected a terminal, a file or a pipe, or --json FILE\n";
  }
  return error == ENOSPC || error == EFBIG ? "stdout cannot be written: the disk is full or the file too large\n"
                                           : "stdout cannot be written; expected a terminal, a file or a pipe\n";
}

}  // namespace

int run_program(int argc, const char* const* argv) {
  // With SIGXFSZ ignored, a file beyond the user's size limit fails like a full disk, with a message.
  (void)std::signal(SIGXFSZ, SIG_IGN);
  announce_interrupts();
  Session session;
  try {
    const int code = parse_and_run(argc, argv, session);
    errno = 0;
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
      put(stderr, stdout_problem(errno));
      return static_cast<int>(base::ExitCode::bad_input);
    }
    return code;
  } catch (const base::Failure& failure) {
    return fail(session, failure);
  } catch (const std::bad_alloc&) {
    return fail(session, base::Failure(base::ExitCode::numerics_failed, "out of memory"));
  } catch (const std::exception& error) {
    return fail(session, base::Failure(base::ExitCode::bug, fmt::format("this is a bug in heatsoak, please report it: {}", error.what())));
  }
}

}  // namespace heatsoak::cli
