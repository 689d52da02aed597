#include <CLI/App.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "calibration/admission.h"
#include "calibration/training_range.h"
#include "cli/command.h"
#include "cli/measured/logs_option.h"
#include "cli/quantity_option.h"
#include "duty/named_files.h"
#include "present/measured/prediction.h"
#include "present/measured/prediction_chart.h"

namespace heatsoak::commands {
namespace {

struct Options {
  std::string model;
  std::vector<std::string> logs;
  std::string plot;
  LogOptions how;
};

ExitCode run(const Options& options, Session& session) {
  const Motor motor = motor_named(session.folders(), options.model);
  std::vector<std::string> notes;
  std::vector<Recording> logs = read_logs(session.folders(), options.logs, options.how, notes);
  const std::vector<std::string> of_logs = notes;
  std::vector<Recording> none;
  make_names_distinct(logs, none);
  std::ranges::move(admit(motor, none, logs, options.how.takes_logs_as_they_are, options.how.ambient_C).notes, std::back_inserter(notes));
  std::vector<std::string> warnings;
  for (const Recording& log : logs) {
    if (motor.fit) {
      for (const OutsideTraining& each : outside(motor.fit->training, log)) {
        warnings.push_back(present::words_of(each));
      }
    }
    if (motor.fit && was_fitted_to(*motor.fit, log)) {
      warnings.push_back(present::fitted_run_words(log.name));
    }
  }
  Prediction prediction = predict(motor, logs, {.ambient_C = options.how.ambient_C});
  prediction.notes.insert(prediction.notes.begin(), notes.begin(), notes.end());
  if (!options.plot.empty()) {
    session.write(options.plot, draw_picture(present::prediction_chart(motor, prediction), options.plot));
  }
  present::Document document = present::prediction_document(motor, prediction, warnings, of_logs);
  document.add_file(options.plot);
  session.show(document);
  prediction.notes.insert(prediction.notes.begin(), warnings.begin(), warnings.end());
  session.answer(present::prediction_json(motor, prediction));
  return ExitCode::done;
}

}  // namespace

Command predict_command() {
  return {
      .name = {},
      .summary =
          "Predicts the temperatures of measured logs from their first temperatures and measured inputs, with a 90 % band; reports error "
          "and coverage",
      .example = "heatsoak predict --model maxon_ec45_flat_70w_24v reports/soak/match_1.csv reports/soak/bench.csv --plot prediction.svg",
      .declare = [](CLI::App& app, Session& session) -> std::function<ExitCode()> {
        const auto options = std::make_shared<Options>();
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
        return [options, &session] { return run(*options, session); };
      }};
}

}  // namespace heatsoak::commands
