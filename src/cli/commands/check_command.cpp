#include <fmt/format.h>

#include <CLI/App.hpp>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <optional>

#include "base/quantity.h"
#include "base/version.h"
#include "check/check_job.h"
#include "cli/command.h"
#include "cli/quantity_option.h"
#include "present/check.h"
#include "present/github.h"
#include "present/junit.h"

namespace heatsoak::cli::commands {
namespace {

struct CheckOptions {
  check::CheckJob job;
  std::string junit;
};

std::string environment(const char* name) {
  const char* const value = std::getenv(name);
  return value ? value : "";
}

/// For GitHub Actions: adds an annotation for each violated limit and a table on the page of the run. If the page cannot be written, the
/// command only warns.
void write_github(const std::vector<check::Outcome>& outcomes, Session& session) {
  if (environment("GITHUB_ACTIONS") == "true") {
    session.say(present::annotations(outcomes, environment("GITHUB_WORKSPACE")));
  }
  if (const std::string page = environment("GITHUB_STEP_SUMMARY"); !page.empty()) {
    session.complete_with([page, text = present::summary_markdown(outcomes, base::program_version())] {
      std::ofstream file(page, std::ios::app | std::ios::binary);
      if (!(file << text).flush()) {
        fmt::print(stderr, "warning: the summary of the run is missing: {} cannot be written\n", page);
      }
    });
  }
}

/// Refuses a bare number of 1 or more: it would be 100 % or more, and usually means percent.
std::string share_problem(const std::string& word) {
  const std::optional<double> bare = base::parse_number(word);
  return bare && std::isfinite(*bare) && *bare >= 1.0
             ? fmt::format("{0} is {1:.6g} %; did you mean {2:.6g} %? Expected a share of at most 100 %, such as 5% or 0.05", word,
                           100.0 * *bare, *bare)
             : std::string();
}

base::ExitCode run(CheckOptions& options, Session& session) {
  options.job.evaluates_beside_invalid = !options.junit.empty();
  options.job.run_command = [&session](const std::vector<std::string>& words, const std::filesystem::path& folder) {
    return answer_of(words, folder, session.database());
  };
  options.job.check_inputs = [&session](const std::vector<std::string>& words, const std::filesystem::path& folder) {
    check_inputs_of(words, folder, session.database());
  };
  const auto kept = std::make_shared<check::CheckAnswer>();
  if (!options.junit.empty()) {
    session.write_after_failure(options.junit, [kept](const base::Failure& failure) {
      return present::junit_xml(kept->outcomes, failure, base::program_version());
    });
  }
  *kept = with_progress(session,
                        [&](const base::JobProgress& progress) { return check::run_check_job(options.job, session.folders(), progress); });
  const check::CheckAnswer& answer = *kept;
  if (answer.invalid) {
    throw base::Failure(*answer.invalid);
  }
  for (const check::RewrittenFile& each : answer.rewritten) {
    session.rewrite(each.path, each.text);
  }
  if (!options.junit.empty()) {
    session.write(options.junit, present::junit_xml(answer.outcomes, base::program_version()));
  }
  session.show(present::check_document(answer.outcomes, options.job.updates, options.job.files));
  write_github(answer.outcomes, session);
  return answer.passed() ? base::ExitCode::done : base::ExitCode::limit_exceeded;
}

}  // namespace

Command check_command() {
  return {.name = {},
          .summary = "Compares computed values with your own limits, for CI; exit 1 if a limit does not hold or cannot be evaluated",
          .example = "heatsoak check reports/check/twente.check.toml --junit check.xml",
          .declare = [](CLI::App& app, Session& session) -> std::function<base::ExitCode()> {
            const auto options = std::make_shared<CheckOptions>();
            app.add_option("files", options->job.files, "check files (`heatsoak list thresholds` shows what can have a limit)")
                ->required()
                ->type_name("FILE.toml");
            app.add_option("--junit", options->junit, "write the result as JUnit XML, for CI services")
                ->type_name("FILE.xml")
                ->check([](const std::string& word) {
                  return word == "-" ? "is stdout, which has the answer for people; expected the name of a file" : std::string();
                });
            CLI::Option* const update = app.add_flag(
                "--update", options->job.updates,
                "rewrite the limits in the files to the present values with some room; limits that cannot be evaluated stay unchanged");
            add_quantity(
                app, "--margin", options->job.margin_share,
                {"margin", "", base::Range::between(0.0, 1.0),
                 "room that --update leaves, as a share of the value, or of the rise over the air for a temperature; 5 % unless given"})
                ->type_name("SHARE")
                ->check(share_problem)
                ->needs(update);
            app.add_option("--threads", options->job.threads, "number of threads, 0 for all cores; the result does not depend on it")
                ->check(whole_number(1024))
                ->capture_default_str();
            session.add_data_option(app);
            session.add_answer_options(app);
            return [options, &session] { return run(*options, session); };
          }};
}

}  // namespace heatsoak::cli::commands
