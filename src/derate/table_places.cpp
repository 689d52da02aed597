#include "derate/table_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "derate/exact_grid.h"

namespace heatsoak::derate {
namespace {

/// Rule by which a table turns squares into currents.
struct CurrentRule {
  double straight_below_A = 0.0;
  double most_current_A = 0.0;

  /// Negative for a negative square, so that tables which allow nothing can be ranked. Not clamped until 1.1 times the most current, so
  /// that the point between two grid points at which the most current is reached influences the shortfall.
  [[nodiscard]] double current_A(double square_A2) const {
    const double straight_A2 = straight_below_A * straight_below_A;
    constexpr double kBeyond_ratio = 1.1;
    return std::min(kBeyond_ratio * most_current_A, square_A2 < straight_A2 ? square_A2 / straight_below_A : std::sqrt(square_A2));
  }
};

/// Returns the exact current of every grid point, 0 where a shortfall does not count: above the limit, and below the straight part.
std::vector<double> counted_currents_A(const ExactGrid& grid, const CurrentRule& rule) {
  std::vector<double> all;
  const std::size_t windings = grid.points[winding].size();
  for (std::size_t place = 0; place < grid.heat_A2.size(); ++place) {
    const double square_A2 = grid.square_A2(place);
    const bool counts = place % windings <= grid.limit && square_A2 >= rule.straight_below_A * rule.straight_below_A;
    all.push_back(counts ? rule.current_A(square_A2) : 0.0);
  }
  return all;
}

/// Part of an axis between two neighbouring breakpoints, or the whole axis if it has one breakpoint.
struct Segment {
  std::size_t low = 0;  ///< index of the first grid point
  std::size_t high = 0;
  std::vector<double> share;  ///< position of each point from low to high: 0 at low, 1 at high
};

std::vector<Segment> segments(const std::vector<std::size_t>& places, const std::vector<double>& points) {
  std::vector<Segment> all;
  const auto add = [&](std::size_t low, std::size_t high) {
    Segment& each = all.emplace_back(low, high);
    for (std::size_t point = low; point <= high; ++point) {
      each.share.push_back(high > low ? (points[point] - points[low]) / (points[high] - points[low]) : 0.0);
    }
  };
  if (places.size() == 1) {
    add(0, points.size() - 1);
  }
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    add(places[i], places[i + 1]);
  }
  return all;
}

/// Heats at chosen breakpoints of the grid, lowered so that the interpolation never exceeds the grid; and their shortfall.
class Fit {
 public:
  /// `counted_A`: counted_currents_A() of grid and rule. The search for the shortfall ends once it exceeds `of_no_use_ratio`.
  Fit(const ExactGrid& grid, const CurrentRule& rule, const std::vector<double>& counted_A, Places places, double of_no_use_ratio)
      : places_(std::move(places)) {
    for (const std::size_t i : places_[speed]) {
      for (const std::size_t j : places_[stator]) {
        for (const std::size_t k : places_[winding]) {
          heat_A2_.push_back(grid.heat_A2[grid.place({i, j, k})]);
        }
      }
    }
    std::array<std::vector<Segment>, kAxes> parts;
    for (const Axis axis : {speed, stator, winding}) {
      parts.at(axis) = segments(places_.at(axis), grid.points.at(axis));
    }
    for_each_cell(parts, [&](const Index& cell, const Cell& at) { lower(grid, cell, at); });
    for_each_cell(parts, [&](const Index& cell, const Cell& at) {
      if (shortfall_ratio_ <= of_no_use_ratio) {
        find_shortfall(grid, rule, counted_A, cell, at);
      }
    });
  }

  [[nodiscard]] const Places& places() const { return places_; }
  [[nodiscard]] const std::vector<double>& heat_A2() const { return heat_A2_; }
  [[nodiscard]] double shortfall_ratio() const { return shortfall_ratio_; }
  [[nodiscard]] const Index& worst() const { return worst_; }
  [[nodiscard]] std::size_t number_count() const {
    return places_[speed].size() + places_[stator].size() + places_[winding].size() + heat_A2_.size();
  }

 private:
  using Cell = std::array<const Segment*, kAxes>;

  template <class Visit>
  static void for_each_cell(const std::array<std::vector<Segment>, kAxes>& parts, const Visit& visit) {
    for (std::size_t i = 0; i < parts[speed].size(); ++i) {
      for (std::size_t j = 0; j < parts[stator].size(); ++j) {
        for (std::size_t k = 0; k < parts[winding].size(); ++k) {
          visit(Index{i, j, k}, Cell{&parts[speed][i], &parts[stator][j], &parts[winding][k]});
        }
      }
    }
  }

  /// Calls visit(place in the grid, interpolated heat, index) for all grid points of a cell.
  template <class Visit>
  void for_each_point(const ExactGrid& grid, const std::array<std::size_t, 8>& corner, const Cell& at, const Visit& visit) const {
    const Segment& along_winding = *at[winding];
    for (std::size_t i = at[speed]->low; i <= at[speed]->high; ++i) {
      const double speed_share = at[speed]->share[i - at[speed]->low];
      for (std::size_t j = at[stator]->low; j <= at[stator]->high; ++j) {
        const double stator_share = at[stator]->share[j - at[stator]->low];
        const std::size_t first = grid.place({i, j, 0});
        for (std::size_t k = along_winding.low; k <= along_winding.high; ++k) {
          const double winding_share = along_winding.share[k - along_winding.low];
          const auto along = [&](std::size_t from) {
            return heat_A2_[corner[from]] + winding_share * (heat_A2_[corner[from + 1]] - heat_A2_[corner[from]]);
          };
          const double first_A2 = along(0);
          const double low_A2 = first_A2 + stator_share * (along(2) - first_A2);
          const double third_A2 = along(4);
          const double high_A2 = third_A2 + stator_share * (along(6) - third_A2);
          visit(first + k, low_A2 + speed_share * (high_A2 - low_A2), Index{i, j, k});
        }
      }
    }
  }

  /// Indices of the heats at the corners of a cell; neighbours along the winding are adjacent. Repeated on an axis with one breakpoint.
  [[nodiscard]] std::array<std::size_t, 8> corners(const Index& cell) const {
    std::array<std::size_t, 8> places{};
    for (std::size_t which = 0; which < places.size(); ++which) {
      const auto along = [&](Axis axis, std::size_t bit) { return cell[axis] + (places_[axis].size() > 1 ? (which >> bit) & 1U : 0U); };
      places.at(which) = (along(speed, 2) * places_[stator].size() + along(stator, 1)) * places_[winding].size() + along(winding, 0);
    }
    return places;
  }

  /// Lowers the corners of a cell by the largest excess over the exact heats in it.
  void lower(const ExactGrid& grid, const Index& cell, const Cell& at) {
    std::array<std::size_t, 8> corner = corners(cell);
    double excess_A2 = 0.0;
    for_each_point(grid, corner, at, [&](std::size_t place, double heat_A2, const Index& /*point*/) {
      excess_A2 = std::max(excess_A2, heat_A2 - grid.heat_A2[place]);
    });
    std::ranges::sort(corner);
    const auto end = std::unique(corner.begin(), corner.end());
    std::for_each(corner.begin(), end, [&](std::size_t each) { heat_A2_[each] -= excess_A2; });
  }

  void find_shortfall(const ExactGrid& grid, const CurrentRule& rule, const std::vector<double>& counted_A, const Index& cell,
                      const Cell& at) {
    const double straight_A2 = rule.straight_below_A * rule.straight_below_A;
    constexpr double kRounding_ratio = 1.0 + 1e-9;
    const auto least_square_ratio = [&] {
      const double kept_ratio = std::max(0.0, 1.0 - shortfall_ratio_);
      return kRounding_ratio * kept_ratio * kept_ratio;
    };
    double least_ratio = least_square_ratio();
    for_each_point(grid, corners(cell), at, [&](std::size_t place, double heat_A2, const Index& point) {
      const double square_A2 = heat_A2 * grid.square_per_heat_ratio[point[winding]];
      // Most points are better than the worst one so far, which their squares show without a root.
      if (counted_A[place] == 0.0 || square_A2 >= std::max(straight_A2, least_ratio * counted_A[place] * counted_A[place])) {
        return;
      }
      const double short_ratio = 1.0 - rule.current_A(square_A2) / counted_A[place];
      if (short_ratio > shortfall_ratio_) {
        shortfall_ratio_ = short_ratio;
        least_ratio = least_square_ratio();
        worst_ = point;
      }
    });
  }

  Places places_;
  std::vector<double> heat_A2_;
  double shortfall_ratio_ = 0.0;
  Index worst_{};
};

/// Returns the breakpoints with one more, the free grid point nearest to `wanted`; unchanged if none is free.
std::vector<std::size_t> with_place(std::vector<std::size_t> places, std::size_t points, std::size_t wanted) {
  if (places.size() == 1 && points > 1) {
    return {0, points - 1};  // an axis without influence gets both ends
  }
  for (std::size_t away = 0; away < points; ++away) {
    for (const std::size_t point : {wanted + away, wanted - away}) {
      if (point < points && !std::ranges::binary_search(places, point)) {
        places.insert(std::ranges::upper_bound(places, point), point);
        return places;
      }
    }
  }
  return places;
}

double three_digits(double positive) {
  const double unit = std::pow(10.0, std::floor(std::log10(positive)) - 2.0);
  return static_cast<float>(unit * std::round(positive / unit));
}

/// Adds breakpoints until the goal is reached.
class Search {
 public:
  Search(const ExactGrid& grid, const BarrierRules& rules, const TableGoal& goal) : grid_(grid), goal_(goal) {
    double hottest_A2 = 0.0;
    for (std::size_t j = 0; j < grid.points[stator].size(); ++j) {
      hottest_A2 = std::max(hottest_A2, grid.square_A2(grid.place({0, j, grid.limit})));
    }
    constexpr double kShare = 1.0 / 3.0;
    constexpr double kLeast_share = 0.02;
    rule_ = {
        three_digits(std::max(kShare * std::min(2.0 * rules.most_current_A, std::sqrt(hottest_A2)), kLeast_share * rules.most_current_A)),
        rules.most_current_A};
    counted_A_ = counted_currents_A(grid, rule_);
  }

  [[nodiscard]] double straight_below_A() const { return rule_.straight_below_A; }

  [[nodiscard]] Fit best() const {
    // The current falls to 0 above the limit, so the table has an edge there.
    Fit fit = of({std::vector<std::size_t>{0}, {0}, {0, grid_.limit, grid_.points[winding].size() - 1}});
    while (fit.shortfall_ratio() > goal_.shortfall_ratio) {
      std::optional<Fit> next = refined(fit);
      if (!next) {
        break;
      }
      fit = std::move(*next);
    }
    return settled(reduced_to_size(without_idle_places(std::move(fit))));
  }

 private:
  [[nodiscard]] Fit of(Places places, double of_no_use_ratio = std::numeric_limits<double>::infinity()) const {
    return {grid_, rule_, counted_A_, std::move(places), of_no_use_ratio};
  }

  /// Tries one more breakpoint on each axis. Returns the fit that reduces the shortfall most per stored number; nothing if none fits.
  [[nodiscard]] std::optional<Fit> refined(const Fit& fit) const {
    std::optional<Fit> best;
    double best_gain = -std::numeric_limits<double>::infinity();
    for (const Axis axis : {winding, stator, speed}) {
      Places places = fit.places();
      places[axis] = with_place(places[axis], grid_.points[axis].size(), fit.worst()[axis]);
      if (places[axis].size() == fit.places()[axis].size()) {
        continue;
      }
      Fit tried = of(std::move(places));
      if (size_bytes(tried) > kOvershoot * goal_.most_bytes) {
        continue;
      }
      const double gain = std::log(fit.shortfall_ratio() / std::max(1e-9, tried.shortfall_ratio())) /
                          static_cast<double>(tried.number_count() - fit.number_count());
      if (gain > best_gain) {
        best_gain = gain;
        best.emplace(std::move(tried));
      }
    }
    return best;
  }

  [[nodiscard]] Fit without_idle_places(Fit fit) const {
    const double allowed_ratio = std::max(goal_.shortfall_ratio, fit.shortfall_ratio());
    for (const Axis axis : {speed, stator, winding}) {
      for (std::size_t i = 1; i + 1 < fit.places()[axis].size();) {
        Places places = fit.places();
        places[axis].erase(places[axis].begin() + static_cast<std::ptrdiff_t>(i));
        Fit tried = of(std::move(places), allowed_ratio);
        if (tried.shortfall_ratio() <= allowed_ratio) {
          fit = std::move(tried);
        } else {
          ++i;
        }
      }
    }
    return fit;
  }

  static std::size_t size_bytes(const Fit& fit) { return sizeof(float) * fit.number_count(); }

  /// Removes the breakpoint that increases the shortfall least until the table fits the size.
  [[nodiscard]] Fit reduced_to_size(Fit fit) const {
    while (size_bytes(fit) > goal_.most_bytes) {
      std::optional<Fit> best;
      for (const Axis axis : {winding, stator, speed}) {
        const std::vector<std::size_t>& places = fit.places()[axis];
        for (std::size_t i = 1; i + 1 < places.size(); ++i) {
          Places fewer = fit.places();
          fewer[axis].erase(fewer[axis].begin() + static_cast<std::ptrdiff_t>(i));
          keep_better(best, std::move(fewer));
        }
        if (places.size() == 2 && axis != winding) {
          Places fewer = fit.places();
          fewer[axis] = {0};
          keep_better(best, std::move(fewer));
        }
      }
      if (!best) {
        break;
      }
      fit = std::move(*best);
    }
    return fit;
  }

  /// Moves single breakpoints by up to four grid points while that reduces the shortfall. Does nothing if the goal is reached.
  [[nodiscard]] Fit settled(Fit fit) const {
    constexpr std::size_t kFurthest = 4;
    constexpr int kMostRounds = 20;
    bool has_moved = fit.shortfall_ratio() > goal_.shortfall_ratio;
    for (int round = 0; has_moved && round < kMostRounds; ++round) {
      has_moved = false;
      for (const Axis axis : {winding, stator, speed}) {
        for (std::size_t i = 1; i + 1 < fit.places()[axis].size(); ++i) {
          for (std::size_t point = fit.places()[axis][i] - std::min(kFurthest, fit.places()[axis][i]);
               point <= fit.places()[axis][i] + kFurthest; ++point) {
            Places moved = fit.places();
            if (point <= moved[axis][i - 1] || point >= moved[axis][i + 1]) {
              continue;
            }
            moved[axis][i] = point;
            if (Fit tried = of(std::move(moved), fit.shortfall_ratio()); tried.shortfall_ratio() < fit.shortfall_ratio()) {
              fit = std::move(tried);
              has_moved = true;
            }
          }
        }
      }
    }
    return fit;
  }

  void keep_better(std::optional<Fit>& best, Places places) const {
    Fit tried = best ? of(std::move(places), best->shortfall_ratio()) : of(std::move(places));
    if (!best || tried.shortfall_ratio() < best->shortfall_ratio()) {
      best.emplace(std::move(tried));
    }
  }

  /// Factor by which the size may exceed the goal while breakpoints are added; reduced_to_size() removes the surplus.
  static constexpr std::size_t kOvershoot = 4;

  const ExactGrid& grid_;
  const TableGoal& goal_;
  CurrentRule rule_;
  std::vector<double> counted_A_;
};

/// Writes axes, heats and shortfall of a fit to a table.
void write(const Fit& fit, const ExactGrid& grid, CurrentTable& table) {
  const std::array axes{&table.speed_rad_per_s, &table.stator_C, &table.winding_C};
  for (const Axis axis : {speed, stator, winding}) {
    axes.at(axis)->clear();
    for (const std::size_t place : fit.places()[axis]) {
      axes.at(axis)->push_back(grid.points[axis][place]);
    }
  }
  // The stator's axis keeps its end even with one breakpoint, because allowed_A() needs it.
  table.stator_C.back() = grid.points[stator].back();
  table.heat_per_ohm_A2 = fit.heat_A2();
  table.bound.shortfall_ratio = std::min(1.0, fit.shortfall_ratio());
}

/// Inverse of write(): an axis with one breakpoint has its first grid point.
Places places_of(const CurrentTable& table, const ExactGrid& grid) {
  const std::array axes{&table.speed_rad_per_s, &table.stator_C, &table.winding_C};
  Places places;
  for (const Axis axis : {speed, stator, winding}) {
    for (const double point : *axes.at(axis)) {
      const auto found = std::ranges::lower_bound(grid.points[axis], point);
      places[axis].push_back(axes.at(axis)->size() == 1 ? 0 : static_cast<std::size_t>(found - grid.points[axis].begin()));
    }
  }
  return places;
}

}  // namespace

HeatPlaces::HeatPlaces(const CurrentTable& table, Barrier& barrier, const BarrierRules& rules)
    : rules_(rules), grid_(std::make_unique<const ExactGrid>(exact_grid(table, barrier, rules))) {}

HeatPlaces::~HeatPlaces() = default;

void HeatPlaces::place(CurrentTable& table, const TableGoal& goal) const {
  const Search search(*grid_, rules_, goal);
  write(search.best(), *grid_, table);
  table.straight_below_A = search.straight_below_A();
}

void HeatPlaces::remove(CurrentTable& table, const std::function<bool(CurrentTable&)>& is_good) const {
  const CurrentRule rule{table.straight_below_A, rules_.most_current_A};
  const std::vector<double> counted_A = counted_currents_A(*grid_, rule);
  Places places = places_of(table, *grid_);
  const auto try_without = [&](Axis axis, std::size_t which) {
    Places fewer = places;
    fewer[axis].erase(fewer[axis].begin() + static_cast<std::ptrdiff_t>(which));
    CurrentTable tried = table;
    write({*grid_, rule, counted_A, fewer, std::numeric_limits<double>::infinity()}, *grid_, tried);
    const bool removes = is_good(tried);
    if (removes) {
      places = std::move(fewer);
      table = std::move(tried);
    }
    return removes;
  };
  for (const Axis axis : {speed, stator, winding}) {
    for (std::size_t i = 1; i + 1 < places[axis].size();) {
      i += try_without(axis, i) ? 0 : 1;
    }
    if (places[axis].size() == 2 && axis != winding) {
      try_without(axis, 1);
    }
  }
}

}  // namespace heatsoak::derate
