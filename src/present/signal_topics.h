// Descriptions of the signals of base/signal_table.h.
#pragma once

#include <optional>
#include <string_view>

#include "base/signals.h"
#include "present/document.h"
#include "present/topics.h"

namespace heatsoak::present {

/// Describes one signal: unit, log column, averaging rule, default and worst-case value, and the effects that need it.
Document signal_description(const base::SignalRow& row);

/// Lists all signals in one table.
Document signals_description();

/// Returns the signal of this log column, or of an earlier name of it; nullptr if there is none.
const base::SignalRow* signal_of_column(std::string_view column);

}  // namespace heatsoak::present
