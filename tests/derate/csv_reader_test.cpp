// The CSV table read by a program that shares no code with the exporter, compared with the compiled C header.
#include <cmath>
#include <random>
#include <regex>

#include "compiled_guard.h"
#include "exported_motor.h"

namespace heatsoak::derate {
namespace {

/// Reads the table (first file), then queries "speed stator winding" (second file); prints the current of each. Interpolates as the first
/// lines of the table say.
constexpr const char* kReader = R"awk(
FNR == 1 { ++file }
file == 1 && /counts as/ { counts = 1; next }
file == 1 && counts && /K of the winding/ { hotter_K = $2; counts = 0 }
file == 1 && /^#|^speed/ { next }
file == 1 {
  for (axis = 1; axis <= 3; ++axis) {
    key = axis SUBSEP $axis
    if (!(key in place)) { place[key] = ++count[axis]; point[axis, count[axis]] = $axis }
  }
  current_A[place[1, $1], place[2, $2], place[3, $3]] = $4
  next
}
{
  for (axis = 1; axis <= 3; ++axis) at[axis] = $axis
  last_C = point[2, count[2]]
  if (at[2] > last_C) { at[3] += hotter_K * (at[2] - last_C); at[2] = last_C }
  if (at[1] > point[1, count[1]] || at[3] > point[3, count[3]]) { print 0; next }
  for (axis = 1; axis <= 3; ++axis) {
    low[axis] = 1
    while (low[axis] + 1 < count[axis] && at[axis] > point[axis, low[axis] + 1]) ++low[axis]
    high[axis] = count[axis] > 1 ? low[axis] + 1 : 1
    from = point[axis, low[axis]]; to = point[axis, high[axis]]
    share[axis] = at[axis] <= from ? 0 : (at[axis] - from) / (to - from)
  }
  sum_A = 0
  for (i = 0; i < 2; ++i) for (j = 0; j < 2; ++j) for (k = 0; k < 2; ++k) {
    weight = (i ? share[1] : 1 - share[1]) * (j ? share[2] : 1 - share[2]) * (k ? share[3] : 1 - share[3])
    sum_A += weight * current_A[i ? high[1] : low[1], j ? high[2] : low[2], k ? high[3] : low[3]]
  }
  printf "%.9g\n", sum_A
}
)awk";

struct Query {
  double speed_rad_per_s;
  double stator_C;
  double winding_C;
};

/// Half of the places lie near the limits, some beyond the axes.
std::vector<Query> queries(const CurrentTable& table) {
  std::mt19937_64 engine(7);
  std::uniform_real_distribution<double> uniform;
  std::vector<Query> all;
  for (int i = 0; i < 800; ++i) {
    const auto temperature_C = [&](double end_C) {
      return i % 2 == 0 ? end_C + 3.0 - 10.0 * uniform(engine) : std::lerp(20.0, end_C, uniform(engine));
    };
    all.push_back({1.05 * table.no_current_speed_rad_per_s * uniform(engine) * (i % 3 == 0 ? 1.0 : 0.5),
                   temperature_C(table.stator_C.back()), temperature_C(table.winding_C.back() - 3.0)});
  }
  return all;
}

/// Returns the currents that the reader finds in the exported table.
std::vector<double> read_back_A(const std::string& csv, const std::vector<Query>& places) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / fmt::format("heatsoak_csv_reader_{}", static_cast<int>(getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "reader.awk") << kReader;
  std::ofstream(folder / "table.csv") << csv;
  std::ofstream queries(folder / "queries");
  for (const Query& each : places) {
    queries << fmt::format("{:.9g},{:.9g},{:.9g}\n", each.speed_rad_per_s, each.stator_C, each.winding_C);
  }
  queries.close();
  EXPECT_EQ(std::system(fmt::format("cd '{}' && LC_ALL=C awk -F '[, ]' -f reader.awk table.csv queries > found", folder.string()).c_str()),
            0);
  std::vector<double> found_A;
  std::ifstream found(folder / "found");
  for (double each_A = 0.0; found >> each_A;) {
    found_A.push_back(each_A);
  }
  std::filesystem::remove_all(folder);
  return found_A;
}

/// Returns the header's currents. The table function is static, so a wrapper calls it.
std::vector<double> header_A(const Derating& derating, const std::vector<Query>& places) {
  const CompiledGuard guard(derating, "csv_reader");
  auto* const allowed_A = guard.function<float(float, float, float)>("model_allowed_A");
  std::vector<double> all_A;
  for (const Query& each : places) {
    all_A.push_back(static_cast<double>(
        allowed_A(static_cast<float>(each.speed_rad_per_s), static_cast<float>(each.stator_C), static_cast<float>(each.winding_C))));
  }
  return all_A;
}

class CsvReader : public testing::TestWithParam<const char*> {};

TEST_P(CsvReader, FindsTheCurrentOfTheHeaderAndNeverMore) {
  const motor::Motor motor = std::string_view(GetParam()) == "lossy"
                                 ? ecx_32_with(effect_table("ac_copper_loss", estimated("share", "0.2")))
                                 : shipped_motor(GetParam());
  const Derating derating = derating_of(motor);
  const std::string csv = exported("csv", derating);
  std::smatch stated;
  ASSERT_TRUE(std::regex_search(csv, stated, std::regex("at most ([0-9.]+) % below it, from ([0-9.]+) A up"))) << csv.substr(0, 2000);
  const double short_ratio = 0.01 * std::stod(stated[1]);
  const double counted_A = std::stod(stated[2]);
  EXPECT_LT(short_ratio, 0.03);
  const std::vector<Query> places = queries(derating.table);
  const std::vector<double> found_A = read_back_A(csv, places);
  const std::vector<double> expected_A = header_A(derating, places);
  ASSERT_EQ(found_A.size(), places.size());
  const double limit_C = derating.rules.limits.winding_C;
  constexpr double kRounding_A = 1e-4;
  int compared = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::string where = fmt::format("{:.6g} rad/s, stator {:.6g} °C, winding {:.6g} °C", places[i].speed_rad_per_s,
                                          places[i].stator_C, places[i].winding_C);
    EXPECT_LE(found_A[i], expected_A[i] + kRounding_A) << where;
    if (expected_A[i] >= counted_A && places[i].winding_C <= limit_C && places[i].stator_C <= derating.table.stator_C.back()) {
      EXPECT_GE(found_A[i], (1.0 - short_ratio) * expected_A[i] - kRounding_A) << where;
      ++compared;
    }
  }
  EXPECT_GT(compared, 200);
}

INSTANTIATE_TEST_SUITE_P(Motors, CsvReader,
                         testing::Values("maxon_ecx_flat_32l_48v", "maxon_ec45_flat_70w_24v", "maxon_dcx19s_24v", "lossy"));

}  // namespace
}  // namespace heatsoak::derate
