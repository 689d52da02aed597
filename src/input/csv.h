// Reads chosen columns of a CSV file row by row and reports the place of each error. libcsv handles the quoting. Serves duties of type
// `recorded`, games as CSV and committed derating tables. Logs of measurements are read by input/number_table.h.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"

namespace heatsoak::input {

/// A file with more columns is rejected, because it is not a log.
inline constexpr std::size_t kMostColumns = 1000;
/// UTF-8 byte order mark, which some editors write at the beginning of a file.
inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// One row: the values of the wanted columns, required ones first. `line` counts from 1.
struct CsvRow {
  int line = 0;
  std::span<const double> values;
  std::span<const int> cells;  ///< index of each value's cell in the row, from 1; 0 if the file lacks the column
};

/// A column of words. The value of a row is the index of its word in the list.
struct CsvWords {
  std::string column;
  std::vector<std::string> words;
};

/// The columns to read from a file.
struct CsvColumns {
  std::vector<std::string> required;  ///< must be in the header
  std::vector<std::string> optional;  ///< NaN if the header lacks them
  std::vector<std::string> blank{};   ///< in these columns an empty cell or "nan" gives NaN and is no error
};
/// Chooses the columns. Called once with the header of the file.
using ChooseCsvColumns = std::function<CsvColumns(std::span<const std::string> header)>;

/// Reads a file with one header row and passes every row to `row`. Lines before the header that begin with "#" are comments. `required`
/// columns must be in the header; `optional` ones give NaN if they are not. A UTF-8 byte order mark and CR LF are accepted. Memory does not
/// grow with the file.
/// Throws Failure (bad_input) for missing columns (with "did you mean") and for a file without rows. The same for a cell that is not a
/// finite number and a row with a different number of cells. It lists at most 20 problems and counts the others. Valid rows are passed even if other rows are
/// invalid, but none if the header is.
void read_csv(const std::filesystem::path& path, std::span<const std::string> required, std::span<const std::string> optional,
              const std::function<void(const CsvRow&)>& row);
void read_csv(const std::filesystem::path& path, std::span<const std::string> required, std::span<const std::string> optional,
              std::span<const CsvWords> words, const std::function<void(const CsvRow&)>& row);
/// The same for files with several possible layouts. A last row without a line break may be incomplete. If `cut_off` is given, such a row
/// is skipped, and `cut_off` is called with its line number. Otherwise it is read as usual.
void read_csv(const std::filesystem::path& path, const ChooseCsvColumns& choose, std::span<const CsvWords> words,
              const std::function<void(const CsvRow&)>& row, const std::function<void(int line)>& cut_off = {});

/// Converts diagnostics of one file whose `column` counts cells: afterwards it counts characters from 1, as an editor does. Reads the file
/// again.
std::vector<base::Diagnostic> with_characters(std::vector<base::Diagnostic> of_cells);

}  // namespace heatsoak::input
