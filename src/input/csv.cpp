#include "input/csv.h"

#include <csv.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "base/diagnostic.h"
#include "base/files.h"
#include "base/quantity.h"
#include "base/unit_names.h"

namespace heatsoak::input {
namespace {

constexpr std::size_t kMostProblems = 20;
constexpr std::size_t kHopeless = 1000;  ///< number of unlisted problems after which reading stops
constexpr std::size_t kLongestCell_bytes = 1 << 16;

/// The beginning of a cell for use in a message: its first line, at most 40 bytes.
std::string_view first_line(std::string_view cell) { return cell.substr(0, std::min<std::size_t>(cell.find_first_of("\r\n"), 40)); }

class Table {
 public:
  Table(std::string file, const ChooseCsvColumns& choose, std::span<const CsvWords> words, const std::function<void(const CsvRow&)>& row,
        const std::function<void(int line)>& cut_off)
      : file_(std::move(file)), choose_(choose), words_(words), row_(row), cut_off_(cut_off) {}

  void cell(std::string_view text) {
    line_breaks_in_row_ += static_cast<int>(std::ranges::count(text, '\n'));
    if (!has_header_) {
      if (column_ >= kMostColumns) {
        stop(fmt::format("has more than {} columns, which no log has", kMostColumns));
      }
      header_.emplace_back(text);
    } else if (column_ < place_of_.size() && place_of_[column_] >= 0 && words_of_[column_] != nullptr) {
      word(text, words_of_[column_]->words);
    } else if (column_ < place_of_.size() && place_of_[column_] >= 0) {
      const std::optional<double> value = text.empty() ? kNothing : base::parse_number(text);
      if (may_be_blank_[column_] && value && std::isnan(*value)) {
        values_[static_cast<std::size_t>(place_of_[column_])] = kNothing;
      } else if (!value || !std::isfinite(*value)) {
        problem(static_cast<int>(column_) + 1, header_[column_],
                fmt::format("\"{}\" is not a finite number; expected one such as 0.25 or -3e-4", first_line(text)));
      } else {
        values_[static_cast<std::size_t>(place_of_[column_])] = *value;
      }
    }
    ++column_;
  }

  /// `terminator` is the byte that ended the row, or -1 at the end of the file. CR LF counts as one line end.
  void end_of_row(int terminator) {
    if (column_ > 0) {
      if (cut_off_ && has_header_ && terminator < 0) {
        problems_.resize(problems_before_row_);
        left_out_ = left_out_before_row_;
        cut_off_(line_);
      } else if (!has_header_) {
        read_header();
        is_header_sound_ = problems_.empty();
      } else if (column_ != header_.size()) {
        problem(1, "", fmt::format("has {} cells where the header has {}", column_, header_.size()));
      } else {
        ++rows_;
        if (is_header_sound_ && !is_bad_row_) {
          row_({line_, values_, cells_});
        }
      }
    }
    column_ = 0;
    is_bad_row_ = false;
    line_ += line_breaks_in_row_ + (terminator == '\n' ? 1 : 0);
    line_breaks_in_row_ = 0;
    problems_before_row_ = problems_.size();
    left_out_before_row_ = left_out_;
  }

  /// Counts a comment line, which is not a row.
  void skip_line() { ++line_; }

  /// Throws immediately: after this error the rest of the file cannot be interpreted.
  [[noreturn]] void stop(std::string message) const { throw base::bad_input({file_, line_, 1}, "", std::move(message)); }

  void finish() {
    problems_ = with_characters(std::move(problems_));
    if (has_header_ && rows_ == 0 && problems_.empty()) {
      problem(1, "", "holds no row of numbers");
    }
    if (!has_header_) {
      problem(1, "", "is empty; expected a header row with names such as time_s, current_A");
    }
    if (left_out_ > 0) {
      base::Diagnostic& rest = problems_.emplace_back();
      rest.at.file = file_;
      rest.message = fmt::format("and {} more problems{}", left_out_, is_hopeless() ? "; the rest was not read" : "");
    }
    if (!problems_.empty()) {
      throw base::Failure(base::ExitCode::bad_input, "", std::move(problems_));
    }
  }

  [[nodiscard]] bool is_hopeless() const { return left_out_ >= kHopeless; }

  void problem(int cell, std::string key, std::string message) {
    is_bad_row_ = true;
    if (problems_.size() < kMostProblems) {
      problems_.push_back({{file_, line_, cell}, std::move(key), std::move(message)});
    } else {
      ++left_out_;
    }
  }

 private:
  static constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

  /// Suggests a column for a missing one: the same quantity in another unit, to be converted, or a similar name.
  [[nodiscard]] std::string confounded_with(const std::string& name) const {
    if (const std::optional<base::UnitOfName> known = base::unit_of_name(name)) {
      const std::string quantity = fmt::format("{}_", known->quantity);
      const auto other = std::ranges::find_if(header_, [&](const std::string& each) { return each.starts_with(quantity); });
      if (other != header_.end()) {
        return fmt::format("; '{}' is in another unit: convert its values and name the column '{}'", *other, name);
      }
    }
    return base::did_you_mean(name, header_);
  }

  void word(std::string_view text, const std::vector<std::string>& words) {
    const auto found = std::ranges::find(words, text);
    if (found == words.end()) {
      const std::string_view shown = first_line(text);
      problem(static_cast<int>(column_) + 1, header_[column_],
              fmt::format("\"{}\" is not {}{}", shown, fmt::join(words, " or "), base::did_you_mean(shown, words)));
    } else {
      values_[static_cast<std::size_t>(place_of_[column_])] = static_cast<double>(found - words.begin());
    }
  }

  void read_header() {
    has_header_ = true;
    if (header_.size() == 1 && header_[0].find_first_of(";\t") != std::string::npos) {
      stop("the header has no comma; expected columns separated by commas, and points in numbers");
    }
    const CsvColumns wanted = choose_(header_);
    values_.assign(wanted.required.size() + wanted.optional.size(), kNothing);
    place_of_.assign(header_.size(), -1);
    words_of_.assign(header_.size(), nullptr);
    may_be_blank_.assign(header_.size(), false);
    cells_.assign(values_.size(), 0);
    for (std::size_t i = 0; i < header_.size(); ++i) {
      const auto found = std::ranges::find(words_, header_[i], &CsvWords::column);
      words_of_[i] = found != words_.end() ? &*found : nullptr;
      may_be_blank_[i] = std::ranges::find(wanted.blank, header_[i]) != wanted.blank.end();
    }
    for (std::size_t i = 0; i < values_.size(); ++i) {
      const bool is_required = i < wanted.required.size();
      const std::string& name = is_required ? wanted.required[i] : wanted.optional[i - wanted.required.size()];
      const auto found = std::ranges::find(header_, name);
      if (found == header_.end()) {
        if (is_required) {
          problem(1, name, fmt::format("there is no such column{}", confounded_with(name)));
        }
        continue;
      }
      if (std::find(found + 1, header_.end(), name) != header_.end()) {
        problem(1, name, "stands twice in the header");
      }
      place_of_[static_cast<std::size_t>(found - header_.begin())] = static_cast<int>(i);
      cells_[i] = static_cast<int>(found - header_.begin()) + 1;
    }
  }

  std::string file_;
  const ChooseCsvColumns& choose_;
  std::span<const CsvWords> words_;
  const std::function<void(const CsvRow&)>& row_;
  const std::function<void(int line)>& cut_off_;
  std::vector<std::string> header_;
  std::vector<int> place_of_;
  std::vector<const CsvWords*> words_of_;
  std::vector<bool> may_be_blank_;
  std::vector<int> cells_;
  std::vector<double> values_;
  std::vector<base::Diagnostic> problems_;
  std::size_t left_out_ = 0;
  std::size_t problems_before_row_ = 0;
  std::size_t left_out_before_row_ = 0;
  std::size_t column_ = 0;
  std::size_t rows_ = 0;
  int line_ = 1;
  int line_breaks_in_row_ = 0;
  bool has_header_ = false;
  bool is_header_sound_ = false;
  bool is_bad_row_ = false;
};

std::unique_ptr<std::FILE, int (*)(std::FILE*)> opened(const std::filesystem::path& path) {
  const auto cannot_read = [&](const char* reason) {
    return base::bad_input({path.string()}, "", fmt::format("cannot be read: {}", reason));
  };
  // O_NONBLOCK: without it, opening a pipe that has no writer would block the program.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(descriptor < 0 ? nullptr : ::fdopen(descriptor, "rb"), &std::fclose);
  struct stat about {};
  if (!file || ::fstat(descriptor, &about) != 0) {
    throw cannot_read(std::strerror(errno));
  }
  if (!S_ISREG(about.st_mode)) {
    throw cannot_read(S_ISDIR(about.st_mode) ? "it is a folder" : "it is a device or a pipe; expected a file");
  }
  base::note_input(path);
  return file;
}

/// Skips comment lines before the header, which exported tables may have.
void skip_comments(std::FILE* file, Table& table) {
  int c = std::fgetc(file);
  for (; c == '#'; c = std::fgetc(file)) {
    while (c != '\n' && c != EOF) {
      c = std::fgetc(file);
    }
    table.skip_line();
  }
  std::ungetc(c, file);
}

/// Holds an exception of a callback, because it must not propagate through libcsv, which is C.
struct Guarded {
  Table& table;
  std::exception_ptr error;
};
template <class Work>
void guarded(void* data, Work work) {
  auto& guard = *static_cast<Guarded*>(data);
  if (!guard.error) {
    try {
      work(guard.table);
    } catch (...) {
      guard.error = std::current_exception();
    }
  }
}

}  // namespace

void read_csv(const std::filesystem::path& path, std::span<const std::string> required, std::span<const std::string> optional,
              const std::function<void(const CsvRow&)>& row) {
  read_csv(path, required, optional, {}, row);
}

void read_csv(const std::filesystem::path& path, std::span<const std::string> required, std::span<const std::string> optional,
              std::span<const CsvWords> words, const std::function<void(const CsvRow&)>& row) {
  const auto always = [&](std::span<const std::string> /*header*/) {
    return CsvColumns{{required.begin(), required.end()}, {optional.begin(), optional.end()}};
  };
  read_csv(path, always, words, row);
}

void read_csv(const std::filesystem::path& path, const ChooseCsvColumns& choose, std::span<const CsvWords> words,
              const std::function<void(const CsvRow&)>& row, const std::function<void(int line)>& cut_off) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file = opened(path);
  Table table(path.string(), choose, words, row, cut_off);
  csv_parser parser{};
  csv_init(&parser, CSV_APPEND_NULL | CSV_REPALL_NL | CSV_STRICT | CSV_STRICT_FINI);
  const std::unique_ptr<csv_parser, void (*)(csv_parser*)> freed(&parser, &csv_free);
  Guarded guard{table, nullptr};
  const auto cell = [](void* text, std::size_t size, void* data) {
    guarded(data, [&](Table& t) { t.cell({static_cast<const char*>(text), size}); });
  };
  const auto end_of_row = [](int terminator, void* data) { guarded(data, [terminator](Table& t) { t.end_of_row(terminator); }); };
  std::vector<char> chunk(1 << 18);
  bool at_start = true;
  skip_comments(file.get(), table);
  while (const std::size_t got = std::fread(chunk.data(), 1, chunk.size(), file.get())) {
    std::string_view bytes(chunk.data(), got);
    if (std::exchange(at_start, false) && bytes.starts_with(kByteOrderMark)) {
      bytes.remove_prefix(kByteOrderMark.size());
    }
    if (bytes.find('\0') != std::string_view::npos) {
      throw base::bad_input({path.string()}, "", "cannot be read: it is a binary file; expected CSV text");
    }
    const std::size_t parsed = csv_parse(&parser, bytes.data(), bytes.size(), cell, end_of_row, &guard);
    if (guard.error) {
      std::rethrow_exception(guard.error);
    }
    if (table.is_hopeless()) {
      table.finish();
    }
    if (parsed != bytes.size()) {
      table.stop("a quote stands inside a cell of this row; expected cells quoted as a whole, or not at all");
    }
    // One chunk may hold a single cell of its size; a longer cell would make the buffer grow with the file.
    if (csv_get_buffer_size(&parser) > chunk.size() + kLongestCell_bytes) {
      table.stop(fmt::format("a cell is longer than {} bytes; is it a binary file, or is a quote not closed?", kLongestCell_bytes));
    }
  }
  if (std::ferror(file.get()) != 0) {
    table.problem(0, "", fmt::format("cannot be read: {}", std::strerror(errno)));
  }
  const bool open_quote = csv_fini(&parser, cell, end_of_row, &guard) != 0;
  if (open_quote && !guard.error) {
    table.stop("a quote in this row is not closed");
  }
  if (guard.error) {
    std::rethrow_exception(guard.error);
  }
  table.finish();
}

std::vector<base::Diagnostic> with_characters(std::vector<base::Diagnostic> of_cells) {
  std::ifstream file;
  std::string text;
  int line = 0;
  for (base::Diagnostic& each : of_cells) {
    if (!each.at.line || !each.at.column || *each.at.column <= 1) {
      continue;
    }
    if (line == 0 || *each.at.line < line) {
      file = std::ifstream(each.at.file, std::ios::binary);
      line = 0;
    }
    for (; line < *each.at.line && std::getline(file, text); ++line) {
    }
    if (line == 1 && text.starts_with(kByteOrderMark)) {
      text.erase(0, kByteOrderMark.size());
    }
    int cell = 1;
    int character = 1;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size() && cell < *each.at.column; ++i) {
      quoted = quoted != (text[i] == '"');
      cell += text[i] == ',' && !quoted ? 1 : 0;
      character += (text[i] & 0xC0) != 0x80 ? 1 : 0;
    }
    // A row that spans several lines is reported at the beginning of its first line.
    each.at.column = cell == *each.at.column ? character : 1;
  }
  return of_cells;
}

}  // namespace heatsoak::input
