// Tables of numbers as loggers write them, fast: chosen columns of a CSV of any dialect, some thousand rows at a time.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace heatsoak {

/// How a file is laid out.
struct TableFormat {
  char separator = ',';
  char decimal_point = '.';
  std::string comment = "#";  ///< lines that begin with it are skipped; empty: there are none
  int header_rows = 1;
  int names_row = 1;  ///< which of them names the columns, from 1
};

/// A cell that is no number: where, and its first characters.
struct BadCell {
  std::size_t row = 0;     ///< of the block
  std::size_t column = 0;  ///< of the chosen ones
  std::string text;        ///< empty where the cell is blank
};

/// A line that is no row: another number of cells than the header has, or cut off at the end of the file.
struct BadLine {
  int line = 0;
  std::size_t cells = 0;
  bool is_cut_off = false;
};

struct TableBlock {
  std::vector<std::vector<double>> columns;  ///< as chosen; NaN for a bad cell
  std::vector<int> lines;                    ///< of each row, from 1 as an editor counts
  std::vector<BadCell> bad_cells;
  std::vector<BadLine> bad_lines;
  [[nodiscard]] std::size_t rows() const { return lines.size(); }
};

/// Quoted cells, CR LF, blank lines, comments and a UTF-8 byte order mark are understood. Memory does not grow with the file.
/// Throws Failure (bad_input): unreadable or binary file, no header, a line longer than 1 MB, an open quote.
class NumberTable {
 public:
  NumberTable(const std::filesystem::path& path, const TableFormat& format);
  ~NumberTable();
  NumberTable(NumberTable&&) noexcept;
  NumberTable& operator=(NumberTable&&) noexcept;

  [[nodiscard]] std::span<const std::string> header() const;
  [[nodiscard]] int header_line() const;  ///< of the names
  /// Places in the header; before the first next().
  void choose(std::vector<std::size_t> columns);
  /// The next rows; false at the end of the file. `block` is reused.
  bool next(TableBlock& block);
  [[nodiscard]] std::size_t bytes_read() const;
  /// The last line has no line end, so that its last cell may be cut off.
  [[nodiscard]] bool ends_without_line_end() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace heatsoak
