// Documents and JSON of `friction`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "friction/friction_job.h"
#include "present/document.h"
#include "present/json.h"

namespace heatsoak::present {

/// Returns the document. Without values of the motor in the job, a note states that its id has no file.
Document friction_document(const friction::FrictionJob& job, const friction::FrictionAnswer& answer);

/// Sentences that the JSON repeats beside the result.
struct FrictionRemarks {
  std::vector<std::string> findings;
  std::vector<std::string> suspicions;
};
Json friction_json(const friction::FrictionJob& job, const friction::SteadyFriction& found, const FrictionRemarks& remarks);
Json friction_json(const friction::FrictionJob& job, const friction::RollOutFriction& found, const FrictionRemarks& remarks);

/// Returns how many wheels have an identifiable friction: "3 of 4 wheels".
std::string identifiable_wheels(const friction::FrictionFit& fit);

/// Returns the voltage per wheel speed that mechanical damping and back-EMF need together; nothing without a damping.
std::optional<friction::Estimate> damping_with_back_emf(const robot::DriveConstants& drive,
                                                        const std::optional<friction::Estimate>& mechanical_Nm_s_per_rad);

}  // namespace heatsoak::present
