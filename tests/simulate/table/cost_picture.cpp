#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cost_study.h"

namespace heatsoak::simulate::studies {
namespace {

constexpr int kWidth_px = 1200;
constexpr int kNames_px = 280;  ///< width of the left column
constexpr int kRow_px = 22;
constexpr int kColumn_px = (kWidth_px - kNames_px - 20) / 4;
constexpr int kBar_px = kColumn_px - 110;  ///< longest bar; its value is printed beside it
constexpr const char* kKeeps = "#2b7bba";
constexpr const char* kGuard = "#1b7837";
constexpr const char* kOver = "#c8413b";

std::string text_at(double x_px, double y_px, const std::string& text, const std::string& more = {}) {
  return fmt::format("  <text x=\"{:.0f}\" y=\"{:.0f}\"{}>{}</text>\n", x_px, y_px, more.empty() ? "" : " " + more, text);
}

std::string box_at(double x_px, double y_px, double width_px, double height_px, const char* color) {
  return fmt::format("  <rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>\n", x_px, y_px, width_px,
                     height_px, color);
}

struct Column {
  const char* title;
  double Cost::*value;
  int decimals;
  const char* unit;
};
constexpr Column kColumns[] = {{"distance not driven", &Cost::lost_percent, 1, " %"}, {"time lost", &Cost::time_lost_s, 0, " s"}};

double most_of(const std::vector<CostLevel>& levels, double Cost::*value) {
  double most = 1e-9;
  for (const CostLevel& level : levels) {
    for (const CostRow& row : level.rows) {
      for (const Cost& cost : row.by_knowledge) {
        most = std::max(most, cost.*value);
      }
    }
  }
  return most;
}

std::string bar(const Column& column, const CostRow& row, const Cost& cost, double most, double x_px, double y_px) {
  const double value = cost.*column.value;
  const char* color = !cost.keeps_limit() ? kOver : row.is_guard ? kGuard : kKeeps;
  const double length_px = std::max(1.5, kBar_px * std::max(0.0, value) / most);
  std::string label = fmt::format("{:.{}f}{}", value, column.decimals, column.unit);
  if (label.starts_with("-") && label.find_first_of("123456789") == std::string::npos) {
    label.erase(0, 1);
  }
  if (!cost.keeps_limit()) {
    label += fmt::format(", {} of {} over", cost.over_limit, cost.motors);
  }
  const std::string weight = row.is_guard ? " font-weight=\"bold\"" : "";
  return box_at(x_px, y_px + 4.0, length_px, kRow_px - 8.0, color) +
         text_at(x_px + length_px + 5.0, y_px + kRow_px - 7.0, label, fmt::format("font-size=\"12\" fill=\"{}\"{}", color, weight));
}

}  // namespace

std::string draw_costs(const std::string& title, const std::vector<std::string>& subtitle, const std::vector<std::string>& knowledge,
                       const std::vector<CostLevel>& levels) {
  std::string body = text_at(20, 34, title, R"(font-size="18" font-weight="bold")");
  double y_px = 34.0;
  for (const std::string& line : subtitle) {
    y_px += 20.0;
    body += text_at(20, y_px, line, R"(font-size="13" fill="#555555")");
  }
  y_px += 26.0;
  const std::pair<const char*, const char*> kLegend[] = {{kGuard, "guard, keeps the limit"},
                                                         {kKeeps, "other way, keeps the limit"},
                                                         {kOver, "winding over the limit with at least one motor"}};
  double x_px = 20.0;
  for (const auto& [color, meaning] : kLegend) {
    body += box_at(x_px, y_px - 11.0, 14.0, 12.0, color) + text_at(x_px + 20.0, y_px, meaning, R"(font-size="13")");
    x_px += color == kOver ? 0.0 : 230.0;
  }
  y_px += 30.0;
  for (std::size_t k = 0; k < knowledge.size(); ++k) {
    const double left_px = kNames_px + static_cast<double>(2 * k) * kColumn_px;
    body += text_at(left_px, y_px, knowledge[k], R"(font-size="14" font-weight="bold")");
    for (std::size_t c = 0; c < std::size(kColumns); ++c) {
      body += text_at(left_px + static_cast<double>(c) * kColumn_px, y_px + 20.0, kColumns[c].title, R"(font-size="13")");
    }
  }
  y_px += 28.0;
  for (const CostLevel& level : levels) {
    body +=
        box_at(20.0, y_px, kWidth_px - 40.0, 1.0, "#bbbbbb") + text_at(20, y_px + 19.0, level.name, R"(font-size="14" font-weight="bold")");
    y_px += 26.0;
    for (const CostRow& row : level.rows) {
      body += text_at(32, y_px + kRow_px - 7.0, row.way, row.is_guard ? R"(font-size="13" font-weight="bold")" : R"(font-size="13")");
      for (std::size_t k = 0; k < row.by_knowledge.size(); ++k) {
        for (std::size_t c = 0; c < std::size(kColumns); ++c) {
          const double left_px = kNames_px + static_cast<double>(2 * k + c) * kColumn_px;
          body += bar(kColumns[c], row, row.by_knowledge[k], most_of(levels, kColumns[c].value), left_px, y_px);
        }
      }
      y_px += kRow_px;
    }
    y_px += 8.0;
  }
  const double height_px = y_px + 10.0;
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1:.0f}\" "
      "viewBox=\"0 0 {0} {1:.0f}\" role=\"img\" aria-label=\"{2}\" font-family=\"sans-serif\">\n"
      "  <rect width=\"{0}\" height=\"{1:.0f}\" fill=\"#ffffff\"/>\n{3}</svg>\n",
      kWidth_px, height_px, title, body);
}

}  // namespace heatsoak::simulate::studies
