#include "derate/sampled_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>

#include "derate/observer.h"

namespace heatsoak::derate {
namespace {

/// Returns the breakpoints with points at most `step` apart, and points at these distances below the end.
std::vector<double> sampled(const std::vector<double>& axis, double step, std::initializer_list<double> near) {
  std::vector<double> points = axis;
  for (std::size_t i = 1; i < axis.size(); ++i) {
    const auto parts = static_cast<int>(std::ceil((axis[i] - axis[i - 1]) / step));
    for (const double point : evenly(axis[i - 1], axis[i], parts + 1)) {
      points.push_back(0.01 * std::round(100.0 * point));
    }
  }
  for (const double away : near) {
    points.push_back(axis.back() - away);
  }
  std::erase_if(points, [&](double point) { return point < axis.front() || point > axis.back(); });
  std::ranges::sort(points);
  constexpr double kSame = 0.02;
  // Breakpoints stay, because the slope of the current changes there.
  std::vector<double> apart;
  for (const double point : points) {
    const bool is_kept = std::ranges::find(axis, point) != axis.end();
    if (!apart.empty() && point - apart.back() < kSame) {
      apart.back() = is_kept ? point : apart.back();
    } else {
      apart.push_back(point);
    }
  }
  return apart;
}

/// SampleCell between neighbouring samples; its corners in binary order of speed, stator and winding.
struct SampleCell {
  std::array<std::size_t, 8> corner{};
  std::array<std::array<double, 2>, 3> end{};  ///< low and high end of each axis
  int parts = 4;                               ///< intervals per axis between points that are compared with the table
};

class Sampling {
 public:
  Sampling(const CurrentTable& table, double limit_C) : table_(table) {
    result_.speed_rad_per_s = table.speed_rad_per_s;
    for (const double last_rad_per_s : {table.most_speed_rad_per_s, table.no_current_speed_rad_per_s}) {
      if (last_rad_per_s > result_.speed_rad_per_s.back()) {
        result_.speed_rad_per_s.push_back(last_rad_per_s);
      }
    }
    constexpr double kStatorSteps = 10.0;
    constexpr double kWindingSteps = 30.0;
    const auto step = [](const std::vector<double>& axis, double steps) { return (axis.back() - axis.front()) / steps; };
    result_.stator_C = sampled(table.stator_C, std::max(1.0, step(table.stator_C, kStatorSteps)), {0.5, 1.0, 2.0, 4.0, 8.0});
    std::vector<double> below_limit_C = table.winding_C;
    std::erase_if(below_limit_C, [&](double each_C) { return each_C >= limit_C; });
    below_limit_C.push_back(limit_C);
    result_.winding_C = sampled(below_limit_C, std::max(1.0, step(below_limit_C, kWindingSteps)), {0.25, 0.5, 1.0, 2.0});
    for (const double speed_rad_per_s : result_.speed_rad_per_s) {
      for (const double stator_C : result_.stator_C) {
        for (const double winding_C : result_.winding_C) {
          result_.current_A.push_back(table.allowed_A(speed_rad_per_s, stator_C, winding_C));
        }
      }
    }
    list_cells();
  }

  SampledTable lowered() {
    // Ends, because each round lowers a current by at least kRounding_A or to 0, and none becomes negative.
    bool has_lowered = true;
    while (has_lowered) {
      has_lowered = false;
      for (const SampleCell& cell : cells_) {
        for_each_point(cell, [&](double exact_A, double shown_A, const std::array<double, 8>& weight) {
          if (shown_A > exact_A + kRounding_A) {
            lower(cell, shown_A - exact_A, exact_A > 0.0, weight);
            has_lowered = true;
          }
        });
      }
    }
    constexpr double kPerAmpere = 1e5;
    for (double& current_A : result_.current_A) {
      current_A = std::max(0.0, std::floor(kPerAmpere * current_A) / kPerAmpere);
    }
    for (const SampleCell& cell : cells_) {
      for_each_point(cell, [&](double exact_A, double shown_A, const std::array<double, 8>& /*weight*/) {
        if (exact_A >= kCounted_ratio * table_.straight_below_A) {
          result_.shortfall_ratio = std::max(result_.shortfall_ratio, 1.0 - shown_A / exact_A);
        }
      });
    }
    return result_;
  }

 private:
  void list_cells() {
    const std::array axes{&result_.speed_rad_per_s, &result_.stator_C, &result_.winding_C};
    const auto cells_of = [](const std::vector<double>& axis) { return std::max<std::size_t>(1, axis.size() - 1); };
    for (std::size_t i = 0; i < cells_of(*axes[0]); ++i) {
      for (std::size_t j = 0; j < cells_of(*axes[1]); ++j) {
        for (std::size_t k = 0; k < cells_of(*axes[2]); ++k) {
          SampleCell& cell = cells_.emplace_back();
          const std::array low{i, j, k};
          const auto high = [&](std::size_t axis) { return std::min(low.at(axis) + 1, axes.at(axis)->size() - 1); };
          for (std::size_t which = 0; which < cell.corner.size(); ++which) {
            const auto at = [&](std::size_t axis) { return (which >> (2 - axis)) & 1U ? high(axis) : low.at(axis); };
            cell.corner.at(which) = (at(0) * axes[1]->size() + at(1)) * axes[2]->size() + at(2);
          }
          for (std::size_t axis = 0; axis < axes.size(); ++axis) {
            cell.end.at(axis) = {(*axes.at(axis))[low.at(axis)], (*axes.at(axis))[high(axis)]};
          }
          // The current may reach 0 inside of the cell, where it has an edge.
          constexpr int kPartsAtEdge = 8;
          cell.parts = result_.current_A[cell.corner.back()] == 0.0 ? kPartsAtEdge : cell.parts;
        }
      }
    }
  }

  /// Calls visit(table's current, interpolated current, weights of the corners) for the points of a grid in the cell.
  template <class Visit>
  void for_each_point(const SampleCell& cell, const Visit& visit) const {
    const auto parts = [&](std::size_t axis) { return cell.end.at(axis)[1] > cell.end.at(axis)[0] ? cell.parts : 0; };
    for (int i = 0; i <= parts(0); ++i) {
      for (int j = 0; j <= parts(1); ++j) {
        for (int k = 0; k <= parts(2); ++k) {
          const std::array share{static_cast<double>(i) / cell.parts, static_cast<double>(j) / cell.parts,
                                 static_cast<double>(k) / cell.parts};
          const auto along = [&](std::size_t axis) { return std::lerp(cell.end.at(axis)[0], cell.end.at(axis)[1], share.at(axis)); };
          std::array<double, 8> weight{};
          double shown_A = 0.0;
          for (std::size_t which = 0; which < weight.size(); ++which) {
            const auto of = [&](std::size_t axis) { return (which >> (2 - axis)) & 1U ? share.at(axis) : 1.0 - share.at(axis); };
            weight.at(which) = of(0) * of(1) * of(2);
            shown_A += weight.at(which) * result_.current_A[cell.corner.at(which)];
          }
          visit(table_.allowed_A(along(0), along(1), along(2)), shown_A, weight);
        }
      }
    }
  }

  /// Lowers the corners that act on a point by what the point exceeds the table; to 0 if the table is 0 there.
  void lower(const SampleCell& cell, double excess_A, bool is_positive, const std::array<double, 8>& weight) {
    double acting = 0.0;
    for (std::size_t which = 0; which < weight.size(); ++which) {
      acting += result_.current_A[cell.corner.at(which)] > 0.0 ? weight.at(which) : 0.0;
    }
    for (std::size_t which = 0; which < weight.size(); ++which) {
      if (weight.at(which) > 0.0) {
        double& current_A = result_.current_A[cell.corner.at(which)];
        current_A = is_positive ? std::max(0.0, current_A - excess_A / acting) : 0.0;
      }
    }
  }

  static constexpr double kRounding_A = 1e-7;

  const CurrentTable& table_;
  SampledTable result_;
  std::vector<SampleCell> cells_;
};

}  // namespace

SampledTable sampled_table(const CurrentTable& table, double limit_C) { return Sampling(table, limit_C).lowered(); }

}  // namespace heatsoak::derate
