// Forecasts of third-party recordings: fits some runs and predicts others. Prints a table without pass or fail. The exit code is 77 if the
// recordings are not available.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <cmath>

#include "../../support/measured_data.h"
#include "../../support/study_words.h"
#include "calibration/forecast/forecast.h"
#include "calibration/forecast/prediction.h"
#include "estimation/fit.h"
#include "recording/mapping.h"
#include "recording/read_recording.h"
#include "support/source_folder.h"

namespace heatsoak::calibration {
namespace {

struct Part {
  std::string file;
  double from_share = 0.0;
  double to_share = 1.0;
};

struct Case {
  std::string name;
  std::string motor;    ///< path below reports
  std::string mapping;  ///< path below the sources
  std::string folder;
  std::vector<Part> fitted;
  std::vector<Part> predicted;
  std::optional<double> ambient_C = {};
};

std::vector<Case> all_cases() {
  const std::string ksu = "reports/calibration/ksu_cool_down.map.toml";
  const std::string spike = "cooling_slopes__Spike-";
  std::vector<Case> cases{{"drone, run 2",
                           "diagnosis/uav_motor.toml",
                           "reports/diagnosis/uav_fan/recordings.map.toml",
                           "tasrv_uav_motor",
                           {{"run1.csv"}, {"run3.csv"}, {"run5.csv"}},
                           {{"run2.csv"}}},
                          {"RI50, no load",
                           "calibration/ri50.toml",
                           "tests/data/mappings/umich_ri50.map.toml",
                           "umich_ri50",
                           {{"stall_staircase.csv"}},
                           {{"no_load_staircase.csv"}},
                           22.0},
                          {"P80, third cool-down",
                           "calibration/p80.toml",
                           ksu,
                           "ksu_propeller_bench",
                           {{spike + "P80-1700_2020-02-11_162559.csv"}, {spike + "P80-1700_2020-03-09_185035.csv"}},
                           {{spike + "P80-1700_2020-03-10_133951.csv"}}},
                          {"Mega, second cool-down",
                           "calibration/p80.toml",
                           ksu,
                           "ksu_propeller_bench",
                           {{spike + "Mega-1700_2020-01-27_105922.csv"}},
                           {{spike + "Mega-1700_2020-03-05_145559.csv"}}}};
  constexpr double kFirstHour = 3600.0 / 7505.0;
  cases.push_back({"Paderborn without torque and power, second hour",
                   "calibration/lea_pmsm_52kw.toml",
                   "reports/diagnosis/traction_motor/recording.map.toml",
                   "paderborn_pmsm",
                   {{"profile24_2.5s.csv", 0.0, kFirstHour}},
                   {{"profile24_2.5s.csv", kFirstHour, 1.0}}});
  for (const double cut : {0.50, 0.60, 0.70, 0.75}) {
    cases.push_back({fmt::format("Paderborn, cut at {:.0f} %", 100.0 * cut),
                     "calibration/lea_pmsm_52kw.toml",
                     "reports/calibration/paderborn_power_balance.map.toml",
                     "paderborn_pmsm",
                     {{"profile24_2.5s.csv", 0.0, cut}},
                     {{"profile24_2.5s.csv", cut, 1.0}}});
  }
  return cases;
}

std::vector<recording::Recording> read(const Case& one, const std::vector<Part>& parts) {
  std::vector<recording::Recording> all;
  for (const Part& part : parts) {
    const std::filesystem::path log = *measured_data(one.folder) / part.file;
    recording::RecordingReport report;
    const recording::Recording whole =
        recording::read_recording(log, recording::mapping_for(log.string(), (kSource / one.mapping).string()), report);
    all.push_back(recording::part_of(whole, part.from_share, part.to_share));
  }
  return all;
}

std::string cells(const std::vector<PredictedRun>& runs, const std::function<std::string(const PredictedSignal&)>& cell) {
  std::vector<std::string> all;
  for (const PredictedRun& run : runs) {
    std::vector<std::string> of_run;
    std::ranges::transform(run.signals, std::back_inserter(of_run), cell);
    all.push_back(fmt::format("{}", fmt::join(of_run, "/")));
  }
  return fmt::format("{}", fmt::join(all, "; "));
}

std::string errors(const std::vector<PredictedRun>& runs) {
  return cells(runs, [](const PredictedSignal& each) { return fmt::format("{:.2f}", each.rmse_K); });
}

/// Returns predictions of the unseen runs with the base network.
std::vector<PredictedRun> predictions(const ForecastModel& model, const Eigen::VectorXd& theta,
                                      const std::vector<estimation::MeasuredRun>& runs) {
  std::vector<PredictedRun> all;
  for (const estimation::MeasuredRun& run : runs) {
    all.push_back(predict(model, theta, Eigen::MatrixXd::Zero(theta.size(), theta.size()), usual_band(1.0), run));
  }
  return all;
}

void examine(const Case& one, int threads) {
  const std::vector<recording::Recording> fitted = read(one, one.fitted);
  const std::vector<recording::Recording> unseen = read(one, one.predicted);
  const motor::Motor motor = motor::read_motor(kSource / "reports" / one.motor);
  const ForecastSetup setup = forecast_setup(motor, fitted);
  std::vector<estimation::RunNote> notes;
  const std::vector<estimation::MeasuredRun> runs = forecast_runs(setup, fitted, one.ambient_C, notes);
  const std::vector<estimation::MeasuredRun> others = forecast_runs(setup, unseen, one.ambient_C, notes);
  const ForecastModel base = setup.model();
  estimation::FitOptions options;
  options.threads = threads;
  const estimation::Fit innovations = estimation::fit(base.motor().model, runs, options);
  const ForecastRules ordinary{.is_tempered = false, .has_heat_factors = false, .threads = threads};
  const ForecastFit plain = fit_forecast(base, runs, {}, innovations.theta, ordinary);
  const auto begin = std::chrono::steady_clock::now();
  const Forecast forecast = forecast_of(setup, runs, std::vector{innovations.theta}, threads);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const ForecastModel model = forecast.model();
  std::vector<PredictedRun> predicted;
  for (const estimation::MeasuredRun& run : others) {
    predicted.push_back(predict(model, forecast.fit.theta, forecast.fit.covariance, forecast.band, run));
  }
  std::vector<std::string> accepted;
  std::ranges::transform(forecast.accepted, std::back_inserter(accepted),
                         [](const AcceptedExtension& each) { return fmt::format("{} ({:.2f})", each.name, each.gain_nats); });
  constexpr std::array kSources{"file", "ordinary", "tempered", "innovations"};
  fmt::print("| {} | {} | {} | {} | **{}** | {} | {} | {} | {} | {:.1f} |\n", one.name, errors(predictions(base, base.start(), others)),
             errors(predictions(base, innovations.theta, others)), errors(predictions(base, plain.theta, others)), errors(predicted),
             cells(predicted, [](const PredictedSignal& each) { return fmt::format("{:.0f}", 100.0 * each.coverage_share); }),
             kSources[static_cast<std::size_t>(forecast.source)], forecast.pieces.size(), fmt::join(accepted, ", "), seconds);
  for (const RivalScore& rival : forecast.rivals) {
    fmt::print(stderr, "  left out, {}: {:.3f} nats", kSources[static_cast<std::size_t>(rival.source)], rival.score_nats);
    for (const auto& [signal, rmse_K] : rival.rmse_K) {
      fmt::print(stderr, ", {} {:.2f} K", signal, rmse_K);
    }
    fmt::print(stderr, "\n");
  }
  fmt::print(stderr, "  weight {:.4f}, error {:.2f} K, band {:.3f}/{:.3f} {:.0f} s {:.3f} x{:.2f}\n", forecast.fit.weight,
             forecast.fit.error_K, forecast.band.unknown_heat_share[0], forecast.band.unknown_heat_share[1], forecast.band.time_scale_s,
             forecast.band.heat_factor_sd, forecast.band.width_ratio);
  for (Eigen::Index i = 0; i < model.motor().model.free_count(); ++i) {
    fmt::print(stderr, "    {} {:.4g} (sd of the logarithm {:.2f})\n", model.motor().model.name(i),
               model.motor().model.value_of(i, forecast.fit.theta[i]), std::sqrt(forecast.fit.covariance(i, i)));
  }
  for (std::size_t i = 0; i < model.faults().size(); ++i) {
    fmt::print(stderr, "    {} {:.3g} s\n", model.faults()[i].type->name,
               std::exp(forecast.fit.theta[model.motor().model.free_count() + static_cast<Eigen::Index>(i)]));
  }
}

int run(const StudyWords& words) {
  constexpr int kSkipped = 77;
  if (!measured_data("tasrv_uav_motor")) {
    // The form in which GoogleTest reports it, for .ci/list_skipped.
    fmt::print("{}:{}: Skipped\n{}\n", __FILE__, __LINE__, why_no_measured_data("tasrv_uav_motor"));
    return kSkipped;
  }
  const std::vector<Case> cases = all_cases();
  const auto is_part = [](const Case& one, const std::string& part) { return one.name.find(part) != std::string::npos; };
  for (const std::string& part : words.all()) {
    if (std::ranges::none_of(cases, [&](const Case& one) { return is_part(one, part); })) {
      throw WrongWord(fmt::format("no case has '{}' in its name", part));
    }
  }
  fmt::print(
      "| predicted | file | innovations | free runs, least squares | written | in the 90 % band, % | by | pieces | extensions | s |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Case& one : cases) {
    if (!words.has(0) || std::ranges::any_of(words.all(), [&](const std::string& part) { return is_part(one, part); })) {
      examine(one, 1);
      std::fflush(stdout);
    }
  }
  return 0;
}

}  // namespace
}  // namespace heatsoak::calibration

int main(int argc, char** argv) {
  return heatsoak::run_study(argc, argv, "usage: heatsoak_forecast_table [PART…]\n\n  PART  part of the names of the wanted cases; all without one\n",
                             100, heatsoak::calibration::run);
}
