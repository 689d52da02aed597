#include <fmt/format.h>

#include <CLI/App.hpp>
#include <memory>
#include <string>

#include "base/version.h"
#include "cli/command.h"
#include "cli/guard_options.h"
#include "cli/quantity_option.h"
#include "duty/named_files.h"
#include "firmware/core_files.h"
#include "firmware/staged_folder.h"
#include "present/core_folder.h"

namespace heatsoak::cli::commands {
namespace {

struct GenerateOptions {
  std::string what;
  GuardOptions guard;
  std::string robot;
  std::string out;
  firmware::CoreOptions core;
  bool force = false;
};

base::ExitCode run(const GenerateOptions& options, Session& session) {
  check_derate_options(options.guard.derate);
  firmware::check_target_folder(options.out, options.force);
  duty::NamedFiles named(session.folders());
  const std::optional<robot::Robot> robot = named.robot(options.robot);
  const motor::Motor motor = guarded_motor(options.guard, named);
  const firmware::GeneratedCore core =
      with_progress(session, "searching the safety factor on heat", 5.0, [&](const base::Progress& progress) {
        return firmware::generate_core(*robot, motor, options.core, options.guard.derate,
                                       fmt::format("heatsoak {}", base::program_version()), progress);
      });
  const auto staged = std::make_shared<firmware::StagedFolder>(options.out, core.folder.files, options.force);
  std::vector<std::filesystem::path> files;
  for (const firmware::CoreFile& file : core.folder.files) {
    files.push_back(std::filesystem::path(options.out) / file.path);
  }
  session.complete_folder([staged] { staged->commit(); }, options.out, std::move(files));
  session.show(present::core_folder_document({*robot, motor, options.core, options.out}, core));
  return base::ExitCode::done;
}

}  // namespace

Command generate_command() {
  return {.name = {},
          .summary = "Writes the drive core with configuration and thermal guard of a robot as source files, ready to compile",
          .example =
              "heatsoak generate core --robot roboteam_twente_v2024 --motor maxon_ecx_flat_32l_48v --out drive_core\n"
              "  heatsoak generate core --robot roboteam_twente_v2024 --motor maxon_ecx_flat_32l_48v --out shadow_core --shadow",
          .declare = [](CLI::App& app, Session& session) -> std::function<base::ExitCode()> {
            const auto options = std::make_shared<GenerateOptions>();
            app.add_option("what", options->what, "core: the drive core")->required()->check(CLI::IsMember({"core"}));
            add_motor_options(app, options->guard);
            app.add_option("--robot", options->robot, "id (see `heatsoak list robots`) or file")->required()->type_name("R");
            app.add_option("--out", options->out, "folder to write, new or empty")->required()->type_name("DIR");
            app.add_flag("--force", options->force, "replace the generated files in a folder that is not empty, keep all others");
            add_quantity(
                app, "--period", options->core.period_s,
                {"period", "s", base::Range::at_least(1e-4),
                 "time between two control steps, 1 ms unless given; the longest one is what the watchdog of the firmware allows"});
            app.add_flag("--shadow", options->core.shadow_mode,
                         "shadow mode: the thermal guard counts what it would limit, but limits nothing; to see in telemetry what the "
                         "guard would cost");
            add_derate_options(app, options->guard.derate);
            session.add_data_option(app);
            session.add_answer_options(app);
            return [options, &session] { return run(*options, session); };
          }};
}

}  // namespace heatsoak::cli::commands
