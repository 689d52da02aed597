// Independent suite of `heatsoak diagnose`: makes motors, runs the program, scores its answers.
//   heatsoak_suite OUT [generate|run|score …] --seed N [--only PREFIX]
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>

#include "motor_case.h"
#include "run_program.h"
#include "score.h"

namespace heatsoak::suite {
namespace {

struct Options {
  std::string out;
  std::vector<std::string> steps{"generate", "run", "score"};

  bool has(const std::string& step) const { return std::ranges::find(steps, step) != steps.end(); }

  std::uint64_t seed = 1;
  std::string only;
  std::string program;
  std::string answers;
  int jobs = 1;
};

void generate(const Options& options) {
  for (const CasePlan& plan : planned_cases(options.seed)) {
    if (plan.id.starts_with(options.only)) {
      write_case(make_case(plan, options.seed), options.seed, options.out);
      fmt::print(stderr, "{}\n", plan.id);
    }
  }
}

std::filesystem::path answers_of(const Options& options) {
  return options.answers.empty() ? std::filesystem::path(options.out) / "answers" : std::filesystem::path(options.answers);
}

int run(const Options& options) {
  if (options.program.empty()) {
    fmt::print(stderr, "No program to run: state --program PATH or set HEATSOAK_PROGRAM.\n");
    return 2;
  }
  const int failures = run_motors(
      {.data = options.out, .answers = answers_of(options), .program = options.program, .only = options.only, .jobs = options.jobs});
  fmt::print(stderr, "{} runs failed.\n", failures);
  return 0;
}

void score(const Options& options) {
  const std::string report = report_of(load_answers(options.out, answers_of(options), options.only));
  std::ofstream(answers_of(options) / "score.md") << report;
  fmt::print("{}", report);
}

}  // namespace
}  // namespace heatsoak::suite

int main(int argc, char** argv) {
  using namespace heatsoak::suite;
  Options options;
  CLI::App app{"Synthetic motors with known missing effects for heatsoak diagnose: generate, run and score. Without a step, all three."};
  app.add_option("out", options.out, "folder of the motors")->required();
  app.add_option("steps", options.steps, "steps to do")->check(CLI::IsMember({"generate", "run", "score"}));
  app.add_option("--seed", options.seed, "seed of the motors")->capture_default_str();
  app.add_option("--only", options.only, "only motors whose name begins so, for example null or single_07");
  app.add_option("--program", options.program, "program heatsoak to run")->envname("HEATSOAK_PROGRAM");
  app.add_option("--answers", options.answers, "folder of the answers (default: OUT/answers), one for each program version");
  app.add_option("--jobs", options.jobs, "programs at a time")->capture_default_str()->check(CLI::Range(1, 64));
  CLI11_PARSE(app, argc, argv);
  if (options.has("generate")) {
    generate(options);
  }
  if (options.has("run")) {
    if (const int code = run(options); code != 0) {
      return code;
    }
  }
  if (options.has("score")) {
    score(options);
  }
  return 0;
}
