// Arithmetic expression of columns, as used in mappings: "'motor temp [C]' - 0.3", "where(duty > 0, I, 0)".
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"

namespace heatsoak::recording {

/// Supports + − * / ^, comparisons, && ||, c ? a : b, and the functions listed in expression.cpp. Column names that are not single words
/// must be in single quotes.
class Expression {
 public:
  /// Parses the text. `at` is its position in the mapping. On an error, adds to `problems` and sets ok() to false.
  Expression(std::string_view text, std::span<const std::string> header, base::Location at, const std::string& key,
             base::Diagnostics& problems);
  ~Expression();
  Expression(Expression&&) noexcept;
  Expression& operator=(Expression&&) noexcept;

  [[nodiscard]] bool ok() const { return is_ok_; }
  /// Indices of the used columns in the header, without repetition.
  [[nodiscard]] const std::vector<std::size_t>& columns() const { return columns_; }
  /// Evaluates all rows. `columns` are the values of columns(), in that order. The result is NaN if a used cell is NaN or the value is not
  /// finite.
  void evaluate(std::span<const std::vector<double>* const> columns, std::vector<double>& values);

 private:
  struct Compiled;
  std::unique_ptr<Compiled> compiled_;
  std::vector<std::size_t> columns_;
  bool is_ok_ = false;
};

}  // namespace heatsoak::recording
