// Texts for GitHub Actions: workflow commands, and the summary on the page of a run.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "base/diagnostic.h"
#include "check/run_checks.h"

namespace heatsoak::present {

/// Returns one workflow command, "::error file=…,line=…,col=…,title=…::…". Paths below `workspace`, which may be empty, are written
/// relative to it, as GitHub expects.
std::string annotation(const base::Location& at, const std::filesystem::path& workspace, std::string_view title, std::string_view message);
/// Returns one workflow command for each threshold that fails.
std::string annotations(std::span<const check::Outcome> outcomes, const std::filesystem::path& workspace);

/// Returns a Markdown table for $GITHUB_STEP_SUMMARY.
std::string summary_markdown(std::span<const check::Outcome> outcomes, std::string_view version);

}  // namespace heatsoak::present
