#include "drive_rows.h"

#include <algorithm>
#include <cmath>

namespace heatsoak::attribution::truth {
namespace {

constexpr double kVoltage_V_s_per_rad = 0.034;
constexpr double kResistance_ohm = 0.45;

/// Fills in the columns that follow from speed and current: battery, duty, vehicle, air and the neighbouring motor.
void finish(std::vector<RowInputs>& rows, Dice& dice, bool drives) {
  const double air_C = dice.uniform(19.0, 27.0);
  const double air_rise_K = dice.uniform(-1.0, 4.0);
  const double battery_V = dice.uniform(24.0, 25.2);
  double neighbour_K = 0.0;
  double neighbour_work = dice.uniform(0.0, 1.0);
  double slip_share = 0.8;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    RowInputs& row = rows[k];
    const double share = static_cast<double>(k) / static_cast<double>(rows.size());
    row.next_acceleration_rad_per_s2 = k + 1 < rows.size() ? rows[k + 1].speed_rad_per_s - row.speed_rad_per_s : 0.0;
    row.ambient_C = air_C + air_rise_K * share + 0.4 * std::sin(0.004 * static_cast<double>(k));
    row.bus_V = battery_V - 2.5 * share - 0.08 * std::abs(row.current_A);
    const double motor_V = kVoltage_V_s_per_rad * row.speed_rad_per_s + kResistance_ohm * row.current_A;
    row.duty_ratio = std::clamp(std::abs(motor_V) / row.bus_V, 0.0, 1.0);
    if (k % 17 == 0) {
      slip_share = dice.uniform(0.25, 1.0);
    }
    if (k % 240 == 0) {
      neighbour_work = dice.uniform(0.0, 1.0);
    }
    row.vehicle_speed_m_per_s = drives ? 0.007 * std::abs(row.speed_rad_per_s) * slip_share : 0.0;
    neighbour_K += (45.0 * neighbour_work - neighbour_K) / 400.0;
    row.neighbour_C = row.ambient_C + neighbour_K;
  }
}

}  // namespace

std::vector<RowInputs> robot_rows(int count, std::uint64_t seed) {
  Dice dice(seed ^ 0x51ed2701);
  std::vector<RowInputs> rows;
  double speed = 0.0;
  double effort = dice.uniform(0.5, 1.0);
  while (static_cast<int>(rows.size()) < count) {
    const double kind = dice.uniform(0.0, 1.0);
    if (dice.uniform(0.0, 1.0) < 0.03) {
      effort = dice.uniform(0.25, 1.1);
    }
    const int seconds = kind < 0.12 ? 5 + dice.below(kind < 0.02 ? 120 : 25) : kind < 0.3 ? 2 + dice.below(4) : 3 + dice.below(8);
    const double direction = dice.uniform(0.0, 1.0) < 0.6 ? 1.0 : -1.0;
    const double target = kind < 0.3 ? 0.0 : direction * dice.uniform(60.0, 520.0) * std::min(1.0, effort + 0.2);
    const double push_A = kind >= 0.12 && kind < 0.3 ? effort * dice.uniform(3.0, 9.0) : 0.0;
    const double load_A = effort * dice.uniform(0.4, 4.5);
    for (int i = 0; i < seconds && static_cast<int>(rows.size()) < count; ++i) {
      const double before = speed;
      speed += std::clamp(target - speed, -220.0, 220.0);
      RowInputs row;
      const bool turns = std::abs(speed) > 1.0;
      row.speed_rad_per_s = turns ? speed : 0.0;
      row.current_A = turns ? (speed > 0 ? 1.0 : -1.0) * load_A + 0.02 * (speed - before) : push_A + 0.02 * (speed - before);
      rows.push_back(row);
    }
  }
  finish(rows, dice, true);
  return rows;
}

std::vector<RowInputs> bench_rows(int count, std::uint64_t seed) {
  Dice dice(seed ^ 0x0badcafe);
  std::vector<RowInputs> rows;
  const auto hold = [&](int seconds, double speed, double current_A) {
    for (int i = 0; i < seconds; ++i) {
      RowInputs row;
      row.speed_rad_per_s = speed;
      row.current_A = current_A;
      rows.push_back(row);
    }
  };
  hold(60, 0.0, 0.0);
  for (int step = 1; step <= 5; ++step) {
    hold(60, 100.0 * step, 0.15 + 0.03 * step);
  }
  hold(60, -500.0, -0.3);
  hold(60, -250.0, -0.2);
  for (int pulse = 0; pulse < 6; ++pulse) {
    hold(25, 0.0, 3.0 + pulse);
    hold(25, 0.0, 0.0);
  }
  for (int step = 0; step < 4; ++step) {
    hold(45, 120.0 * (step + 1), 6.0);
    hold(15, 0.0, 0.0);
  }
  hold(120, 0.0, 4.5);
  hold(90, 500.0, 0.3);
  hold(60, 0.0, 0.0);
  while (static_cast<int>(rows.size()) < count) {
    hold(1, 0.0, 0.0);
  }
  rows.resize(static_cast<std::size_t>(count));
  finish(rows, dice, false);
  return rows;
}

}  // namespace heatsoak::attribution::truth
