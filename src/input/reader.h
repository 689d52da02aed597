// Checked access to a table of a file: collects every problem and reports every unknown key.
#pragma once

#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"
#include "base/parameter.h"
#include "base/parameter_value.h"
#include "input/document.h"

namespace heatsoak::input {

enum class Need { required, optional };

/// Reads the keys of one table. A getter that finds a problem adds it to the diagnostics and returns nothing; the caller continues, so that
/// one run finds all problems. finish() reports keys that were never requested.
class Reader {
 public:
  /// `table` and `diagnostics` must outlive the reader. `path` is the dotted name of the table, "" at the top.
  Reader(const Value& table, std::string path, base::Diagnostics& diagnostics);

  std::optional<std::string> text(std::string_view key, Need need);
  std::optional<bool> flag(std::string_view key, Need need);
  std::vector<std::string> texts(std::string_view key, Need need);
  /// Returns one of `choices`; any other value is a problem whose message lists them.
  std::optional<std::string> choice(std::string_view key, std::span<const std::string_view> choices, Need need);
  /// Returns a quantity written as text with a unit, converted to the unit of `spec` and checked against its range.
  std::optional<double> quantity(const base::ParameterSpec& spec, Need need);
  /// Returns a list of such quantities. An invalid element is reported as key[index] and returned as 0, so that the length is kept.
  std::vector<double> quantities(const base::ParameterSpec& spec, Need need);
  /// Reads `{ value = "…", origin = "…", source = "…", tolerance = "…" }`; see motor_db/README.md.
  std::optional<base::ParameterValue> parameter(const base::ParameterSpec& spec, Need need);
  std::optional<Reader> table(std::string_view key, Need need);
  std::vector<Reader> tables(std::string_view key);  ///< the elements of [[key]]; empty if there are none
  /// Returns every member of this table as a table, with its key.
  std::vector<std::pair<std::string, Reader>> named_tables();

  /// Marks a key as known without reading it, for use when another problem prevents its interpretation.
  void pass_over(std::string_view key) { asked_.insert(std::string(key)); }
  void finish();

  /// Adds a problem at the value of `key`, or at the table itself if it has no such key.
  void problem(std::string_view key, std::string message);
  /// Adds a problem found in another file that this table refers to.
  void add(const base::Diagnostic& found);
  [[nodiscard]] base::Location at(std::string_view key) const;
  [[nodiscard]] std::vector<std::string> keys() const;

 private:
  const Value* get(std::string_view key, Value::Kind kind, Need need);
  const Value* find(const base::ParameterSpec& spec, Need need);
  [[nodiscard]] std::string full(std::string_view key) const;
  std::optional<double> parse(const Value& value, std::string_view key, const base::ParameterSpec& spec);
  void read_spread(const base::ParameterSpec& spec, base::ParameterValue& parameter);
  void read_confirmations(const base::ParameterSpec& spec, base::ParameterValue& parameter);

  const Value* table_;
  std::string path_;
  base::Diagnostics* diagnostics_;
  std::set<std::string, std::less<>> asked_;
};

}  // namespace heatsoak::input
