#include "derate/committed_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <regex>

#include "base/files.h"
#include "base/quantity.h"
#include "derate/exporter.h"
#include "derate/header_text.h"
#include "input/csv.h"

namespace heatsoak {
namespace {

constexpr std::size_t kLargestTable_bytes = 10'000'000;

int line_at(std::string_view text, std::size_t place) {
  return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(place), '\n'));
}

void require_ascending(const CommittedTable& committed, int line, std::string_view name, const std::vector<double>& axis,
                       std::size_t least_count) {
  const bool is_finite = std::ranges::all_of(axis, [](double each) { return std::isfinite(each); });
  if (axis.size() < least_count || !is_finite || std::ranges::adjacent_find(axis, std::greater_equal<>()) != axis.end()) {
    throw bad_input({committed.file.string(), line, 1}, std::string(name),
                    "the axis of the table does not ascend; expected a file that `heatsoak derate` wrote");
  }
}

Failure no_current(const CommittedTable& committed, int line) {
  return bad_input({committed.file.string(), line, 1}, "current", "the table holds a current that is none; expected numbers");
}

/// Throws where the table is none: an axis that does not ascend, a value that is not a number or cannot be.
void require_sound(const CommittedTable& committed, const CurrentTable& table, int line) {
  require_ascending(committed, line, "speed", table.speed_rad_per_s, 1);
  require_ascending(committed, line, "stator", table.stator_C, 1);
  require_ascending(committed, line, "winding", table.winding_C, 2);
  if (!std::ranges::all_of(table.square_A2, [](double each_A2) { return std::isfinite(each_A2); })) {
    throw no_current(committed, line);
  }
  if (!(table.most_current_A > 0.0) || !(table.straight_below_A > 0.0) || !(table.winding_per_stator_K >= 0.0) ||
      !(table.no_current_speed_rad_per_s > table.most_speed_rad_per_s)) {
    throw bad_input(
        {committed.file.string(), line, 1}, "",
        "MOST_CURRENT_A, STRAIGHT_BELOW_A, WINDING_PER_STATOR_K, MOST_SPEED_RAD_PER_S or NO_CURRENT_SPEED_RAD_PER_S is missing or "
        "cannot be; expected a header that `heatsoak derate` wrote");
  }
}

/// Of "#define …_NAME 1.5f"; not a number where there is none or several differ.
double constant(const std::string& text, std::string_view name) {
  const std::regex define(fmt::format("#define [A-Z0-9_]*_{} ([0-9.eE+-]+)f\n", name));
  double found = std::numeric_limits<double>::quiet_NaN();
  for (std::sregex_iterator each(text.begin(), text.end(), define); each != std::sregex_iterator(); ++each) {
    const double value = std::strtod((*each)[1].str().c_str(), nullptr);
    if (!std::isnan(found) && found != value) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    found = value;
  }
  return found;
}

/// The four arrays of the table; of the names that end alike, those that belong together.
void read_header(const std::string& text, CommittedTable& committed) {
  // A spliced line may hide code in a comment; `heatsoak derate` writes none.
  if (const std::size_t splice = std::min(text.find('\\'), text.find("?\?/")); splice != std::string::npos) {
    throw bad_input({committed.file.string(), line_at(text, splice), 1}, "",
                    "a backslash or the trigraph for it; expected a header that `heatsoak derate` wrote, which has none");
  }
  const std::vector<HeaderArray> arrays = header_arrays(text);
  const auto find = [&](const std::string& name) { return std::ranges::find(arrays, name, &HeaderArray::name); };
  constexpr std::string_view kSquare = "_square_A2";
  for (const HeaderArray& currents : arrays) {
    if (!currents.name.ends_with(kSquare)) {
      continue;
    }
    const std::string prefix = currents.name.substr(0, currents.name.size() - kSquare.size());
    const auto speeds = find(prefix + "_speed_rad_per_s");
    const auto stators = find(prefix + "_stator_C");
    const auto windings = find(prefix + "_winding_C");
    if (speeds == arrays.end() || stators == arrays.end() || windings == arrays.end()) {
      continue;
    }
    const int line = line_at(text, currents.begin);
    if (currents.values.size() != speeds->values.size() * stators->values.size() * windings->values.size()) {
      throw bad_input({committed.file.string(), line, 1}, currents.name,
                      fmt::format("holds {} currents; expected {} × {} × {} of them, as many as its axes have places",
                                  currents.values.size(), speeds->values.size(), stators->values.size(), windings->values.size()));
    }
    committed.table = {.speed_rad_per_s = speeds->values,
                       .stator_C = stators->values,
                       .winding_C = windings->values,
                       .square_A2 = currents.values,
                       .most_current_A = constant(text, "MOST_CURRENT_A"),
                       .straight_below_A = constant(text, "STRAIGHT_BELOW_A"),
                       .most_speed_rad_per_s = constant(text, "MOST_SPEED_RAD_PER_S"),
                       .no_current_speed_rad_per_s = constant(text, "NO_CURRENT_SPEED_RAD_PER_S"),
                       .winding_per_stator_K = constant(text, "WINDING_PER_STATOR_K")};
    committed.code = text;
    require_sound(committed, *committed.table, line);
    return;
  }
  throw bad_input({committed.file.string()}, "",
                  "holds no derating table; expected a C header or a CSV table that `heatsoak derate` wrote");
}

/// The values of a column, each once, ascending.
std::vector<double> axis_of(const std::vector<CommittedRow>& rows, double CommittedRow::*column) {
  std::vector<double> axis;
  std::ranges::transform(rows, std::back_inserter(axis), [column](const CommittedRow& row) { return row.*column; });
  std::ranges::sort(axis);
  axis.erase(std::unique(axis.begin(), axis.end()), axis.end());
  return axis;
}

void read_csv_table(CommittedTable& committed) {
  const std::array<std::string, 4> columns{"speed_rad_per_s", "stator_C", "winding_C", "allowed_current_A"};
  std::vector<CommittedRow>& rows = committed.rows;
  std::vector<int> lines;
  read_csv(committed.file, columns, {}, [&](const CsvRow& row) {
    rows.push_back({row.values[0], row.values[1], row.values[2], row.values[3]});
    lines.push_back(row.line);
  });
  const std::vector<double> speeds = axis_of(rows, &CommittedRow::speed_rad_per_s);
  const std::vector<double> stators = axis_of(rows, &CommittedRow::stator_C);
  const std::vector<double> windings = axis_of(rows, &CommittedRow::winding_C);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const CommittedRow& row = rows[i];
    const bool is_of_grid = i < speeds.size() * stators.size() * windings.size() &&
                            row.speed_rad_per_s == speeds[i / windings.size() / stators.size()] &&
                            row.stator_C == stators[i / windings.size() % stators.size()] && row.winding_C == windings[i % windings.size()];
    if (!is_of_grid) {
      throw bad_input({committed.file.string(), lines[i], 1}, "",
                      "the rows are no full grid of speed, stator and winding in this order; expected a file that `heatsoak derate` wrote");
    }
    if (!(row.current_A >= 0.0) || !std::isfinite(row.current_A)) {
      throw no_current(committed, lines[i]);
    }
  }
  if (rows.size() != speeds.size() * stators.size() * windings.size()) {
    throw bad_input({committed.file.string(), lines.back(), 1}, "", "rows of the grid are missing at the end of the table");
  }
  require_ascending(committed, 1, "winding", windings, 2);
}

/// Points that a file rounds are taken for those of the fresh axis: of an axis that ends there, one more digit would be no current.
std::vector<double> snapped(std::vector<double> axis, const std::vector<double>& fresh) {
  constexpr double kRounding_share = 1e-5;
  const double size = std::max(std::abs(fresh.front()), std::abs(fresh.back()));
  for (double& point : axis) {
    const double nearest = *std::ranges::min_element(fresh, {}, [&](double each) { return std::abs(each - point); });
    point = std::abs(nearest - point) <= kRounding_share * size ? nearest : point;
  }
  return axis;
}

/// The points of both, and just behind the end of each.
std::vector<double> joined(std::vector<double> one, const std::vector<double>& other) {
  for (const double end : {one.back(), other.back()}) {
    one.push_back(std::nextafter(end, std::numeric_limits<double>::infinity()));
  }
  one.insert(one.end(), other.begin(), other.end());
  std::ranges::sort(one);
  one.erase(std::unique(one.begin(), one.end()), one.end());
  return one;
}

/// Takes the place in where it is further apart than what was found, and further than rounding.
void take_in(TableComparison& found, const TablePlace& place, double tolerance_A) {
  TablePlace& worst = place.committed_A > place.fresh_A ? found.excess : found.lost;
  if (place.difference_A > std::max(tolerance_A, worst.difference_A)) {
    worst = place;
  }
}

void compare_tables(CurrentTable committed, const CurrentTable& fresh, double tolerance_A, TableComparison& found) {
  committed.speed_rad_per_s = snapped(std::move(committed.speed_rad_per_s), fresh.speed_rad_per_s);
  committed.stator_C = snapped(std::move(committed.stator_C), fresh.stator_C);
  committed.winding_C = snapped(std::move(committed.winding_C), fresh.winding_C);
  std::vector<double> speeds_rad_per_s = committed.speed_rad_per_s;
  for (const CurrentTable& each : {committed, fresh}) {
    speeds_rad_per_s.insert(speeds_rad_per_s.end(), {each.most_speed_rad_per_s, each.no_current_speed_rad_per_s});
  }
  std::ranges::sort(speeds_rad_per_s);
  // Beyond the stator's axis it counts as a hotter winding.
  constexpr double kHotter_K = 3.0;
  std::vector<double> stators_C = joined(committed.stator_C, fresh.stator_C);
  stators_C.push_back(stators_C.back() + kHotter_K);
  for (const double speed_rad_per_s : joined(speeds_rad_per_s, fresh.speed_rad_per_s)) {
    for (const double stator_C : stators_C) {
      for (const double winding_C : joined(committed.winding_C, fresh.winding_C)) {
        const double committed_A = committed.allowed_A(speed_rad_per_s, stator_C, winding_C);
        const double fresh_A = fresh.allowed_A(speed_rad_per_s, stator_C, winding_C);
        take_in(found, {std::abs(committed_A - fresh_A), committed_A, fresh_A, speed_rad_per_s, stator_C, winding_C}, tolerance_A);
      }
    }
  }
}

void compare_rows(const std::vector<CommittedRow>& rows, const CurrentTable& fresh, double tolerance_A, TableComparison& found) {
  for (const CommittedRow& row : rows) {
    const double fresh_A = fresh.allowed_A(row.speed_rad_per_s, row.stator_C, row.winding_C);
    take_in(found, {std::abs(row.current_A - fresh_A), row.current_A, fresh_A, row.speed_rad_per_s, row.stator_C, row.winding_C},
            tolerance_A);
  }
}

/// What rounding of the file may change.
double tolerance_A(const CommittedTable& committed, const CurrentTable& fresh) {
  constexpr double kRounding_share = 5e-4;
  double most_A = fresh.current_of_A(*std::ranges::max_element(fresh.square_A2));
  if (committed.table) {
    most_A = std::max(most_A, committed.table->current_of_A(*std::ranges::max_element(committed.table->square_A2)));
  }
  for (const CommittedRow& row : committed.rows) {
    most_A = std::max(most_A, row.current_A);
  }
  return kRounding_share * most_A;
}

std::string fresh_header(const Derating& fresh) {
  const std::vector<ExporterType>& all = all_exporters();
  return std::ranges::find(all, "c_header", &ExporterType::name)->write(fresh);
}

}  // namespace

CommittedTable read_committed_table(const std::filesystem::path& file) {
  CommittedTable committed{.file = file, .table = {}, .rows = {}, .version = {}, .code = {}};
  const std::string text = read_file(file, kLargestTable_bytes);
  static const std::regex kVersion(R"re((?:heatsoak |VERSION ")(\d+\.\d+\.\d+))re");
  std::smatch version;
  const std::string head = text.substr(0, 4000);
  if (std::regex_search(head, version, kVersion)) {
    committed.version = version[1];
  }
  if (text.find("static const float") != std::string::npos) {
    read_header(text, committed);
  } else {
    read_csv_table(committed);
  }
  return committed;
}

TableComparison compare(const CommittedTable& committed, const Derating& fresh) {
  TableComparison found;
  const double rounding_A = tolerance_A(committed, fresh.table);
  if (committed.table) {
    compare_tables(*committed.table, fresh.table, rounding_A, found);
  }
  compare_rows(committed.rows, fresh.table, rounding_A, found);
  if (!committed.code.empty()) {
    const HeaderDifference difference = first_difference(committed.code, fresh_header(fresh));
    found.differing_line = difference.line;
    found.differing_text = difference.text;
    found.differing_fresh_text = difference.other_text;
  }
  return found;
}

}  // namespace heatsoak
