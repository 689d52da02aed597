#include "recording/recording_stream.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <span>

#include "base/diagnostic.h"
#include "base/quantity.h"
#include "base/unit_names.h"
#include "input/number_table.h"
#include "recording/channel_source.h"
#include "recording/interval_values.h"
#include "recording/noise.h"
#include "recording/row_order.h"
#include "recording/screening.h"
#include "recording/suggested_mapping.h"

namespace heatsoak::recording {
namespace {

constexpr double kUnsorted_share = 0.1;
constexpr int kTimeDigits = 10;  // of a Unix time in seconds

/// Quantities of a canonical log: all columns whose name is a quantity. Reports the other columns.
std::vector<QuantityMapping> quantities_of_header(const input::NumberTable& table, const std::string& file, RecordingReport& report) {
  std::vector<QuantityMapping> found;
  for (std::size_t i = 0; i < table.header().size(); ++i) {
    const std::string& name = table.header()[i];
    if (std::ranges::find(found, name, &QuantityMapping::column) != found.end()) {
      continue;  // a repeated name is reported elsewhere
    }
    if (const std::optional<Quantity> quantity = quantity_named(name)) {
      QuantityMapping& mapping = found.emplace_back();
      mapping.quantity = *quantity;
      mapping.column = name;
      mapping.at = {file, table.header_line(), 1};
    } else {
      report.notes.emplace_back(ColumnWithoutUnit{i + 1, name});
    }
  }
  return found;
}

/// Hint about the separator of a header that was read as one cell.
std::string other_separator(std::span<const std::string> header) {
  const std::string text = header.empty() ? "" : header.front();
  for (const auto& [mark, name] : {std::pair(';', ";"), std::pair('\t', "tab"), std::pair(',', ","), std::pair('|', "|")}) {
    if (text.find(mark) != std::string::npos) {
      return fmt::format("; this file seems to have {}: read it with --map and a mapping that sets [file] separator = \"{}\"",
                         mark == '\t' ? std::string("tabs") : fmt::format("'{}'", mark), name);
    }
  }
  return " (a foreign log is read with --map; [file] header_rows and names_row of the mapping skip lines above its header)";
}

}  // namespace

/// Rows of the file before checks.
struct RawRows {
  std::vector<double> time_s;
  std::vector<int> line;
  std::vector<double> run_value;  ///< empty without a run column
  std::vector<std::vector<double>> columns;

  [[nodiscard]] std::size_t size() const { return time_s.size(); }

  template <class Change>
  void for_each(const Change& change) {
    change(time_s);
    change(line);
    change(run_value);
    std::ranges::for_each(columns, change);
  }
  /// Returns rows [begin, end).
  [[nodiscard]] RawRows slice(std::size_t begin, std::size_t end) const {
    const auto of = [begin, end]<class T>(const std::vector<T>& all) {
      return all.empty() ? all
                         : std::vector<T>(all.begin() + static_cast<std::ptrdiff_t>(begin), all.begin() + static_cast<std::ptrdiff_t>(end));
    };
    RawRows some{of(time_s), of(line), of(run_value), {}};
    for (const std::vector<double>& column : columns) {
      some.columns.push_back(of(column));
    }
    return some;
  }
  void append(const RawRows& more) {
    const auto add = []<class T>(std::vector<T>& to, const std::vector<T>& from) { to.insert(to.end(), from.begin(), from.end()); };
    add(time_s, more.time_s);
    add(line, more.line);
    add(run_value, more.run_value);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      add(columns[i], more.columns[i]);
    }
  }
  void keep(const std::vector<char>& stays) {
    for_each([&stays](auto& column) {
      std::size_t to = 0;
      for (std::size_t row = 0; row < column.size(); ++row) {
        if (stays[row] != 0) {
          column[to++] = column[row];
        }
      }
      column.resize(to);
    });
  }
};

class RecordingStream::Intake {
 public:
  Intake(const std::filesystem::path& log, const Mapping& mapping, RecordingReport& report)
      : log_(log), mapping_(mapping), report_(report), table_(log, mapping.format) {
    find_sources();
    table_.choose(used_.all());
  }

  bool next(Recording& part) {
    fill();
    if (rows_.size() == context_) {
      conclude();
      return false;
    }
    const std::size_t judged = is_at_end_ ? rows_.size() : rows_.size() - margin_;
    const std::vector<char> stays = increasing(judged);
    const RawRows ahead = rows_.slice(judged, rows_.size());
    const auto last = static_cast<std::size_t>(std::count(stays.begin(), stays.begin() + static_cast<std::ptrdiff_t>(judged), 1));
    if (std::ranges::count(stays, 0) > 0) {
      rows_.keep(stays);
    }
    const std::size_t first = std::exchange(context_, std::min(margin_, last));
    RawRows next = rows_.slice(last - context_, last);
    next.append(ahead);
    part = checked(first, last);
    rows_ = std::move(next);
    return true;
  }

  [[nodiscard]] std::size_t bytes_read() const { return table_.bytes_read(); }
  [[nodiscard]] std::span<const std::string> header() const { return table_.header(); }
  [[nodiscard]] bool has_numbers(std::size_t channel) const { return has_numbers_[channel] != 0; }

 private:
  void find_sources() {
    if (table_.header().size() < 2) {
      throw base::bad_input({log_.string(), table_.header_line(), 1}, "",
                            fmt::format("the header has one column only; expected names separated by '{}'{}", mapping_.format.separator,
                                        other_separator(table_.header())));
    }
    const std::vector<QuantityMapping> quantities =
        mapping_.is_canonical() ? quantities_of_header(table_, log_.string(), report_) : mapping_.quantities;
    base::Diagnostics problems;
    std::set<std::string> keys;
    for (const QuantityMapping& quantity : quantities) {
      if (!keys.insert(quantity.quantity.key).second) {
        problems.add(quantity.at, quantity.quantity.key,
                     fmt::format("has two names: '{}' is the earlier one; keep one of the two", earlier_key(quantity.quantity.key)));
      }
      if (quantity.quantity.meaning.empty() && !nearest_quantity(quantity.quantity.key).empty()) {
        report_.notes.emplace_back(AdditionalSignal{quantity.quantity.key});
      }
      ChannelSource source(quantity, table_.header(), log_.string(), used_, problems);
      if (source.is_absent()) {
        report_.notes.emplace_back(NotRecorded{quantity.quantity.key, quantity.column});
      } else if (quantity.quantity.kind == QuantityKind::time) {
        time_.emplace(std::move(source));
      } else {
        sources_.push_back(std::move(source));
      }
    }
    if (!time_ && problems.empty()) {
      problems.add({log_.string(), table_.header_line(), 1}, "time_s", missing_time());
    }
    if (time_ && sources_.empty() && mapping_.is_canonical() && problems.empty()) {
      problems.add({log_.string(), table_.header_line(), 1}, "", no_quantity());
    }
    valid_ = condition(mapping_.valid, mapping_.valid_at, "rows.valid", problems);
    if (!mapping_.run_column.empty()) {
      run_ = condition("'" + mapping_.run_column + "'", mapping_.run_column_at, "runs.column", problems);
    }
    problems.throw_if_any();
    rows_.columns.resize(sources_.size());
    has_numbers_.resize(sources_.size(), 0);
    for (const ChannelSource& source : sources_) {
      offsets_s_.push_back(source.clock_offset_s());
      furthest_offset_s_ = std::max(furthest_offset_s_, std::abs(source.clock_offset_s()));
    }
  }

  /// Returns the message about a log without time_s, with a mapping to start from. A column with the time in another unit must not be
  /// renamed.
  [[nodiscard]] std::string missing_time() const {
    const std::vector<std::string> names(table_.header().begin(), table_.header().end());
    for (const std::string& name : names) {
      const std::optional<base::UnitOfName> other = base::unit_of_name(name);
      if (other && (other->quantity == "time" || other->quantity == "t") && other->unit != "s") {
        return fmt::format("there is no such column; '{}' is in another unit. {}", name, how_to_map());
      }
    }
    const std::string similar = base::did_you_mean("time_s", names);
    return fmt::format("there is no such column{} {}", similar.empty() ? "." : similar, how_to_map());
  }

  /// Returns the message about a log none of whose columns besides the time is a quantity.
  [[nodiscard]] std::string no_quantity() const {
    std::vector<std::string> others;
    for (const std::string& name : table_.header()) {
      if (name != time_->quantity().key) {
        others.push_back(fmt::format("'{}'", name));
      }
    }
    return fmt::format("{} {} not understood; expected names of quantities with their unit, such as winding_C and current_A. {}",
                       fmt::join(others, ", "), others.size() == 1 ? "is" : "are", how_to_map());
  }

  [[nodiscard]] std::string how_to_map() const {
    return fmt::format("A foreign log is read with a mapping. Complete this one and save it as {}.map.toml:\n{}", log_.filename().string(),
                       suggested_mapping(table_.header()));
  }

  std::optional<BlockExpression> condition(const std::string& text, const base::Location& at, const char* key,
                                           base::Diagnostics& problems) {
    if (text.empty()) {
      return std::nullopt;
    }
    Expression expression(text, table_.header(), at, key, problems);
    return expression.ok() ? std::optional<BlockExpression>(std::in_place, std::move(expression), used_) : std::nullopt;
  }

  void take(const input::TableBlock& block, const BadCells& bad) {
    report_.rows_in_file += block.rows() + block.bad_lines.size();
    for (const input::BadLine& line : block.bad_lines) {
      LeftOut& entry = report_.left_out[{"", line.is_cut_off ? LeftOutReason::cut_off : LeftOutReason::wrong_number_of_cells}];
      entry.example = entry.count == 0 ? fmt::format("{} instead of {}", line.cells, table_.header().size()) : entry.example;
      entry.add(line.line);
    }
    keep_.assign(block.rows(), 1);
    if (valid_) {
      const std::vector<double>& valid = valid_->evaluate(block);
      for (std::size_t row = 0; row < block.rows(); ++row) {
        if (std::isnan(valid[row]) || valid[row] == 0.0) {
          keep_[row] = 0;
          report_.left_out[{"", LeftOutReason::not_valid}].add(block.lines[row]);
        }
      }
    }
    block_time_s_.clear();
    time_->append(block, bad, std::vector<char>(block.rows(), 1), time_report_, block_time_s_);
    for (std::size_t row = 0; row < block.rows(); ++row) {
      if (keep_[row] != 0 && std::isnan(block_time_s_[row])) {
        keep_[row] = 0;
        report_.left_out[{"", LeftOutReason::without_time}].add(block.lines[row]);
      }
      if (keep_[row] != 0) {
        add_row(block_time_s_[row], block.lines[row]);
      }
    }
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      sources_[i].append(block, bad, keep_, report_, rows_.columns[i]);
    }
    if (run_) {
      const std::vector<double>& run = run_->evaluate(block);
      for (std::size_t row = 0; row < block.rows(); ++row) {
        if (keep_[row] != 0) {
          rows_.run_value.push_back(run[row]);
        }
      }
    }
  }

  void add_row(double time_s, int line) {
    if (rows_with_time_++ > 0 && !(time_s > time_before_s_) && !first_backwards_) {
      first_backwards_ = {line, time_s, time_before_s_};
    }
    time_before_s_ = time_s;
    rows_.time_s.push_back(time_s);
    rows_.line.push_back(line);
  }

  /// Reads rows until there are enough for a part and the margin around it.
  void fill() {
    constexpr std::size_t kPart = 1 << 16;
    constexpr std::size_t kMargin = 1 << 12;
    margin_ = std::max(margin_, kMargin);
    input::TableBlock block;
    BadCells bad;
    while (!is_at_end_ && rows_.size() < context_ + kPart + margin_) {
      if (!table_.next(block)) {
        is_at_end_ = true;
        break;
      }
      bad.read(block);
      take(block, bad);
      // A clock offset larger than the margin needs a larger margin.
      if (furthest_offset_s_ > 0.0 && context_ == 0 && rows_.size() > kPart) {
        constexpr double kSpare_ratio = 1.5;
        constexpr double kMostMargin = 1 << 22;
        const double period_s = std::max(usual_period_s(rows_.time_s), 1e-9);
        margin_ = std::max(margin_, static_cast<std::size_t>(std::min(kMostMargin, kSpare_ratio * furthest_offset_s_ / period_s)));
      }
    }
  }

  /// Returns 1 for each row to keep so that time increases. Reports dropped rows before `judged`.
  std::vector<char> increasing(std::size_t judged) {
    const auto fresh = std::span(rows_.time_s).subspan(context_);
    std::vector<char> stays(rows_.size(), 1);
    const auto is_done = [this](double time_s) { return context_ > 0 && !(time_s > rows_.time_s[context_ - 1]); };
    if (std::ranges::none_of(fresh, is_done)) {
      std::ranges::copy(increasing_rows(fresh), stays.begin() + static_cast<std::ptrdiff_t>(context_));
    } else {
      std::vector<double> later_s;
      std::ranges::copy_if(fresh, std::back_inserter(later_s), [&](double time_s) { return !is_done(time_s); });
      const std::vector<char> later = increasing_rows(later_s);
      std::size_t at = 0;
      for (std::size_t row = context_; row < rows_.size(); ++row) {
        stays[row] = is_done(rows_.time_s[row]) ? '\0' : later[at++];
      }
    }
    for (std::size_t row = context_; row < judged; ++row) {
      if (stays[row] == 0) {
        report_.left_out[{"", LeftOutReason::time_does_not_increase}].add(rows_.line[row]);
        const bool is_repeated = row > 0 && rows_.time_s[row] == rows_.time_s[row - 1];
        report_.repeated_times += is_repeated ? 1 : 0;
        backwards_ += is_repeated ? 0 : 1;
      }
    }
    return stays;
  }

  /// Checks rows [first, last) and returns them as a part. The rows before and after them serve as context.
  Recording checked(std::size_t first, std::size_t last) {
    Recording part;
    part.name = log_.stem().string();
    part.file = log_;
    part.motor = mapping_.motor;
    part.conditions = mapping_.conditions;
    for (std::size_t row = std::max<std::size_t>(first, 1); row < last; ++row) {
      steps_s_.add(rows_.time_s[row] - rows_.time_s[row - 1]);
    }
    part.run_begins =
        run_begins(rows_.time_s, rows_.run_value, mapping_.longest_gap_s.value_or(kLongestStep_ratio * median_of(steps_s_.values())));
    part.time_s = std::move(rows_.time_s);
    part.line = std::move(rows_.line);
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      const std::vector<double>& values = rows_.columns[i];
      has_numbers_[i] = has_numbers_[i] != 0 || std::any_of(values.begin() + static_cast<std::ptrdiff_t>(first),
                                                            values.begin() + static_cast<std::ptrdiff_t>(last),
                                                            [](double value) { return !std::isnan(value); })
                            ? 1
                            : 0;
      part.channels.push_back({sources_[i].quantity(), std::move(rows_.columns[i])});
    }
    to_interval_values(part, mapping_.inputs, offsets_s_);
    screening_.leave_out_bad_samples(part, first, last, report_);
    report_.rows_kept += last - first;
    cut(part, first, last);
    return part;
  }

  static void cut(Recording& part, std::size_t first, std::size_t last) {
    const auto to_own = [first, last](auto& column) {
      column.resize(last);
      column.erase(column.begin(), column.begin() + static_cast<std::ptrdiff_t>(first));
    };
    to_own(part.time_s);
    to_own(part.line);
    for (Channel& channel : part.channels) {
      to_own(channel.values);
    }
    std::erase_if(part.run_begins, [first, last](std::size_t begin) { return begin < first || begin >= last; });
    for (std::size_t& begin : part.run_begins) {
      begin -= first;
    }
  }

  /// Throws Failure (bad_input) if most rows repeat a time. Few repeated rows are harmless, but here most of the data would be lost.
  void refuse_where_time_repeats() const {
    constexpr double kMost_share = 0.5;
    if (static_cast<double>(report_.repeated_times) > kMost_share * static_cast<double>(rows_with_time_)) {
      throw base::bad_input(
          {log_.string(), first_backwards_->line, 1}, time_->quantity().key,
          fmt::format("{} of {} rows have the time of the row before, the first at {} s; expected a different time for every "
                      "row: is it written with too few digits?",
                      report_.repeated_times, rows_with_time_, base::significant(first_backwards_->time_s, kTimeDigits)));
    }
  }

  /// Checks at the end of the file.
  void conclude() {
    report_.file_bytes = table_.bytes_read();
    if (rows_with_time_ == 0) {
      throw base::bad_input({log_.string()}, "", report_.rows_in_file == 0 ? "has a header but no rows" : first_reason());
    }
    refuse_where_time_repeats();
    if (static_cast<double>(backwards_) > kUnsorted_share * static_cast<double>(rows_with_time_)) {
      throw base::bad_input(
          {log_.string(), first_backwards_->line, 1}, time_->quantity().key,
          fmt::format("time does not increase: {} of {} rows would be left out, the first is at {} s after {} s; expected rows "
                      "sorted by time, one recording per file",
                      backwards_, rows_with_time_, base::significant(first_backwards_->time_s, kTimeDigits),
                      base::significant(first_backwards_->before_s, kTimeDigits)));
    }
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      const std::string& key = sources_[i].quantity().key;
      if (!has_numbers(i)) {
        report_.notes.emplace_back(ChannelWithoutNumbers{key, report_.rows_kept});
      } else if (sources_[i].filled() > 0) {
        report_.notes.emplace_back(BlanksFilled{key, sources_[i].filled()});
      }
    }
    if (std::ranges::count(has_numbers_, 1) == 0) {
      throw base::Failure(base::ExitCode::cannot_answer, "",
                          {{{log_.string(), table_.header_line(), 1}, {}, "no quantity except the time contains a number"}});
    }
  }

  [[nodiscard]] std::string first_reason() const {
    const auto& [what, left_out] = *report_.left_out.begin();
    return fmt::format("none of its {} rows can be used; {} at line {}{}", report_.rows_in_file, to_string(what.second),
                       left_out.lines.front().first, left_out.example.empty() ? "" : fmt::format(" ({})", left_out.example));
  }

  /// First row whose time is not later than that of the row before.
  struct Backwards {
    int line = 0;
    double time_s = 0.0;
    double before_s = 0.0;
  };
  std::filesystem::path log_;
  Mapping mapping_;
  RecordingReport& report_;
  RecordingReport time_report_;  ///< separate, because a row without time is reported as a row and not as a sample
  input::NumberTable table_;
  UsedColumns used_;
  std::optional<ChannelSource> time_;
  std::vector<ChannelSource> sources_;
  std::optional<BlockExpression> valid_;
  std::optional<BlockExpression> run_;
  std::vector<double> offsets_s_;  ///< clock offset per channel
  double furthest_offset_s_ = 0.0;
  std::vector<char> keep_;
  std::vector<double> block_time_s_;
  RawRows rows_;
  std::size_t context_ = 0;  ///< number of leading rows that were already returned
  std::size_t margin_ = 0;   ///< number of rows kept before a part and read after it
  bool is_at_end_ = false;
  Thinned steps_s_;
  Screening screening_;
  std::vector<char> has_numbers_;  ///< per channel
  std::size_t rows_with_time_ = 0;
  double time_before_s_ = 0.0;
  std::size_t backwards_ = 0;
  std::optional<Backwards> first_backwards_;
};

RecordingStream::RecordingStream(const std::filesystem::path& log, const Mapping& mapping, RecordingReport& report)
    : intake_(std::make_unique<Intake>(log, mapping, report)) {}
RecordingStream::~RecordingStream() = default;

bool RecordingStream::next(Recording& part) { return intake_->next(part); }
std::size_t RecordingStream::bytes_read() const { return intake_->bytes_read(); }

std::span<const std::string> RecordingStream::header() const { return intake_->header(); }
bool RecordingStream::has_numbers(std::size_t channel) const { return intake_->has_numbers(channel); }

}  // namespace heatsoak::recording
