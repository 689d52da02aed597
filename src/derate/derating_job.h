// The answer of `derate`: the derating of one motor, the text of its file, and the comparison with an earlier table.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "derate/committed_table.h"
#include "derate/derating.h"
#include "derate/exporter.h"

namespace heatsoak::derate {

struct DeratingJob {
  robot::Robot robot;
  motor::Motor motor;
  DerateOptions options;
  const ExporterType* exporter = nullptr;  ///< format of the file; null: no file
  std::string compiler = {};               ///< C compiler for the exporter's binary; empty: none
  std::filesystem::path committed = {};    ///< earlier table to compare with; empty: none
};

/// An earlier table beside its comparison with the fresh one.
struct TableCheck {
  CommittedTable committed;
  TableComparison found;
};

struct DeratingAnswer {
  Derating derating;
  std::string text;  ///< content of the exporter's file; empty without an exporter
  std::optional<TableCheck> check;

  /// Returns whether the earlier table is safe to use; true without one.
  [[nodiscard]] bool holds() const { return !check || check->found.holds(); }
};

/// Throws Failure (bad_input) for an earlier table that cannot be read or has another sensor, before the computation; and as derate() and
/// provenance_of() do.
DeratingAnswer run_derating(const DeratingJob& job, const base::Progress& progress = {});

}  // namespace heatsoak::derate
