#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "base/files.h"
#include "cli/command.h"
#include "cli/quantity_option.h"
#include "duty/make_duty.h"
#include "duty/named_files.h"
#include "present/duty.h"
#include "present/game_words.h"

namespace heatsoak::cli::commands {
namespace {

struct DutyOptions {
  std::string duty;
  std::string log;
  std::string player;
  std::string robot;
  std::string out;
  double every_s = 0.01;
  std::uint64_t seed = 1;
  std::string planner = "jerk_limited";
  std::vector<std::string> given;  ///< options given on the command line
};

bool is_given(const DutyOptions& options, std::string_view option) {
  return std::ranges::find(options.given, option) != options.given.end();
}

/// Throws if an option was given that has no effect in this case, because the user expects it to have one.
void refuse(const DutyOptions& options, std::initializer_list<std::string_view> unused, const std::string& why) {
  for (const std::string_view option : unused) {
    if (is_given(options, option)) {
      throw base::Failure(base::ExitCode::bad_input, fmt::format("{} {}", option, why));
    }
  }
}

duty::DutyAnswer answer_of(const duty::DutyJob& job, const Session& session) {
  try {
    return with_progress(session, [&](const base::JobProgress& progress) { return duty::make_duty(job, progress); });
  } catch (const duty::GameNotUsable& failure) {
    throw present::in_words(failure);
  }
}

base::ExitCode run(const DutyOptions& options, Session& session) {
  if (options.duty.empty() == options.log.empty()) {
    throw base::Failure(base::ExitCode::bad_input, "expected one of --duty and --import (`heatsoak duty --help` shows examples)");
  }
  if (options.duty.empty()) {
    refuse(options, {"--seed", "--planner"}, "is for matches; --import reads a recorded game");
  } else {
    refuse(options, {"--player"}, "is for a recorded game (--import)");
  }
  if (options.out.empty()) {
    refuse(options, {"--every"}, "is for the rows of a table; expected --out FILE.csv with it");
  }
  duty::NamedFiles named(session.folders());
  const std::optional<robot::Robot> robot = named.robot(options.robot);
  const std::optional<duty::Duty> duty = options.log.empty() ? named.duty(options.duty) : std::nullopt;
  named.throw_if_any();
  if (!duty) {
    session.require_readable({options.log});
  }
  duty::DutyJob job{.robot = *robot, .duty = duty, .log = options.log, .player = options.player, .every_s = options.every_s};
  if (is_given(options, "--seed")) {
    job.seed = options.seed;
  }
  if (is_given(options, "--planner")) {
    job.planner = options.planner == "bang_bang" ? duty::Planner::bang_bang : duty::Planner::jerk_limited;
  }
  base::StreamedFile* table = nullptr;
  if (!options.out.empty()) {
    job.put_table = [&](std::string_view text) {
      table = table != nullptr ? table : &session.stream(options.out);
      table->write(text);
    };
  }
  const duty::DutyAnswer answer = answer_of(job, session);
  present::Document document = present::duty_document(answer);
  if (!options.out.empty()) {
    std::filesystem::path description = options.out;
    description.replace_extension(".toml");
    session.write(description, duty::duty_file(answer, options.out));
    present::add_next_command(document, description.string());
  }
  session.show(document);
  return base::ExitCode::done;
}

}  // namespace

Command duty_command() {
  return {.name = {},
          .summary = "Generates a duty (a match with its phases and sources of heat), or turns a recorded game into a duty",
          .example = "heatsoak duty --duty division_a_match --robot roboteam_twente_v2024 --seed 1 --out match.csv",
          .declare = [](CLI::App& app, Session& session) -> std::function<base::ExitCode()> {
            const auto options = std::make_shared<DutyOptions>();
            app.add_option("--duty", options->duty, "id (see `heatsoak list duties`) or file")->type_name("D");
            app.add_option("--import", options->log,
                           "recorded game: CSV (t_s, team, robot_id, x_m, y_m, yaw_rad) or SSL_LOG_FILE (.log, .log.gz)")
                ->type_name("LOG");
            app.add_option("--player", options->player, "player of the recorded game, such as \"yellow 3\"; the busiest one unless given")
                ->type_name("P");
            app.add_option("--robot", options->robot, "id (see `heatsoak list robots`) or file")->required()->type_name("R");
            add_table(app, options->out, "table of torque and speed of every wheel; FILE.toml beside it is the duty for `evaluate`");
            add_quantity(app, "--every", options->every_s,
                         {"every", "s", base::Range::between(1e-3, 10.0), "time between two rows; 0.01 s unless given"});
            add_seed(app, options->seed, "seed of a match; the same seed gives the same game");
            app.add_option("--planner", options->planner, "planner of a match")
                ->check(CLI::IsMember({"jerk_limited", "bang_bang"}))
                ->type_name("P")
                ->capture_default_str();
            session.add_data_option(app);
            session.add_answer_options(app);
            return [options, &app, &session] {
              for (const CLI::Option* each : app.get_options([](const CLI::Option* option) { return option->count() > 0; })) {
                options->given.push_back(each->get_name());
              }
              return run(*options, session);
            };
          }};
}

}  // namespace heatsoak::cli::commands
