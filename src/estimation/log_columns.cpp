#include "estimation/log_columns.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/unknown.h"
#include "estimation/log_rows.h"
#include "estimation/thresholds.h"

namespace heatsoak::estimation {
namespace {

Eigen::VectorXd means_along(const recording::Channel& channel, const std::vector<double>& row_time_s, const std::vector<double>& time_s) {
  Eigen::VectorXd means = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(time_s.size()) - 1, base::kUnknown);
  auto row = static_cast<std::size_t>(std::ranges::lower_bound(row_time_s, time_s.front()) - row_time_s.begin());
  for (Eigen::Index k = 0; k < means.size(); ++k) {
    double sum = 0.0;
    double count = 0.0;
    for (; row < row_time_s.size() && row_time_s[row] < time_s[static_cast<std::size_t>(k) + 1]; ++row) {
      if (!std::isnan(channel.values[row])) {
        sum += channel.values[row];
        count += 1.0;
      }
    }
    means[k] = count > 0.0 ? sum / count : base::kUnknown;
  }
  return means;
}

/// Replaces each NaN by the nearest known value; all stay NaN if none is known.
Eigen::VectorXd without_gaps(Eigen::VectorXd values) {
  Eigen::Index last = -1;
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    if (std::isnan(values[k])) {
      continue;
    }
    const Eigen::Index middle = last < 0 ? 0 : (last + k + 1) / 2;
    for (Eigen::Index gap = last + 1; gap < k; ++gap) {
      values[gap] = gap < middle ? values[last] : values[k];
    }
    last = k;
  }
  if (last >= 0) {
    values.tail(values.size() - 1 - last).setConstant(values[last]);
  }
  return values;
}

}  // namespace

std::vector<RunNote> columns_lacking(std::span<const std::string> columns, std::span<const recording::Recording> recordings) {
  std::vector<RunNote> notes;
  for (const recording::Recording& recording : recordings) {
    ColumnsLacking lacking{recording.name, {}};
    std::ranges::copy_if(columns, std::back_inserter(lacking.columns), [&](const std::string& column) {
      return !column.empty() && !has_values(recording.find(recording::canonical_key(column)));
    });
    if (!lacking.columns.empty()) {
      notes.emplace_back(std::move(lacking));
    }
  }
  return notes;
}

double long_blanks_s(const recording::Recording& recording, std::string_view column) {
  const recording::Channel* const channel = recording.find(recording::canonical_key(column));
  if (!has_values(channel)) {
    return 0.0;
  }
  double all_s = 0.0;
  for (const auto& [begin, end] : recording.runs()) {
    for (std::size_t row = begin; row < end;) {
      const std::size_t first = row;
      while (row < end && std::isnan(channel->values[row])) {
        ++row;
      }
      // From the last value to the next one, as in LogRows.
      const double between_s = recording.time_s[std::min(row, end - 1)] - recording.time_s[first > begin ? first - 1 : first];
      all_s += row > first && between_s >= thresholds().slow_s ? recording.time_s[std::min(row, end - 1)] - recording.time_s[first] : 0.0;
      row += row == first ? 1 : 0;
    }
  }
  return all_s;
}

std::map<std::string, Eigen::VectorXd> columns_along(const recording::Recording& recording, const std::vector<double>& time_s) {
  // The shaft power is torque times speed, so the torque stays a column of its own.
  const auto is_elsewhere = [](std::string_view key) {
    return std::ranges::any_of(thermal::kQuantities<double>, [&](const thermal::OperatingQuantity<double>& each) {
      return each.column == key && each.signal != thermal::Signal::shaft_power;
    });
  };
  std::map<std::string, Eigen::VectorXd> columns;
  for (const recording::Channel& channel : recording.channels) {
    // The network's laws use the current's magnitude; its sign is only available from the log.
    const bool has_sign = channel.quantity.key == column_of(thermal::Signal::current);
    if (channel.quantity.kind != recording::QuantityKind::temperature && (!is_elsewhere(channel.quantity.key) || has_sign)) {
      columns.emplace(channel.quantity.key, means_along(channel, recording.time_s, time_s));
    }
  }
  return columns;
}

std::vector<std::string> keep_common_columns(std::vector<MeasuredRun>& runs, std::span<const std::string> of_model) {
  std::map<std::string, std::size_t> counts;
  for (const MeasuredRun& run : runs) {
    for (const auto& [key, values] : run.columns) {
      counts[key] += values.array().isNaN().all() ? 0 : 1;
    }
  }
  std::vector<std::string> left_out;
  for (const auto& [key, count] : counts) {
    if (count < runs.size() && std::ranges::find(of_model, key) == of_model.end()) {
      left_out.push_back(key);
    }
  }
  for (MeasuredRun& run : runs) {
    std::erase_if(run.columns, [&](const auto& each) { return std::ranges::find(left_out, each.first) != left_out.end(); });
  }
  return left_out;
}

void set_columns(MeasuredRun& run, std::span<const std::string> keys) {
  for (std::size_t place = 0; place < keys.size(); ++place) {
    const auto found = run.columns.find(recording::canonical_key(keys[place]));
    const Eigen::VectorXd values = found == run.columns.end() ? Eigen::VectorXd() : without_gaps(found->second);
    const bool is_known = values.size() > 0 && !std::isnan(values[0]);
    const auto set = [&](thermal::OperatingPoint<double>& at, Eigen::Index k) {
      thermal::set_quantity(at, thermal::column_row(place), is_known ? values[k] : 0.0);
      at.known = is_known ? at.known : at.known & ~thermal::column_bit(place);
    };
    for (std::size_t k = 0; k < run.at.size(); ++k) {
      set(run.at[k], static_cast<Eigen::Index>(k));
    }
    for (UnknownInputs& unknown : run.unknown_inputs) {
      set(unknown.other, unknown.interval);
    }
  }
}

void set_columns(std::vector<MeasuredRun>& runs, std::span<const std::string> keys) {
  std::ranges::for_each(runs, [&](MeasuredRun& run) { set_columns(run, keys); });
}

}  // namespace heatsoak::estimation
