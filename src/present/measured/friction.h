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
  const friction::SteadyParts& steady;
  const friction::FrictionFit& fit;
  const friction::HeldOutError& error;
  bool uses_return_legs = false;
  std::optional<friction::ExpectedFrom> expected_from;  ///< set if `error` also contains the error of a robot file without measurement
  std::size_t logs = 0;
};
Document friction_document(const robot::Robot& robot, const FrictionAnswer& answer);

/// Inputs that the JSON repeats beside the result.
struct FrictionRemarks {
  std::optional<std::string> motor_id;  ///< nothing if no file of the robot's motor was found
  std::vector<std::string> findings;
  std::vector<std::string> suspicions;
};
Json friction_json(const robot::Robot& robot, const FrictionAnswer& answer, const FrictionRemarks& remarks);

/// Returns one sentence for each wheel whose measurements contradict the assumed friction law.
std::vector<std::string> lack_of_fit_words(const friction::FrictionFit& fit);

/// Returns the document of a roll-out test with this number of logs. `drive` must have a drag torque of 0.
Document roll_out_document(const robot::Robot& robot, const friction::RollOutResult& result, const robot::DriveConstants& drive,
                           std::size_t logs);
Json roll_out_json(const robot::Robot& robot, const friction::RollOutResult& result, const robot::DriveConstants& drive,
                   const FrictionRemarks& remarks);

/// Returns the voltage per wheel speed that mechanical damping and back-EMF need together; nothing without a damping.
std::optional<friction::Estimate> damping_with_back_emf(const robot::DriveConstants& drive,
                                                        const std::optional<friction::Estimate>& mechanical_Nm_s_per_rad);

/// Returns the remarks of a test. `motor` is the id of the robot's motor, which has no file if `has_motor` is false. `of_fit` follow last.
FrictionRemarks friction_remarks(const std::string& motor, bool has_motor, const friction::FrictionRun& run,
                                 const std::vector<std::string>& of_fit);

/// Adds the findings as notes and the suspicions as warnings.
void add_findings(Document& document, std::span<const std::string> findings, std::span<const std::string> suspicions);

}  // namespace heatsoak::present
