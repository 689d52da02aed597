// Uses a functional mock-up unit like a simulator: dlopen loads its binary, and its description gives the variables by name. The types of
// the standard are defined here independently, so a unit with other types fails.
#pragma once

#include <dlfcn.h>
#include <expat.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "unpacked.h"

namespace heatsoak::derate {

using Attributes = std::map<std::string, std::string>;

/// Returns the attributes of every element that has this attribute.
inline std::vector<Attributes> elements_with(const std::string& xml, const std::string& attribute) {
  struct Found {
    std::string attribute;
    std::vector<Attributes> all;
  } found{attribute, {}};
  XML_Parser parser = XML_ParserCreate(nullptr);
  XML_SetUserData(parser, &found);
  XML_SetStartElementHandler(parser, [](void* data, const XML_Char* name, const XML_Char** pairs) {
    Attributes of{{"", name}};
    for (; *pairs != nullptr; pairs += 2) {
      of[pairs[0]] = pairs[1];
    }
    auto& into = *static_cast<Found*>(data);
    if (of.contains(into.attribute)) {
      into.all.push_back(of);
    }
  });
  EXPECT_EQ(XML_Parse(parser, xml.data(), static_cast<int>(xml.size()), XML_TRUE), XML_STATUS_OK);
  XML_ParserFree(parser);
  return found.all;
}

/// Error messages of the unit's logger.
inline std::vector<std::string>& fmu_log() {
  static std::vector<std::string> lines;
  return lines;
}

/// One instance of a unit of either version. Status 0 means success.
class FmuUnit {
 public:
  /// Event mode and early return as the importer announces them to FMI 3.0.
  struct Importer {
    bool has_event_mode = false;
    bool takes_early_return = false;
  };

  FmuUnit(const std::string& bytes, int version, const std::string& token = {})
      : FmuUnit(bytes, version, token, {.has_event_mode = false, .takes_early_return = false}) {}
  FmuUnit(const std::string& bytes, int version, const std::string& token, Importer importer)
      : version_(version), importer_(importer), files_(unpacked(bytes)) {
    const std::string& description = files_.at("modelDescription.xml");
    for (const Attributes& each : elements_with(description, "valueReference")) {
      if (each.contains("name")) {
        variables_[each.at("name")] = each;
      }
    }
    static int number = 0;
    file_ = std::filesystem::path(testing::TempDir()) / fmt::format("heatsoak_fmu_{}_{}.so", static_cast<int>(getpid()), number++);
    for (const auto& [path, content] : files_) {
      if (path.starts_with("binaries/")) {
        std::ofstream(file_, std::ios::binary) << content;
      }
    }
    library_ = dlopen(file_.c_str(), RTLD_NOW | RTLD_LOCAL);
    EXPECT_NE(library_, nullptr) << dlerror();
    const std::string own =
        elements_with(description, version == 2 ? "guid" : "instantiationToken").at(0).at(version == 2 ? "guid" : "instantiationToken");
    make(token.empty() ? own : token);
  }
  FmuUnit(const FmuUnit&) = delete;
  FmuUnit& operator=(const FmuUnit&) = delete;
  ~FmuUnit() {
    call<void>("FreeInstance", instance_);
    dlclose(library_);
    std::filesystem::remove(file_);
  }

  [[nodiscard]] bool is_made() const { return instance_ != nullptr; }
  [[nodiscard]] bool has(const std::string& name) const { return variables_.contains(name); }
  [[nodiscard]] const Attributes& variable(const std::string& name) const { return variables_.at(name); }
  [[nodiscard]] const std::map<std::string, std::string>& files() const { return files_; }

  int set(const std::string& name, double value) {
    return set_reference(static_cast<std::uint32_t>(std::stoul(variables_.at(name).at("valueReference"))), value);
  }
  int set_reference(std::uint32_t reference, double value) {
    return version_ == 2 ? call<int>("SetReal", instance_, &reference, std::size_t{1}, &value)
                         : call<int>("SetFloat64", instance_, &reference, std::size_t{1}, &value, std::size_t{1});
  }
  double get(const std::string& name) {
    const auto reference = static_cast<std::uint32_t>(std::stoul(variables_.at(name).at("valueReference")));
    double value = NAN;
    EXPECT_EQ((version_ == 2 ? call<int>("GetReal", instance_, &reference, std::size_t{1}, &value)
                             : call<int>("GetFloat64", instance_, &reference, std::size_t{1}, &value, std::size_t{1})),
              0)
        << name;
    return value;
  }
  bool get_boolean(const std::string& name) {
    const auto reference = static_cast<std::uint32_t>(std::stoul(variables_.at(name).at("valueReference")));
    int two = -1;
    bool three = false;
    EXPECT_EQ((version_ == 2 ? call<int>("GetBoolean", instance_, &reference, std::size_t{1}, &two)
                             : call<int>("GetBoolean", instance_, &reference, std::size_t{1}, &three, std::size_t{1})),
              0);
    return version_ == 2 ? two == 1 : three;
  }
  int get_item(const std::string& name) {
    const auto reference = static_cast<std::uint32_t>(std::stoul(variables_.at(name).at("valueReference")));
    int two = -1;
    std::int64_t three = -1;
    EXPECT_EQ((version_ == 2 ? call<int>("GetInteger", instance_, &reference, std::size_t{1}, &two)
                             : call<int>("GetInt64", instance_, &reference, std::size_t{1}, &three, std::size_t{1})),
              0);
    return version_ == 2 ? two : static_cast<int>(three);
  }
  int enter(double start_s = 0.0) {
    if (version_ == 3) {
      return call<int>("EnterInitializationMode", instance_, false, 0.0, start_s, false, 0.0);
    }
    const int status = call<int>("SetupExperiment", instance_, 0, 0.0, start_s, 0, 0.0);
    return status != 0 ? status : call<int>("EnterInitializationMode", instance_);
  }
  int run() { return call<int>("ExitInitializationMode", instance_); }
  int reset() { return call<int>("Reset", instance_); }
  int step(double now_s, double step_s) {
    if (version_ == 2) {
      return call<int>("DoStep", instance_, now_s, step_s, 1);
    }
    bool event = true;
    bool terminate = true;
    bool early = true;
    double last_s = NAN;
    const int status = call<int>("DoStep", instance_, now_s, step_s, false, &event, &terminate, &early, &last_s);
    EXPECT_FALSE(event || terminate || early);
    return status;
  }

  /// Result of one step of FMI 3.0, with its events.
  struct Step {
    int status = -1;
    bool is_event = false;
    bool is_early = false;
    double last_s = NAN;
  };
  Step step_to_event(double now_s, double step_s) {
    Step step;
    bool terminate = true;
    step.status = call<int>("DoStep", instance_, now_s, step_s, false, &step.is_event, &terminate, &step.is_early, &step.last_s);
    EXPECT_FALSE(terminate);
    return step;
  }
  int enter_event_mode() { return call<int>("EnterEventMode", instance_); }
  int enter_step_mode() { return call<int>("EnterStepMode", instance_); }
  /// Returns the status; next_event_s is NaN if the unit names none.
  int update_discrete_states(double* next_event_s) {
    bool again = true;
    bool terminate = true;
    bool nominals = true;
    bool values = true;
    bool has_next = false;
    double next_s = NAN;
    const int status = call<int>("UpdateDiscreteStates", instance_, &again, &terminate, &nominals, &values, &has_next, &next_s);
    EXPECT_FALSE(again || terminate || nominals || values);
    *next_event_s = has_next ? next_s : NAN;
    return status;
  }
  void* keep() {
    void* state = nullptr;
    EXPECT_EQ(call<int>(version_ == 2 ? "GetFMUstate" : "GetFMUState", instance_, &state), 0);
    return state;
  }
  int bring_back(void* state) { return call<int>(version_ == 2 ? "SetFMUstate" : "SetFMUState", instance_, state); }
  void forget(void* state) { EXPECT_EQ(call<int>(version_ == 2 ? "FreeFMUstate" : "FreeFMUState", instance_, &state), 0); }
  std::vector<char> bytes_of(void* state) {
    std::size_t size = 0;
    EXPECT_EQ(call<int>(version_ == 2 ? "SerializedFMUstateSize" : "SerializedFMUStateSize", instance_, state, &size), 0);
    std::vector<char> bytes(size);
    EXPECT_EQ(call<int>(version_ == 2 ? "SerializeFMUstate" : "SerializeFMUState", instance_, state, bytes.data(), size), 0);
    return bytes;
  }
  int from_bytes(const std::vector<char>& bytes, void** state) {
    return call<int>(version_ == 2 ? "DeSerializeFMUstate" : "DeserializeFMUState", instance_, bytes.data(), bytes.size(), state);
  }

 private:
  struct Callbacks {
    void (*logger)(void*, const char*, int, const char*, const char*, ...) = &FmuUnit::log_format;
    void* (*allocate)(std::size_t, std::size_t) = &std::calloc;
    void (*free)(void*) = &std::free;
    void (*finished)(void*, int) = nullptr;
    void* environment = nullptr;
  };
  static void log_format(void* /*environment*/, const char* /*name*/, int /*status*/, const char* /*category*/, const char* format, ...) {
    fmu_log().emplace_back(format);
  }
  static void log(void* /*environment*/, int /*status*/, const char* /*category*/, const char* message) { fmu_log().emplace_back(message); }

  template <class Result, class... Arguments>
  Result call(const std::string& name, Arguments... arguments) {
    void* const symbol = dlsym(library_, fmt::format("fmi{}{}", version_, name).c_str());
    EXPECT_NE(symbol, nullptr) << name;
    return reinterpret_cast<Result (*)(Arguments...)>(symbol)(arguments...);
  }

  void make(const std::string& token) {
    if (version_ == 2) {
      instance_ = call<void*>("Instantiate", "unit", 1, token.c_str(), "", static_cast<const Callbacks*>(&callbacks_), 0, 1);
    } else {
      instance_ = call<void*>("InstantiateCoSimulation", "unit", token.c_str(), "", false, true, importer_.has_event_mode,
                              importer_.takes_early_return, static_cast<const std::uint32_t*>(nullptr), std::size_t{0},
                              static_cast<void*>(nullptr), &FmuUnit::log, static_cast<void*>(nullptr));
    }
  }

  int version_;
  Importer importer_;
  std::map<std::string, std::string> files_;
  std::map<std::string, Attributes> variables_;
  std::filesystem::path file_;
  void* library_ = nullptr;
  Callbacks callbacks_;
  void* instance_ = nullptr;
};

}  // namespace heatsoak::derate
