// Text of the start files. The values of the small motor are those of motor_db/maxon_ec45_flat_70w_24v.toml.
#include <fmt/format.h>

#include "motor.h"

namespace heatsoak::suite {
namespace {

/// Values that no equation of this folder uses, as the sheet prints them.
struct Sheet {
  const char* heading = "";
  const char* identity = "";
  const char* assigned_power = "";
  const char* no_load_speed = "";
  const char* nominal_speed = "";
  const char* nominal_torque = "";
  const char* stall_torque = "";
  const char* stall_current = "";
  const char* max_efficiency = "";
  const char* inductance = "";
  const char* speed_constant = "";
  const char* speed_torque_gradient = "";
  const char* mechanical_time_constant = "";
  const char* inertia = "";
  const char* pole_pairs = "";
  const char* winding_time_constant = "";
  const char* stator_time_constant = "";
  const char* winding_limit = "";
  const char* mass = "";
  const char* diameter = "";
};

constexpr Sheet kSmallSheet{.heading = "maxon EC 45 flat, 70 W, 24 V winding",
                            .identity = "manufacturer = \"maxon\"\nname = \"EC 45 flat, 70 W, 24 V\"\npart_number = \"397172\"\n",
                            .assigned_power = "70 W",
                            .no_load_speed = "6110 rpm",
                            .nominal_speed = "4860 rpm",
                            .nominal_torque = "128 mN m",
                            .stall_torque = "1460 mN m",
                            .stall_current = "39.5 A",
                            .max_efficiency = "85 %",
                            .inductance = "0.463 mH",
                            .speed_constant = "259 rpm/V",
                            .speed_torque_gradient = "4.26 rpm/mNm",
                            .mechanical_time_constant = "8.07 ms",
                            .inertia = "181 g cm2",
                            .pole_pairs = "8",
                            .winding_time_constant = "29.6 s",
                            .stator_time_constant = "178 s",
                            .winding_limit = "125 degC",
                            .mass = "141 g",
                            .diameter = "42.8 mm"};

// Computed from resistance, torque constant and no-load current of the family.
constexpr Sheet kLargeSheet{.heading = "Outer-rotor motor of 900 W, 48 V; an invented product for tests",
                            .identity = "manufacturer = \"none\"\nname = \"Outer rotor, 900 W, 48 V\"\npart_number = \"suite-900\"\n",
                            .assigned_power = "900 W",
                            .no_load_speed = "5380 rpm",
                            .nominal_speed = "5010 rpm",
                            .nominal_torque = "1781 mN m",
                            .stall_torque = "25900 mN m",
                            .stall_current = "306 A",
                            .max_efficiency = "91.7 %",
                            .inductance = "0.12 mH",
                            .speed_constant = "112.3 rpm/V",
                            .speed_torque_gradient = "0.2075 rpm/mNm",
                            .mechanical_time_constant = "14.1 ms",
                            .inertia = "6500 g cm2",
                            .pole_pairs = "10",
                            .winding_time_constant = "38 s",
                            .stator_time_constant = "235 s",
                            .winding_limit = "155 degC",
                            .mass = "1300 g",
                            .diameter = "90 mm"};

std::string tolerated(const char* key, const std::string& value, int percent) {
  return fmt::format("{} = {{ value = \"{}\", origin = \"datasheet\", source = \"sheet\", tolerance = \"{} %\" }}\n", key, value, percent);
}

std::string fixed_value(const char* key, const std::string& value) {
  return fmt::format("{} = {{ value = \"{}\", origin = \"datasheet\", source = \"sheet\" }}\n", key, value);
}

}  // namespace

std::string start_file(const Family& family) {
  const Sheet& sheet = family.name == "small" ? kSmallSheet : kLargeSheet;
  std::string text = fmt::format("# {}\n{}type = \"brushless\"\nrotor = \"external\"\n\n", sheet.heading, sheet.identity);
  text += "[sources]\nsheet = \"data sheet of the motor; the tolerances are engineering defaults\"\n\n";
  text +=
      "[conventions]\nterminal_resistance = \"between_terminals\"\ntorque_constant = \"per_dc_ampere\"\nstall_includes_saturation = "
      "false\n\n";
  text += "[figures]\n" + fixed_value("nominal_voltage", fmt::format("{} V", family.bus_V)) +
          fixed_value("assigned_power", sheet.assigned_power);
  text += tolerated("no_load_speed", sheet.no_load_speed, 10);
  text += fmt::format(
      "no_load_current = {{ value = \"{:.3f} A\", origin = \"datasheet\", source = \"sheet\", range = [\"{:.3f} A\", \"{:.3f} A\"] }}\n",
      family.no_load_current_A, 0.7 * family.no_load_current_A, 1.5 * family.no_load_current_A);
  text += tolerated("nominal_speed", sheet.nominal_speed, 10) + tolerated("nominal_torque", sheet.nominal_torque, 10);
  text += tolerated("nominal_current", fmt::format("{} A", family.nominal_current_A), 10);
  text += tolerated("stall_torque", sheet.stall_torque, 15) + tolerated("stall_current", sheet.stall_current, 10);
  text += tolerated("max_efficiency", sheet.max_efficiency, 5);
  text += tolerated("terminal_resistance", fmt::format("{} ohm", family.resistance_25C_ohm), 10);
  text += tolerated("terminal_inductance", sheet.inductance, 20);
  text += tolerated("torque_constant", fmt::format("{:.1f} mN m/A", 1000.0 * family.torque_constant_Nm_per_A), 7);
  text += tolerated("speed_constant", sheet.speed_constant, 7) + tolerated("speed_torque_gradient", sheet.speed_torque_gradient, 15);
  text += tolerated("mechanical_time_constant", sheet.mechanical_time_constant, 20) + tolerated("rotor_inertia", sheet.inertia, 10);
  text += fixed_value("pole_pairs", sheet.pole_pairs) + fixed_value("max_speed", "10000 rpm");
  text += tolerated("thermal_resistance_winding_stator", fmt::format("{} K/W", family.contact_K_per_W), 25);
  text += tolerated("thermal_resistance_stator_ambient", fmt::format("{} K/W", family.air_K_per_W), 25);
  text += tolerated("thermal_time_constant_winding", sheet.winding_time_constant, 25);
  text += tolerated("thermal_time_constant_stator", sheet.stator_time_constant, 25);
  text +=
      fixed_value("winding_limit", sheet.winding_limit) + fixed_value("ambient_min", "-40 degC") + fixed_value("ambient_max", "100 degC");
  return text + tolerated("mass", sheet.mass, 5) + tolerated("diameter", sheet.diameter, 1);
}

}  // namespace heatsoak::suite
