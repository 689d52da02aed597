#include "study.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <mutex>

#include "recording/read_recording.h"

namespace heatsoak::calibration::study {
namespace {

double truth_of(const std::string& name, const estimation::TwoNodeTruth& truth) {
  if (name == "thermal_resistance_winding_stator") {
    return truth.winding_stator_K_per_W;
  }
  if (name == "thermal_resistance_stator_ambient") {
    return truth.stator_ambient_K_per_W;
  }
  if (name == "thermal_time_constant_winding") {
    return truth.winding_J_per_K * truth.winding_stator_K_per_W;
  }
  if (name == "thermal_time_constant_stator") {
    return truth.stator_J_per_K * truth.stator_ambient_K_per_W;
  }
  if (name == "winding_heat_capacity") {
    return truth.winding_J_per_K;
  }
  if (name == "stator_heat_capacity") {
    return truth.stator_J_per_K;
  }
  return name == "terminal_resistance" ? truth.resistance_25C_ohm : std::nan("");
}

}  // namespace

Folder::Folder() {
  std::string name = (std::filesystem::temp_directory_path() / "heatsoak_study_XXXXXX").string();
  path_ = ::mkdtemp(name.data());
}

Folder::~Folder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

motor::Motor Sheet::motor(const Folder& folder) const {
  const auto file = folder.path() / "made_up.toml";
  std::ofstream out(file);
  const auto parameter = [&](const char* key, double value, const char* unit, const std::string& spread,
                             const std::string& origin = "datasheet") {
    out << fmt::format("{} = {{ value = \"{:.6g}{}{}\", origin = \"{}\", source = \"s\", derivation = \"made up\"{} }}\n", key, value,
                       *unit ? " " : "", unit, origin, spread);
  };
  out << "manufacturer = \"none\"\nname = \"made up\"\ntype = \"brushless\"\n[sources]\ns = \"made up\"\n[conventions]\n"
         "terminal_resistance = \"between_terminals\"\ntorque_constant = \"per_dc_ampere\"\n[figures]\n";
  parameter("nominal_voltage", 24.0, "V", "");
  parameter("terminal_resistance", truth.resistance_25C_ohm, "ohm", resistance_spread, resistance_origin);
  parameter("torque_constant", 0.034, "N m/A", "");
  parameter("no_load_current", no_load_current_A, "A", "");
  parameter("temperature_coefficient", truth.temperature_coefficient_per_K, "1/K", "");
  parameter("winding_limit", 155.0, "degC", "");
  parameter("thermal_resistance_winding_stator", truth.winding_stator_K_per_W, "K/W", thermal_spread);
  parameter("thermal_resistance_stator_ambient", truth.stator_ambient_K_per_W, "K/W", thermal_spread);
  parameter("thermal_time_constant_winding", truth.winding_J_per_K * truth.winding_stator_K_per_W, "s", thermal_spread);
  parameter("thermal_time_constant_stator", truth.stator_J_per_K * truth.stator_ambient_K_per_W, "s", thermal_spread);
  out.close();
  return motor::read_motor(file);
}

estimation::TwoNodeTruth drawn_truth(const Sheet& sheet, const motor::Motor& motor, std::uint64_t seed) {
  base::Random random(seed, 1000);
  estimation::TwoNodeTruth truth = sheet.truth;
  const auto factor = [&](std::string_view key) {
    return std::exp(prior_sd_of(motor.parameters.find(key)->second) * estimation::standard_normal(random));
  };
  const double across_ratio = factor("thermal_resistance_winding_stator");
  const double out_ratio = factor("thermal_resistance_stator_ambient");
  truth.winding_stator_K_per_W *= across_ratio;
  truth.stator_ambient_K_per_W *= out_ratio;
  truth.winding_J_per_K *= factor("thermal_time_constant_winding") / across_ratio;
  truth.stator_J_per_K *= factor("thermal_time_constant_stator") / out_ratio;
  if (!sheet.resistance_spread.empty()) {
    const base::Spread& spread = *motor.parameters.find("terminal_resistance")->second.spread;
    truth.resistance_25C_ohm *= std::exp(0.25 * std::log(spread.high / spread.low) * estimation::standard_normal(random));
  }
  return truth;
}

std::filesystem::path write_log(const recording::Recording& log, const std::filesystem::path& file) {
  std::ofstream out(file);
  out << "time_s";
  for (const recording::Channel& channel : log.channels) {
    out << ',' << channel.quantity.key;
  }
  for (std::size_t row = 0; row < log.rows(); ++row) {
    out << fmt::format("\n{:g}", log.time_s[row]);
    for (const recording::Channel& channel : log.channels) {
      out << ',' << (std::isnan(channel.values[row]) ? "" : fmt::format("{:.8g}", channel.values[row]));
    }
  }
  out << '\n';
  return file;
}

recording::Recording read_log(const std::filesystem::path& file) {
  recording::RecordingReport report;
  return recording::read_recording(file, recording::mapping_for(file, {}), report);
}

struct Prepared {
  motor::Motor motor;
  estimation::TwoNodeTruth truth;
  std::vector<recording::Recording> logs;
};

/// Reads files one after the other, because the parser of units is not thread-safe.
Prepared prepare(const Sheet& sheet, const Case& one) {
  static std::mutex reading;
  const std::lock_guard lock(reading);
  const Folder folder;
  Prepared all{sheet.motor(folder), {}, {}};
  all.truth = drawn_truth(sheet, all.motor, one.seed);
  for (int run = 0; run < one.runs; ++run) {
    const recording::Recording made = estimation::generated_log(all.truth, one.making, one.seed, static_cast<std::uint64_t>(run));
    all.logs.push_back(read_log(write_log(made, folder.path() / fmt::format("run_{}.csv", run + 1))));
  }
  return all;
}

CaseResult calibrate_case(const Sheet& sheet, const Case& one) {
  const Prepared prepared = prepare(sheet, one);
  CalibrationOptions options;
  options.fit.threads = one.threads;
  options.fit.with_flux = one.with_flux;
  options.written = one.written;
  const auto begin = std::chrono::steady_clock::now();
  CaseResult result{{}, calibrate(prepared.motor, prepared.logs, {}, options)};
  result.seconds_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  for (const CalibratedParameter& parameter : result.calibration.parameters) {
    result.marks.push_back({parameter.name, truth_of(parameter.name, prepared.truth), parameter});
  }
  return result;
}

}  // namespace heatsoak::calibration::study
