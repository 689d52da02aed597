#include <fmt/format.h>

#include <CLI/App.hpp>
#include <memory>

#include "base/confidence.h"
#include "calibration/prediction_job.h"
#include "cli/command.h"
#include "cli/measured/logs_option.h"
#include "cli/quantity_option.h"
#include "duty/named_files.h"
#include "present/failure_words.h"
#include "present/measured/prediction.h"
#include "present/measured/prediction_chart.h"

namespace heatsoak::cli::commands {
namespace {

struct PredictOptions {
  std::string model;
  std::vector<std::string> logs;
  std::string plot;
  recording::LogChoice how;
};

base::ExitCode run(const PredictOptions& options, Session& session) {
  const calibration::PredictionJob job{duty::motor_named(session.folders(), options.model),
                                       recording::read_usable_logs({}, options.logs, choice_of(options.how, session))};
  require_read(job.logs, session);
  session.begin_computation();
  const calibration::PredictionAnswer answer = calibration::run_prediction(job);
  present::Document document = present::prediction_document(job.motor, answer, job.logs.readings);
  if (session.draws(options.plot)) {
    session.draw(document, options.plot, present::prediction_chart(job.motor, answer.prediction));
  }
  session.show(document);
  return base::ExitCode::done;
}

}  // namespace

Command predict_command() {
  static const std::string kSummary = fmt::format(
      "Predicts the temperatures of measured logs from their first temperatures and measured inputs, with a {} band; reports error and "
      "coverage",
      base::level_text(base::kBand_share));
  return {
      .name = {},
      .summary = kSummary,
      .example = "heatsoak predict --model maxon_ec45_flat_70w_24v reports/soak/match_1.csv reports/soak/bench.csv --plot prediction.svg",
      .declare = [](CLI::App& app, Session& session) -> std::function<base::ExitCode()> {
        const auto options = std::make_shared<PredictOptions>();
        app.add_option("--model", options->model, "motor file, best from `heatsoak calibrate`, or an id (see `heatsoak list motors`)")
            ->required()
            ->type_name("FILE");
        app.add_option("logs", options->logs, "measured runs (CSV); LOG@60-100% takes the last 40 % of its time")
            ->required()
            ->type_name("LOG");
        add_picture(app, options->plot, "picture of measured and predicted temperatures with the band");
        add_log_options(app, options->how);
        session.add_data_option(app);
        session.add_answer_options(app);
        return [options, &session] { return present::with_words([&] { return run(*options, session); }); };
      }};
}

}  // namespace heatsoak::cli::commands
