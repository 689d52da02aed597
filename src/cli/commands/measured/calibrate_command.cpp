#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>

#include "calibration/admission.h"
#include "calibration/calibrate.h"
#include "cli/command.h"
#include "cli/measured/calibration_chart.h"
#include "cli/measured/logs_option.h"
#include "cli/measured/prediction_answer.h"
#include "cli/named_files.h"
#include "cli/quantity_option.h"
#include "cli/terminal.h"
#include "motor/motor.h"
#include "motor/write_motor.h"
#include "present/measured/calibration.h"
#include "present/measured/calibration_words.h"

namespace heatsoak::commands {
namespace {

struct Options {
  std::string motor;
  std::vector<std::string> logs;
  std::vector<std::string> holdout;
  std::string out;
  std::string plot;
  LogOptions how;
  FitOptions fit;
  bool writes_forecast = false;
  bool writes_innovations = false;
};

nlohmann::ordered_json error_json(const std::vector<ErrorBeforeAfter>& errors, bool after) {
  nlohmann::ordered_json all = nlohmann::ordered_json::object();
  for (const ErrorBeforeAfter& each : errors) {
    const SignalError& error = after ? each.after : each.before;
    all[each.signal] = {{"rmse_K", rounded(error.rmse_K, 4)}, {"max_abs_K", rounded(error.max_abs_K, 4)}, {"samples", error.samples}};
  }
  return all;
}

/// Rounds to six significant digits, which are the same on every machine.
nlohmann::ordered_json number(double value) { return std::stod(fmt::format("{:.6g}", value)); }

nlohmann::ordered_json forecast_json(const Calibration& calibration) {
  const Forecast& forecast = *calibration.forecast;
  constexpr std::array kSources{"file", "least_squares", "forecast_fit", "innovations_fit"};
  nlohmann::ordered_json left_out = nlohmann::ordered_json::object();
  for (const RivalScore& rival : forecast.rivals) {
    for (const auto& [signal, rmse_K] : rival.rmse_K) {
      left_out[kSources[static_cast<std::size_t>(rival.source)]][signal] = {{"rmse_K", rounded(rmse_K, 4)}};
    }
  }
  nlohmann::ordered_json extensions = nlohmann::ordered_json::array();
  for (const AcceptedExtension& each : forecast.accepted) {
    extensions.push_back({{"id", each.name}, {"nats", rounded(each.gain_nats, 3)}});
  }
  return {{"best", kSources[static_cast<std::size_t>(forecast.source)]},
          {"written", calibration.is_forecast_written ? kSources[static_cast<std::size_t>(forecast.source)] : kSources.back()},
          {"left_out_pieces", forecast.pieces.size()},
          {"left_out_error", left_out},
          {"extensions", extensions},
          {"band",
           {{"unknown_heat_winding_share", number(forecast.band.unknown_heat_share[0])},
            {"unknown_heat_stator_share", number(forecast.band.unknown_heat_share[1])},
            {"time_scale_s", number(forecast.band.time_scale_s)},
            {"heat_factor_sd", number(forecast.band.heat_factor_sd)},
            {"width_ratio", number(forecast.band.width_ratio)}}}};
}

nlohmann::ordered_json json_of(const Motor& motor, const Calibration& result, const present::LogRemarks& remarks, const std::string& out) {
  nlohmann::ordered_json parameters = nlohmann::ordered_json::array();
  for (const CalibratedParameter& each : result.parameters) {
    parameters.push_back({{"name", each.name},
                          {"value", number(each.value)},
                          {"unit", each.unit},
                          {"ci95", {number(each.low), number(each.high)}},
                          {"identifiable", each.is_identifiable},
                          {"before", number(each.before)},
                          {"interval", each.by_profile ? "profile_likelihood" : "curvature"}});
  }
  nlohmann::ordered_json open = nlohmann::ordered_json::array();
  for (const OpenDirection& each : result.open) {
    open.push_back({{"parameters", each.what}, {"why", each.why}, {"experiment", each.experiment}});
  }
  nlohmann::ordered_json correlation = nlohmann::ordered_json::array();
  for (Eigen::Index i = 0; i < result.correlation.rows(); ++i) {
    nlohmann::ordered_json row = nlohmann::ordered_json::array();
    for (Eigen::Index j = 0; j < result.correlation.cols(); ++j) {
      row.push_back(rounded(result.correlation(i, j), 4));
    }
    correlation.push_back(std::move(row));
  }
  return {{"schema", "heatsoak.calibration/1"},
          {"motor", motor.id},
          {"runs", result.runs.size()},
          {"parameters", parameters},
          {"correlation", correlation},
          {"error", error_json(result.fit_error, true)},
          {"error_before", error_json(result.fit_error, false)},
          {"holdout_error", error_json(result.holdout_error, true)},
          {"holdout_error_before", error_json(result.holdout_error, false)},
          {"holdout", {{"before", runs_json(result.holdout_before)}, {"after", runs_json(result.holdout_after)}}},
          {"forecast", forecast_json(result)},
          {"latent_flux",
           {{"winding_W", number(result.fit.flux.rms_W[0])},
            {"stator_W", number(result.fit.flux.rms_W[1])},
            {"time_scale_s", number(result.fit.flux.time_scale_s)}}},
          {"rejected_share", number(result.fit.rejected_share)},
          {"not_identifiable", open},
          {"next_experiment", result.next_experiment},
          {"worse_than_before", present::words_of(result.worse)},
          {"notes", present::all_notes(result, remarks)},
          {"model", out}};
}

/// Adds the steps that the logs require, which come before the experiment that the fit suggests.
void report_next_steps(std::vector<std::string> steps, std::string& next_experiment) {
  if (!next_experiment.empty()) {
    steps.push_back(next_experiment);
  }
  next_experiment = fmt::format("{}", fmt::join(steps, "; then: "));
}

ExitCode run(const Options& options, Session& session) {
  const Motor motor = motor_named(session.folders(), options.motor);
  present::LogRemarks remarks;
  std::vector<Recording> logs = read_logs(session.folders(), options.logs, options.how, remarks.of_reading);
  std::vector<Recording> holdout = read_logs(session.folders(), options.holdout, options.how, remarks.of_reading);
  make_names_distinct(logs, holdout);
  if (!options.how.takes_logs_as_they_are) {
    refuse_runs_of_the_file(motor, logs, holdout);
  }
  Admission admission = admit(motor, logs, holdout, options.how.takes_logs_as_they_are, options.how.ambient_C);
  remarks.of_screening = std::move(admission.notes);
  const WrittenFit written = options.writes_forecast      ? WrittenFit::forecast
                             : options.writes_innovations ? WrittenFit::innovations
                                                          : WrittenFit::best;
  std::shared_ptr<void> line = elapsed_line("calibrating");
  Calibration result = calibrate(motor, logs, holdout, {options.fit, options.how.ambient_C, written});
  line.reset();
  report_next_steps(admission.next_steps, result.next_experiment);
  session.write(options.out, to_toml(calibrated_motor(motor, result)));
  if (!options.plot.empty()) {
    session.write(options.plot, draw_picture(calibration_chart(motor, result), options.plot));
  }
  present::Document document = present::calibration_document(motor, result, remarks);
  document.add_file(options.out);
  document.add_file(options.plot);
  session.show(document);
  session.answer(json_of(motor, result, remarks, options.out));
  return ExitCode::done;
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
          .declare = [](CLI::App& app, Session& session) -> std::function<ExitCode()> {
            const auto options = std::make_shared<Options>();
            app.add_option("--motor", options->motor, "id (see `heatsoak list motors`) or file: start of the fit and prior knowledge")
                ->required()
                ->type_name("M");
            app.add_option("logs", options->logs, "measured runs (CSV)")->required()->type_name("LOG");
            app.add_option("--holdout", options->holdout, "runs to test on, not fitted to")->type_name("LOG");
            app.add_option("--out", options->out, "the calibrated motor, a motor file")->required()->type_name("FILE.toml");
            CLI::Option* const forecast = app.add_flag(
                "--forecast", options->writes_forecast,
                "always write the model that predicts left-out runs best, even if it needs effects that no diagnosis named; default: only "
                "with three runs or more, if it predicts left-out ones better by 5 % than the innovations fit");
            app.add_flag("--innovations", options->writes_innovations,
                         "always write the fit that explains the response within seconds of a load change, for `heatsoak diagnose`")
                ->excludes(forecast);
            add_picture(app, options->plot, "picture of measured and fitted temperatures");
            add_log_options(app, options->how);
            add_seed(app, options->fit.seed, "of the starting points; same seed, same bytes");
            app.add_option("--threads", options->fit.threads, "0: all cores; the result does not depend on it")
                ->check(whole_number(1024))
                ->capture_default_str();
            session.add_data_option(app);
            session.add_answer_options(app);
            return [options, &session] { return run(*options, session); };
          }};
}

}  // namespace heatsoak::commands
