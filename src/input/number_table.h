// Fast reader for large CSV logs of any dialect: reads chosen columns of numbers in blocks of some thousand rows.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace heatsoak::input {

/// CSV dialect of a file.
struct TableFormat {
  char separator = ',';
  char decimal_point = '.';
  std::string comment = "#";  ///< lines that begin with it are skipped; empty: the file has no comments
  int header_rows = 1;
  int names_row = 1;  ///< number of the header row with the column names, from 1
};

/// A cell that is not a finite number.
struct BadCell {
  std::size_t row = 0;     ///< index in the block
  std::size_t column = 0;  ///< index among the chosen columns
  std::string text;        ///< first characters of the cell; empty if it is blank
};

/// A line that is not a valid row, and not among the rows of the block: its number of cells differs from the header's, or the file ends inside it.
struct BadLine {
  int line = 0;
  std::size_t cells = 0;
  bool is_cut_off = false;
};

struct TableBlock {
  std::vector<std::vector<double>> columns;  ///< one vector per chosen column; NaN for a bad cell
  std::vector<int> lines;                    ///< line number of each row, from 1
  std::vector<BadCell> bad_cells;
  std::vector<BadLine> bad_lines;
  [[nodiscard]] std::size_t rows() const { return lines.size(); }
};

/// Accepts quoted cells, CR LF, blank lines, comments and a UTF-8 byte order mark. Memory does not grow with the file. Throws Failure
/// (bad_input) for an unreadable or binary file, a missing header, a line longer than 1 MB and an unclosed quote.
class NumberTable {
 public:
  NumberTable(const std::filesystem::path& path, const TableFormat& format);
  ~NumberTable();
  NumberTable(NumberTable&&) noexcept;
  NumberTable& operator=(NumberTable&&) noexcept;

  [[nodiscard]] std::span<const std::string> header() const;
  [[nodiscard]] int header_line() const;  ///< line of the column names
  /// Sets the columns to read, as indices into header(). Call it before the first next().
  void choose(std::vector<std::size_t> columns);
  /// Reads the next rows into `block`, whose memory is reused. Returns false at the end of the file.
  bool next(TableBlock& block);
  [[nodiscard]] std::size_t bytes_read() const;
  /// Returns whether the last line has no line end, so that its last cell may be incomplete.
  [[nodiscard]] bool ends_without_line_end() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace heatsoak::input
