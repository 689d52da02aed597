#include "identify/measurement/read_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/diagnostic.h"
#include "identify/measurement/channel_source.h"
#include "identify/measurement/interval_values.h"
#include "identify/measurement/row_order.h"
#include "identify/measurement/screening.h"
#include "input/number_table.h"

namespace heatsoak {
namespace {

constexpr double kUnsorted_share = 0.1;

/// The canonical form: every column whose name is a quantity.
std::vector<QuantityMapping> quantities_of_header(const NumberTable& table, const std::string& file, RecordingReport& report) {
  std::vector<QuantityMapping> found;
  for (std::size_t i = 0; i < table.header().size(); ++i) {
    const std::string& name = table.header()[i];
    if (const std::optional<Quantity> quantity = quantity_named(name)) {
      QuantityMapping& mapping = found.emplace_back();
      mapping.quantity = *quantity;
      mapping.column = name;
      mapping.at = {file, table.header_line(), 1};
    } else {
      report.notes.push_back(
          fmt::format("column {} '{}' is not used: its name does not end in a unit{}", i + 1, name, nearest_quantity(name)));
    }
  }
  return found;
}

/// A file on its way into columns.
class Intake {
 public:
  Intake(const std::filesystem::path& log, const Mapping& mapping, RecordingReport& report)
      : log_(log), mapping_(mapping), report_(report), table_(log, mapping.format) {
    find_sources();
    table_.choose(used_.all());
  }

  Recording read() {
    TableBlock block;
    BadCells bad;
    while (table_.next(block)) {
      bad.read(block);
      take(block, bad);
      make_room();
    }
    report_.file_bytes = table_.bytes_read();
    Recording recording = order();
    describe(recording);
    to_interval_values(recording, mapping_.inputs, offsets_s_);
    leave_out_bad_samples(recording, report_);
    return recording;
  }

 private:
  void find_sources() {
    if (table_.header().size() < 2) {
      throw bad_input({log_.string(), table_.header_line(), 1}, "",
                      fmt::format("the header has one column only; expected names separated by '{}' (a foreign log is read with --map)",
                                  mapping_.format.separator));
    }
    const std::vector<QuantityMapping> quantities =
        mapping_.is_canonical() ? quantities_of_header(table_, log_.string(), report_) : mapping_.quantities;
    Diagnostics problems;
    for (const QuantityMapping& quantity : quantities) {
      ChannelSource source(quantity, table_.header(), log_.string(), used_, problems);
      if (source.is_absent()) {
        report_.notes.push_back(fmt::format("{} is not recorded: no column '{}'", quantity.quantity.key, quantity.column));
      } else if (quantity.quantity.kind == QuantityKind::time) {
        time_.emplace(std::move(source));
      } else {
        sources_.push_back(std::move(source));
      }
    }
    if (!time_ && problems.empty()) {
      const std::vector<std::string> names(table_.header().begin(), table_.header().end());
      problems.add(
          {log_.string(), table_.header_line(), 1}, "time_s",
          fmt::format("there is no such column{}; a foreign log is read with a mapping (--map FILE.toml)", did_you_mean("time_s", names)));
    }
    valid_ = condition(mapping_.valid, mapping_.valid_at, "rows.valid", problems);
    if (!mapping_.run_column.empty()) {
      run_ = condition("'" + mapping_.run_column + "'", mapping_.run_column_at, "runs.column", problems);
    }
    problems.throw_if_any();
    columns_.resize(sources_.size());
  }

  std::optional<BlockExpression> condition(const std::string& text, const Location& at, const char* key, Diagnostics& problems) {
    if (text.empty()) {
      return std::nullopt;
    }
    Expression expression(text, table_.header(), at, key, problems);
    return expression.ok() ? std::optional<BlockExpression>(std::in_place, std::move(expression), used_) : std::nullopt;
  }

  void take(const TableBlock& block, const BadCells& bad) {
    report_.rows_in_file += block.rows() + block.bad_lines.size();
    for (const BadLine& line : block.bad_lines) {
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
        time_s_.push_back(block_time_s_[row]);
        line_.push_back(block.lines[row]);
      }
    }
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      sources_[i].append(block, bad, keep_, report_, columns_[i]);
    }
    if (run_) {
      const std::vector<double>& run = run_->evaluate(block);
      for (std::size_t row = 0; row < block.rows(); ++row) {
        if (keep_[row] != 0) {
          run_value_.push_back(run[row]);
        }
      }
    }
  }

  /// As soon as the length of rows is known: columns that grow by doubling would be copied and take twice the memory.
  void make_room() {
    constexpr std::size_t kEnoughRows = 50'000;
    constexpr double kMargin_ratio = 1.03;
    std::error_code unknown;
    const std::uintmax_t file_bytes = std::filesystem::file_size(log_, unknown);
    if (has_room_ || unknown || time_s_.size() < kEnoughRows) {
      return;
    }
    has_room_ = true;
    const auto rows = static_cast<std::size_t>(kMargin_ratio * static_cast<double>(time_s_.size()) * static_cast<double>(file_bytes) /
                                               static_cast<double>(table_.bytes_read()));
    time_s_.reserve(rows);
    line_.reserve(rows);
    for (std::vector<double>& column : columns_) {
      column.reserve(rows);
    }
  }

  /// Rows whose time does not increase go.
  Recording order() {
    if (time_s_.empty()) {
      throw bad_input({log_.string()}, "", report_.rows_in_file == 0 ? "has a header but no rows" : first_reason());
    }
    const std::vector<char> stays = increasing_rows(time_s_);
    const auto kept = static_cast<std::size_t>(std::ranges::count(stays, 1));
    if (static_cast<double>(stays.size() - kept) > kUnsorted_share * static_cast<double>(stays.size())) {
      throw unsorted(stays.size() - kept);
    }
    if (kept < stays.size()) {
      for (std::size_t row = 0; row < stays.size(); ++row) {
        if (stays[row] == 0) {
          report_.left_out[{"", LeftOutReason::time_does_not_increase}].add(line_[row]);
          report_.repeated_times += row > 0 && time_s_[row] == time_s_[row - 1] ? 1 : 0;
        }
      }
      const auto compact = [&stays](auto& column) {
        std::size_t to = 0;
        for (std::size_t row = 0; row < column.size(); ++row) {
          if (stays[row] != 0) {
            column[to++] = column[row];
          }
        }
        column.resize(to);
      };
      compact(time_s_);
      compact(line_);
      std::ranges::for_each(columns_, compact);
      compact(run_value_);
    }
    report_.rows_kept = kept;
    Recording recording;
    recording.run_begins = run_begins(time_s_, run_value_, mapping_.longest_gap_s);
    recording.time_s = std::move(time_s_);
    recording.line = std::move(line_);
    return recording;
  }

  [[nodiscard]] Failure unsorted(std::size_t count) const {
    std::size_t row = 1;
    while (time_s_[row] > time_s_[row - 1]) {
      ++row;
    }
    return bad_input(
        {log_.string(), line_[row], 1}, time_->quantity().key,
        fmt::format("time does not increase: {} of {} rows would have to go, the first is at {:g} s after {:g} s; expected rows "
                    "sorted by time, one recording per file",
                    count, time_s_.size(), time_s_[row], time_s_[row - 1]));
  }

  [[nodiscard]] std::string first_reason() const {
    const auto& [what, left_out] = *report_.left_out.begin();
    return fmt::format("none of its {} rows can be used; {} at line {}{}", report_.rows_in_file, to_string(what.second),
                       left_out.lines.front().first, left_out.example.empty() ? "" : fmt::format(" ({})", left_out.example));
  }

  void describe(Recording& recording) {
    recording.name = log_.stem().string();
    recording.file = log_;
    recording.motor = mapping_.motor;
    recording.conditions = mapping_.conditions;
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      const Quantity& quantity = sources_[i].quantity();
      if (std::ranges::all_of(columns_[i], [](double value) { return std::isnan(value); })) {
        report_.notes.push_back(fmt::format("{} is left out: not one number in {} rows", quantity.key, columns_[i].size()));
        continue;
      }
      if (sources_[i].filled() > 0) {
        report_.notes.push_back(fmt::format("{}: {} blank samples are filled as the mapping says", quantity.key, sources_[i].filled()));
      }
      recording.channels.push_back({quantity, std::move(columns_[i])});
      offsets_s_.push_back(sources_[i].clock_offset_s());
    }
    if (recording.channels.empty()) {
      throw Failure(ExitCode::cannot_answer, fmt::format("{}: no quantity beside the time holds a number", log_.string()));
    }
  }

  const std::filesystem::path& log_;
  const Mapping& mapping_;
  RecordingReport& report_;
  RecordingReport time_report_;  ///< a row without time is reported as a row, not as a sample
  NumberTable table_;
  UsedColumns used_;
  std::optional<ChannelSource> time_;
  std::vector<ChannelSource> sources_;
  std::optional<BlockExpression> valid_;
  std::optional<BlockExpression> run_;
  std::vector<char> keep_;
  std::vector<double> block_time_s_;
  std::vector<double> time_s_;
  std::vector<int> line_;
  std::vector<double> run_value_;
  std::vector<std::vector<double>> columns_;
  std::vector<double> offsets_s_;  ///< of the recording's channels
  bool has_room_ = false;
};

}  // namespace

Recording read_recording(const std::filesystem::path& log, const Mapping& mapping, RecordingReport& report) {
  return Intake(log, mapping, report).read();
}

}  // namespace heatsoak
