// Tables of parameters with their origin, for descriptions of files.
#pragma once

#include <string>
#include <string_view>

#include "base/parameter_value.h"
#include "present/document.h"

namespace heatsoak::present {

/// Returns a table with the columns parameter, value, origin, range, source and remarks; no rows.
Table parameter_table(std::string title);

/// Adds a row; `meaning` comes before the derivation and the confirmations.
void add_parameter(Table& table, std::string_view key, std::string_view unit, const base::ParameterValue& parameter,
                   std::string_view meaning = {});

/// Adds a row that has only a value.
void add_value(Table& table, std::string_view key, const std::string& value);

/// Returns a table of labels and prose without a head.
Table labelled_table(std::string title);

/// Adds a row of a labelled table, unless `words` is empty.
void add_labelled(Table& table, std::string_view label, std::string_view words);

/// Formats a value with four digits and its unit.
std::string with_unit(double value, std::string_view unit);

}  // namespace heatsoak::present
