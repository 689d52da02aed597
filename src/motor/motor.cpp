#include "motor/motor.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/confidence.h"
#include "base/copper.h"
#include "input/document.h"
#include "motor/motor_effects.h"
#include "motor/read_motor.h"

namespace heatsoak::motor {
namespace {

/// Ranges from a watch motor to a locomotive motor; a value outside them has a wrong unit.
constexpr base::Range kVoltage = base::Range::between(0.1, 1e4);
constexpr base::Range kCurrent = base::Range::between(1e-4, 1e5);
constexpr base::Range kResistance = base::Range::between(1e-5, 1e5);
constexpr base::Range kInductance = base::Range::between(1e-8, 1e2);
constexpr base::Range kTorqueConstant = base::Range::between(1e-6, 1e3);
constexpr base::Range kSpeedConstant = base::Range::between(1e-3, 1e6);
constexpr base::Range kGradient = base::Range::between(1e-6, 1e12);
constexpr base::Range kMechanicalTime = base::Range::between(1e-5, 1e3);
constexpr base::Range kInertia = base::Range::between(1e-13, 1e4);
constexpr base::Range kSpeed = base::Range::between(0.1, 1e5);
constexpr base::Range kTorque = base::Range::between(1e-8, 1e6);
constexpr base::Range kPower = base::Range::between(1e-5, 1e8);
constexpr base::Range kMass = base::Range::between(1e-5, 1e5);
constexpr base::Range kSize = base::Range::between(1e-3, 10.0);
constexpr base::Range kThermalResistance = base::Range::between(1e-3, 1e3);
constexpr base::Range kThermalTime = base::Range::between(0.1, 1e6);
constexpr base::Range kTemperature = base::Range::between(-60.0, 400.0);

// clang-format off
constexpr std::array kSpecs = {
    MotorParameterSpec{{"nominal_voltage", "V", kVoltage, "supply voltage of the nominal values"}, &MotorValues::nominal_voltage_V, input::Need::required},
    MotorParameterSpec{{"terminal_resistance", "ohm", kResistance, "resistance of the winding at 25 °C"}, &MotorValues::terminal_resistance_ohm, input::Need::required, true},
    MotorParameterSpec{{"terminal_inductance", "H", kInductance, "inductance of the winding"}, &MotorValues::terminal_inductance_H},
    MotorParameterSpec{{"torque_constant", "N m/A", kTorqueConstant, "torque per ampere"}, &MotorValues::torque_constant_Nm_per_A, input::Need::required, true},
    MotorParameterSpec{{"speed_constant", "rad/s/V", kSpeedConstant, "speed per volt of back-EMF"}, &MotorValues::speed_constant_rad_per_s_per_V},
    MotorParameterSpec{{"speed_torque_gradient", "rad/s/(N m)", kGradient, "loss of speed per torque at constant voltage"}, &MotorValues::speed_torque_gradient_rad_per_s_per_Nm},
    MotorParameterSpec{{"mechanical_time_constant", "s", kMechanicalTime, "mechanical time constant R·J/K_t²"}, &MotorValues::mechanical_time_constant_s},
    MotorParameterSpec{{"rotor_inertia", "kg m2", kInertia, "moment of inertia of the rotor"}, &MotorValues::rotor_inertia_kg_m2},
    MotorParameterSpec{{"no_load_speed", "rad/s", kSpeed, "speed without load at nominal voltage"}, &MotorValues::no_load_speed_rad_per_s},
    MotorParameterSpec{{"no_load_current", "A", base::Range::between(0.0, 1e5), "current without load at nominal voltage, from iron and friction loss"}, &MotorValues::no_load_current_A, input::Need::required, true},
    MotorParameterSpec{{"nominal_speed", "rad/s", kSpeed, "speed at nominal voltage and torque"}, &MotorValues::nominal_speed_rad_per_s},
    MotorParameterSpec{{"nominal_torque", "N m", kTorque, "largest continuous torque at 25 °C ambient"}, &MotorValues::nominal_torque_Nm},
    MotorParameterSpec{{"nominal_current", "A", kCurrent, "largest continuous current at 25 °C ambient"}, &MotorValues::nominal_current_A},
    MotorParameterSpec{{"stall_torque", "N m", kTorque, "torque at standstill and nominal voltage"}, &MotorValues::stall_torque_Nm},
    MotorParameterSpec{{"stall_current", "A", kCurrent, "current at standstill and nominal voltage"}, &MotorValues::stall_current_A},
    MotorParameterSpec{{"max_efficiency", "", base::Range::between(0.0, 1.0), "highest efficiency at nominal voltage"}, &MotorValues::max_efficiency},
    MotorParameterSpec{{"peak_current", "A", kCurrent, "short-time current limit of the manufacturer"}, &MotorValues::peak_current_A},
    MotorParameterSpec{{"peak_torque", "N m", kTorque, "short-time torque limit of the manufacturer"}, &MotorValues::peak_torque_Nm},
    MotorParameterSpec{{"max_speed", "rad/s", kSpeed, "highest speed that the mechanics permit"}, &MotorValues::max_speed_rad_per_s},
    MotorParameterSpec{{"assigned_power", "W", kPower, "name-plate power"}, &MotorValues::assigned_power_W},
    MotorParameterSpec{{"pole_pairs", "", base::Range::between(1.0, 100.0), "number of pole pairs of the rotor"}, &MotorValues::pole_pairs},
    MotorParameterSpec{{"mass", "kg", kMass, "mass of the motor"}, &MotorValues::mass_kg},
    MotorParameterSpec{{"diameter", "m", kSize, "diameter of the body"}, &MotorValues::diameter_m},
    MotorParameterSpec{{"length", "m", kSize, "length of the body"}, &MotorValues::length_m},
    MotorParameterSpec{{"thermal_resistance_winding_stator", "K/W", kThermalResistance, "thermal resistance R_th1 from winding to housing"}, &MotorValues::thermal_resistance_winding_stator_K_per_W, input::Need::required, true},
    MotorParameterSpec{{"thermal_resistance_stator_ambient", "K/W", kThermalResistance, "thermal resistance R_th2 from housing to ambient, as mounted for the data sheet"}, &MotorValues::thermal_resistance_stator_ambient_K_per_W, input::Need::required, true},
    MotorParameterSpec{{"thermal_time_constant_winding", "s", kThermalTime, "heat capacity of the winding times R_th1"}, &MotorValues::thermal_time_constant_winding_s, input::Need::required, true},
    MotorParameterSpec{{"thermal_time_constant_stator", "s", kThermalTime, "heat capacity of the stator times R_th2"}, &MotorValues::thermal_time_constant_stator_s, input::Need::required, true},
    MotorParameterSpec{{"winding_limit", "degC", kTemperature, "highest permissible winding temperature"}, &MotorValues::winding_limit_C, input::Need::required, true},
    MotorParameterSpec{{"stator_limit", "degC", kTemperature, "highest permissible stator temperature"}, &MotorValues::stator_limit_C, input::Need::optional, true},
    MotorParameterSpec{{"ambient_min", "degC", kTemperature, "lowest permissible ambient temperature"}, &MotorValues::ambient_min_C},
    MotorParameterSpec{{"ambient_max", "degC", kTemperature, "highest permissible ambient temperature"}, &MotorValues::ambient_max_C},
    MotorParameterSpec{{"temperature_coefficient", "1/K", base::Range::between(0.0, 0.01), "temperature coefficient of the winding resistance at 25 °C; 0.0039 1/K (copper) unless given"}, &MotorValues::temperature_coefficient_per_K},
};
// clang-format on
constexpr std::array<std::string_view, 8> kAgreed{"nominal_voltage", "assigned_power", "max_speed",   "pole_pairs",
                                                  "winding_limit",   "stator_limit",   "ambient_min", "ambient_max"};

/// Factors to the conventions of MotorValues. For a sinusoidal back-EMF the torque constant per peak phase ampere is √3·π/6 = 0.907 of the
/// one per DC ampere of block commutation; RMS is peak/√2.
constexpr std::array<std::pair<std::string_view, double>, 2> kResistanceConventions{{{"between_terminals", 1.0}, {"phase_to_star", 2.0}}};
const std::array<std::pair<std::string_view, double>, 3> kTorqueConventions{
    {{"per_dc_ampere", 1.0},
     {"per_peak_phase_ampere", 6.0 / (std::numbers::sqrt3 * std::numbers::pi)},
     {"per_rms_phase_ampere", 6.0 / (std::numbers::sqrt3 * std::numbers::pi) / std::numbers::sqrt2}}};

void set_value(MotorValues& values, const MotorParameterSpec& spec, double value) {
  std::visit([&](const auto member) { values.*member = value; }, spec.value);
}

double* place_of(double& value, double /*absent*/) { return &value; }
double* place_of(std::optional<double>& value, double absent) { return value ? &*value : &value.emplace(absent); }

template <class Conventions>
double convention_factor(input::Reader& conventions, std::string_view key, const Conventions& known) {
  std::vector<std::string_view> names;
  names.reserve(known.size());
  for (const auto& [name, factor] : known) {
    names.push_back(name);
  }
  const std::optional<std::string> given = conventions.choice(key, names, input::Need::required);
  for (const auto& [name, factor] : known) {
    if (given == name) {
      return factor;
    }
  }
  return 1.0;
}

void scale(base::ParameterValue& parameter, double factor) {
  parameter.value *= factor;
  if (parameter.spread) {
    parameter.spread->low *= factor;
    parameter.spread->high *= factor;
  }
  for (base::Confirmation& other : parameter.confirmed_by) {
    other.value *= factor;
  }
}

/// Table of the values of a motor file.
constexpr std::string_view kTable = "figures";

void read_file_parameters(input::Reader& top, Motor& motor, double resistance_factor, double torque_factor) {
  std::optional<input::Reader> parameters = top.table(kTable, input::Need::required);
  if (!parameters) {
    return;
  }
  for (const MotorParameterSpec& each : kSpecs) {
    if (std::optional<base::ParameterValue> parameter = parameters->parameter(each.spec, each.need)) {
      if (each.spec.key == "terminal_resistance" || each.spec.key == "terminal_inductance") {
        scale(*parameter, resistance_factor);
      } else if (each.spec.key == "torque_constant") {
        scale(*parameter, torque_factor);
      }
      if (each.spec.key == "pole_pairs" && parameter->value != std::round(parameter->value)) {
        parameters->problem("pole_pairs", "is not a whole number");
      }
      set_value(motor.nominal, each, parameter->value);
      motor.parameters.emplace(each.spec.key, std::move(*parameter));
    }
  }
  parameters->finish();
}

/// Returns the ids of an entry's source as a list "a, b"; empty if it is neither a text nor a list.
std::string listed_sources(const input::Value& entry) {
  const input::Value* const source = entry.find("source");
  std::vector<std::string> ids;
  for (const input::Value& each : source != nullptr ? source->items : std::vector<input::Value>{}) {
    ids.push_back(each.text);
  }
  return source == nullptr ? "" : ids.empty() ? source->text : fmt::format("{}", fmt::join(ids, ", "));
}

/// Every source id that a value names must be explained in [sources], so that its origin can be checked. `entries`: kTable of the file, for
/// entries whose value is invalid; may be null.
void check_sources(const Motor& motor, const input::Value* entries, base::Diagnostics& diagnostics) {
  std::vector<std::string> known;
  for (const auto& [id, text] : motor.sources) {
    known.push_back(id);
  }
  const auto look_up = [&](const base::ParameterValue& parameter, const std::string& key, const std::string& id) {
    if (!motor.sources.contains(id)) {
      diagnostics.add(parameter.at, key, fmt::format("'{}' is not in [sources]{}", id, base::did_you_mean(id, known)));
    }
  };
  const auto check = [&](const std::string& key, const base::ParameterValue& parameter) {
    for (std::size_t at = 0; at < parameter.source.size();) {
      const std::size_t end = std::min(parameter.source.find(", ", at), parameter.source.size());
      look_up(parameter, key + ".source", parameter.source.substr(at, end - at));
      at = end + 2;
    }
    for (const base::Confirmation& other : parameter.confirmed_by) {
      look_up(parameter, key + ".confirmed_by", other.source);
    }
  };
  for (const auto& [key, parameter] : motor.parameters) {
    check(fmt::format("{}.{}", kTable, key), parameter);
  }
  for (const input::Member& entry : entries != nullptr ? entries->members : std::vector<input::Member>{}) {
    if (entry.value.kind == input::Value::Kind::table && !motor.parameters.contains(entry.key)) {
      base::ParameterValue unread;
      unread.at = entry.value.at;
      unread.source = listed_sources(entry.value);
      check(fmt::format("{}.{}", kTable, entry.key), unread);
    }
  }
  for (const MotorEffect& effect : motor.effects) {
    for (std::size_t i = 0; i < effect.parameters.size(); ++i) {
      check(fmt::format("effects.{}.{}", effect.name, effect.type->parameters[i].key), effect.parameters[i]);
    }
  }
  for (const MotorSensor& sensor : motor.sensors) {
    check(fmt::format("effects.{}.{}", sensor.name, sensor.type->size.key), sensor.size);
  }
}

/// Keys of all values in the order of sampling.
std::vector<std::string> parameter_keys(const Motor& motor) {
  std::vector<std::string> keys;
  for (const MotorParameterSpec& each : kSpecs) {
    if (motor.parameters.contains(each.spec.key)) {
      keys.emplace_back(each.spec.key);
    }
  }
  for (const MotorEffect& effect : motor.effects) {
    for (const base::ParameterSpec& spec : effect.type->parameters) {
      keys.push_back(fmt::format("effects.{}.{}", effect.name, spec.key));
    }
  }
  return keys;
}

/// Pairs of each value and the number in the sample that it sets, in the order of parameter_keys().
std::vector<std::pair<const base::ParameterValue*, double*>> places(const Motor& motor, MotorSample& sample) {
  std::vector<std::pair<const base::ParameterValue*, double*>> all;
  for (const MotorParameterSpec& each : kSpecs) {
    if (const auto found = motor.parameters.find(each.spec.key); found != motor.parameters.end()) {
      const double parameter = found->second.value;
      all.emplace_back(&found->second,
                       std::visit([&](const auto member) { return place_of(sample.values.*member, parameter); }, each.value));
    }
  }
  for (std::size_t e = 0; e < motor.effects.size(); ++e) {
    for (std::size_t p = 0; p < motor.effects[e].parameters.size(); ++p) {
      all.emplace_back(&motor.effects[e].parameters[p], &sample.effect_parameters[e][p]);
    }
  }
  return all;
}

}  // namespace

Motor::Motor() = default;
Motor::Motor(const Motor&) = default;
Motor::Motor(Motor&&) noexcept = default;
Motor& Motor::operator=(const Motor&) = default;
Motor& Motor::operator=(Motor&&) noexcept = default;
Motor::~Motor() = default;

double drag_torque_Nm(const MotorValues& motor) { return motor.torque_constant_Nm_per_A * motor.no_load_current_A; }

base::ParameterValue* find_parameter(Motor& motor, std::string_view key) {
  if (const auto found = motor.parameters.find(key); found != motor.parameters.end()) {
    return &found->second;
  }
  for (MotorEffect& effect : motor.effects) {
    for (std::size_t i = 0; i < effect.parameters.size(); ++i) {
      if (key == fmt::format("effects.{}.{}", effect.name, effect.type->parameters[i].key)) {
        return &effect.parameters[i];
      }
    }
  }
  for (MotorSensor& sensor : motor.sensors) {
    if (key == fmt::format("effects.{}.{}", sensor.name, sensor.type->size.key)) {
      return &sensor.size;
    }
  }
  return nullptr;
}

std::vector<SensorFault> faults_of(const Motor& motor, std::string_view signal) {
  std::vector<SensorFault> faults;
  for (const MotorSensor& sensor : motor.sensors) {
    if (sensor.type->signal == signal) {
      faults.push_back({sensor.type, sensor.size.value});
    }
  }
  return faults;
}

void refresh_values(Motor& motor) {
  for (const MotorParameterSpec& each : kSpecs) {
    if (const auto found = motor.parameters.find(each.spec.key); found != motor.parameters.end()) {
      set_value(motor.nominal, each, found->second.value);
    }
  }
}

std::span<const MotorParameterSpec> motor_parameter_specs() { return kSpecs; }

bool is_agreed(std::string_view key) { return std::ranges::find(kAgreed, key) != kAgreed.end(); }

Motor read_motor(const std::filesystem::path& path) {
  base::Diagnostics diagnostics;
  Motor motor = read_motor(path, diagnostics);
  diagnostics.throw_if_any();
  return motor;
}

Motor read_motor(const std::filesystem::path& path, base::Diagnostics& diagnostics) {
  const input::Value root = input::read_toml(path);
  input::Reader top(root, "", diagnostics);
  Motor motor;
  motor.id = path.stem().string();
  motor.file = path;
  motor.manufacturer = top.text("manufacturer", input::Need::required).value_or("");
  motor.name = top.text("name", input::Need::required).value_or("");
  motor.part_number = top.text("part_number", input::Need::optional).value_or("");
  constexpr std::array<std::string_view, 2> kTypes{"brushless", "brushed"};
  motor.type = top.choice("type", kTypes, input::Need::required).value_or("");
  constexpr std::array<std::string_view, 2> kRotors{"external", "internal"};
  motor.rotor = top.choice("rotor", kRotors, input::Need::optional).value_or("");
  motor.notes = top.texts("notes", input::Need::optional);
  if (std::optional<input::Reader> sources = top.table("sources", input::Need::required)) {
    for (const std::string& id : sources->keys()) {
      motor.sources.emplace(id, sources->text(id, input::Need::required).value_or(""));
    }
  }
  double resistance_factor = 1.0;
  double torque_factor = 1.0;
  if (std::optional<input::Reader> conventions = top.table("conventions", input::Need::required)) {
    resistance_factor = convention_factor(*conventions, "terminal_resistance", kResistanceConventions);
    torque_factor = convention_factor(*conventions, "torque_constant", kTorqueConventions);
    motor.stall_includes_saturation = conventions->flag("stall_includes_saturation", input::Need::optional).value_or(false);
    conventions->finish();
  }
  motor.nominal.temperature_coefficient_per_K = base::kCopper_per_K;
  read_file_parameters(top, motor, resistance_factor, torque_factor);
  read_effects(top, motor);
  if (std::optional<input::Reader> table = top.table("fit", input::Need::optional)) {
    motor.fit = read_fit(*table, parameter_keys(motor));
  }
  top.finish();
  check_sources(motor, root.find(kTable), diagnostics);
  return motor;
}

namespace {

/// Scales all temperature rises as a factor on the heat would. The resistances stay within their possible range.
void scale_heat(MotorValues& values, double heat_ratio) {
  for (double* const resistance_K_per_W :
       {&values.thermal_resistance_winding_stator_K_per_W, &values.thermal_resistance_stator_ambient_K_per_W}) {
    *resistance_K_per_W = std::clamp(*resistance_K_per_W * heat_ratio, kThermalResistance.low, kThermalResistance.high);
  }
}

}  // namespace

std::optional<Motor> at_upper_band(const Motor& motor) {
  if (!motor.fit || !motor.fit->band) {
    return std::nullopt;
  }
  Motor upper = motor;
  scale_heat(upper.nominal, drawn_heat_factor(*motor.fit->band, 0.5 * (1.0 + base::kBand_share)));
  return upper;
}

MotorSample nominal_sample(const Motor& motor) {
  MotorSample sample{motor.nominal, {}};
  for (const MotorEffect& effect : motor.effects) {
    sample.effect_parameters.push_back(effect.values());
  }
  return sample;
}

MotorSample draw_sample(const Motor& motor, base::Random& random) {
  MotorSample sample = nominal_sample(motor);
  const std::vector<std::pair<const base::ParameterValue*, double*>> all = places(motor, sample);
  std::vector<double> uniforms(all.size(), 0.5);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].first->spread) {
      uniforms[i] = random.uniform();
    }
  }
  if (motor.fit) {
    const std::vector<std::string> keys = parameter_keys(motor);
    const auto place = [&](const std::string& key) { return static_cast<std::size_t>(std::ranges::find(keys, key) - keys.begin()); };
    std::vector<double> fitted;
    for (const std::string& key : motor.fit->parameters) {
      fitted.push_back(uniforms[place(key)]);
    }
    correlate(*motor.fit, fitted);
    for (std::size_t i = 0; i < fitted.size(); ++i) {
      uniforms[place(motor.fit->parameters[i])] = fitted[i];
    }
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].first->spread) {
      *all[i].second = all[i].first->quantile(uniforms[i]);
    }
  }
  if (motor.fit && motor.fit->band) {
    scale_heat(sample.values, drawn_heat_factor(*motor.fit->band, random.uniform()));
  }
  return sample;
}

namespace {

/// Quality of a motor file written by a calibration. Limits and constants from a data sheet do not lower it, estimates do.
std::string_view quality_of_fit(const Motor& motor) {
  bool is_measured = true;
  for (const MotorEffect& effect : motor.effects) {
    for (std::size_t i = 0; i < effect.parameters.size(); ++i) {
      is_measured = is_measured && (!effect.type->parameters[i].choices.empty() || effect.parameters[i].origin != base::Origin::estimated);
    }
  }
  for (const MotorParameterSpec& each : kSpecs) {
    const auto found = motor.parameters.find(each.spec.key);
    if (each.is_thermal && found != motor.parameters.end()) {
      const base::Origin origin = found->second.origin;
      is_measured =
          is_measured && (each.spec.key.starts_with("thermal_") ? origin == base::Origin::measured : origin != base::Origin::estimated);
    }
  }
  return is_measured ? "measured" : "mixed";
}

}  // namespace

std::string_view data_quality(const Motor& motor) {
  if (motor.fit) {
    return quality_of_fit(motor);
  }
  bool all_of_sheet = true;
  for (const MotorEffect& effect : motor.effects) {
    for (std::size_t i = 0; i < effect.parameters.size(); ++i) {
      const base::ParameterValue& parameter = effect.parameters[i];
      if (!effect.type->parameters[i].choices.empty()) {
        continue;
      }
      if (parameter.origin == base::Origin::estimated) {
        return "estimated";
      }
      all_of_sheet = all_of_sheet && (parameter.origin == base::Origin::datasheet || parameter.origin == base::Origin::measured);
    }
  }
  for (const MotorParameterSpec& each : kSpecs) {
    const auto found = motor.parameters.find(each.spec.key);
    if (!each.is_thermal || found == motor.parameters.end()) {
      continue;
    }
    const base::Origin origin = found->second.origin;
    const bool is_network = each.spec.key.starts_with("thermal_") || each.spec.key == "winding_limit";
    if (is_network && origin == base::Origin::estimated) {
      return "estimated";
    }
    all_of_sheet = all_of_sheet && (origin == base::Origin::datasheet || origin == base::Origin::measured);
  }
  return all_of_sheet ? "datasheet" : "mixed";
}

}  // namespace heatsoak::motor
