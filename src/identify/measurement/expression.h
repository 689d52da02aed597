// An expression of columns, as a mapping writes it: "'motor temp [C]' - 0.3", "where(duty > 0, I, 0)".
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"

namespace heatsoak {

/// + − * / ^, comparisons, && ||, c ? a : b, and the functions that functions() lists. Columns are named bare, or in
/// single quotes where the name is no word.
class Expression {
 public:
  /// `at` is where the text begins in the mapping; a problem is added to `problems`, and the expression is not ok().
  Expression(std::string_view text, std::span<const std::string> header, Location at, const std::string& key, Diagnostics& problems);
  ~Expression();
  Expression(Expression&&) noexcept;
  Expression& operator=(Expression&&) noexcept;

  [[nodiscard]] bool ok() const { return is_ok_; }
  /// Places in the header, each once.
  [[nodiscard]] const std::vector<std::size_t>& columns() const { return columns_; }
  /// One value per row; `columns` are the values of columns() in their order. NaN where a column is, or where the value is not finite.
  void evaluate(std::span<const std::vector<double>* const> columns, std::vector<double>& values);

 private:
  struct Compiled;
  std::unique_ptr<Compiled> compiled_;
  std::vector<std::size_t> columns_;
  bool is_ok_ = false;
};

}  // namespace heatsoak
