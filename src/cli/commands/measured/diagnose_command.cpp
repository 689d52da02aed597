#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <iterator>
#include <memory>

#include "cli/command.h"
#include "cli/measured/logs_option.h"
#include "cli/terminal.h"
#include "diagnosis/diagnosis_job.h"
#include "duty/named_files.h"
#include "motor/write_motor.h"
#include "present/failure_words.h"
#include "present/measured/diagnosis.h"
#include "present/measured/diagnosis_output.h"
#include "present/measured/diagnosis_words.h"

namespace heatsoak::cli::commands {
namespace {

struct DiagnoseOptions {
  std::string model;
  std::vector<std::string> train;
  std::vector<std::string> holdout;
  std::string out;
  recording::LogChoice logs;
};

void write_folder(const DiagnoseOptions& options, const diagnosis::DiagnosisAnswer& answer,
                  const std::vector<recording::LogReading>& readings, const present::Document& document, Session& session) {
  const std::filesystem::path folder(options.out);
  session.make_folder(folder);
  std::vector<std::pair<std::string, std::string>> svg;
  for (const present::DiagnosisPicture& picture : present::diagnosis_pictures(answer)) {
    svg.emplace_back(picture.name, report::draw_svg(picture.chart));
    session.write(folder / (picture.name + ".svg"), svg.back().second);
  }
  motor::Motor motor = answer.motor;
  std::ranges::move(present::notes_of_model_file(answer.diagnosis), std::back_inserter(motor.notes));
  session.write(folder / (motor.id + ".toml"), motor::to_toml(motor));
  session.write(folder / "diagnosis.json", present::json_text(document.data));
  session.write(folder / "diagnosis.html", present::diagnosis_page(answer, readings, svg));
}

base::ExitCode run(const DiagnoseOptions& options, Session& session) {
  if (!options.out.empty()) {
    report::require_drawing("--out", "leave out --out for the answer without its folder");
  }
  const diagnosis::DiagnosisJob job{duty::motor_named(session.folders(), options.model),
                                    recording::read_usable_logs(options.train, options.holdout, choice_of(options.logs, session))};
  require_read(job.logs, session);
  if (!options.out.empty()) {
    for (const std::string& name : {job.motor.id + ".toml", std::string("diagnosis.json"), std::string("diagnosis.html")}) {
      session.expect_output(std::filesystem::path(options.out) / name, options.out);
    }
  }
  const diagnosis::DiagnosisAnswer answer =
      with_progress(session, [&](const base::JobProgress& progress) { return diagnosis::run_diagnosis(job, progress); });
  const std::vector<recording::LogReading>& readings = job.logs.readings;
  const present::Document document = present::diagnosis_document(answer, readings);
  if (!options.out.empty()) {
    write_folder(options, answer, readings, document, session);
  }
  session.show(document);
  return answer.diagnosis.verdict == diagnosis::DiagnosisVerdict::not_identifiable ? base::ExitCode::cannot_answer : base::ExitCode::done;
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
      .declare = [](CLI::App& app, Session& session) -> std::function<base::ExitCode()> {
        const auto options = std::make_shared<DiagnoseOptions>();
        app.add_option("--model", options->model, "motor file, best from `heatsoak calibrate`, or an id")
            ->required()
            ->type_name("MODEL.toml");
        app.add_option("--train", options->train, "logs that the extended model is fitted to; LOG@0-60% takes the first 60 % of its time")
            ->required()
            ->type_name("LOG");
        app.add_option("--holdout", options->holdout, "hold-out logs that the fit does not use; for the error before and after")
            ->type_name("LOG");
        app.add_option("--out", options->out, "folder for the extended model, page, pictures and JSON")->type_name("DIR");
        add_log_options(app, options->logs);
        session.add_data_option(app);
        session.add_answer_options(app);
        return [options, &session] { return present::with_words([&] { return run(*options, session); }); };
      },
  };
}

}  // namespace heatsoak::cli::commands
