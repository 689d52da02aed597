#include "recording/channel_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/unknown.h"

namespace heatsoak::recording {
namespace {

std::optional<std::size_t> place_of(std::span<const std::string> header, const std::string& name) {
  const auto found = std::ranges::find(header, name);
  return found == header.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - header.begin()));
}

bool is_true(double value) { return !std::isnan(value) && value != 0.0; }

}  // namespace

std::size_t UsedColumns::slot(std::size_t column) {
  const auto found = std::ranges::find(columns_, column);
  if (found != columns_.end()) {
    return static_cast<std::size_t>(found - columns_.begin());
  }
  columns_.push_back(column);
  return columns_.size() - 1;
}

BlockExpression::BlockExpression(Expression expression, UsedColumns& used) : expression_(std::move(expression)) {
  for (const std::size_t column : expression_.columns()) {
    slots_.push_back(used.slot(column));
  }
}

const std::vector<double>& BlockExpression::evaluate(const input::TableBlock& block) {
  std::vector<const std::vector<double>*> inputs;
  for (const std::size_t slot : slots_) {
    inputs.push_back(&block.columns[slot]);
  }
  expression_.evaluate(inputs, values_);
  return values_;
}

void BadCells::read(const input::TableBlock& block) {
  by_slot_.resize(block.columns.size());
  for (auto& column : by_slot_) {
    column.clear();
  }
  for (const input::BadCell& cell : block.bad_cells) {
    by_slot_[cell.column].push_back(&cell);
  }
}

const std::string* BadCells::find(std::size_t slot, std::size_t row) const {
  const auto& column = by_slot_[slot];
  const auto found = std::ranges::lower_bound(column, row, {}, [](const input::BadCell* cell) { return cell->row; });
  return found != column.end() && (*found)->row == row ? &(*found)->text : nullptr;
}

ChannelSource::ChannelSource(const QuantityMapping& mapping, std::span<const std::string> header, const std::string& log, UsedColumns& used,
                             base::Diagnostics& problems)
    : mapping_(mapping) {
  const bool is_of_mapping = !mapping.places.empty();
  const std::string key = is_of_mapping ? "quantities." + mapping.quantity.key : mapping.quantity.key;
  const auto compile = [&](const std::string& text, const std::string& part) -> std::optional<BlockExpression> {
    if (text.empty()) {
      return std::nullopt;
    }
    Expression expression(text, header, mapping.place_of(part), fmt::format("{}.{}", key, part), problems);
    return expression.ok() ? std::optional<BlockExpression>(std::in_place, std::move(expression), used) : std::nullopt;
  };
  if (!mapping.column.empty()) {
    const std::optional<std::size_t> place = place_of(header, mapping.column);
    if (!place && mapping.is_optional) {
      is_absent_ = true;
      return;
    }
    if (!place) {
      problems.add(mapping.place_of("column"), key + ".column",
                   fmt::format("{} has no column '{}'{}", log, mapping.column,
                               base::did_you_mean(mapping.column, std::vector<std::string>(header.begin(), header.end()))));
      return;
    }
    if (std::ranges::count(header, mapping.column) > 1) {
      problems.add(mapping.place_of("column"), is_of_mapping ? key + ".column" : key,
                   fmt::format("'{}' appears twice in the header of {}", mapping.column, log));
      return;
    }
    slot_ = used.slot(*place);
  }
  expression_ = compile(mapping.expression, "expression");
  valid_ = compile(mapping.valid, "valid");
  for (const GapFill& fill : mapping.fills) {
    if (std::optional<BlockExpression> condition = compile(fill.where, "fill")) {
      fills_.push_back({fill.value, std::move(*condition)});
    }
  }
}

void ChannelSource::leave_out(LeftOutReason reason, int line, const std::string* example, RecordingReport& report) {
  auto entry = std::ranges::find(entries_, reason, &std::pair<LeftOutReason, LeftOut*>::first);
  if (entry == entries_.end()) {
    entries_.emplace_back(reason, &report.left_out[{mapping_.quantity.key, reason}]);
    entry = entries_.end() - 1;
  }
  if (example != nullptr && entry->second->example.empty()) {
    entry->second->example = *example;
  }
  entry->second->add(line);
}

void ChannelSource::append(const input::TableBlock& block, const BadCells& bad, const std::vector<char>& keep, RecordingReport& report,
                           std::vector<double>& values) {
  const std::vector<double>& raw = expression_ ? expression_->evaluate(block) : block.columns[*slot_];
  const std::vector<double>* const valid = valid_ ? &valid_->evaluate(block) : nullptr;
  std::vector<const std::vector<double>*> fill_where;
  for (Fill& fill : fills_) {
    fill_where.push_back(&fill.where.evaluate(block));
  }
  for (std::size_t row = 0; row < block.rows(); ++row) {
    if (keep[row] == 0) {
      continue;
    }
    double value = mapping_.value + mapping_.scale_factor * raw[row];
    if (std::isnan(value)) {
      const std::string* const cell = slot_ ? bad.find(*slot_, row) : nullptr;
      const bool is_blank = cell == nullptr || cell->empty();
      for (std::size_t i = 0; is_blank && std::isnan(value) && i < fills_.size(); ++i) {
        value = is_true((*fill_where[i])[row]) ? fills_[i].value : value;
      }
      if (std::isnan(value)) {
        leave_out(is_blank ? LeftOutReason::not_recorded : LeftOutReason::not_a_number, block.lines[row], cell, report);
      } else {
        ++filled_;
      }
    } else if (valid != nullptr && !is_true((*valid)[row])) {
      leave_out(LeftOutReason::not_valid, block.lines[row], nullptr, report);
      value = base::kUnknown;
    } else if (!mapping_.quantity.possible.contains(value)) {
      const std::string shown = fmt::format("{:g}", value);
      leave_out(LeftOutReason::impossible, block.lines[row], &shown, report);
      value = base::kUnknown;
    } else if ((mapping_.saturates_low && value <= *mapping_.saturates_low) ||
               (mapping_.saturates_high && value >= *mapping_.saturates_high)) {
      leave_out(LeftOutReason::saturated, block.lines[row], nullptr, report);
      value = base::kUnknown;
    }
    values.push_back(value);
  }
}

}  // namespace heatsoak::recording
