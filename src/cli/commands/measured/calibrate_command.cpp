#include <CLI/App.hpp>
#include <memory>

#include "calibration/calibration_job.h"
#include "cli/command.h"
#include "cli/measured/logs_option.h"
#include "cli/quantity_option.h"
#include "cli/terminal.h"
#include "duty/named_files.h"
#include "motor/write_motor.h"
#include "present/failure_words.h"
#include "present/measured/calibration.h"
#include "present/measured/calibration_chart.h"

namespace heatsoak::cli::commands {
namespace {

struct CalibrateOptions {
  std::string motor;
  std::vector<std::string> logs;
  std::vector<std::string> holdout;
  std::string out;
  std::string plot;
  recording::LogChoice how;
  estimation::FitOptions fit;
  bool writes_forecast = false;
  bool writes_innovations = false;
};

base::ExitCode run(const CalibrateOptions& options, Session& session) {
  calibration::CalibrationJob job{duty::motor_named(session.folders(), options.motor),
                                  recording::read_usable_logs(options.logs, options.holdout, choice_of(options.how, session)), options.fit};
  job.written = options.writes_forecast      ? calibration::WrittenFit::forecast
                : options.writes_innovations ? calibration::WrittenFit::innovations
                                             : calibration::WrittenFit::best;
  require_read(job.logs, session);
  const calibration::CalibrationAnswer answer =
      with_progress(session, [&](const base::JobProgress& progress) { return calibration::run_calibration(job, progress); });
  session.write(options.out, motor::to_toml(answer.motor));
  present::Document document = present::calibration_document(job.motor, answer, job.logs.readings, options.out);
  if (session.draws(options.plot)) {
    session.draw(document, options.plot, present::calibration_chart(job.motor, answer.calibration));
  }
  session.show(document);
  return base::ExitCode::done;
}

}  // namespace

Command calibrate_command() {
  return {.name = {},
          .summary =
              "Fits the thermal parameters of a motor to measured runs, with confidence intervals and what the runs do not determine; exit "
              "3 if nothing is identifiable",
          .example =
              "heatsoak simulate --motor maxon_ec45_flat_70w_24v --robot roboteam_twente_v2024 --duty paper_intermittent --out log.csv && "
              "heatsoak calibrate --motor maxon_ec45_flat_70w_24v log.csv --out model.toml --plot calibration.svg",
          .declare = [](CLI::App& app, Session& session) -> std::function<base::ExitCode()> {
            const auto options = std::make_shared<CalibrateOptions>();
            app.add_option("--motor", options->motor, "id (see `heatsoak list motors`) or file: start of the fit and prior knowledge")
                ->required()
                ->type_name("M");
            app.add_option("logs", options->logs, "measured runs (CSV)")->required()->type_name("LOG");
            app.add_option("--holdout", options->holdout, "runs for a test; the fit does not use them")->type_name("LOG");
            app.add_option("--out", options->out, "motor file of the calibrated motor")->required()->type_name("FILE.toml");
            CLI::Option* const forecast = app.add_flag(
                "--forecast", options->writes_forecast,
                "always write the model that predicts left-out runs best, even if it contains effects that no diagnosis named; default: "
                "only if its error on left-out runs, or quarters of one run, is 5 % and 0.1 K below that of the innovations fit");
            app.add_flag("--innovations", options->writes_innovations,
                         "always write the fit that explains the response within seconds of a load change, for `heatsoak diagnose`")
                ->excludes(forecast);
            add_picture(app, options->plot, "picture of measured and fitted temperatures");
            add_log_options(app, options->how);
            add_seed(app, options->fit.seed, "seed of the starting points; the same seed gives the same bytes");
            app.add_option("--threads", options->fit.threads, "number of threads, 0 for all cores; the result does not depend on it")
                ->check(whole_number(1024))
                ->capture_default_str();
            session.add_data_option(app);
            session.add_answer_options(app);
            return [options, &session] { return present::with_words([&] { return run(*options, session); }); };
          }};
}

}  // namespace heatsoak::cli::commands
