#include "examination.h"

#include <fmt/format.h>
#include <unistd.h>

#include <Eigen/Dense>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "base/unknown.h"
#include "drive_rows.h"
#include "estimation/log_columns.h"
#include "estimation/measured_run.h"
#include "estimation/turning_rows.h"
#include "motor/write_motor.h"

namespace heatsoak::attribution::truth {
namespace {

/// Removes outliers as the log reader does: samples that differ from their neighbours by more than six standard deviations.
void leave_out_outliers(std::vector<double>& values) {
  const std::vector<double> all = values;
  for (std::size_t k = 3; k + 3 < all.size(); ++k) {
    std::vector<double> near;
    for (std::size_t i = k - 3; i <= k + 3; ++i) {
      if (!std::isnan(all[i])) {
        near.push_back(all[i]);
      }
    }
    if (near.size() < 5 || std::isnan(all[k])) {
      continue;
    }
    std::ranges::sort(near);
    const double middle = near[near.size() / 2];
    std::vector<double> off;
    for (const double value : near) {
      off.push_back(std::abs(value - middle));
    }
    std::ranges::sort(off);
    if (std::abs(all[k] - middle) > 6.0 * 1.4826 * std::max(0.1, off[off.size() / 2])) {
      values[k] = base::kUnknown;
    }
  }
}

/// Replaces all signals of the motion in each row by those of another row.
void shuffle_speed(recording::Recording& log, Dice& dice) {
  for (std::size_t row = log.rows(); row > 1; --row) {
    const auto other = static_cast<std::size_t>(dice.below(static_cast<int>(row)));
    for (recording::Channel& channel : log.channels) {
      const std::string& key = channel.quantity.key;
      if (key == "speed_rad_per_s" || key == "modulation_ratio" || key == "vehicle_speed_m_per_s") {
        std::swap(channel.values[row - 1], channel.values[other]);
      }
    }
  }
}

}  // namespace

Runs record(const Case& sealed) {
  constexpr int kEarlier = 3;
  Dice dice(sealed.seed * 7919 + 17);
  Runs runs;
  runs.make.metal_ratio = sealed.metal_ratio;
  for (double* const value : {&runs.make.copper_capacity_J_per_K, &runs.make.iron_capacity_J_per_K, &runs.make.copper_to_iron_K_per_W,
                              &runs.make.iron_to_air_K_per_W}) {
    *value *= dice.uniform(0.8, 1.25);
  }
  double age_h = dice.uniform(0.0, 2.0);
  const auto recorded = [&](const Missing& missing, int number, bool on_bench) {
    const std::uint64_t seed = sealed.seed * 131 + static_cast<std::uint64_t>(number);
    const std::vector<RowInputs> rows = on_bench ? bench_rows(sealed.rows, seed) : robot_rows(sealed.rows, seed);
    TrueRun run = run_motor(runs.make, missing, sealed.surprise, rows, age_h, seed ^ 0xabcdef, "run" + std::to_string(number + 1));
    for (const std::size_t channel : {0, 1}) {
      leave_out_outliers(run.log.channels[channel].values);
    }
    if (!sealed.has_right_speed) {
      shuffle_speed(run.log, dice);
    }
    if (!sealed.has_winding_sensor) {
      std::ranges::fill(run.log.channels.front().values, base::kUnknown);
    }
    age_h += sealed.rows / 3600.0;
    return run;
  };
  for (int r = 0; r < sealed.training_runs + 2; ++r) {
    const bool on_bench = (sealed.training_runs > 1 && r == sealed.training_runs - 1) || r == sealed.training_runs + 1;
    (r < sealed.training_runs ? runs.training : runs.unseen).push_back(recorded(sealed.missing, r, on_bench));
  }
  for (int r = 0; sealed.is_calibrated && r < kEarlier; ++r) {
    runs.earlier.push_back(recorded({}, 100 + r, r == kEarlier - 1));
  }
  return runs;
}

namespace {

motor::Motor motor_in(const std::string& text) {
  const auto file = std::filesystem::temp_directory_path() / fmt::format("heatsoak_sheet_{}.toml", getpid());
  std::ofstream(file) << text;
  motor::Motor motor = motor::read_motor(file);
  std::filesystem::remove(file);
  return motor;
}

}  // namespace

motor::Motor read_back(const motor::Motor& motor) { return motor_in(motor::to_toml(motor)); }

motor::Motor sheet_of(const MotorMake& make) {
  std::ostringstream out;
  out << "manufacturer = \"none\"\nname = \"made up\"\ntype = \"brushless\"\n[sources]\ns = \"made up\"\n[conventions]\n"
         "terminal_resistance = \"between_terminals\"\ntorque_constant = \"per_dc_ampere\"\n[figures]\n";
  const auto put = [&](const char* key, double value, const char* unit) {
    out << fmt::format("{} = {{ value = \"{:.6g} {}\", origin = \"datasheet\", source = \"s\" }}\n", key, value, unit);
  };
  put("nominal_voltage", 24.0, "V");
  put("terminal_resistance", make.resistance_25C_ohm, "ohm");
  put("torque_constant", 0.034, "N m/A");
  put("no_load_current", 0.0, "A");
  put("temperature_coefficient", make.copper_per_K, "1/K");
  put("winding_limit", 155.0, "degC");
  put("thermal_resistance_winding_stator", 1.15 * make.copper_to_iron_K_per_W, "K/W");
  put("thermal_resistance_stator_ambient", 0.9 * make.iron_to_air_K_per_W, "K/W");
  put("thermal_time_constant_winding", make.copper_to_iron_K_per_W * make.copper_capacity_J_per_K, "s");
  put("thermal_time_constant_stator", make.iron_to_air_K_per_W * make.iron_capacity_J_per_K, "s");
  return motor_in(out.str());
}

Calibrated calibrated(const Case& sealed, const MotorMake& make, const std::vector<TrueRun>& runs) {
  Calibrated all{model_before(make, sealed.seed), {}};
  std::vector<estimation::MeasuredRun> rows;
  std::ranges::transform(runs, std::back_inserter(rows), measured);
  all.fit = estimation::fit(all.model, rows, {});
  all.model.set_theta(all.fit.theta);
  all.model.prior = {all.fit.theta, all.fit.covariance.inverse()};
  all.usual.error_K = all.fit.free_run_error_K;
  all.usual.flux_W = std::ranges::max(all.fit.flux.rms_W);
  return all;
}

estimation::Model model_before(const MotorMake& make, std::uint64_t seed) {
  Dice dice(seed * 104729 + 5);
  const auto off = [&dice](double value) { return value * dice.uniform(0.8, 1.25); };
  estimation::Model out;
  thermal::Network& network = out.network;
  network.add_node("winding", off(make.copper_capacity_J_per_K));
  network.add_node("stator", off(make.iron_capacity_J_per_K));
  const auto add = [&](const char* name, const char* type, std::vector<std::string> nodes, std::vector<double> parameters) {
    network.add_effect(name, *thermal::find_effect(type), nodes, parameters);
  };
  add("copper_loss", "copper_loss", {"winding"}, {make.resistance_25C_ohm, make.copper_per_K});
  add("winding_stator", "conduction", {"winding", "stator"}, {off(make.copper_to_iron_K_per_W)});
  add("stator_ambient", "conduction", {"stator", "ambient"}, {off(make.iron_to_air_K_per_W)});
  network.limit_current_by("copper_loss");
  out.values = network.values();
  out.flux_nodes = {0, 1};
  out.prior = {Eigen::VectorXd(0), Eigen::MatrixXd(0, 0)};
  for (std::size_t place = 0; place < network.parameters().size(); ++place) {
    const std::string& name = network.parameters()[place].name;
    if (name.find("heat_capacity") != std::string::npos || name.find("thermal_resistance") != std::string::npos) {
      const double value = out.values[place];
      out.set_free({static_cast<int>(place), true, 1.0, value / 20.0, value * 20.0}, 1.1);
    }
  }
  return out;
}

std::vector<estimation::MeasuredRun> measured_pieces(const TrueRun& run) {
  estimation::MeasuredRunOptions options;
  options.needed = {thermal::Signal::current};
  return estimation::measured_runs(run.log, options).runs;
}

estimation::MeasuredRun measured(const TrueRun& run) { return measured_pieces(run).front(); }

double rms_error_K(const estimation::Model& model, const std::vector<TrueRun>& runs) {
  double squares_K2 = 0.0;
  double count = 0.0;
  for (const TrueRun& run : runs) {
    estimation::MeasuredRun as_run = measured(run);
    estimation::set_columns(as_run, model.columns);
    std::vector<double> start_C(static_cast<std::size_t>(model.network.state_count()), as_run.at.front().ambient_C);
    start_C[0] = run.winding_C.front();
    start_C[1] = run.stator_C.front();
    const estimation::LinearisedRun path = estimation::linearise(model.network, model.values_in(as_run), {}, {}, start_C, as_run);
    for (Eigen::Index k = 0; k < path.samples(); ++k) {
      const auto row = static_cast<std::size_t>(std::llround(as_run.time_s[static_cast<std::size_t>(k)]));
      squares_K2 += std::pow(path.state_C(0, k) - run.winding_C[row], 2) + std::pow(path.state_C(1, k) - run.stator_C[row], 2);
      count += 2.0;
    }
  }
  return std::sqrt(squares_K2 / count);
}

diagnosis::DiagnosisInput question(const Case& sealed, const Runs& runs) {
  diagnosis::DiagnosisInput input;
  Calibrated before{model_before(runs.make, sealed.seed), {}};
  if (!runs.earlier.empty()) {
    before = calibrated(sealed, runs.make, runs.earlier);
  }
  input.model = std::move(before.model);
  input.usual = before.usual;
  for (const TrueRun& run : runs.training) {
    std::ranges::copy(measured_pieces(run), std::back_inserter(input.train));
  }
  return input;
}

std::vector<estimation::MeasuredRun> holdout(const Runs& runs, bool is_speed_linear) {
  std::vector<estimation::MeasuredRun> all;
  std::ranges::transform(runs.unseen, std::back_inserter(all), measured);
  return is_speed_linear ? estimation::turning_within_rows(std::move(all)) : all;
}

std::optional<calibration::ContradictingRun> contradiction(const diagnosis::DiagnosisInput& input, const Selection& selection) {
  std::vector<estimation::MeasuredRun> train = input.train;
  estimation::set_columns(train, selection.after.model.columns);
  return calibration::contradicting_run(selection.after, train, selection.weights);
}

Answer examine(const Case& sealed) {
  const Runs runs = record(sealed);
  diagnosis::DiagnosisInput input = question(sealed, runs);
  const auto begin = std::chrono::steady_clock::now();
  Answer answer;
  const std::optional<bool> is_speed_linear = estimation::settle_turning_rows(input.model, input.train);
  answer.diagnosis = diagnosis::diagnose(input, {});
  answer.seconds_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  answer.score = errors_of_models(input, answer.diagnosis, holdout(runs, is_speed_linear.value_or(false)));
  const Selection& selection = answer.diagnosis.selection;
  for (const AcceptedTerm& term : selection.terms) {
    const std::string curve =
        term.curve ? term.curve->term.node + "~" + selection.regressors[static_cast<std::size_t>(term.curve->term.regressor)].name : "";
    answer.named.push_back(term.candidate ? term.candidate->id : curve);
  }
  answer.before_K = rms_error_K(selection.before.model, runs.unseen);
  answer.after_K = rms_error_K(selection.after.model, runs.unseen);
  return answer;
}

double floor_K(Case sealed) {
  sealed.missing = {};
  const Runs runs = record(sealed);
  diagnosis::DiagnosisInput given = question(sealed, runs);
  SelectionInput input;
  input.model = std::move(given.model);
  input.runs = std::move(given.train);
  input.usual = given.usual;
  SelectionRules rules;
  rules.scans_regressors = false;
  rules.most_effects = 0;
  return rms_error_K(select_effects(input, rules).before.model, runs.unseen);
}

}  // namespace heatsoak::attribution::truth
