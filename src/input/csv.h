// Columns of numbers out of a CSV file, row by row, with places for messages. libcsv reads the quoting.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"

namespace heatsoak {

/// A header with more is no log.
inline constexpr std::size_t kMostColumns = 1000;
/// What some editors put before UTF-8 text.
inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// One row: the wanted columns in the wanted order. `line` counts from 1 as an editor does.
struct CsvRow {
  int line = 0;
  std::span<const double> values;
  std::span<const int> cells;  ///< which cell of the row each value is, from 1; 0 where the file has none
};

/// A column whose cells are words: the value of a row is the word's place in the list.
struct CsvWords {
  std::string column;
  std::vector<std::string> words;
};

/// Which columns are wanted of a file.
struct CsvColumns {
  std::vector<std::string> required;  ///< must be in the header
  std::vector<std::string> optional;  ///< give NaN where the header has none
  std::vector<std::string> blank{};   ///< of these a cell that is empty or "nan" gives NaN and is no problem
};
/// Called once, with the header as it stands in the file.
using ChooseCsvColumns = std::function<CsvColumns(std::span<const std::string> header)>;

/// Reads a file with one header row and gives every row to `row`. Lines before the header that begin with "#" are comments. `required`
/// names must be in the header; `optional` ones give NaN where the header has none. Memory does not grow with the file. A UTF-8 byte order
/// mark and CR LF are fine. Throws Failure (bad_input): missing columns (with "did you mean"), a cell that is no finite number, a row with
/// another number of cells, no rows. At most 20 problems are listed, then how many more there are. Rows that are sound are
/// given even where others are not, but none where the header is wrong.
void read_csv(const std::filesystem::path& path, std::span<const std::string> required, std::span<const std::string> optional,
              const std::function<void(const CsvRow&)>& row);
void read_csv(const std::filesystem::path& path, std::span<const std::string> required, std::span<const std::string> optional,
              std::span<const CsvWords> words, const std::function<void(const CsvRow&)>& row);
/// The same for files that come in several forms. With `cut_off` a last row that no line break ends is left out, because its
/// last number may be cut inside, and `cut_off` hears its line; without it such a row is one like any other.
void read_csv(const std::filesystem::path& path, const ChooseCsvColumns& choose, std::span<const CsvWords> words,
              const std::function<void(const CsvRow&)>& row, const std::function<void(int line)>& cut_off = {});

/// Problems of one file whose columns count cells, with the character (from 1) at which each cell begins in their place, as
/// an editor counts. Reads the file once more.
std::vector<Diagnostic> with_characters(std::vector<Diagnostic> of_cells);

}  // namespace heatsoak
