// Operating point of the machine: every number that a thermal law may depend on. The table of these numbers is base/signal_table.h.
#pragma once

#include <array>
#include <limits>
#include <string_view>
#include <utility>

#include "base/signals.h"

namespace heatsoak::thermal {

using base::AveragingRule;
using base::FirmwareInput;
using base::FromColumn;
using base::kSignalCount;
using base::Signal;
using base::WithoutPower;
using base::WorstCase;

/// Set of optional quantities: bit `row` stands for that row of kQuantities.
using QuantitySet = unsigned;
/// Largest number of log columns that the curves of one motor can use.
inline constexpr std::size_t kLogColumns = 3;

/// One number for each row of base/signal_table.h, which has their meaning. They are means over one interval, chosen so that intervals can
/// be merged without changing the heat: I²R uses the RMS current, a loss ∝ |ω| the mean speed, one ∝ ω² the RMS speed. Products such as
/// |I|·ω² use the product of the means. That is accurate if the interval is short compared with load changes, like the rows of a log. A
/// quantity that is not measured keeps its default.
template <class S>
struct OperatingPoint {
  using Scalar = S;

#define HEATSOAK_SIGNAL(name, member, default_value, ...) S member = S(default_value);
#include "base/signal_table.h"
  QuantitySet known = 0;  ///< optional quantities that are known, equal for all samples of Lanes; see set_quantity()

  [[nodiscard]] constexpr bool knows(QuantitySet quantities) const { return (known & quantities) == quantities; }
};

/// A row of the table of signals with its member; S as in OperatingPoint.
template <class S>
struct OperatingQuantity : base::SignalRow {
  S OperatingPoint<S>::*value;
};

/// Every number of OperatingPoint, in its order.
template <class S, class P = OperatingPoint<S>>
inline constexpr std::array kQuantities{
#define HEATSOAK_SIGNAL(row_name, member, ...) OperatingQuantity<S>{base::kSignals[base::signal_row(#row_name)], &P::member},
#include "base/signal_table.h"
};

inline constexpr std::size_t kQuantityCount = base::kSignals.size();

/// Returns the index of a quantity in the table; kQuantityCount if there is none of that name.
constexpr std::size_t quantity_row(std::string_view name) { return base::signal_row(name); }

/// Returns the bit of a quantity in OperatingPoint::known; 0 if it is not optional.
constexpr QuantitySet known_bit(std::size_t row) { return kQuantities<double>[row].is_optional ? QuantitySet{1} << row : 0; }
static_assert(kQuantityCount <= std::numeric_limits<QuantitySet>::digits, "one bit for each row");

inline constexpr QuantitySet kNeighbour = known_bit(quantity_row("neighbour_temperature"));

/// Row of a column of the log; `place` is below kLogColumns.
constexpr std::size_t column_row(std::size_t place) {
  constexpr std::size_t kFirst = quantity_row("first_column");
  return kFirst + place;
}
constexpr QuantitySet column_bit(std::size_t place) { return known_bit(column_row(place)); }
static_assert(quantity_row("third_column") == column_row(kLogColumns - 1) && column_bit(0) != 0 && kNeighbour != 0);

/// Sets a quantity of the table and, if it is optional, its bit in `known`. Code that fills an operating point sets each optional quantity
/// with this function: a law ignores a value without its bit.
template <class S, class V>
constexpr void set_quantity(OperatingPoint<S>& at, std::size_t row, const V& value) {
  at.*kQuantities<S>[row].value = value;
  at.known |= known_bit(row);
}

/// Returns the row with the log column of a signal.
constexpr const OperatingQuantity<double>& quantity_of(Signal signal) {
  return kQuantities<double>[quantity_row(base::row_of(signal).name)];
}

/// Calls f for each quantity, with that quantity of all given points as arguments.
template <class F, class... Point>
constexpr void for_each_quantity(F&& f, Point&... at) {
  const auto one = [&]<std::size_t i>() { f(at.*(kQuantities<typename Point::Scalar>[i].value)...); };
  [&]<std::size_t... i>(std::index_sequence<i...>) { (one.template operator()<i>(), ...); }
  (std::make_index_sequence<kQuantityCount>());
}

/// Calls assign(target, source) for each quantity of the two points, and copies which optional quantities are known.
template <class F, class To, class From>
constexpr void convert_point(F&& assign, To& to, const From& from) {
  for_each_quantity(std::forward<F>(assign), to, from);
  to.known = from.known;
}

}  // namespace heatsoak::thermal
