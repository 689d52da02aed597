// Begin of the reasons of skipped tests.
#pragma once

/// Begins the reason of a skip that fails in CI: measured recordings are missing, or something that packages.txt installs.
/// `.ci/list_skipped` looks for it.
#define HEATSOAK_FAILS_CI "[fails CI] "

/// Begins the reason of a skip for want of a consumer that tests/derate/consumers/run installs under this name.
#define HEATSOAK_LACKS_CONSUMER(name) "[consumer " name "] "
