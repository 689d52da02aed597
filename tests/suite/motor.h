#pragma once
// Motors of the suite: two families, as two bodies or as eight.
#include <string>
#include <vector>

#include "network.h"
#include "random.h"

namespace heatsoak::suite {

constexpr double kCopper_per_K = 0.0039;  ///< temperature coefficient of copper at 25 °C

/// Nominal values of a family, as its start file states them.
struct Family {
  std::string name;
  double scale = 1.0;  ///< heat, capacities and conductances in units of the small motor, roughly
  double resistance_25C_ohm = 0.0;
  double torque_constant_Nm_per_A = 0.0;
  double no_load_current_A = 0.0;
  double nominal_current_A = 0.0;
  double bus_V = 0.0;
  double top_speed_rad_per_s = 0.0;  ///< highest speed of the drives
  double inertia_kg_m2 = 0.0;        ///< rotor and its share of the robot
  double contact_K_per_W = 0.0;
  double air_K_per_W = 0.0;
  double winding_J_per_K = 0.0;
  double stator_J_per_K = 0.0;
  double hottest_C = 0.0;  ///< drives are reduced until the winding stays below

  double copper_W() const { return resistance_25C_ohm * nominal_current_A * nominal_current_A; }
};

const Family& small_family();
const Family& large_family();

/// Text of the start file. It is the same for all motors of a family.
std::string start_file(const Family& family);

/// Part of a node: a body and its share of the node's heat.
struct Part {
  std::size_t body = 0;
  double share = 1.0;
};
using Parts = std::vector<Part>;

double mean_C(const Parts& parts, std::span<const double> temperature_C);
void source(const Parts& parts, double power_W, HeatBook& book);
void flow(const Parts& from, const Parts& to, double power_W, HeatBook& book);
void to_air(const Parts& from, double power_W, HeatBook& book);

struct SensorErrors {
  double offset_winding_K = 0.0;
  double offset_stator_K = 0.0;
  double lag_winding_s = 0.0;
  double lag_stator_s = 0.0;
  double gain_winding = 1.0;  ///< about 25 °C
};

struct Motor {
  Family nominal;
  double resistance_25C_ohm = 0.0;
  double torque_constant_Nm_per_A = 0.0;
  double no_load_current_A = 0.0;
  Network network;
  Parts winding;
  Parts stator;
  std::size_t winding_sensor = 0;
  std::size_t stator_sensor = 1;
  SensorErrors sensors;

  double winding_C(std::span<const double> temperature_C) const { return mean_C(winding, temperature_C); }
  double stator_C(std::span<const double> temperature_C) const { return mean_C(stator, temperature_C); }
};

/// Draws a motor of two bodies. Capacities, resistances and time constants are within 25 % of the nominal values, the no-load current
/// within the range of the start file.
Motor two_body_motor(const Family& family, Random random);

/// Draws a motor of eight bodies whose sums are of the size of the nominal values.
Motor eight_body_motor(const Family& family, Random random);

/// Adds the copper loss of each winding part at its own temperature, and the no-load loss. The two builders above call it.
void add_losses(Motor& motor);

}  // namespace heatsoak::suite
