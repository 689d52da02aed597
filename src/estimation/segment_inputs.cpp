#include "estimation/segment_inputs.h"

#include <algorithm>
#include <cmath>

#include "base/unknown.h"

namespace heatsoak::estimation {
namespace {

double square_A2(const thermal::OperatingPoint<double>& at) { return at.current_rms_A * at.current_rms_A; }

std::vector<double> along(const LogRows& rows, std::size_t first, std::size_t last,
                          double (*quantity)(const thermal::OperatingPoint<double>&)) {
  std::vector<double> all;
  for (std::size_t row = first; row <= last; ++row) {
    all.push_back(quantity(rows.at(row)));
  }
  return all;
}

thermal::OperatingPoint<double> nowhere() {
  thermal::OperatingPoint<double> none;
  thermal::for_each_quantity([](double& value) { value = base::kUnknown; }, none);
  return none;
}

/// Replaces assumed quantities by the logged cells of a row, where these are not NaN.
thermal::OperatingPoint<double> with_cells(thermal::OperatingPoint<double> supposed, const thermal::OperatingPoint<double>& cells) {
  const double unlogged_share = supposed.unlogged_speed_share;
  thermal::for_each_quantity([](double& value, const double& cell) { value = std::isnan(cell) ? value : cell; }, supposed, cells);
  supposed.unlogged_speed_share = unlogged_share;
  supposed.known = cells.known;
  return supposed;
}

}  // namespace

SegmentInputs::SegmentInputs(const recording::Recording& recording, const LogRows& rows, std::size_t first, std::size_t last)
    : recording_(recording),
      rows_(rows),
      steps_(row_steps(std::span(recording.time_s).subspan(first, last - first + 1))),
      square_A2_(std::span(recording.time_s).subspan(first, last - first + 1), along(rows, first, last, square_A2), steps_.usual_s),
      speed_rad_per_s_(std::span(recording.time_s).subspan(first, last - first + 1),
                       along(rows, first, last, [](const Point& at) { return at.speed_mean_rad_per_s; }), steps_.usual_s) {}

void SegmentInputs::add(std::size_t row, std::size_t next, MeanInputs& mean, const Ends& ends) {
  const double duration_s = recording_.time_s[next] - recording_.time_s[row];
  const double own_s = recording_.time_s[row + 1] - recording_.time_s[row];
  const bool lacks_rows =
      steps_.is_regular && std::lround(own_s / steps_.usual_s) > 1 && recording_.inputs != recording::InputConvention::linear;
  const bool speaks_of_end = lacks_rows && next == row + 1 && recording_.inputs == recording::InputConvention::previous_interval;
  const double unknown_s = duration_s - (lacks_rows ? steps_.usual_s : own_s);
  const std::size_t behind = speaks_of_end ? row : next;
  if (!(unknown_s > 0.0) || !rows_.is_known(behind)) {
    mean.add(filled(row), duration_s);
    ends(next);
    return;
  }
  mean.add(filled(row), duration_s - unknown_s);
  const bool speaks_from_before = speaks_of_end && row > 0 && rows_.is_known(row - 1);
  add_gap({row, next, lacks_rows, own_s, unknown_s, filled(speaks_from_before ? row - 1 : row), filled(behind)}, mean, ends);
}

void SegmentInputs::add_gap(const Gap& gap, MeanInputs& mean, const Ends& ends) {
  const Point always = always_known(gap);
  if (gap.lacks_rows) {
    add_middle(gap, always, gap.own_s - steps_.usual_s, mean);
  }
  const bool lacks_speed_only = !std::isnan(always.current_rms_A) && !std::isnan(always.input_power_W);
  for (std::size_t blank = gap.row + 1; blank < gap.next; ++blank) {
    const Point cells = rows_.at(blank);
    const double blank_s = recording_.time_s[blank + 1] - recording_.time_s[blank];
    if (lacks_speed_only) {
      ends(blank);
    }
    add_middle(gap, cells, blank_s, mean);
    if (lacks_speed_only) {
      add_uncertainty(gap, cells, blank_s, mean);
    }
  }
  if (!lacks_speed_only) {
    add_uncertainty(gap, always, gap.unknown_s, mean);
  }
  ends(gap.next);
}

void SegmentInputs::add_middle(const Gap& gap, const Point& cells, double middle_s, MeanInputs& mean) const {
  Point first_half = gap.before, second_half = gap.after;
  if (recording_.inputs == recording::InputConvention::linear) {
    const double from_A = gap.before.current_rms_A, to_A = gap.after.current_rms_A;
    first_half.current_rms_A = second_half.current_rms_A = std::sqrt((from_A * from_A + from_A * to_A + to_A * to_A) / 3.0);
  }
  mean.add(with_cells(first_half, cells), 0.5 * middle_s);
  mean.add(with_cells(second_half, cells), 0.5 * middle_s);
}

/// Adds the uncertainty of a gap: the inputs may change at any time within it, or more often than the rows around it show.
void SegmentInputs::add_uncertainty(const Gap& gap, const Point& cells, double uncertain_s, MeanInputs& mean) {
  const auto lost_rows = static_cast<std::size_t>(std::lround(gap.unknown_s / steps_.usual_s));
  const GapStatistics& of_current = square_A2_.over(lost_rows);
  const GapStatistics& of_speed = speed_rad_per_s_.over(lost_rows);
  const Point from = with_cells(gap.before, cells);
  mean.add_uncertainty(from, with_cells(gap.after, cells), std::max(of_current.step_share, of_speed.step_share) * uncertain_s);
  Point burst = from;
  burst.current_rms_A = std::sqrt(square_A2(from) + (std::isnan(cells.current_rms_A) ? of_current.beyond_sd : 0.0));
  burst.speed_mean_rad_per_s += std::isnan(cells.speed_mean_rad_per_s) ? of_speed.beyond_sd : 0.0;
  mean.add_uncertainty(from, burst, uncertain_s);
}

thermal::OperatingPoint<double> SegmentInputs::always_known(const Gap& gap) const {
  Point always = gap.lacks_rows ? nowhere() : rows_.at(gap.row + 1);
  for (std::size_t blank = gap.row + 1; blank < gap.next; ++blank) {
    const Point cells = rows_.at(blank);
    thermal::for_each_quantity([](double& all, const double& cell) { all = std::isnan(cell) ? base::kUnknown : all; }, always, cells);
  }
  return always;
}

thermal::OperatingPoint<double> SegmentInputs::filled(std::size_t row) const {
  Point at = rows_.at(row);
  thermal::for_each_quantity([](double& value) { value = std::isnan(value) ? 0.0 : value; }, at);
  return at;
}

}  // namespace heatsoak::estimation
