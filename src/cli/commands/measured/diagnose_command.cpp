#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/quantity.h"
#include "calibration/admission.h"
#include "cli/command.h"
#include "cli/measured/effect_topics.h"
#include "cli/measured/logs_option.h"
#include "cli/terminal.h"
#include "diagnosis/model_file.h"
#include "duty/named_files.h"
#include "estimation/log_columns.h"
#include "estimation/open_loop.h"
#include "motor/write_motor.h"
#include "present/measured/diagnosis.h"
#include "present/measured/diagnosis_answer.h"

namespace heatsoak::commands {
namespace {

struct Options {
  std::string model;
  std::vector<std::string> train;
  std::vector<std::string> holdout;
  std::string out;
  LogOptions logs;
};

std::vector<MeasuredRun> runs_of(const std::vector<Recording>& recordings, const MeasuredRunOptions& options,
                                 std::vector<std::string>& notes) {
  std::vector<MeasuredRun> all;
  for (const Recording& recording : recordings) {
    MeasuredRuns runs = measured_runs(recording, options);
    notes.insert(notes.end(), runs.notes.begin(), runs.notes.end());
    std::ranges::move(runs.runs, std::back_inserter(all));
  }
  return all;
}

/// Throws if not even the extended model follows the runs: effects found in them would be meaningless.
void refuse_where_nothing_follows(const Diagnosis& diagnosis, const DiagnosisInput& input) {
  constexpr double kFar_K = 20.0;
  for (const auto& [signal, error] : diagnosis.after_train) {
    const double moves_K = standard_deviation_K(input.train, signal);
    if (error.rmse_K > std::max(kFar_K, moves_K)) {
      throw Failure(ExitCode::cannot_answer,
                    fmt::format("no effect makes the model follow these logs: {} has an error of {} K rms, more than its variation "
                                "(standard deviation {} K)\n  check for another motor, a wrong unit (degrees Fahrenheit, minutes, "
                                "milliamperes) or a misplaced sensor; `heatsoak log inspect` shows each channel",
                                signal, significant(error.rmse_K, 2), significant(moves_K, 2)));
    }
  }
}

void hand_out(const Options& options, const Motor& extended, const Diagnosis& diagnosis, const DiagnosisInput& input,
              const HoldoutScore& score, Session& session) {
  const std::filesystem::path folder(options.out);
  session.make_folder(folder);
  std::vector<std::pair<std::string, std::string>> svg;
  for (const present::DiagnosisPicture& picture : present::diagnosis_pictures(diagnosis, input, score)) {
    svg.emplace_back(picture.name, draw_svg(picture.chart));
    session.write(folder / (picture.name + ".svg"), svg.back().second);
  }
  session.write(folder / (extended.id + ".toml"), to_toml(extended));
  session.write(folder / "diagnosis.json", present::diagnosis_json(diagnosis, input, score).dump(2) + "\n");
  session.write(folder / "diagnosis.html", present::diagnosis_page(diagnosis, input, score, svg));
}

ExitCode run(const Options& options, Session& session) {
  const Motor motor = motor_named(session.folders(), options.model);
  std::vector<std::string> notes;
  std::vector<std::string> warnings;
  std::vector<Recording> train = read_logs(session.folders(), options.train, options.logs, notes);
  std::vector<Recording> holdout = read_logs(session.folders(), options.holdout, options.logs, notes);
  if (motor.fit && !motor.fit->extensions.empty()) {
    warnings.push_back(
        fmt::format("an effect that {} imitates may stay unfound, because the file has {} for better forecasts only; calibrate "
                    "with --innovations for a diagnosis",
                    fmt::join(motor.fit->extensions, " and "), motor.fit->extensions.size() == 1 ? "it" : "them"));
  }
  const std::vector<std::string> of_logs = notes;
  notes.insert(notes.end(), warnings.begin(), warnings.end());
  make_names_distinct(train, holdout);
  std::ranges::move(admit(motor, train, holdout, options.logs.takes_logs_as_they_are, options.logs.ambient_C).notes,
                    std::back_inserter(notes));
  ModelOfLogs model = model_of_logs(motor, train);
  notes.insert(notes.end(), model.notes.begin(), model.notes.end());
  MeasuredRunOptions how = model.how;
  how.ambient_C = options.logs.ambient_C;
  DiagnosisInput input;
  input.model = model.model;
  input.usual = model.usual;
  input.train = runs_of(train, how, notes);
  if (std::string note = settle_turning_rows(input); !note.empty()) {
    notes.push_back(std::move(note));
  }
  if (const std::vector<std::string> rare = keep_common_columns(input.train, input.model.column); !rare.empty()) {
    notes.push_back(
        fmt::format("not every log has {}: heat that depends on {} is not searched for; to search for it, leave out the other logs",
                    fmt::join(rare, ", "), rare.size() == 1 ? "it" : "them"));
  }
  std::shared_ptr<void> line = elapsed_line("searching for missing effects");
  Diagnosis diagnosis = heatsoak::diagnose(input, {});
  line.reset();
  set_column(input.train, diagnosis.selection.after.model.column);
  refuse_where_nothing_follows(diagnosis, input);
  const Motor extended = extended_motor(motor, model, diagnosis);
  HoldoutScore score = score_holdout(input, diagnosis, runs_of(holdout, how, notes));
  score_files(motor, extended, holdout, {options.logs.ambient_C, input.turns_within_rows}, score);
  diagnosis.words = describe(diagnosis, score);
  diagnosis.description = fmt::format("{}", fmt::join(diagnosis.words, " "));
  if (std::string lacking = column_lacking(diagnosis.selection.after.model.column, holdout);
      !lacking.empty() && std::ranges::find(notes, lacking) == notes.end()) {
    notes.push_back(std::move(lacking));
  }
  diagnosis.notes = notes;
  present::Document document = present::diagnosis_document(diagnosis, warnings, of_logs);
  if (!options.out.empty()) {
    hand_out(options, extended, diagnosis, input, score, session);
    document.add_file(options.out + "/diagnosis.html");
    document.add_file(fmt::format("{}/{}.toml", options.out, motor.id));
  }
  session.show(document);
  session.answer(present::diagnosis_json(diagnosis, input, score));
  return diagnosis.verdict == DiagnosisVerdict::not_identifiable ? ExitCode::cannot_answer : ExitCode::done;
}

}  // namespace

Command diagnose_command() {
  return {
      .name = {},
      .summary =
          "Finds what a model cannot explain in measured runs, names the missing effect, adds it, and shows the error before and after",
      .example =
          "heatsoak diagnose --model maxon_ec45_flat_70w_24v --train reports/soak/match_1.csv reports/soak/match_2.csv "
          "reports/soak/bench.csv --holdout reports/soak/match_3.csv --out diagnosis",
      .declare = [](CLI::App& app, Session& session) -> std::function<ExitCode()> {
        const auto options = std::make_shared<Options>();
        app.add_option("--model", options->model, "motor file, best from `heatsoak calibrate`, or an id")
            ->required()
            ->type_name("MODEL.toml");
        app.add_option("--train", options->train, "logs that the extended model is fitted to; LOG@0-60% takes the first 60 % of its time")
            ->required()
            ->type_name("LOG...");
        app.add_option("--holdout", options->holdout, "hold-out logs that the fit does not use; for the error before and after")
            ->type_name("LOG...");
        app.add_option("--out", options->out, "folder for the extended model, page, pictures and JSON")->type_name("DIR");
        add_log_options(app, options->logs);
        session.add_data_option(app);
        session.add_answer_options(app);
        return [options, &session] { return run(*options, session); };
      },
      .topics = effect_topics,
  };
}

}  // namespace heatsoak::commands
