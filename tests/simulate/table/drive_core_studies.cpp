// Regenerates the tables and charts of reports/drive_core from simulations with realistic sensors. Every run writes the same bytes.
//   heatsoak_drive_core_studies [FOLDER [low_speed|planners|guard|costs]]
//   FOLDER: reports/drive_core of the checkout by default. Without a study's name all four run.
#include "drive_core_studies.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "base/diagnostic.h"
#include "base/files.h"
#include "support/shipped.h"
#include "support/study_words.h"

namespace heatsoak::simulate::studies {

Spread spread_of(std::vector<double> values) {
  std::ranges::sort(values);
  const auto at = [&](double share) {
    const double place = share * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return std::lerp(values[below], values[above], place - static_cast<double>(below));
  };
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  return {mean, at(0.05), at(0.95), values.back()};
}

std::string to_text(const Spread& spread, int decimals) {
  return fmt::format("{:.{}f} [{:.{}f}, {:.{}f}]", spread.mean, decimals, spread.low, decimals, spread.high, decimals);
}

std::string Sheet::markdown() const {
  std::string text = fmt::format("| {} |\n|", fmt::join(header, " | "));
  for (std::size_t i = 0; i < header.size(); ++i) {
    text += "---|";
  }
  for (const std::vector<std::string>& row : rows) {
    text += fmt::format("\n| {} |", fmt::join(row, " | "));
  }
  return text + "\n";
}

std::string Sheet::csv() const {
  std::string text = fmt::format("{}\n", fmt::join(header, ","));
  for (const std::vector<std::string>& row : rows) {
    text += fmt::format("{}\n", fmt::join(row, ","));
  }
  return text;
}

void Report::write(const std::string& file, const std::string& text) const { base::write_file(folder / file, text); }
void Report::draw(const std::string& file, const report::Chart& chart) const { write(file, report::draw_svg(chart)); }

DriveOptions sensed_drive(const robot::Robot& robot, std::uint64_t seed, bool has_current_sensor) {
  DriveOptions options = real_drive(robot, seed);
  options.sensing.has_motor_current = has_current_sensor;
  return options;
}

namespace {

struct Study {
  std::string_view name;
  void (*run)(const Subject& subject, const Report& report);
};
constexpr Study kStudies[] = {
    {"low_speed", study_low_speed}, {"planners", study_planners_in_match}, {"guard", study_guard}, {"costs", study_costs}};

int run(const StudyWords& words) {
  const Report report{words.folder(0, kSource / "reports" / "drive_core")};
  std::vector<std::string_view> names;
  std::ranges::transform(kStudies, std::back_inserter(names), &Study::name);
  const std::string wanted = words.one_of(1, names);
  const Subject subject{twente(), ecx_32()};
  for (const Study& study : kStudies) {
    if (!wanted.empty() && wanted != study.name) {
      continue;
    }
    const auto start = std::chrono::steady_clock::now();
    study.run(subject, report);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    fmt::print("{}: {:.0f} s\n", study.name, took.count());
  }
  return 0;
}

}  // namespace
}  // namespace heatsoak::simulate::studies

int main(int argc, char** argv) {
  constexpr const char* kUsage =
      "usage: heatsoak_drive_core_studies [FOLDER [low_speed|planners|guard|costs]]\n\n"
      "  FOLDER       an existing folder; reports/drive_core without it\n"
      "  low_speed …  one study instead of all\n";
  return heatsoak::run_study(argc, argv, kUsage, 2, heatsoak::simulate::studies::run);
}
