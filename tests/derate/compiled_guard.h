// Compiles a generated header to a shared library, so that a test can call it a million times.
#pragma once

#include <dlfcn.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "derate/export_text.h"
#include "derate/exporter.h"

namespace heatsoak::derate {

/// Guard of a motor; signals other than current, speed and air are 0.
class CompiledGuard {
 public:
  struct Input {
    float current_A = 0.0F;
    float speed_rad_per_s = 0.0F;
    float ambient_C = 40.0F;
  };
  struct Output {
    float allowed_A = 0.0F;
    float guarded_C = 0.0F;
    float nominal_C = 0.0F;
    float model_only_A = 0.0F;
    int reason = -1;
    int sensor = -1;
  };
  enum Status { used, silent, jumped, too_cold, frozen };
  enum Restored { restored, time_unknown, nothing_restored };

  explicit CompiledGuard(const Derating& derating, std::string_view name = "guard") {
    const std::filesystem::path folder =
        std::filesystem::path(testing::TempDir()) / fmt::format("heatsoak_compiled_{}_{}", name, static_cast<int>(getpid()));
    std::filesystem::create_directories(folder);
    for (const ExporterType& each : all_exporters()) {
      if (each.name == "c_header") {
        std::ofstream(folder / "guard.h") << each.write(derating);
      }
    }
    std::ofstream(folder / "guard.c") << wrapper(identifier(derating.motor_id), derating.sensor.has_value(),
                                                 derating.sensor && derating.sensor->resistance);
    const std::string command = fmt::format(
        "cc -std=c99 -O2 -shared -fPIC -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wdouble-promotion -Werror -ffp-contract=off -o "
        "'{0}' "
        "'{1}' -lm 2> '{2}'",
        (folder / "guard.so").string(), (folder / "guard.c").string(), (folder / "errors").string());
    if (std::system(command.c_str()) != 0) {
      std::stringstream errors;
      errors << std::ifstream(folder / "errors").rdbuf();
      ADD_FAILURE() << errors.str();
      return;
    }
    library_ = dlopen((folder / "guard.so").c_str(), RTLD_NOW | RTLD_LOCAL);
    std::filesystem::remove_all(folder);
    if (library_ == nullptr) {
      ADD_FAILURE() << dlerror();
    }
  }
  CompiledGuard(const CompiledGuard&) = delete;
  CompiledGuard& operator=(const CompiledGuard&) = delete;
  ~CompiledGuard() {
    if (library_ != nullptr) {
      dlclose(library_);
    }
  }
  [[nodiscard]] explicit operator bool() const { return library_ != nullptr; }

  /// Looks up a symbol of the wrapper.
  template <class Function>
  [[nodiscard]] Function* function(const char* name) const {
    return reinterpret_cast<Function*>(dlsym(library_, name));
  }

 private:
  static std::string wrapper(const std::string& prefix, bool has_sensor, bool has_resistance) {
    std::string text = R"(#include <string.h>
#include "guard.h"
typedef struct { float current_A, speed_rad_per_s, ambient_C; } plain_input;
typedef struct { float allowed_A, guarded_C, nominal_C, model_only_A; int reason, sensor; } plain_output;
float model_allowed_A(float speed_rad_per_s, float stator_C, float winding_C) { return @_allowed_A(speed_rad_per_s, stator_C, winding_C); }
int model_size(void) { return (int)sizeof(@_state); }
void model_start(void *state, float body_C) { @_start(state, body_C); }
void model_temperatures(const void *state, float *to) { memcpy(to, ((const @_state *)state)->state_C, sizeof ((const @_state *)state)->state_C); }
void model_step(void *state, const plain_input *in, plain_output *out) {
  @_input input;
  @_output made;
  memset(&input, 0, sizeof input);
  input.current_A = in->current_A;
  input.speed_rad_per_s = in->speed_rad_per_s;
  input.ambient_C = in->ambient_C;
  made = @_step(state, &input);
  out->allowed_A = out->model_only_A = made.allowed_current_A;
  out->guarded_C = made.guarded_winding_C;
  out->nominal_C = made.nominal_winding_C;
  out->reason = (int)made.reason;
  out->sensor = -1;
}
void model_save(const void *state, unsigned char *buffer) { @_save(state, buffer); }
int model_restore(void *state, const unsigned char *buffer, float elapsed_s, float unsaved_s, float board_C) {
  return (int)@_restore(state, buffer, elapsed_s, unsaved_s, board_C);
}
)";
    if (has_sensor) {
      text += R"(int sensed_size(void) { return (int)sizeof(@_sensed_state); }
void sensed_start(void *state, float body_C) { @_sensed_start(state, body_C); }
void sensed_save(const void *state, unsigned char *buffer) { @_sensed_save(state, buffer); }
int sensed_restore(void *state, const unsigned char *buffer, float elapsed_s, float unsaved_s, float board_C) {
  return (int)@_sensed_restore(state, buffer, elapsed_s, unsaved_s, board_C);
}
void sensed_step(void *state, const plain_input *in, float reading_C, plain_output *out) {
  @_input input;
  @_sensed_output made;
  memset(&input, 0, sizeof input);
  input.current_A = in->current_A;
  input.speed_rad_per_s = in->speed_rad_per_s;
  input.ambient_C = in->ambient_C;
  made = @_step_with_sensor(state, &input, reading_C);
  out->allowed_A = made.guard.allowed_current_A;
  out->guarded_C = made.guard.guarded_winding_C;
  out->nominal_C = made.guard.nominal_winding_C;
  out->model_only_A = made.model_only_A;
  out->reason = (int)made.guard.reason;
  out->sensor = (int)made.sensor;
}
)";
    }
    if (has_resistance) {
      text += R"(int resistance_size(void) { return (int)sizeof(@_resistance); }
void resistance_start(void *sensor, float body_C) { @_resistance_start(sensor, body_C); }
float resistance_reading_C(void *sensor, const void *state, const plain_input *in, float voltage_V) {
  @_input input;
  memset(&input, 0, sizeof input);
  input.current_A = in->current_A;
  input.speed_rad_per_s = in->speed_rad_per_s;
  input.ambient_C = in->ambient_C;
  return @_resistance_reading_C(sensor, state, &input, voltage_V);
}
)";
    }
    for (std::size_t at = text.find('@'); at != std::string::npos; at = text.find('@', at + prefix.size())) {
      text.replace(at, 1, prefix);
    }
    return text;
  }

  void* library_ = nullptr;
};

/// Guard of one motor without a sensor.
class ModelGuard {
 public:
  explicit ModelGuard(const CompiledGuard& guard)
      : guard_(guard), state_(static_cast<std::size_t>(guard.function<int()>("model_size")())) {}

  void start(float body_C) { guard_.function<void(void*, float)>("model_start")(state_.data(), body_C); }
  CompiledGuard::Output step(const CompiledGuard::Input& in) {
    CompiledGuard::Output out;
    step_(state_.data(), &in, &out);
    return out;
  }
  [[nodiscard]] std::vector<float> temperatures_C(std::size_t nodes) const {
    std::vector<float> found(nodes);
    guard_.function<void(const void*, float*)>("model_temperatures")(state_.data(), found.data());
    return found;
  }
  [[nodiscard]] std::vector<unsigned char> saved(std::size_t nodes) const {
    std::vector<unsigned char> buffer(4 * (2 + 2 * nodes));
    guard_.function<void(const void*, unsigned char*)>("model_save")(state_.data(), buffer.data());
    return buffer;
  }
  int restore(const std::vector<unsigned char>& buffer, float elapsed_s, float unsaved_s, float board_C) {
    return guard_.function<int(void*, const unsigned char*, float, float, float)>("model_restore")(state_.data(), buffer.data(), elapsed_s,
                                                                                                   unsaved_s, board_C);
  }

 private:
  const CompiledGuard& guard_;
  std::vector<unsigned char> state_;
  void (*step_)(void*, const void*,
                CompiledGuard::Output*) = guard_.function<void(void*, const void*, CompiledGuard::Output*)>("model_step");
};

/// Guard of one motor with its sensor.
class SensedGuard {
 public:
  explicit SensedGuard(const CompiledGuard& guard)
      : guard_(guard), state_(static_cast<std::size_t>(guard.function<int()>("sensed_size")())) {}

  void start(float body_C) { guard_.function<void(void*, float)>("sensed_start")(state_.data(), body_C); }
  CompiledGuard::Output step(const CompiledGuard::Input& in, float reading_C) {
    CompiledGuard::Output out;
    step_(state_.data(), &in, reading_C, &out);
    return out;
  }
  [[nodiscard]] std::vector<unsigned char>& state() { return state_; }
  [[nodiscard]] std::vector<unsigned char> saved(std::size_t nodes) const {
    std::vector<unsigned char> buffer(4 * (2 + 2 * nodes));
    guard_.function<void(const void*, unsigned char*)>("sensed_save")(state_.data(), buffer.data());
    return buffer;
  }
  int restore(const std::vector<unsigned char>& buffer, float elapsed_s, float unsaved_s, float board_C) {
    return guard_.function<int(void*, const unsigned char*, float, float, float)>("sensed_restore")(state_.data(), buffer.data(), elapsed_s,
                                                                                                    unsaved_s, board_C);
  }

 private:
  const CompiledGuard& guard_;
  std::vector<unsigned char> state_;
  void (*step_)(void*, const void*, float,
                CompiledGuard::Output*) = guard_.function<void(void*, const void*, float, CompiledGuard::Output*)>("sensed_step");
};

}  // namespace heatsoak::derate
