// Documents and JSON of `friction`.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "friction/friction_job.h"
#include "present/document.h"
#include "present/json.h"
#include "robot/robot.h"

namespace heatsoak::present {

struct FrictionAnswer {
  const SteadyParts& steady;
  const FrictionFit& fit;
  const HeldOutError& error;
  bool uses_return_legs = false;
  bool has_expectation = false;      ///< true if `error` also contains the error of a robot file without measurement
  const std::string& expected_from;  ///< source of that expectation
  std::size_t logs = 0;
};
Document friction_document(const Robot& robot, const FrictionAnswer& answer);

/// Inputs that the JSON repeats beside the result.
struct FrictionRemarks {
  std::optional<std::string> motor_id;  ///< nothing if no file of the robot's motor was found
  std::vector<std::string> findings;
  std::vector<std::string> suspicions;
};
Json friction_json(const Robot& robot, const FrictionAnswer& answer, const FrictionRemarks& remarks);

/// Returns one sentence for each wheel whose measurements contradict the assumed friction law.
std::vector<std::string> lack_of_fit_words(const FrictionFit& fit);

/// `drive` must have a drag torque of 0.
Document roll_out_document(const Robot& robot, const RollOutResult& result, const DriveConstants& drive, std::size_t logs);
Json roll_out_json(const Robot& robot, const RollOutResult& result, const DriveConstants& drive, const FrictionRemarks& remarks);

/// Returns the voltage per wheel speed that mechanical damping and back-EMF need together.
Estimate damping_with_back_emf(const DriveConstants& drive, const Estimate& mechanical_Nm_s_per_rad);

/// Returns the remarks of a test. `motor` is the id of the robot's motor, which has no file if `has_motor` is false. `of_fit` follow last.
FrictionRemarks friction_remarks(const std::string& motor, bool has_motor, const FrictionRun& run, const std::vector<std::string>& of_fit);

/// Returns why 0 is written to the robot file.
std::string words_of(const WrittenAsZero& finding);

/// Adds the findings as notes and the suspicions as warnings.
void add_findings(Document& document, std::span<const std::string> findings, std::span<const std::string> suspicions);

}  // namespace heatsoak::present
