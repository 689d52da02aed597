#include "recording/condensed_recording.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "base/unknown.h"

namespace heatsoak::recording {
namespace {

struct Group {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Weighted mean of the known values, or with `by_square` their RMS with the sign of the mean. NaN if none is known.
double mean_of(std::span<const double> values, std::span<const double> weight_ratio, bool by_square) {
  double sum = 0.0;
  double squares = 0.0;
  double weights = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isnan(values[i])) {
      sum += weight_ratio[i] * values[i];
      squares += weight_ratio[i] * values[i] * values[i];
      weights += weight_ratio[i];
    }
  }
  return weights > 0.0 ? by_square ? std::copysign(std::sqrt(squares / weights), sum) : sum / weights : base::kUnknown;
}

double lowest_of(std::span<const double> values) {
  double lowest = base::kUnknown;
  for (const double value : values) {
    lowest = value < lowest || std::isnan(lowest) ? value : lowest;
  }
  return lowest;
}

double highest_of(std::span<const double> values) {
  double highest = base::kUnknown;
  for (const double value : values) {
    highest = value > highest || std::isnan(highest) ? value : highest;
  }
  return highest;
}

double first_of(std::span<const double> values) {
  const auto found = std::ranges::find_if(values, [](double value) { return !std::isnan(value); });
  return found == values.end() ? base::kUnknown : *found;
}

}  // namespace

CondensedRecording::Rows CondensedRecording::merged(const Recording& rows, const Rows* counted, std::size_t most) {
  Rows some{{rows.name, rows.file, rows.motor, rows.conditions, {}, {}, {}, {}}, {}, {}, {}};
  std::vector<Group> groups;
  const std::vector<std::size_t>& begins = rows.run_begins;
  auto run = begins.begin();
  for (std::size_t begin = 0; begin < rows.rows(); begin = groups.back().end) {
    if (run != begins.end() && *run == begin) {
      some.rows.run_begins.push_back(groups.size());
      ++run;
    }
    groups.push_back({begin, std::min(begin + most, run != begins.end() ? *run : rows.rows())});
    some.rows.time_s.push_back(rows.time_s[begin]);
    some.rows.line.push_back(rows.line[begin]);
    double weight_ratio = 0.0;
    for (std::size_t i = begin; i < groups.back().end; ++i) {
      weight_ratio += counted ? counted->weight_ratio[i] : 1.0;
    }
    some.weight_ratio.push_back(weight_ratio);
  }
  const std::vector<double> ones(most, 1.0);
  for (std::size_t c = 0; c < rows.channels.size(); ++c) {
    const Channel& channel = rows.channels[c];
    const bool is_input = channel.quantity.kind == QuantityKind::heat_input;
    const bool is_mean = is_input || channel.quantity.kind == QuantityKind::surroundings;
    const bool by_square = is_input && channel.quantity.unit == "A";
    std::vector<double>& values = some.rows.channels.emplace_back(Channel{channel.quantity, {}}).values;
    std::vector<double>& low = some.low.emplace_back();
    std::vector<double>& high = some.high.emplace_back();
    for (std::vector<double>* const each : {&values, &low, &high}) {
      each->reserve(groups.size());
    }
    for (const auto& group : groups) {
      const auto of = [&group](const std::vector<double>& all) { return std::span(all).subspan(group.begin, group.end - group.begin); };
      values.push_back(is_mean ? mean_of(of(channel.values), counted ? of(counted->weight_ratio) : std::span(ones), by_square)
                               : first_of(of(channel.values)));
      low.push_back(lowest_of(of(counted ? counted->low[c] : channel.values)));
      high.push_back(highest_of(of(counted ? counted->high[c] : channel.values)));
    }
  }
  return some;
}

void CondensedRecording::leave_every_other_run_aside(Rows& some) {
  std::vector<char> stays(some.rows.rows(), 0);
  std::vector<std::size_t> run_begins;
  std::size_t kept = 0;
  const auto runs = some.rows.runs();
  // Always keep the last run, which may continue in the next part.
  for (std::size_t run = (runs.size() - 1) % 2; run < runs.size(); run += 2) {
    run_begins.push_back(kept);
    std::fill(stays.begin() + static_cast<std::ptrdiff_t>(runs[run].first), stays.begin() + static_cast<std::ptrdiff_t>(runs[run].second),
              1);
    kept += runs[run].second - runs[run].first;
  }
  const auto keep = [&stays](auto& values) {
    std::size_t to = 0;
    for (std::size_t row = 0; row < stays.size(); ++row) {
      if (stays[row] != 0) {
        values[to++] = values[row];
      }
    }
    values.resize(to);
  };
  keep(some.rows.time_s);
  keep(some.rows.line);
  keep(some.weight_ratio);
  for (Channel& channel : some.rows.channels) {
    keep(channel.values);
  }
  std::ranges::for_each(some.low, keep);
  std::ranges::for_each(some.high, keep);
  some.rows.run_begins = std::move(run_begins);
}

void CondensedRecording::add(const Recording& part) {
  Rows more = merged(part, nullptr, merged_);
  if (all_.rows.time_s.empty()) {
    all_ = std::move(more);
  } else {
    for (const std::size_t begin : more.rows.run_begins) {
      all_.rows.run_begins.push_back(all_.rows.rows() + begin);
    }
    const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    append(all_.rows.time_s, more.rows.time_s);
    append(all_.rows.line, more.rows.line);
    append(all_.weight_ratio, more.weight_ratio);
    for (std::size_t c = 0; c < all_.rows.channels.size(); ++c) {
      append(all_.rows.channels[c].values, more.rows.channels[c].values);
      append(all_.low[c], more.low[c]);
      append(all_.high[c], more.high[c]);
    }
  }
  while (all_.rows.rows() > most_rows_) {
    const std::size_t before = all_.rows.rows();
    all_ = merged(all_.rows, &all_, 2);
    merged_ *= 2;
    constexpr double kLittle_share = 0.8;
    if (static_cast<double>(all_.rows.rows()) > kLittle_share * static_cast<double>(before)) {
      leave_every_other_run_aside(all_);
    }
  }
}

void CondensedRecording::erase_channel(std::size_t channel) {
  const auto at = static_cast<std::ptrdiff_t>(channel);
  all_.rows.channels.erase(all_.rows.channels.begin() + at);
  all_.low.erase(all_.low.begin() + at);
  all_.high.erase(all_.high.begin() + at);
}

}  // namespace heatsoak::recording
