// Options of the verbs that read measured logs.
#pragma once

#include <CLI/App.hpp>

#include "cli/command.h"
#include "recording/named_logs.h"

namespace heatsoak::cli {

/// --map, --ambient and --as-is.
void add_log_options(CLI::App& app, recording::LogChoice& choice);

/// Returns the choice with the folders of the session.
recording::LogChoice choice_of(recording::LogChoice choice, const Session& session);

/// If only the inputs are read, throws the failures of the logs that cannot be read; otherwise the computation reports them with the
/// problems of the other logs.
void require_read(const recording::NamedLogs& logs, const Session& session);

}  // namespace heatsoak::cli
