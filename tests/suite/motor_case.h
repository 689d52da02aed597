#pragma once
// Motors of the suite: what each lacks, its logs and its truth.
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "effects.h"
#include "run_log.h"
#include "two_body_fit.h"

namespace heatsoak::suite {

struct PlannedEffect {
  const EffectKind* kind = nullptr;
  double strength = 1.0;
};

struct CasePlan {
  std::string id;     ///< group and number, the name of the folder
  std::string group;  ///< null, single, pair, outside or eight
  const Family* family = nullptr;
  bool has_eight_bodies = false;
  std::vector<PlannedEffect> effects{};
  UnknownHeat unknown_heat = UnknownHeat::kOrnsteinUhlenbeck;
};

/// All motors of a seed, in the order of their groups.
std::vector<CasePlan> planned_cases(std::uint64_t seed);

/// Logs of a motor, and what the suite knows of it.
struct MotorCase {
  CasePlan plan;
  Motor motor{};
  double load_factor = 1.0;
  double unknown_winding_W = 0.0;
  double unknown_stator_W = 0.0;
  SensorNoise noise{};
  std::vector<Log> train{};
  std::vector<Log> holdout{};
  TwoBodyFit fit{};                   ///< to the training logs
  TwoBodyFit fit_without{};           ///< to the same runs of the motor without its effects
  std::vector<double> error_ratio{};  ///< per effect: error of the fit with this effect alone, over that without, larger of two sensors
};

/// An effect is visible if it raises the error of the refitted two-body model by this factor.
constexpr double kVisibleRatio = 2.0;

MotorCase make_case(const CasePlan& plan, std::uint64_t seed);

nlohmann::ordered_json truth_of(const MotorCase& made, std::uint64_t seed);

/// Writes logs, start.toml and truth.json to a folder of the case's name.
void write_case(const MotorCase& made, std::uint64_t seed, const std::filesystem::path& out);

}  // namespace heatsoak::suite
