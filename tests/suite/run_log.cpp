#include "run_log.h"

#include <fmt/format.h>

#include <cmath>

namespace heatsoak::suite {
namespace {

/// First-order lag of a sensor, exact for a constant temperature. A lag of zero follows at once.
void follow(double& shown_C, double at_C, double lag_s) {
  shown_C += (at_C - shown_C) * (lag_s > 0.0 ? 1.0 - std::exp(-kStep_s / lag_s) : 1.0);
}

double in_steps(double value, double step) { return step * std::round(value / step); }

double rms_with_sign(const Instant* first) {
  double sum_A = 0.0;
  double sum_A2 = 0.0;
  for (int i = 0; i < kStepsPerRow; ++i) {
    sum_A += first[i].current_A;
    sum_A2 += first[i].current_A * first[i].current_A;
  }
  return std::copysign(std::sqrt(sum_A2 / kStepsPerRow), sum_A);
}

double mean_of(const Instant* first, double Instant::*member) {
  double sum = 0.0;
  for (int i = 0; i < kStepsPerRow; ++i) {
    sum += first[i].*member;
  }
  return sum / kStepsPerRow;
}

/// One temperature channel of a log.
struct Channel {
  double Row::*value_C;
  bool Row::*has;
  bool Row::*is_good;
};

constexpr double kOutlierShare = 0.003;
constexpr double kDropOutShare = 0.0015;  ///< share of rows at which a drop-out of 1 to 4 s begins
constexpr double kMissingShare = 0.0015;
constexpr double kStuckRunShare = 1.0 / 3.0;

void add_noise(const Channel& channel, double noise_K, double step_K, Random& random, Log& log) {
  for (Row& row : log) {
    double shown_C = row.*channel.value_C + noise_K * random.normal();
    if (random.chance(kOutlierShare)) {
      shown_C += random.sign() * random.uniform(4.0, 18.0);
      row.*channel.is_good = false;
    }
    row.*channel.value_C = in_steps(shown_C, step_K);
  }
}

void stick(const Channel& channel, Random& random, Log& log) {
  const auto count = static_cast<std::size_t>(random.uniform(15.0, 45.0));
  const std::size_t first = random.index(log.size() - count);
  for (std::size_t i = first + 1; i < first + count; ++i) {
    log[i].*channel.value_C = log[first].*channel.value_C;
    log[i].*channel.is_good = false;
  }
}

void drop_out(const Channel& channel, Random& random, Log& log) {
  for (std::size_t i = 0; i < log.size(); ++i) {
    if (random.chance(kDropOutShare)) {
      for (std::size_t count = 1 + random.index(4); count > 0 && i < log.size(); --count, ++i) {
        log[i].*channel.has = false;
        log[i].*channel.is_good = false;
      }
    }
  }
}

}  // namespace

std::vector<Temperatures> simulate(const Motor& motor, const Inputs& inputs, const UnknownHeats& unknown, std::vector<double> start_C) {
  const std::size_t stated = start_C.size();
  double mean = 0.0;
  for (const double each_C : start_C) {
    mean += each_C / static_cast<double>(stated);
  }
  start_C.resize(motor.network.bodies.size(), 0.5 * (mean + inputs.front().ambient_C));
  State state{.temperature_C = std::move(start_C)};
  double unknown_winding_W = 0.0;
  double unknown_stator_W = 0.0;
  Network network = motor.network;
  network.laws.emplace_back([&](const Instant&, std::span<const double>, HeatBook& book) {
    source(motor.winding, unknown_winding_W, book);
    source(motor.stator, unknown_stator_W, book);
  });
  double winding_C = state.temperature_C[motor.winding_sensor];
  double stator_C = state.temperature_C[motor.stator_sensor];
  std::vector<Temperatures> rows;
  rows.reserve(inputs.size() / kStepsPerRow);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (i % kStepsPerRow == 0) {
      rows.push_back({.winding_C = 25.0 + motor.sensors.gain_winding * (winding_C - 25.0) + motor.sensors.offset_winding_K,
                      .stator_C = stator_C + motor.sensors.offset_stator_K});
    }
    unknown_winding_W = unknown.winding_W[i];
    unknown_stator_W = unknown.stator_W[i];
    advance(network, inputs[i], kStep_s, state);
    follow(winding_C, state.temperature_C[motor.winding_sensor], motor.sensors.lag_winding_s);
    follow(stator_C, state.temperature_C[motor.stator_sensor], motor.sensors.lag_stator_s);
  }
  return rows;
}

SensorNoise drawn_noise(Random random) {
  return {.winding_K = random.uniform(0.08, 0.2),
          .stator_K = random.uniform(0.08, 0.2),
          .winding_step_K = 0.0625 * std::exp2(static_cast<double>(random.index(3))),
          .stator_step_K = 0.0625 * std::exp2(static_cast<double>(random.index(3)))};
}

Log rows_of(const Inputs& inputs) {
  Log log(inputs.size() / kStepsPerRow);
  for (std::size_t i = 0; i < log.size(); ++i) {
    const Instant* first = &inputs[i * kStepsPerRow];
    log[i].time_s = static_cast<double>(i);
    log[i].current_A = rms_with_sign(first);
    log[i].speed_rad_per_s = mean_of(first, &Instant::speed_rad_per_s);
    log[i].bus_V = mean_of(first, &Instant::bus_V);
    log[i].modulation_ratio = mean_of(first, &Instant::modulation_ratio);
    log[i].ambient_C = mean_of(first, &Instant::ambient_C);
    log[i].vehicle_speed_m_per_s = mean_of(first, &Instant::vehicle_speed_m_per_s);
    log[i].fan_ratio = mean_of(first, &Instant::fan_ratio);
    log[i].neighbour_C = first->neighbour_C;
  }
  return log;
}

Log measured(const Log& rows, const std::vector<Temperatures>& truth, const SensorNoise& noise, Random random) {
  Log log = rows;
  for (std::size_t i = 0; i < log.size(); ++i) {
    log[i].winding_C = truth[i].winding_C;
    log[i].stator_C = truth[i].stator_C;
    log[i].current_A = in_steps(log[i].current_A + 0.004 * random.normal(), 0.005);
    log[i].speed_rad_per_s = in_steps(log[i].speed_rad_per_s, 0.1);
    log[i].bus_V += 0.02 * random.normal();
    log[i].ambient_C = in_steps(log[i].ambient_C + 0.04 * random.normal(), 0.0625);
    log[i].neighbour_C = in_steps(log[i].neighbour_C + 0.1 * random.normal(), 0.0625);
  }
  const Channel winding{&Row::winding_C, &Row::has_winding, &Row::winding_is_good};
  const Channel stator{&Row::stator_C, &Row::has_stator, &Row::stator_is_good};
  add_noise(winding, noise.winding_K, noise.winding_step_K, random, log);
  add_noise(stator, noise.stator_K, noise.stator_step_K, random, log);
  if (random.chance(kStuckRunShare)) {
    stick(random.chance(0.5) ? winding : stator, random, log);
  }
  drop_out(winding, random, log);
  drop_out(stator, random, log);
  Log kept;
  for (std::size_t i = 0; i < log.size(); ++i) {
    if (i == 0 || !random.chance(kMissingShare)) {
      kept.push_back(log[i]);
    }
  }
  return kept;
}

std::string csv_of(const Log& log) {
  fmt::memory_buffer text;
  const auto out = fmt::appender(text);
  fmt::format_to(
      out,
      "time_s,current_A,speed_rad_per_s,bus_V,modulation_ratio,ambient_C,winding_C,stator_C,vehicle_speed_m_per_s,fan_ratio,neighbour_C\n");
  for (const Row& row : log) {
    // Adding zero turns a negative zero into zero.
    fmt::format_to(out, "{:.1f},{:.3f},{:.1f},{:.2f},{:.3f},{:.4f},", row.time_s, row.current_A + 0.0, row.speed_rad_per_s + 0.0, row.bus_V,
                   row.modulation_ratio, row.ambient_C);
    fmt::format_to(out, "{},{},", row.has_winding ? fmt::format("{:.4f}", row.winding_C) : "",
                   row.has_stator ? fmt::format("{:.4f}", row.stator_C) : "");
    fmt::format_to(out, "{:.2f},{:.2f},{:.4f}\n", row.vehicle_speed_m_per_s, row.fan_ratio, row.neighbour_C);
  }
  return fmt::to_string(text);
}

}  // namespace heatsoak::suite
