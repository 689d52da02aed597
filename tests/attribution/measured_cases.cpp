#include "measured_cases.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "calibration/calibrate.h"
#include "recording/mapping.h"
#include "recording/read_recording.h"
#include "support/source_folder.h"

namespace heatsoak::attribution::measured {

const std::filesystem::path& reports() {
  static const std::filesystem::path folder = kSource / "reports/diagnosis";
  return folder;
}

recording::Recording read(const std::filesystem::path& log, const std::filesystem::path& map) {
  recording::RecordingReport report;
  return recording::read_recording(log, recording::mapping_for(log.string(), map.string()), report);
}

std::vector<estimation::MeasuredRun> runs_of(const diagnosis::ModelOfLogs& model, const std::vector<recording::Recording>& recordings,
                                             std::optional<double> ambient_C) {
  std::vector<estimation::MeasuredRun> all;
  estimation::MeasuredRunOptions how = model.how;
  how.ambient_C = ambient_C;
  for (const recording::Recording& recording : recordings) {
    std::ranges::move(estimation::measured_runs(recording, how).runs, std::back_inserter(all));
  }
  return all;
}

Diagnosed diagnosed(const motor::Motor& motor, const std::vector<recording::Recording>& train,
                    const std::vector<recording::Recording>& holdout, std::optional<double> ambient_C) {
  Diagnosed out{diagnosis::model_of_logs(motor, train), {}, {}, {}};
  out.input = {out.model.model, runs_of(out.model, train, ambient_C), out.model.usual};
  out.diagnosis = diagnosis::diagnose(out.input, {});
  out.score = errors_of_models(out.input, out.diagnosis, runs_of(out.model, holdout, ambient_C));
  return out;
}

const diagnosis::FoundEffect* effect_of(const diagnosis::Diagnosis& diagnosis, std::string_view id) {
  const auto found = std::ranges::find(diagnosis.effects, id, &diagnosis::FoundEffect::id);
  return found == diagnosis.effects.end() ? nullptr : &*found;
}

motor::Motor guessed_otherwise(motor::Motor motor, const std::map<std::string, double>& factor) {
  for (const auto& [key, by] : factor) {
    base::ParameterValue& value = *motor::find_parameter(motor, key);
    value.value *= by;
    value.spread->low *= by;
    value.spread->high *= by;
  }
  motor::refresh_values(motor);
  return motor;
}

Drone drone(const std::filesystem::path& folder, bool is_for_forecasts, const std::map<std::string, double>& factor) {
  Drone all;
  for (const char* const name : {"run1", "run2", "run3", "run4", "run5"}) {
    all.run[name] = read(folder / (std::string(name) + ".csv"), reports() / "uav_fan/recordings.map.toml");
  }
  const motor::Motor start = guessed_otherwise(motor::read_motor(reports() / "uav_motor.toml"), factor);
  all.motor = calibration::calibrated_motor(
      start, calibration::calibrate(
                 start, std::vector{all.run["run1"], all.run["run3"], all.run["run5"]}, {},
                 {.fit = {}, .written = is_for_forecasts ? calibration::WrittenFit::forecast : calibration::WrittenFit::innovations}));
  return all;
}

Diagnosed diagnosed(Drone& all, double cut) {
  return diagnosed(all.motor, {all.run["run1"], all.run["run3"], all.run["run5"], recording::part_of(all.run["run4"], 0.0, cut)},
                   {recording::part_of(all.run["run4"], cut, 1.0), all.run["run2"]});
}

recording::Recording of_bench(const std::filesystem::path& folder, const char* name) {
  return read(folder / ("cooling_slopes__Spike-" + std::string(name) + ".csv"), reports() / "propeller_bench/recordings.map.toml");
}

PropellerBench propeller_bench(const std::filesystem::path& folder) {
  return {of_bench(folder, "Mega-1700_2020-01-27_105922"), of_bench(folder, "Mega-1700_2020-03-05_145559"),
          motor::read_motor(reports() / "propeller_bench/start.toml")};
}

Diagnosed of_traction_motor(const std::filesystem::path& folder, double cut) {
  const recording::Recording all = read(folder / "profile24_2.5s.csv", reports() / "traction_motor/recording.map.toml");
  return diagnosed(motor::read_motor(reports() / "traction_motor/start.toml"), {recording::part_of(all, 0.0, cut)},
                   {recording::part_of(all, cut, 1.0)});
}

}  // namespace heatsoak::attribution::measured
