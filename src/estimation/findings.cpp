#include "estimation/findings.h"

#include <fmt/format.h>

#include <utility>

namespace heatsoak::estimation {

RunNotSimulated::RunNotSimulated(const std::string& run, const base::Failure& cause)
    : base::Failure(cause.code(), fmt::format("{}: {}", run, cause.message()), {cause.diagnostics().begin(), cause.diagnostics().end()}) {}

NoUsableInterval::NoUsableInterval(const std::string& recording, std::filesystem::path file, std::size_t least_rows,
                                   std::vector<LossOfRows> reasons)
    : base::Failure(base::ExitCode::cannot_answer,
                    fmt::format("{}: no interval of {} rows or more has temperatures and all heat inputs", recording, least_rows)),
      file_(std::move(file)),
      reasons_(std::move(reasons)) {}

}  // namespace heatsoak::estimation
