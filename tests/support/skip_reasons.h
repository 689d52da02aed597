// Begin of the reasons of skipped tests.
#pragma once

/// Begins the reason of a skip that fails in CI: something is missing that packages.txt installs, or that a variable promises.
/// `.ci/list_skipped` looks for it.
#define HEATSOAK_FAILS_CI "[fails CI] "
