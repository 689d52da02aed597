#include "derate/current_table.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "motor/datasheet_network.h"

namespace heatsoak {
namespace {

/// Where the winding is above its limit all the same (a restart, hotter air than declared) the current fades out instead of chattering.
constexpr double kFadeOut_K = 1.0;
constexpr double kFirstStep_K = 1.0;  ///< of an axis, below its limit

class Barrier {
 public:
  Barrier(const Observer& observer, const BarrierRules& rules)
      : rules_(rules),
        cases_(hot_cases(observer, rules)),
        rates_(observer.formula(), observer.rate_steps()),
        inputs_(firmware::kSignalCount + observer.state_count()),
        rate_(observer.state_count()) {}

  double current_A(double speed_rad_per_s, double stator_C, double winding_C) {
    if (holds(rules_.most_current_A, speed_rad_per_s, stator_C, winding_C)) {
      return rules_.most_current_A;
    }
    constexpr int kHalvings = 18;
    double low_A = 0.0;
    double high_A = rules_.most_current_A;
    if (!holds(low_A, speed_rad_per_s, stator_C, winding_C)) {
      return 0.0;
    }
    for (int i = 0; i < kHalvings; ++i) {
      const double middle_A = 0.5 * (low_A + high_A);
      (holds(middle_A, speed_rad_per_s, stator_C, winding_C) ? low_A : high_A) = middle_A;
    }
    return low_A;
  }

 private:
  bool holds(double current_A, double speed_rad_per_s, double stator_C, double winding_C) {
    const TemperatureLimits& limits = rules_.limits;
    return std::ranges::all_of(cases_, [&](const HotCase& each) {
      const Signals signals = each.signals(rules_, current_A, speed_rad_per_s);
      find_rates(signals, stator_C, winding_C);
      const double winding_K_per_s = rate_[states::winding];
      if (!(winding_K_per_s <= (limits.winding_C - winding_C) / rules_.approach_s)) {
        return false;
      }
      if (!limits.stator_C) {
        return true;
      }
      find_rates(signals, stator_C, winding_C + rules_.approach_s * winding_K_per_s);
      return rate_[states::stator] <= (*limits.stator_C - stator_C) / rules_.stator_approach_s;
    });
  }

  void find_rates(const Signals& signals, double stator_C, double winding_C) {
    std::ranges::copy(signals, inputs_.begin());
    std::fill(inputs_.begin() + firmware::kSignalCount, inputs_.end(), stator_C);
    inputs_[firmware::kSignalCount + states::winding] = winding_C;
    rates_.run(inputs_, rate_);
  }

  const BarrierRules& rules_;
  std::vector<HotCase> cases_;
  FormulaRun<double> rates_;
  std::vector<double> inputs_;
  std::vector<double> rate_;
};

/// Close together where the current falls, near the limit; the last place is where it has faded out.
std::vector<double> axis_C(double coldest_C, double limit_C) {
  std::vector<double> points{limit_C, limit_C + kFadeOut_K};
  for (double step_K = kFirstStep_K; limit_C - step_K > coldest_C; step_K *= 2.0) {
    points.push_back(limit_C - step_K);
  }
  points.push_back(std::min(coldest_C, limit_C - 2.0 * kFirstStep_K));
  std::ranges::sort(points);
  return points;
}

/// With a stator's limit the current may fall anywhere: where the winding is as hot as that stator bears.
std::vector<double> winding_axis_C(const BarrierRules& rules) {
  constexpr double kEven_K = 2.0;
  if (!rules.limits.stator_C) {
    return axis_C(rules.hottest_ambient_C, rules.limits.winding_C);
  }
  const double span_K = rules.limits.winding_C - rules.hottest_ambient_C;
  std::vector<double> points =
      evenly(rules.limits.winding_C - std::max(span_K, kEven_K), rules.limits.winding_C, 2 + static_cast<int>(span_K / kEven_K));
  points.push_back(rules.limits.winding_C + kFadeOut_K);
  return points;
}

/// Without a limit of its own the stator is never hotter than the winding's.
std::vector<double> stator_axis_C(const BarrierRules& rules) {
  constexpr int kStators = 8;
  return rules.limits.stator_C ? axis_C(rules.hottest_ambient_C, std::min(*rules.limits.stator_C, rules.limits.winding_C))
                               : evenly(std::min(rules.hottest_ambient_C, rules.limits.winding_C - 1.0), rules.limits.winding_C, kStators);
}

/// Two places of an axis and how far between them.
template <class Number>
struct Between {
  std::size_t below = 0;
  std::size_t above = 0;
  Number share{0};
};

/// Nothing above the last place, and for what is not a number.
template <class Number>
std::optional<Between<Number>> between(const std::vector<double>& axis, Number x) {
  if (!(x <= static_cast<Number>(axis.back()))) {
    return std::nullopt;
  }
  std::size_t above = 1;
  while (above + 1 < axis.size() && x > static_cast<Number>(axis[above])) {
    ++above;
  }
  const auto low = static_cast<Number>(axis[above - 1]);
  const auto high = static_cast<Number>(axis[above]);
  return Between<Number>{above - 1, above, x > low ? (x - low) / (high - low) : Number{0}};
}

/// Makes the corners of a cell smaller until nothing inside it allows too much; whether there was anything to do.
bool keep_below_barrier(CurrentTable& table, Barrier& barrier, std::size_t speed, std::size_t stator, std::size_t winding) {
  double ratio = 1.0;
  for (const double a : {0.25, 0.5, 0.75}) {
    for (const double b : {0.25, 0.5, 0.75}) {
      for (const double c : {0.25, 0.5, 0.75}) {
        const double speed_rad_per_s = std::lerp(table.speed_rad_per_s[speed], table.speed_rad_per_s[speed + 1], a);
        const double stator_C = std::lerp(table.stator_C[stator], table.stator_C[stator + 1], b);
        const double winding_C = std::lerp(table.winding_C[winding], table.winding_C[winding + 1], c);
        const double shown_A = table.allowed_A(speed_rad_per_s, stator_C, winding_C);
        if (shown_A > 0.0) {
          ratio = std::min(ratio, barrier.current_A(speed_rad_per_s, stator_C, winding_C) / shown_A);
        }
      }
    }
  }
  constexpr double kRounding = 1e-4;
  if (ratio >= 1.0 - kRounding) {
    return false;
  }
  for (std::size_t corner = 0; corner < 8; ++corner) {
    table.current_A[table.place(speed + (corner & 1U), stator + ((corner >> 1U) & 1U), winding + ((corner >> 2U) & 1U))] *= ratio;
  }
  return true;
}

}  // namespace

template <class Number>
Number CurrentTable::allowed_A(Number speed, Number stator, Number winding) const {
  const auto at_speed = between(speed_rad_per_s, speed);
  const auto at_stator = between(stator_C, stator);
  const auto at_winding = between(winding_C, winding);
  if (!at_speed || !at_stator || !at_winding) {
    return Number{0};
  }
  const auto along_winding = [&](std::size_t i, std::size_t j) {
    const auto low = static_cast<Number>(current_A[place(i, j, at_winding->below)]);
    const auto high = static_cast<Number>(current_A[place(i, j, at_winding->above)]);
    return low + at_winding->share * (high - low);
  };
  const auto along_stator = [&](std::size_t i) {
    const Number low = along_winding(i, at_stator->below);
    const Number high = along_winding(i, at_stator->above);
    return low + at_stator->share * (high - low);
  };
  const Number low = along_stator(at_speed->below);
  const Number high = along_stator(at_speed->above);
  return low + at_speed->share * (high - low);
}

template float CurrentTable::allowed_A<float>(float, float, float) const;
template double CurrentTable::allowed_A<double>(double, double, double) const;

double barrier_current_A(const Observer& observer, const BarrierRules& rules, double speed_rad_per_s, double stator_C, double winding_C) {
  return Barrier(observer, rules).current_A(speed_rad_per_s, stator_C, winding_C);
}

CurrentTable current_table(const Observer& observer, const BarrierRules& rules) {
  constexpr int kSpeeds = 7;
  CurrentTable table{.speed_rad_per_s = evenly(0.0, rules.most_speed_rad_per_s, kSpeeds),
                     .stator_C = stator_axis_C(rules),
                     .winding_C = winding_axis_C(rules),
                     .current_A = {}};
  table.speed_rad_per_s.push_back(std::max(kSpeedFadeOut_ratio * rules.most_speed_rad_per_s, rules.no_current_speed_rad_per_s));
  Barrier barrier(observer, rules);
  for (const double speed_rad_per_s : table.speed_rad_per_s) {
    for (const double stator_C : table.stator_C) {
      for (const double winding_C : table.winding_C) {
        const bool is_above = speed_rad_per_s > rules.most_speed_rad_per_s || winding_C > rules.limits.winding_C ||
                              (rules.limits.stator_C && stator_C > *rules.limits.stator_C);
        table.current_A.push_back(is_above ? 0.0 : barrier.current_A(speed_rad_per_s, stator_C, winding_C));
      }
    }
  }
  const std::size_t stators_end = rules.limits.stator_C ? 2 : 1;  // what fades out is no cell of the barrier
  constexpr int kMostPasses = 20;
  bool changed = true;
  for (int pass = 0; changed && pass < kMostPasses; ++pass) {
    changed = false;
    for (std::size_t i = 0; i + 1 < table.speed_rad_per_s.size(); ++i) {
      for (std::size_t j = 0; j + stators_end < table.stator_C.size(); ++j) {
        for (std::size_t k = 0; k + 2 < table.winding_C.size(); ++k) {
          changed = keep_below_barrier(table, barrier, i, j, k) || changed;
        }
      }
    }
  }
  for (double& current_A : table.current_A) {
    const auto nearest = static_cast<float>(current_A);
    current_A = nearest > current_A ? std::nextafter(nearest, 0.0F) : nearest;
  }
  return table;
}

}  // namespace heatsoak
