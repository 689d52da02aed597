// Where a channel's values come from in a file with a certain header: columns, expressions, conditions.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "identify/measurement/expression.h"
#include "identify/measurement/mapping.h"
#include "identify/measurement/recording_report.h"
#include "input/number_table.h"

namespace heatsoak {

/// The columns of a file that anything reads, and which of a block's columns each of them is.
class UsedColumns {
 public:
  std::size_t slot(std::size_t column);
  [[nodiscard]] const std::vector<std::size_t>& all() const { return columns_; }

 private:
  std::vector<std::size_t> columns_;
};

/// An expression with its place in the blocks.
class BlockExpression {
 public:
  BlockExpression(Expression expression, UsedColumns& used);
  /// One value per row of the block; valid until the next call.
  const std::vector<double>& evaluate(const TableBlock& block);

 private:
  Expression expression_;
  std::vector<std::size_t> slots_;
  std::vector<double> values_;
};

/// The cells of a block that are no numbers, looked up by place.
class BadCells {
 public:
  void read(const TableBlock& block);
  /// Null where the cell is a number; an empty text is a blank cell.
  [[nodiscard]] const std::string* find(std::size_t slot, std::size_t row) const;

 private:
  std::vector<std::vector<const BadCell*>> by_slot_;  ///< per column in the order of rows
};

/// One channel on its way from cells to canonical values.
class ChannelSource {
 public:
  /// Problems of names and expressions are added to `problems`.
  ChannelSource(const QuantityMapping& mapping, std::span<const std::string> header, const std::string& log, UsedColumns& used,
                Diagnostics& problems);

  [[nodiscard]] const Quantity& quantity() const { return mapping_.quantity; }
  [[nodiscard]] double clock_offset_s() const { return mapping_.clock_offset_s; }
  /// An optional quantity of which the file has no column.
  [[nodiscard]] bool is_absent() const { return is_absent_; }
  [[nodiscard]] std::size_t filled() const { return filled_; }

  /// Appends the rows of the block where `keep` says so; what is no measurement becomes NaN and is reported.
  void append(const TableBlock& block, const BadCells& bad, const std::vector<char>& keep, RecordingReport& report,
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
  std::vector<std::pair<LeftOutReason, LeftOut*>> entries_;  ///< of the report, looked up once
  std::size_t filled_ = 0;
  bool is_absent_ = false;
};

}  // namespace heatsoak
