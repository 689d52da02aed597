// Forecasts of synthetic motors with eight parts: fits one to three runs with each rival and predicts two unseen runs, one of them on a
// bench.
//   heatsoak_forecast_rivals [FIRST_SEED [SEEDS [RUNS]]]
// Prints one line per case with the RMS errors in K (winding and stator together, worse of both unseen runs), then a summary.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "../../support/study_words.h"
#include "base/parallel.h"
#include "calibration/forecast/forecast.h"
#include "calibration/forecast/prediction.h"
#include "calibration/written_forecast.h"
#include "examination.h"
#include "motor/motor.h"

namespace {

using namespace heatsoak;
using namespace heatsoak::attribution::truth;

constexpr double kTorque_Nm_per_A = 0.034;
constexpr double kNoLoad_A = 0.2;

/// `extended`: the best forecast fit, with its extensions; `written`: that or the innovations fit, as `calibrate` decides.
enum Rival { file, innovations, ordinary, tempered, extended, written, rival_count };
constexpr std::array<const char*, rival_count> kNames{"file", "innovations", "ordinary", "tempered", "extended", "written"};

/// Heat of the drag that the motor file states as its no-load current.
Missing drag(double ratio) {
  Missing missing;
  missing.heat.push_back(
      [ratio](const Moment& m, PerPart& q) { q[yoke] += ratio * kTorque_Nm_per_A * kNoLoad_A * std::abs(m.in.speed_rad_per_s); });
  return missing;
}

/// Data sheet of the motor: each thermal value is off by up to 25 %, and says so.
motor::Motor sheet_of(const MotorMake& make, std::uint64_t seed) {
  Dice dice(seed * 104729 + 5);
  const auto off = [&dice](double value) { return value * dice.uniform(0.8, 1.25); };
  std::string text =
      "manufacturer = \"none\"\nname = \"made up\"\ntype = \"brushless\"\n[sources]\ns = \"made up\"\n[conventions]\n"
      "terminal_resistance = \"between_terminals\"\ntorque_constant = \"per_dc_ampere\"\n[figures]\n";
  const auto put = [&](const char* key, double value, const char* unit, const char* spread) {
    text += fmt::format("{} = {{ value = \"{:.6g}{}{}\", origin = \"datasheet\", source = \"s\"{} }}\n", key, value, *unit ? " " : "", unit,
                        spread);
  };
  constexpr const char* kQuarter = ", tolerance = \"25 %\"";
  put("nominal_voltage", 24.0, "V", "");
  put("terminal_resistance", make.resistance_25C_ohm, "ohm", ", tolerance = \"10 %\"");
  put("torque_constant", kTorque_Nm_per_A, "N m/A", "");
  put("no_load_current", kNoLoad_A, "A", ", tolerance = \"30 %\"");
  put("temperature_coefficient", make.copper_per_K, "1/K", "");
  put("winding_limit", 155.0, "degC", "");
  const double across = off(make.copper_to_iron_K_per_W);
  const double out = off(make.iron_to_air_K_per_W);
  put("thermal_resistance_winding_stator", across, "K/W", kQuarter);
  put("thermal_resistance_stator_ambient", out, "K/W", kQuarter);
  put("thermal_time_constant_winding", off(make.copper_capacity_J_per_K) * across, "s", kQuarter);
  put("thermal_time_constant_stator", off(make.iron_capacity_J_per_K) * out, "s", kQuarter);
  const std::filesystem::path path = std::filesystem::temp_directory_path() / fmt::format("heatsoak_rivals_{}.toml", seed);
  std::ofstream(path) << text;
  motor::Motor motor = motor::read_motor(path);
  std::filesystem::remove(path);
  return motor;
}

struct Result {
  std::string name;
  int runs = 0;
  std::array<double, rival_count> error_K{};
  calibration::ForecastSource source = calibration::ForecastSource::file;
  std::string accepted = {};
};

std::vector<recording::Recording> logs_of(const std::vector<TrueRun>& runs) {
  std::vector<recording::Recording> logs;
  std::ranges::transform(runs, std::back_inserter(logs), &TrueRun::log);
  return logs;
}

double worst_K(const calibration::ForecastModel& model, const Eigen::VectorXd& theta, const std::vector<estimation::MeasuredRun>& unseen) {
  double worst = 0.0;
  for (const estimation::MeasuredRun& run : unseen) {
    const calibration::PredictedRun of_run =
        calibration::predict(model, theta, Eigen::MatrixXd::Zero(theta.size(), theta.size()), calibration::usual_band(1.0), run);
    double squares = 0.0;
    for (const calibration::PredictedSignal& each : of_run.signals) {
      squares += each.rmse_K * each.rmse_K / static_cast<double>(of_run.signals.size());
    }
    worst = std::max(worst, std::sqrt(squares));
  }
  return worst;
}

Result examine(const std::string& name, int runs, const motor::Motor& motor, const Runs& recorded) {
  Result result{.name = name, .runs = runs};
  const std::vector<recording::Recording> fitted = logs_of(recorded.training);
  const calibration::ForecastSetup setup = calibration::forecast_setup(motor, fitted);
  std::vector<estimation::RunNote> notes;
  const std::vector<estimation::MeasuredRun> train = calibration::forecast_runs(setup, fitted, {}, notes);
  const std::vector<estimation::MeasuredRun> unseen = calibration::forecast_runs(setup, logs_of(recorded.unseen), {}, notes);
  const calibration::ForecastModel base = setup.model();
  estimation::FitOptions options;
  options.threads = 1;
  const estimation::Fit by_innovations = estimation::fit(base.motor().model, train, options);
  const auto free_run = [&](bool is_tempered) {
    const calibration::ForecastRules rules{.is_tempered = is_tempered, .has_heat_factors = is_tempered, .threads = 1};
    calibration::ForecastFit best = calibration::fit_forecast(base, train, {}, base.start(), rules);
    const calibration::ForecastFit other = calibration::fit_forecast(base, train, {}, base.within_bounds(by_innovations.theta), rules);
    return other.error_K < best.error_K ? other : best;
  };
  const calibration::Forecast forecast = calibration::forecast_of(setup, train, std::vector{base.within_bounds(by_innovations.theta)}, 1);
  result.error_K[file] = worst_K(base, base.start(), unseen);
  result.error_K[innovations] = worst_K(base, base.within_bounds(by_innovations.theta), unseen);
  result.error_K[ordinary] = worst_K(base, free_run(false).theta, unseen);
  result.error_K[tempered] = worst_K(base, free_run(true).theta, unseen);
  result.error_K[extended] = worst_K(forecast.model(), forecast.fit.theta, unseen);
  calibration::Calibration calibration;
  calibration.motor_model = base.motor();
  calibration.fit = by_innovations;
  calibration.runs = train;
  calibration.forecast = forecast;
  calibration::score_innovations(base, options, calibration);
  const bool is_forecast = calibration::writes_forecast(calibration::WrittenFit::best, *calibration.forecast, true);
  result.error_K[written] = result.error_K[is_forecast ? extended : innovations];
  result.source = is_forecast ? forecast.source : calibration::ForecastSource::innovations;
  for (const calibration::AcceptedExtension& each : forecast.accepted) {
    result.accepted += each.name + " ";
  }
  return result;
}

void summarise(const std::vector<Result>& results, int runs) {
  for (int rival = 0; rival < rival_count; ++rival) {
    double log_sum = 0.0;
    std::vector<double> ratios;
    int near = 0;
    for (const Result& each : results) {
      if (each.runs != runs) {
        continue;
      }
      const double best = std::min({each.error_K[file], each.error_K[innovations], each.error_K[ordinary]});
      const double ratio = each.error_K[static_cast<std::size_t>(rival)] / best;
      ratios.push_back(ratio);
      log_sum += std::log(ratio);
      near += each.error_K[static_cast<std::size_t>(rival)] <= std::max(1.05 * best, best + 0.1) ? 1 : 0;
    }
    std::ranges::sort(ratios);
    const auto count = static_cast<double>(ratios.size());
    fmt::print(
        "{} run{}: {:12} geometric mean ratio to the best of file, innovations, ordinary {:.3f}, median {:.3f}, 90 % {:.2f}, largest "
        "{:.2f}; within 5 % or 0.1 K: {:.0f} %\n",
        runs, runs > 1 ? "s" : "", kNames[static_cast<std::size_t>(rival)], std::exp(log_sum / count), ratios[ratios.size() / 2],
        ratios[static_cast<std::size_t>(0.9 * count)], ratios.back(), 100.0 * near / count);
  }
}

int run(const StudyWords& words) {
  const std::uint64_t first = words.whole(0, "FIRST_SEED", 0, 1);
  const std::uint64_t seeds = words.whole(1, "SEEDS", 1, 1);
  const std::vector<int> run_counts = words.has(2) ? std::vector{static_cast<int>(words.whole(2, "RUNS", 1, 1, 3))} : std::vector{1, 2, 3};
  struct Task {
    std::string name;
    int runs;
    motor::Motor motor;
    Runs recorded;
  };
  std::vector<Task> tasks;
  for (std::uint64_t seed = first; seed < first + seeds; ++seed) {
    for (const int runs : run_counts) {
      const auto add = [&](const std::string& name, const Missing& missing, std::uint64_t own) {
        Dice dice(own * 31 + 7);
        Case sealed;
        sealed.missing = together(drag(dice.uniform(0.8, 1.25)), missing);
        sealed.training_runs = runs;
        sealed.seed = own;
        Runs recorded = record(sealed);
        motor::Motor motor = sheet_of(recorded.make, own);
        tasks.push_back({name, runs, std::move(motor), std::move(recorded)});
      };
      for (int i = 0; i < 10; ++i) {
        add("nothing", {}, 700000 + 1000 * seed + static_cast<std::uint64_t>(i));
      }
      for (std::size_t s = 0; s < subjects().size(); ++s) {
        add(std::string(subjects()[s].name), subjects()[s].make(1.0), 800000 + 1000 * seed + s);
      }
    }
  }
  std::vector<Result> results(tasks.size());
  base::in_parallel(tasks.size(), 0, [&](std::size_t i) {
    const Task& task = tasks[i];
    results[i] = examine(task.name, task.runs, task.motor, task.recorded);
  });
  constexpr std::array kSources{"file", "ordinary", "tempered", "innovations"};
  for (const Result& each : results) {
    fmt::print("{:28} {} runs:", each.name, each.runs);
    for (const double error_K : each.error_K) {
      fmt::print(" {:7.2f}", error_K);
    }
    fmt::print("  {} {}\n", kSources[static_cast<std::size_t>(each.source)], each.accepted);
  }
  for (const int runs : run_counts) {
    summarise(results, runs);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return run_study(argc, argv, "usage: heatsoak_forecast_rivals [FIRST_SEED [SEEDS [RUNS]]]\n", 3, run); }
