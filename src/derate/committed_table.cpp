#include "derate/committed_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
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

/// Throws where the table is none: an axis that does not ascend, a current below 0 or that is no number.
void require_sound(const CommittedTable& committed, int line) {
  const CurrentTable& table = committed.table;
  const Location at{committed.file.string(), line, 1};
  for (const auto& [name, axis] :
       {std::pair("speed", &table.speed_rad_per_s), {"stator", &table.stator_C}, {"winding", &table.winding_C}}) {
    const bool is_finite = std::ranges::all_of(*axis, [](double each) { return std::isfinite(each); });
    if (axis->size() < 2 || !is_finite || std::ranges::adjacent_find(*axis, std::greater_equal<>()) != axis->end()) {
      throw bad_input(at, name, "the axis of the table does not ascend; expected a file that `heatsoak derate` wrote");
    }
  }
  if (std::ranges::any_of(table.current_A, [](double each_A) { return !(each_A >= 0.0) || !std::isfinite(each_A); })) {
    throw bad_input(at, "current", "the table holds a current that is none; expected numbers of 0 A or more");
  }
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
  constexpr std::string_view kCurrent = "_current_A";
  for (const HeaderArray& currents : arrays) {
    if (!currents.name.ends_with(kCurrent)) {
      continue;
    }
    const std::string prefix = currents.name.substr(0, currents.name.size() - kCurrent.size());
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
    committed.table = {speeds->values, stators->values, windings->values, currents.values};
    committed.code = text;
    require_sound(committed, line);
    return;
  }
  throw bad_input({committed.file.string()}, "",
                  "holds no derating table; expected a C header or a CSV table that `heatsoak derate` wrote");
}

void read_csv_table(CommittedTable& committed) {
  const std::array<std::string, 4> columns{"speed_rad_per_s", "stator_C", "winding_C", "allowed_current_A"};
  std::vector<std::array<double, 4>> rows;
  std::vector<int> lines;
  read_csv(committed.file, columns, {}, [&](const CsvRow& row) {
    rows.push_back({row.values[0], row.values[1], row.values[2], row.values[3]});
    lines.push_back(row.line);
  });
  CurrentTable& table = committed.table;
  const std::array axes{&table.speed_rad_per_s, &table.stator_C, &table.winding_C};
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    std::ranges::transform(rows, std::back_inserter(*axes[axis]), [axis](const auto& row) { return row.at(axis); });
    std::ranges::sort(*axes[axis]);
    axes[axis]->erase(std::unique(axes[axis]->begin(), axes[axis]->end()), axes[axis]->end());
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::size_t windings = table.winding_C.size();
    const std::size_t stators = table.stator_C.size();
    const bool is_of_grid = i < table.speed_rad_per_s.size() * stators * windings &&
                            rows[i][0] == table.speed_rad_per_s[i / windings / stators] &&
                            rows[i][1] == table.stator_C[i / windings % stators] && rows[i][2] == table.winding_C[i % windings];
    if (!is_of_grid) {
      throw bad_input({committed.file.string(), lines[i], 1}, "",
                      "the rows are no full grid of speed, stator and winding in this order; expected a file that `heatsoak derate` wrote");
    }
    table.current_A.push_back(rows[i][3]);
  }
  if (rows.size() != table.speed_rad_per_s.size() * table.stator_C.size() * table.winding_C.size()) {
    throw bad_input({committed.file.string(), lines.back(), 1}, "", "rows of the grid are missing at the end of the table");
  }
  require_sound(committed, 1);
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

void compare_tables(CurrentTable committed, const CurrentTable& fresh, TableComparison& found) {
  committed.speed_rad_per_s = snapped(std::move(committed.speed_rad_per_s), fresh.speed_rad_per_s);
  committed.stator_C = snapped(std::move(committed.stator_C), fresh.stator_C);
  committed.winding_C = snapped(std::move(committed.winding_C), fresh.winding_C);
  constexpr double kRounding_share = 5e-4;
  const double most_A = std::max(*std::ranges::max_element(committed.current_A), *std::ranges::max_element(fresh.current_A));
  const double tolerance_A = kRounding_share * most_A;
  for (const double speed_rad_per_s : joined(committed.speed_rad_per_s, fresh.speed_rad_per_s)) {
    for (const double stator_C : joined(committed.stator_C, fresh.stator_C)) {
      for (const double winding_C : joined(committed.winding_C, fresh.winding_C)) {
        const double committed_A = committed.allowed_A(speed_rad_per_s, stator_C, winding_C);
        const double fresh_A = fresh.allowed_A(speed_rad_per_s, stator_C, winding_C);
        const double difference_A = std::abs(committed_A - fresh_A);
        TablePlace& place = committed_A > fresh_A ? found.excess : found.lost;
        if (difference_A > std::max(tolerance_A, place.difference_A)) {
          place = {difference_A, committed_A, fresh_A, speed_rad_per_s, stator_C, winding_C};
        }
      }
    }
  }
}

std::string fresh_header(const Derating& fresh) {
  const std::vector<ExporterType>& all = all_exporters();
  return std::ranges::find(all, "c_header", &ExporterType::name)->write(fresh);
}

}  // namespace

CommittedTable read_committed_table(const std::filesystem::path& file) {
  CommittedTable committed{file, {}, {}, {}};
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
  compare_tables(committed.table, fresh.table, found);
  if (!committed.code.empty()) {
    const HeaderDifference difference = first_difference(committed.code, fresh_header(fresh));
    found.differing_line = difference.line;
    found.differing_text = difference.text;
    found.differing_fresh_text = difference.other_text;
  }
  return found;
}

}  // namespace heatsoak
