#include "select/candidates.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>

#include "motor/conditions.h"

namespace heatsoak::select {

namespace {

/// Applies each condition to the motors that depend on it; at least one must.
void apply_conditions(const std::map<std::string, std::string>& conditions, std::vector<motor::Motor>& motors) {
  for (const auto& [key, value] : conditions) {
    if (!motors.empty() && std::ranges::none_of(motors, [&](const motor::Motor& motor) { return motor::depends_on(motor, key); })) {
      motor::under(motors.front(), {{key, value}});  // throws
    }
  }
  for (motor::Motor& motor : motors) {
    motor = motor::under_its_own(std::move(motor), conditions);
  }
}

}  // namespace

std::vector<motor::Motor> named_candidates(const CandidateNames& names, duty::NamedFiles& files) {
  std::vector<std::string> single;
  for (const std::string& name : names.motors) {
    const std::vector<std::string> all = name == "all" ? input::ids_in(files.folders().motors) : std::vector<std::string>{name};
    single.insert(single.end(), all.begin(), all.end());
  }
  std::vector<motor::Motor> motors;
  const std::optional<motor::Motor> model = names.model.empty() ? std::nullopt : files.motor(names.model);
  if (model) {
    motors.push_back(motor::under(*model, names.conditions));
  }
  std::set<std::filesystem::path> taken;
  for (const std::string& name : single) {
    const std::optional<std::filesystem::path> file = files.motor_file(name);
    const bool is_replaced = file && model && model->fit && model->fit->motor == file->stem();
    if (!file || is_replaced || !taken.insert(*file).second) {
      continue;
    }
    const auto same =
        std::ranges::find_if(taken, [&](const std::filesystem::path& other) { return other != *file && other.stem() == file->stem(); });
    if (same != taken.end()) {
      throw base::bad_input({file->string()}, "",
                            fmt::format("this file and {} are two motors with the same id, '{}'; rename one of the files", same->string(),
                                        file->stem().string()));
    }
    if (const std::optional<motor::Motor> motor = files.motor(name)) {
      motors.push_back(*motor);
    }
  }
  if (names.model.empty()) {
    apply_conditions(names.conditions, motors);
  }
  return motors;
}

std::vector<motor::Motor> motors_of_database(const input::DataFolders& folders, const std::map<std::string, std::string>& conditions) {
  std::vector<motor::Motor> motors;
  for (const std::string& id : input::ids_in(folders.motors)) {
    duty::NamedFiles files(folders);
    if (const std::optional<motor::Motor> motor = files.motor(id)) {
      motors.push_back(motor::under_its_own(*motor, conditions));
    }
  }
  return motors;
}

}  // namespace heatsoak::select
