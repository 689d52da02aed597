#include "input/number_table.h"

#include <csv.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "base/diagnostic.h"
#include "base/files.h"
#include "base/unknown.h"
#include "input/csv.h"

namespace heatsoak::input {
namespace {

constexpr std::size_t kBlockRows = 4096;
constexpr std::size_t kChunk_bytes = 1 << 20;
constexpr std::size_t kLongestLine_bytes = 1 << 20;
constexpr std::size_t kLongestExample_bytes = 40;

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first == std::string_view::npos ? std::string_view() : text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

}  // namespace

/// Reads a file line by line through a buffer.
class LineReader {
 public:
  // O_NONBLOCK: without it, opening a pipe that has no writer would block the program.
  explicit LineReader(const std::filesystem::path& path)
      : path_(path.string()), descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
    struct stat about {};
    if (descriptor_ < 0 || ::fstat(descriptor_, &about) != 0) {
      fail(std::strerror(errno));
    }
    if (!S_ISREG(about.st_mode)) {
      fail(S_ISDIR(about.st_mode) ? "it is a folder" : "it is a device or a pipe; expected a file");
    }
    base::note_input(path);
  }
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;
  ~LineReader() {
    if (descriptor_ >= 0) {
      ::close(descriptor_);
    }
  }

  /// Gives the next line without its line end; it is valid until the next call. Returns false at the end of the file.
  bool next(std::string_view& line) {
    for (;;) {
      const char* const from = buffer_.data() + begin_;
      const void* const found = begin_ + searched_ < end_ ? std::memchr(from + searched_, '\n', end_ - begin_ - searched_) : nullptr;
      if (found != nullptr) {
        const auto size = static_cast<std::size_t>(static_cast<const char*>(found) - from);
        take(line, size, size + 1);
        return true;
      }
      searched_ = end_ - begin_;
      if (is_at_end_) {
        if (searched_ == 0) {
          return false;
        }
        has_open_end_ = true;
        take(line, searched_, searched_);
        return true;
      }
      if (searched_ > kLongestLine_bytes) {
        throw base::bad_input({path_, line_ + 1, 1}, "", "a line of more than 1 MB; is it a binary file, or is a quote not closed?");
      }
      fill();
    }
  }
  /// Appends a line end and the next line to `record`, for quoted cells with line breaks. Returns false at the end of the file or if the
  /// record exceeds the longest line allowed.
  bool extend(std::string& record) {
    std::string_view more;
    if (record.size() > kLongestLine_bytes || !next(more)) {
      return false;
    }
    record += '\n';
    record += more;
    return true;
  }

  [[nodiscard]] int line() const { return line_; }
  [[nodiscard]] std::size_t bytes() const { return bytes_; }
  [[nodiscard]] bool has_open_end() const { return has_open_end_; }
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  [[noreturn]] void fail(const char* reason) {
    if (descriptor_ >= 0) {
      ::close(std::exchange(descriptor_, -1));
    }
    throw base::bad_input({path_}, "", fmt::format("cannot be read: {}", reason));
  }

  void take(std::string_view& line, std::size_t size, std::size_t with_end) {
    line = std::string_view(buffer_.data() + begin_, size);
    if (line.ends_with('\r')) {
      line.remove_suffix(1);
    }
    begin_ += with_end;
    searched_ = 0;
    ++line_;
  }

  void fill() {
    std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(begin_), buffer_.begin() + static_cast<std::ptrdiff_t>(end_), buffer_.begin());
    end_ -= std::exchange(begin_, 0);
    buffer_.resize(std::max(buffer_.size(), end_ + kChunk_bytes));  // zero-fills only when the buffer grows
    const ssize_t got = ::read(descriptor_, buffer_.data() + end_, kChunk_bytes);
    if (got < 0) {
      fail(std::strerror(errno));
    }
    const auto size = static_cast<std::size_t>(got);
    if (size > 0 && std::memchr(buffer_.data() + end_, '\0', size) != nullptr) {
      fail("it is a binary file; expected CSV text");
    }
    if (bytes_ == 0 && std::string_view(buffer_.data(), size).starts_with(kByteOrderMark)) {
      begin_ = kByteOrderMark.size();
    }
    bytes_ += size;
    end_ += size;
    is_at_end_ = size == 0;
  }

  std::string path_;
  int descriptor_ = -1;
  std::vector<char> buffer_;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::size_t searched_ = 0;  ///< bytes from begin_ that were searched without finding a line end
  std::size_t bytes_ = 0;
  int line_ = 0;
  bool is_at_end_ = false;
  bool has_open_end_ = false;
};

namespace {

/// Splits one record into cells with libcsv. Returns nothing if the quoting is invalid.
std::optional<std::vector<std::string>> quoted_cells(std::string_view record, char separator) {
  csv_parser parser{};
  csv_init(&parser, CSV_STRICT | CSV_STRICT_FINI | CSV_APPEND_NULL);
  const std::unique_ptr<csv_parser, void (*)(csv_parser*)> freed(&parser, &csv_free);
  csv_set_delim(&parser, static_cast<unsigned char>(separator));
  std::vector<std::string> cells;
  const auto cell = [](void* text, std::size_t size, void* to) {
    static_cast<std::vector<std::string>*>(to)->emplace_back(static_cast<const char*>(text), size);
  };
  const bool is_whole = csv_parse(&parser, record.data(), record.size(), cell, nullptr, &cells) == record.size();
  return is_whole && csv_fini(&parser, cell, nullptr, &cells) == 0 ? std::optional(cells) : std::nullopt;
}

}  // namespace

struct NumberTable::State {
  State(const std::filesystem::path& path, TableFormat layout) : lines(path), format(std::move(layout)) {}

  /// Gives the next line that is neither blank nor a comment. Returns false at the end of the file.
  bool next_content(std::string_view& line) {
    while (lines.next(line)) {
      if (!(format.comment.empty() ? false : line.starts_with(format.comment)) && !trimmed(line).empty()) {
        return true;
      }
    }
    return false;
  }

  std::vector<std::string> cells_of(std::string_view line) {
    std::string record(line);
    const int first_line = lines.line();
    while (std::ranges::count(record, '"') % 2 != 0 && lines.extend(record)) {
    }
    std::optional<std::vector<std::string>> cells = quoted_cells(record, format.separator);
    if (!cells) {
      throw base::bad_input({lines.path(), first_line, 1}, "", "a quote in this row is not closed, or stands inside a cell");
    }
    return std::move(*cells);
  }

  void read_header() {
    std::string_view line;
    for (int row = 1; row <= format.header_rows; ++row) {
      if (!next_content(line)) {
        throw base::bad_input({lines.path()}, "", row == 1 ? "is empty; expected a table with a header" : "ends inside its header");
      }
      if (line.find('\r') != std::string_view::npos && line.find('"') == std::string_view::npos) {
        throw base::bad_input({lines.path(), lines.line(), 1}, "",
                              "its lines end with a carriage return alone; expected a line feed, or both");
      }
      std::vector<std::string> cells = cells_of(line);
      if (row == format.names_row) {
        header_line = lines.line();
        header = std::move(cells);
      }
    }
    if (format.header_rows == 0) {
      throw base::bad_input({lines.path()}, "", "has no header row; expected names of columns");
    }
    for (std::string& name : header) {
      name = trimmed(name);
    }
    if (header.size() > kMostColumns) {
      throw base::bad_input({lines.path(), header_line, 1}, "", fmt::format("has more than {} columns, which no log has", kMostColumns));
    }
    slots.assign(header.size(), -1);
  }

  /// Parses one cell and appends it to column `slot` of the block; NaN and an entry in bad_cells if it is not a finite number.
  void number(std::string_view cell, int slot, TableBlock& block) const {
    cell = trimmed(cell);
    const std::string_view digits = cell.starts_with('+') && !cell.starts_with("+-") ? cell.substr(1) : cell;
    char copy[64];
    const char* begin = digits.data();
    const char* end = begin + digits.size();
    if (format.decimal_point != '.' && digits.size() < sizeof copy) {
      std::ranges::replace_copy(digits, copy, format.decimal_point, '.');
      begin = copy;
      end = copy + digits.size();
    }
    double value = base::kUnknown;
    const auto [stopped, error] = std::from_chars(begin, end, value);
    if (error != std::errc() || stopped != end || !std::isfinite(value)) {
      value = base::kUnknown;
      block.bad_cells.push_back({block.rows(), static_cast<std::size_t>(slot), std::string(cell.substr(0, kLongestExample_bytes))});
    }
    block.columns[static_cast<std::size_t>(slot)].push_back(value);
  }

  /// Reads a row without quotes and returns its number of cells. Values are appended to the block even if that number is wrong.
  std::size_t split(std::string_view line, TableBlock& block) {
    const char* at = line.data();
    const char* const end = at + line.size();
    std::size_t column = 0;
    for (; column < last_used; ++column) {
      const int slot = slots[column];
      if (slot >= 0 && format.decimal_point == '.') {
        double value = 0.0;
        const auto [stopped, error] = std::from_chars(at, end, value);
        if (error == std::errc() && (stopped == end || *stopped == format.separator) && std::isfinite(value)) {
          block.columns[static_cast<std::size_t>(slot)].push_back(value);
          if (stopped == end) {
            return column + 1;
          }
          at = stopped + 1;
          continue;
        }
      }
      const char* stop = static_cast<const char*>(std::memchr(at, format.separator, static_cast<std::size_t>(end - at)));
      if (slot >= 0) {
        number({at, static_cast<std::size_t>((stop != nullptr ? stop : end) - at)}, slot, block);
      }
      if (stop == nullptr) {
        return column + 1;
      }
      at = stop + 1;
    }
    return column + 1 + static_cast<std::size_t>(std::count(at, end, format.separator));
  }

  void read_row(std::string_view line, TableBlock& block) {
    const std::size_t bad_before = block.bad_cells.size();
    const int first_line = lines.line();
    std::size_t cells = 0;
    if (std::memchr(line.data(), '"', line.size()) == nullptr) {
      cells = split(line, block);
    } else {
      const std::vector<std::string> quoted = cells_of(line);
      cells = quoted.size();
      for (std::size_t column = 0; column < std::min(cells, slots.size()); ++column) {
        if (slots[column] >= 0) {
          number(quoted[column], slots[column], block);
        }
      }
    }
    if (cells == header.size()) {
      block.lines.push_back(first_line);
      return;
    }
    for (std::vector<double>& column : block.columns) {
      column.resize(block.rows());
    }
    block.bad_cells.resize(bad_before);
    block.bad_lines.push_back({first_line, cells, lines.has_open_end()});
  }

  LineReader lines;
  TableFormat format;
  std::vector<std::string> header;
  int header_line = 0;
  std::vector<int> slots;     ///< for each column of the file its index among the chosen ones, or -1
  std::size_t last_used = 0;  ///< columns from this index on are only counted
  std::size_t chosen = 0;
};

NumberTable::NumberTable(const std::filesystem::path& path, const TableFormat& format) : state_(std::make_unique<State>(path, format)) {
  state_->read_header();
}
NumberTable::~NumberTable() = default;
NumberTable::NumberTable(NumberTable&&) noexcept = default;
NumberTable& NumberTable::operator=(NumberTable&&) noexcept = default;

std::span<const std::string> NumberTable::header() const { return state_->header; }
int NumberTable::header_line() const { return state_->header_line; }
std::size_t NumberTable::bytes_read() const { return state_->lines.bytes(); }
bool NumberTable::ends_without_line_end() const { return state_->lines.has_open_end(); }

void NumberTable::choose(std::vector<std::size_t> columns) {
  state_->chosen = columns.size();
  for (std::size_t slot = 0; slot < columns.size(); ++slot) {
    state_->slots.at(columns[slot]) = static_cast<int>(slot);
    state_->last_used = std::max(state_->last_used, columns[slot] + 1);
  }
}

bool NumberTable::next(TableBlock& block) {
  block.columns.resize(state_->chosen);
  for (std::vector<double>& column : block.columns) {
    column.clear();
    column.reserve(kBlockRows);
  }
  block.lines.clear();
  block.bad_cells.clear();
  block.bad_lines.clear();
  std::string_view line;
  while (block.rows() + block.bad_lines.size() < kBlockRows && state_->next_content(line)) {
    state_->read_row(line, block);
  }
  return block.rows() + block.bad_lines.size() > 0;
}

}  // namespace heatsoak::input
