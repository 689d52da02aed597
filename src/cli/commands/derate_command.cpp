#include <fmt/format.h>

#include <CLI/App.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/guard_options.h"
#include "cli/quantity_option.h"
#include "cli/sensor_options.h"
#include "derate/derating_job.h"
#include "duty/named_files.h"
#include "present/derating.h"
#include "present/failure_words.h"

namespace heatsoak::cli::commands {
namespace {

struct DerateOptions {
  GuardOptions guard;
  std::string robot;
  std::string to;  ///< empty: given by the ending of `out`
  std::string out;
  std::string committed;  ///< file of --check
  std::string compiler;   ///< C compiler for the binary of an FMU; empty: the FMU contains only sources
  SensorFlags sensor;
};

const derate::ExporterType& exporter_named(const std::string& name) {
  std::vector<std::string> names;
  std::string expected;
  for (const derate::ExporterType& each : derate::all_exporters()) {
    if (each.name == name) {
      return each;
    }
    names.emplace_back(each.name);
    expected += fmt::format("{}{}", expected.empty() ? "" : ", ", each.name);
  }
  throw base::Failure(base::ExitCode::bad_input,
                      fmt::format("--to {}: expected one of {}{}", name, expected, base::did_you_mean(name, names)));
}

/// Returns the format of --to or else that of the ending of --out. A name without an ending, or no name, gets a C header.
const derate::ExporterType& exporter_of(const DerateOptions& options) {
  const std::string ending = std::filesystem::path(options.out).extension().string();
  if (!options.to.empty() || ending.empty()) {
    return exporter_named(options.to.empty() ? "c_header" : options.to);
  }
  if (const derate::ExporterType* const selected = derate::exporter_of_ending(ending)) {
    return *selected;
  }
  std::string expected;
  for (const derate::ExporterType& each : derate::all_exporters()) {
    expected += each.file_ending.empty() ? "" : fmt::format("{}{}", expected.empty() ? "" : ", ", each.file_ending);
  }
  throw base::Failure(base::ExitCode::bad_input,
                      fmt::format("--out {}: its ending gives no format; expected {}, or --to FORM (`heatsoak list formats` shows them)",
                                  options.out, expected));
}

base::ExitCode run(const DerateOptions& options, Session& session) {
  const derate::ExporterType& exporter = exporter_of(options);
  derate::DerateOptions derate_options = options.guard.derate;
  derate_options.sensor = sensor_options(options.sensor);
  if (derate_options.sensor && exporter.name != "c_header" && exporter.name != "json") {
    throw base::Failure(base::ExitCode::bad_input,
                        fmt::format("--to {} does not support a sensor: expected --to c_header or json, or no sensor", exporter.name));
  }
  if (options.out.empty() && options.committed.empty() && !session.gives_json()) {
    throw base::Failure(base::ExitCode::bad_input, "expected --out FILE to write, --check FILE to compare with, or --json FILE");
  }
  if (options.out == "-") {
    throw base::Failure(base::ExitCode::bad_input, "--out -: expected a file; /dev/stdout stands for the terminal");
  }
  if (!options.compiler.empty() && exporter.write_compiled == nullptr) {
    throw base::Failure(
        base::ExitCode::bad_input,
        fmt::format("--compiler: {} has no binary; expected --to fmi2_motor, fmi2_guard, fmi3_motor or fmi3_guard", exporter.name));
  }
  check_derate_options(options.guard.derate);
  duty::NamedFiles named(session.folders());
  const std::optional<robot::Robot> robot = named.robot(options.robot);
  derate::DeratingJob job{.robot = {}, .motor = guarded_motor(options.guard, named), .options = derate_options};
  job.robot = *robot;
  job.exporter = options.out.empty() ? nullptr : &exporter;
  job.compiler = options.compiler;
  job.committed = options.committed;
  const derate::DeratingAnswer answer = present::with_words([&] {
    return with_progress(session, "searching the safety factor on heat", 5.0,
                         [&](const base::Progress& progress) { return derate::run_derating(job, progress); });
  });
  if (!options.out.empty()) {
    session.write(options.out, answer.text);
  }
  session.show(present::derating_document(job, answer, options.out));
  return answer.holds() ? base::ExitCode::done : base::ExitCode::limit_exceeded;
}

}  // namespace

Command derate_command() {
  return {
      .name = {},
      .summary =
          "Writes how much current the firmware may allow: observer and derating table, checked on motors of every declared tolerance",
      .example = "heatsoak derate --motor maxon_ecx_flat_32l_48v --robot roboteam_twente_v2024 --to c_header --out motor_guard.h",
      .declare = [](CLI::App& app, Session& session) -> std::function<base::ExitCode()> {
        const auto options = std::make_shared<DerateOptions>();
        add_motor_options(app, options->guard);
        app.add_option("--robot", options->robot, "id (see `heatsoak list robots`) or file")->required()->type_name("R");
        app.add_option("--to", options->to,
                       "output format (see `heatsoak list formats`); unless given, that of the ending of --out, or a C header without one")
            ->type_name("FORM");
        app.add_option("--out", options->out, "file to write")->type_name("FILE");
        app.add_option("--compiler", options->compiler,
                       "C compiler, such as cc: adds a binary for this machine to an FMU, which otherwise contains only its sources")
            ->type_name("CC");
        app.add_option("--check", options->committed,
                       "C header or CSV table that was written earlier with the same options; exit 1 if it allows more than a fresh one")
            ->type_name("FILE");
        add_quantity(app, "--period", options->guard.derate.period_s,
                     {"period", "s", base::Range::between(1e-3, 1.0), "time between two calls of the firmware; 10 ms unless given"});
        add_derate_options(app, options->guard.derate);
        add_sensor_options(app, options->sensor);
        session.add_data_option(app);
        session.add_answer_options(app);
        return [options, &session] { return run(*options, session); };
      }};
}

}  // namespace heatsoak::cli::commands
