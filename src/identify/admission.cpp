#include "identify/admission.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/diagnostic.h"
#include "base/quantity.h"
#include "identify/measurement/quality.h"
#include "identify/measurement/fingerprint.h"

namespace heatsoak {
namespace {

/// Beyond this multiple of what the nominal voltage can do a figure has another unit.
constexpr double kMost_ratio = 3.0;

/// A run that counts twice makes intervals narrower than they are; one held out that was fitted tests nothing.
void refuse_repeated(std::span<const Recording> fitted, std::span<const Recording> held_out) {
  std::vector<std::pair<std::string, const Recording*>> seen;
  std::vector<Diagnostic> repeated;
  for (const auto& recordings : {fitted, held_out}) {
    for (const Recording& recording : recordings) {
      std::string fingerprint = fingerprint_of(recording);
      const auto found = std::ranges::find_if(seen, [&](const auto& other) { return share_rows(other.first, fingerprint); });
      if (found != seen.end()) {
        repeated.push_back({{recording.file.string()}, {}, fmt::format("holds the same rows as {}", found->second->file.string())});
      }
      seen.emplace_back(std::move(fingerprint), &recording);
    }
  }
  if (!repeated.empty()) {
    throw Failure(ExitCode::bad_input, "rows of a log are given twice", std::move(repeated));
  }
}

double largest(const DataQuality& quality, std::string_view key) {
  const auto found = std::ranges::find_if(quality.channels, [key](const ChannelQuality& each) { return each.quantity.key == key; });
  return found == quality.channels.end() ? 0.0 : std::max(std::abs(found->low), std::abs(found->high));
}

/// What this motor cannot do at three times its voltage.
void beyond_the_motor(const Motor& motor, const DataQuality& quality, std::vector<std::string>& wrong) {
  const MotorValues& nominal = motor.nominal;
  const double most_A = kMost_ratio * nominal.nominal_voltage_V / nominal.terminal_resistance_ohm;
  if (const double reached_A = largest(quality, "current_A"); reached_A > most_A) {
    wrong.push_back(
        fmt::format("current_A reaches {} A; through {} ohm at three times the nominal voltage flow {} A: is it in "
                    "milliamperes, or is it another motor?",
                    significant(reached_A, 3), significant(nominal.terminal_resistance_ohm, 3), significant(most_A, 3)));
  }
  const double most_rad_per_s = kMost_ratio * nominal.nominal_voltage_V / nominal.torque_constant_Nm_per_A;
  if (const double reached_rad_per_s = largest(quality, "speed_rad_per_s"); reached_rad_per_s > most_rad_per_s) {
    wrong.push_back(fmt::format(
        "speed_rad_per_s reaches {} rad/s; at three times the nominal voltage this motor turns at {} rad/s: is it in rpm "
        "({} rad/s), or is it another motor?",
        significant(reached_rad_per_s, 3), significant(most_rad_per_s, 3), significant(convert(reached_rad_per_s, "rpm", "rad/s"), 3)));
  }
}

}  // namespace

std::vector<std::string> admit(const Motor& motor, std::span<const Recording> fitted, std::span<const Recording> held_out,
                               bool takes_logs_as_they_are, double ambient_C) {
  refuse_repeated(fitted, held_out);
  std::vector<std::string> notes;
  std::vector<Diagnostic> wrong;
  const auto look = [&](const Recording& recording, const DataQuality& quality) {
    if (!recording.motor.empty() && recording.motor != motor.id && !(motor.fit && recording.motor == motor.fit->motor)) {
      notes.push_back(fmt::format("{} says that it is of the motor {}, not of {}", recording.name, recording.motor, motor.id));
    }
    for (const std::string& each : quality.suspicions) {
      notes.push_back(fmt::format("{}: {}", recording.name, each));
    }
    std::vector<std::string> spoiling = quality.spoiling;
    if (spoiling.empty()) {
      beyond_the_motor(motor, quality, spoiling);
    }
    for (const std::string& each : spoiling) {
      wrong.push_back({{recording.file.string()}, {}, each});
    }
  };
  for (const Recording& recording : fitted) {
    const DataQuality quality = assess(recording, {}, ambient_C);
    require_thermal(recording, quality);
    look(recording, quality);
  }
  for (const Recording& recording : held_out) {
    look(recording, assess(recording, {}, ambient_C));
  }
  if (!wrong.empty() && !takes_logs_as_they_are) {
    throw Failure(ExitCode::bad_input,
                  "units or sensors of the logs look wrong; correct them in a mapping (--map), or if they are right go on with --as-is",
                  std::move(wrong));
  }
  return notes;
}

void refuse_runs_of_the_file(const Motor& motor, std::span<const Recording> fitted, std::span<const Recording> held_out) {
  std::vector<Diagnostic> known;
  for (const auto& recordings : {fitted, held_out}) {
    for (const Recording& recording : recordings) {
      if (motor.fit && was_fitted_to(*motor.fit, recording)) {
        known.push_back({{recording.file.string()}, {}, fmt::format("{} was fitted to these rows (fit.runs)", motor.id)});
      }
    }
  }
  if (!known.empty()) {
    throw Failure(ExitCode::bad_input,
                  "a run would count twice; start from the file as it was before that fit, or if it is another run go on with --as-is",
                  std::move(known));
  }
}

}  // namespace heatsoak
bool was_fitted_to(const MotorFit& fit, const Recording& recording) {
  return std::ranges::any_of(fit.runs, [&recording](const std::string& run) { return is_of_run(recording, run); });
}

