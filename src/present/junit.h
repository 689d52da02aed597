// JUnit XML of `check`, as GitHub, GitLab and Jenkins read it.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "base/diagnostic.h"
#include "check/run_checks.h"

namespace heatsoak::present {

/// Returns one <testsuite> per check and one <testcase> per threshold. A broken limit is a <failure>, a threshold that could not be
/// evaluated an <error>.
std::string junit_xml(std::span<const check::Outcome> outcomes, std::string_view version);

/// Returns JUnit XML of a run that ended with the failure, such as a check file that cannot be read: the outcomes of the other files, and
/// one <testcase> with an <error>.
std::string junit_xml(std::span<const check::Outcome> outcomes, const base::Failure& failure, std::string_view version);

}  // namespace heatsoak::present
