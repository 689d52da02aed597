// Computes a channel's values from the columns of a file: columns, expressions, validity conditions.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "input/number_table.h"
#include "recording/expression.h"
#include "recording/mapping.h"
#include "recording/recording_report.h"

namespace heatsoak::recording {

/// Columns of a file that are used. slot() registers a column and returns its index within the blocks.
class UsedColumns {
 public:
  std::size_t slot(std::size_t column);
  [[nodiscard]] const std::vector<std::size_t>& all() const { return columns_; }

 private:
  std::vector<std::size_t> columns_;
};

/// Expression evaluated on the blocks of a table.
class BlockExpression {
 public:
  BlockExpression(Expression expression, UsedColumns& used);
  /// One value per row of the block; valid until the next call.
  const std::vector<double>& evaluate(const input::TableBlock& block);

 private:
  Expression expression_;
  std::vector<std::size_t> slots_;
  std::vector<double> values_;
};

/// Cells of a block that are not numbers, indexed by position.
class BadCells {
 public:
  void read(const input::TableBlock& block);
  /// Returns the text of the cell, empty for a blank cell; nullptr if the cell is a number.
  [[nodiscard]] const std::string* find(std::size_t slot, std::size_t row) const;

 private:
  std::vector<std::vector<const input::BadCell*>> by_slot_;  ///< per column, in ascending order of rows
};

/// Converts the cells of one channel to canonical values.
class ChannelSource {
 public:
  /// Adds unknown columns and invalid expressions to `problems`.
  ChannelSource(const QuantityMapping& mapping, std::span<const std::string> header, const std::string& log, UsedColumns& used,
                base::Diagnostics& problems);

  [[nodiscard]] const Quantity& quantity() const { return mapping_.quantity; }
  [[nodiscard]] double clock_offset_s() const { return mapping_.clock_offset_s; }
  /// True for an optional quantity without a column in the file.
  [[nodiscard]] bool is_absent() const { return is_absent_; }
  [[nodiscard]] std::size_t filled() const { return filled_; }

  /// Appends the rows of the block with nonzero `keep`, in the quantity's unit. Invalid samples become NaN and are reported.
  void append(const input::TableBlock& block, const BadCells& bad, const std::vector<char>& keep, RecordingReport& report,
              std::vector<double>& values);

 private:
  struct Fill {
    double value;
    BlockExpression where;
  };
  void leave_out(LeftOutReason reason, int line, const std::string* example, RecordingReport& report);

  QuantityMapping mapping_;
  std::optional<std::size_t> slot_;
  std::optional<BlockExpression> expression_;
  std::optional<BlockExpression> valid_;
  std::vector<Fill> fills_;
  std::vector<std::pair<LeftOutReason, LeftOut*>> entries_;  ///< entries of the report, cached
  std::size_t filled_ = 0;
  bool is_absent_ = false;
};

}  // namespace heatsoak::recording
