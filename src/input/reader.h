// Checked access to a table: every problem is collected, every unknown key is named.
#pragma once

#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"
#include "base/figure.h"
#include "base/parameter.h"
#include "input/document.h"

namespace heatsoak {

enum class Need { required, optional };

/// Reads the keys of one table. A getter that finds a problem adds it to the diagnostics and returns nothing;
/// the caller goes on, so that all problems are found in one run. finish() reports keys nobody asked for.
class Reader {
 public:
  /// `table` and `diagnostics` outlive the reader. `path` is the dotted name of the table, "" at the top.
  Reader(const Value& table, std::string path, Diagnostics& diagnostics);

  std::optional<std::string> text(std::string_view key, Need need);
  std::optional<bool> flag(std::string_view key, Need need);
  std::vector<std::string> texts(std::string_view key, Need need);
  /// One of `choices`; the message lists them.
  std::optional<std::string> choice(std::string_view key, std::span<const std::string_view> choices, Need need);
  /// A quantity written as text with a unit, in the unit and range of `spec`.
  std::optional<double> quantity(const ParameterSpec& spec, Need need);
  /// A list of such texts. What is wrong with an element is reported at its place, as key[index];
  /// it counts as 0, so that the length is that of the list.
  std::vector<double> quantities(const ParameterSpec& spec, Need need);
  /// `{ value = "…", origin = "…", source = "…", tolerance = "…" }`; see motor_db/README.md.
  std::optional<Figure> figure(const ParameterSpec& spec, Need need);
  std::optional<Reader> table(std::string_view key, Need need);
  std::vector<Reader> tables(std::string_view key);  ///< [[key]], or none
  /// Every member of this table as a table of its own, for folders of named things.
  std::vector<std::pair<std::string, Reader>> named_tables();

  /// Knows the key without looking at it: where another problem hides what it should hold.
  void pass_over(std::string_view key) { asked_.insert(std::string(key)); }
  void finish();

  /// A problem of the value of `key`, or of the whole table where it has no such key.
  void problem(std::string_view key, std::string message);
  /// A problem of another file that this table names.
  void add(const Diagnostic& found);
  [[nodiscard]] Location at(std::string_view key) const;
  [[nodiscard]] std::vector<std::string> keys() const;

 private:
  const Value* get(std::string_view key, Value::Kind kind, Need need);
  const Value* find(const ParameterSpec& spec, Need need);
  [[nodiscard]] std::string full(std::string_view key) const;
  std::optional<double> parse(const Value& value, std::string_view key, std::string_view unit);
  void read_spread(const ParameterSpec& spec, Figure& figure);
  void read_confirmations(const ParameterSpec& spec, Figure& figure);

  const Value* table_;
  std::string path_;
  Diagnostics* diagnostics_;
  std::set<std::string, std::less<>> asked_;
};

}  // namespace heatsoak
