// Text of outcomes for people and for the programs of a CI service.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "base/diagnostic.h"
#include "check/run_checks.h"

namespace heatsoak::check {

/// Returns how many limits hold, do not hold and cannot be evaluated, without a full stop.
std::string conclusion_text(std::span<const Outcome> outcomes);

/// Returns the measured value with its unit; "–" if the threshold was not evaluated.
std::string value_text(const Outcome& outcome);
/// Returns the margin with its sign and unit; "–" if the threshold was not evaluated.
std::string margin_text(const Outcome& outcome);

/// Returns the limit as text: "at most 150 °C".
std::string limit_text(const Outcome& outcome);

/// Returns robot, duty and motor of a check as text, without those that it lacks, or its command.
std::string things_of(const Check& check);

/// Returns the basis of the value, or the reason why the threshold fails or could not be evaluated.
std::string explanation(const Outcome& outcome);

/// Returns JUnit XML as GitHub, GitLab and Jenkins read it: one <testsuite> per check and one <testcase> per threshold. An exceeded limit
/// is a <failure>, a threshold that could not be evaluated an <error>.
std::string junit_xml(std::span<const Outcome> outcomes, std::string_view version);

/// Returns JUnit XML of a run that ended with the failure, such as a check file that cannot be read: the outcomes of the other files, and
/// one <testcase> with an <error>.
std::string junit_xml(std::span<const Outcome> outcomes, const base::Failure& failure, std::string_view version);

/// Returns a Markdown table for $GITHUB_STEP_SUMMARY.
std::string summary_markdown(std::span<const Outcome> outcomes, std::string_view version);

/// Returns workflow commands of GitHub Actions, "::error file=…,line=…,col=…,title=…::…": one line for each threshold that fails. Paths
/// below `workspace`, which may be empty, are written relative to it, as GitHub expects.
std::string annotations(std::span<const Outcome> outcomes, const std::filesystem::path& workspace);
/// Returns one workflow command.
std::string annotation(const base::Location& at, const std::filesystem::path& workspace, std::string_view title, std::string_view message);

}  // namespace heatsoak::check
