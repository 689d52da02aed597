#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <memory>

#include "cli/command.h"
#include "cli/quantity_option.h"
#include "present/measured/log.h"
#include "present/measured/log_chart.h"
#include "recording/inspect_log.h"

namespace heatsoak::cli::commands {
namespace {

struct LogOptions {
  std::string action;
  std::vector<std::string> files;
  std::string map;
  std::string plot;
  std::string out;
};

void check(const LogOptions& options) {
  const bool converts = options.action == "convert";
  if (converts && (options.files.size() != 1 || options.out.empty() || !options.plot.empty())) {
    throw base::Failure(base::ExitCode::bad_input, "log convert: expected one FILE and --out FILE.csv");
  }
  if (!converts && !options.out.empty()) {
    throw base::Failure(base::ExitCode::bad_input,
                        "log inspect has no --out; `heatsoak log convert FILE --out FILE.csv` writes the canonical form");
  }
  if (!options.plot.empty() && options.files.size() != 1) {
    throw base::Failure(base::ExitCode::bad_input, fmt::format("--plot draws one log; {} are given", options.files.size()));
  }
}

base::ExitCode inspect(const LogOptions& options, Session& session) {
  const std::vector<recording::InspectedLog> logs = recording::inspect_logs(session.folders(), options.files, options.map);
  present::Document document = present::logs_document(logs);
  if (session.draws(options.plot)) {
    for (const recording::InspectedLog& log : logs) {
      session.draw(document, options.plot, present::log_chart(log));
    }
  }
  session.show(document);
  return std::ranges::all_of(logs, &recording::InspectedLog::is_good) ? base::ExitCode::done : base::ExitCode::cannot_answer;
}

base::ExitCode convert(const LogOptions& options, Session& session) {
  recording::ConvertedLog log = recording::convert_log(session.folders(), options.files.front(), options.map);
  session.write(options.out, std::move(log.text));
  session.show(present::conversion_document(log, options.out));
  return base::ExitCode::done;
}

base::ExitCode run(const LogOptions& options, Session& session) {
  check(options);
  return options.action == "inspect" ? inspect(options, session) : convert(options, session);
}

}  // namespace

Command log_command() {
  return {
      .name = {},
      .summary =
          "Inspects a measured log: channels, data quality, rejected samples with the reason; or converts a foreign log to canonical CSV",
      .example =
          "heatsoak simulate --motor maxon_ec45_flat_70w_24v --robot roboteam_twente_v2024 --duty paper_intermittent --out log.csv && "
          "heatsoak log inspect log.csv --plot log.svg",
      .declare = [](CLI::App& app, Session& session) -> std::function<base::ExitCode()> {
        const auto options = std::make_shared<LogOptions>();
        app.add_option("action", options->action, "action on the logs")->required()->check(CLI::IsMember({"inspect", "convert"}));
        app.add_option("file", options->files, "logs: canonical CSV (time_s, winding_C, current_A, …), or any table with a mapping")
            ->required()
            ->type_name("FILE");
        app.add_option("--map", options->map,
                       "mapping of columns to quantities; FILE.map.toml beside the log is found automatically (docs/file_formats.md)")
            ->type_name("FILE.toml");
        add_picture(app, options->plot, "picture of all channels over time, rejected samples marked");
        add_table(app, options->out, "log in the canonical form, written by convert");
        session.add_answer_options(app);
        return [options, &session] { return run(*options, session); };
      }};
}

}  // namespace heatsoak::cli::commands
