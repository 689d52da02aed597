#include "present/steady.h"

#include <CLI/App.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "base/air_range.h"
#include "cli/command.h"
#include "cli/condition_option.h"
#include "cli/quantity_option.h"
#include "duty/named_files.h"
#include "motor/conditions.h"
#include "motor/on_off_load.h"

namespace heatsoak::cli::commands {
namespace {

struct SteadyOptions {
  std::string motor;
  std::map<std::string, std::string> conditions;
  thermal::OnOffCurrent current;
};

base::ExitCode run(const SteadyOptions& options, Session& session) {
  duty::NamedFiles named(session.folders());
  const std::optional<motor::Motor> motor = named.motor(options.motor);
  named.throw_if_any();
  const motor::OnOffAnswer answer = motor::under_on_off_current(motor::under(*motor, options.conditions), options.current);
  session.show(present::steady_document(answer));
  return answer.is_over_limit ? base::ExitCode::limit_exceeded : base::ExitCode::done;
}

}  // namespace

Command steady() {
  return {.name = {},
          .summary =
              "Computes mean and highest temperature in the steady state of an on/off current; also equations (8) to (12) of the RoboTeam "
              "Twente paper (copper loss only)",
          .example = "heatsoak steady --motor maxon_ec45_flat_70w_24v --current-on 6A --time-on 4s --time-off 6s --ambient 25degC",
          .declare = [](CLI::App& app, Session& session) -> std::function<base::ExitCode()> {
            const auto options = std::make_shared<SteadyOptions>();
            app.add_option("--motor", options->motor, "id (see `heatsoak list motors`) or file")->required()->type_name("M");
            add_conditions(app, options->conditions);
            add_quantity(app, "--current-on", options->current.current_on_A,
                         {"current-on", "A", base::Range::between(0.0, 1e5), "current while on"})
                ->required();
            add_quantity(app, "--time-on", options->current.time_on_s,
                         {"time-on", "s", base::Range::between(1e-9, 1e9), "time of a cycle with current"})
                ->required();
            add_quantity(app, "--time-off", options->current.time_off_s,
                         {"time-off", "s", base::Range::between(0.0, 1e9), "time of a cycle without current"})
                ->required();
            add_quantity(app, "--ambient", options->current.ambient_C,
                         {"ambient", "degC", base::kPossibleAir_C, "temperature of the air; 25degC unless given"});
            session.add_data_option(app);
            session.add_answer_options(app);
            return [options, &session] { return run(*options, session); };
          }};
}

}  // namespace heatsoak::cli::commands
