#include "friction/robot_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <regex>
#include <sstream>

#include "base/confidence.h"
#include "input/toml_text.h"

namespace heatsoak::friction {
namespace {

using Lines = std::vector<std::string>;

Lines lines_of(const std::string& text) {
  Lines lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

std::string joined(const Lines& lines) {
  std::string text;
  for (const std::string& line : lines) {
    text += line + "\n";
  }
  return text;
}

/// Formats an entry with value and range as TOML, with two digits more than the first uncertain one. `least` is a lower bound. A long entry
/// has several lines.
std::string parameter(const std::string& key, const Estimate& estimate, double scale, const std::string& unit, double least,
                      const std::string& source, const std::string& derivation) {
  const auto kept = [&](double value) { return std::max(value, least) * scale; };
  const double width = estimate.interval ? kept(estimate.interval->high) - kept(estimate.interval->low) : 0.0;
  const double smallest = width > 0.0 ? width : std::max(std::abs(kept(estimate.value)), 1e-3) * 0.01;
  const int decimals = std::clamp(2 - static_cast<int>(std::floor(std::log10(smallest))), 0, 9);
  const auto text = [&](double value) {
    const double rounding = 0.5 * std::pow(10.0, -decimals);
    return fmt::format("\"{:.{}f} {}\"", std::abs(value) < rounding ? 0.0 : value, decimals, unit);  // no −0
  };
  std::string range;
  if (width > 0.0) {
    range = fmt::format(", range = [{}, {}]", text(kept(estimate.interval->low)), text(kept(estimate.interval->high)));
  }
  return input::with_short_lines(fmt::format("{} = {{ value = {}, origin = \"measured\", source = {}{}, derivation = {} }}", key,
                                             text(kept(estimate.value)), input::toml_text(source), range, input::toml_text(derivation)));
}

bool is_header(const std::string& line) { return std::regex_search(line, std::regex(R"(^\s*\[)")); }
bool is_header_of(const std::string& line, const std::string& table) {
  return std::regex_search(line,
                           std::regex(R"(^\s*\[\[?\s*)" + std::regex_replace(table, std::regex(R"(\.)"), R"(\s*\.\s*)") + R"(\s*[\].])"));
}

base::Failure other_form(const robot::Robot& robot, const std::string& table) {
  return base::bad_input({robot.file.string()}, table,
                         fmt::format("is not written as a table [{}], so it cannot be updated in place", table));
}

/// Removes [friction.heading], its wheels and the comments before it; keeps comments that belong to the next table.
void remove_heading(Lines& lines) {
  for (auto begin = lines.begin(); begin != lines.end();) {
    if (!is_header_of(*begin, "friction.heading")) {
      ++begin;
      continue;
    }
    auto end = std::find_if(begin + 1, lines.end(), is_header);
    while (end != begin + 1 && (std::prev(end)->empty() || std::prev(end)->starts_with("#"))) {
      --end;
    }
    // The comment above the table belongs to it.
    while (begin != lines.begin() && (std::prev(begin)->starts_with("#") || std::prev(begin)->empty())) {
      --begin;
    }
    begin = lines.erase(begin, end);
  }
}

/// Returns the position after the last line with text of the table [friction]; appends the table if the file has none.
Lines::iterator end_of_friction(Lines& lines, const robot::Robot& robot) {
  static const std::regex kHeader(R"(^\s*\[\s*friction\s*\])");
  const auto header = std::ranges::find_if(lines, [](const std::string& line) { return std::regex_search(line, kHeader); });
  if (header == lines.end()) {
    if (std::ranges::any_of(robot.parameters, [](const auto& each) { return each.first.starts_with("friction."); })) {
      throw other_form(robot, "friction");
    }
    lines.insert(lines.end(), {"", "[friction]"});
    return lines.end();
  }
  auto end = std::find_if(header + 1, lines.end(), is_header);
  while (end != header + 1 && (std::prev(end)->empty() || std::prev(end)->starts_with("#"))) {
    --end;
  }
  return end;
}

/// Returns the end of the entry that begins at `first`; its value in braces may continue over several lines. Returns `first` if the value
/// is not in braces.
Lines::iterator end_of_entry(Lines& lines, Lines::iterator first) {
  static const std::regex kOpening(R"(=\s*\{)");
  static const std::regex kClosing(R"(\}\s*(#.*)?$)");
  if (!std::regex_search(*first, kOpening)) {
    return first;
  }
  const auto last = std::find_if(first, lines.end(), [](const std::string& line) { return std::regex_search(line, kClosing); });
  return last == lines.end() ? first : last + 1;
}

constexpr const char* kDamping = "wheel_damping";

/// Writes the entry of the damping over the old one.
void set_damping(Lines& lines, const robot::Robot& robot, const std::string& entry) {
  const auto place = robot.parameters.find("friction.wheel_damping");
  if (place == robot.parameters.end()) {
    lines.insert(end_of_friction(lines, robot), entry);
    return;
  }
  const auto first = lines.begin() + (place->second.at.line.value() - 1);
  const auto end = end_of_entry(lines, first);
  if (end == first || !std::regex_search(*first, std::regex(R"(^\s*wheel_damping\s*=)"))) {
    throw other_form(robot, "friction");
  }
  *first = entry;
  lines.erase(first + 1, end);
}

/// Mean of the wheels; the interval covers the intervals of all wheels. Nothing if a wheel has no value.
std::optional<Estimate> over_wheels(const std::vector<std::optional<Estimate>>& wheels) {
  double mean = 0.0;
  Interval all{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const std::optional<Estimate>& wheel : wheels) {
    if (!wheel) {
      return std::nullopt;
    }
    const Interval own = wheel->interval.value_or(Interval{wheel->value, wheel->value});
    mean += wheel->value / static_cast<double>(wheels.size());
    all = {std::min(all.low, own.low), std::max(all.high, own.high)};
  }
  return Estimate{mean, all};
}

template <class Convert>
Estimate converted(const Estimate& estimate, const Convert& convert) {
  const auto& interval = estimate.interval;
  return {convert(estimate.value), interval ? std::optional(Interval{convert(interval->low), convert(interval->high)}) : std::nullopt};
}

std::string volts(const Estimate& estimate) {
  const auto& interval = estimate.interval;
  return interval ? fmt::format("{:.3f} V, {} in {:.3f} to {:.3f} V", estimate.value, base::level_text(base::kInterval_share),
                                interval->low, interval->high)
                  : fmt::format("{:.3f} V", estimate.value);
}

/// Lines of the table of one wheel.
Lines wheel_table(const WheelFriction& wheel, const robot::DriveConstants& drive, const std::string& conversion,
                  const std::string& source) {
  const double Nm_per_V = drive.torque_constant_Nm_per_A / drive.resistance_ohm * drive.gear_ratio * drive.gear_efficiency;
  const Estimate constant =
      converted(*wheel.constant_V, [&](double value_V) { return robot::friction_torque_of_voltage_Nm(drive, value_V); });
  Estimate sine = converted(*wheel.sine_V, [&](double value_V) { return value_V * Nm_per_V; });
  // Friction must not drive the wheel on any heading.
  sine = converted(sine, [&](double value) { return std::max(value, -constant.value); });
  const auto degrees = [&](double angle_rad) { return angle_rad * 180.0 / std::numbers::pi; };
  const double none = -std::numeric_limits<double>::infinity();
  return {"", "[[friction.heading.wheel]]",
          parameter("constant", constant, 1e3, "mN m", 0.0, source,
                    "b = " + volts(*wheel.constant_V) + "; " + conversion + ", less the motor's drag"),
          parameter("sine", sine, 1e3, "mN m", none, source, "a = " + volts(*wheel.sine_V) + "; " + conversion),
          parameter("phase", converted(*wheel.phase_rad, degrees), 1.0, "deg", none, source,
                    wheel.phase_is_given ? "the wheel's rolling direction: too few headings to determine it" : "fitted")};
}

void note_what_is_cut(const FrictionFit& fit, const robot::DriveConstants& drive, std::vector<WrittenAsZero>& notes) {
  const double drag_V = drive.drag_torque_Nm * drive.resistance_ohm / drive.torque_constant_Nm_per_A;
  const double back_emf_V_s_per_rad = drive.torque_constant_Nm_per_A * drive.gear_ratio;
  for (std::size_t i = 0; i < fit.wheels.size(); ++i) {
    const WheelFriction& wheel = fit.wheels[i];
    if (wheel.constant_V->value < drag_V) {
      notes.emplace_back(DragExceedsOffset{i + 1, drag_V});
    }
    if (!wheel.damping_is_given && wheel.damping_V_s_per_rad->value < back_emf_V_s_per_rad) {
      notes.emplace_back(BackEmfExceedsDamping{i + 1, back_emf_V_s_per_rad});
    }
  }
}

/// Joins the lines. Throws Failure (bug) if the result cannot be read as a robot file.
std::string checked(const Lines& lines, const robot::Robot& robot) {
  std::string text = joined(lines);
  try {
    robot::parse_robot(text, robot.file);
  } catch (const base::Failure& failure) {
    throw base::Failure(base::ExitCode::bug, fmt::format("the updated robot file cannot be read: {}", failure.what()));
  }
  return text;
}

}  // namespace

WheelNotIdentifiable::WheelNotIdentifiable(std::size_t wheel, std::optional<WheelProblem> problem)
    : base::Failure(
          base::ExitCode::cannot_answer,
          fmt::format("no robot file is written, because the friction of wheel {} over the directions is not identifiable", wheel)),
      problem_(problem) {}

DampingNegative::DampingNegative(double damping_Nm_s_per_rad)
    : base::Failure(base::ExitCode::cannot_answer, "no robot file is written, because the damping is negative"),
      damping_Nm_s_per_rad_(damping_Nm_s_per_rad) {}

std::string with_measured_friction(const std::string& text, const robot::Robot& robot, const robot::DriveConstants& drive,
                                   const FrictionFit& fit, const std::string& source, std::vector<WrittenAsZero>& notes) {
  for (std::size_t i = 0; i < fit.wheels.size(); ++i) {
    if (!fit.wheels[i].is_learned() || !fit.wheels[i].constant_V) {
      throw WheelNotIdentifiable(i + 1, fit.wheels[i].problem);
    }
  }
  note_what_is_cut(fit, drive, notes);
  Lines lines = lines_of(text);
  const bool has_heading = std::ranges::any_of(lines, [](const std::string& line) { return is_header_of(line, "friction.heading"); });
  const bool is_known = robot.friction.heading.constant_Nm.has_value() || !robot.friction.heading.wheels.empty();
  if (is_known && !has_heading) {
    throw other_form(robot, "friction.heading");
  }
  const auto old_rotation = robot.parameters.find("friction.heading.rotation");
  Lines rotation_lines;
  if (old_rotation != robot.parameters.end()) {
    const auto first = lines.begin() + (old_rotation->second.at.line.value() - 1);
    const auto end = end_of_entry(lines, first);
    rotation_lines.assign(first, end == first ? first + 1 : end);
  }
  const std::string conversion =
      fmt::format("as voltage at the driver, / {:.4g} ohm x {:.4g} mN m/A{}", drive.resistance_ohm, 1e3 * drive.torque_constant_Nm_per_A,
                  drive.gear_ratio == 1.0 ? "" : fmt::format(" x {:.4g} of the gear", drive.gear_ratio * drive.gear_efficiency));
  if (std::ranges::none_of(fit.wheels, &WheelFriction::damping_is_given)) {
    std::vector<std::optional<Estimate>> dampings;
    for (const WheelFriction& wheel : fit.wheels) {
      dampings.push_back(
          converted(*wheel.damping_V_s_per_rad, [&](double value) { return robot::damping_of_voltage_Nm_s_per_rad(drive, value); }));
    }
    set_damping(lines, robot,
                parameter(kDamping, over_wheels(dampings).value(), 1e3, "mN m s/rad", 0.0, source,
                          "mean of the wheels, the interval covers those of all; " + conversion + ", without the back-EMF"));
  }
  remove_heading(lines);
  Lines table{"", "# f = a sin(heading + phase) + b sign(sin(heading + phase)); torques at the wheel, without the drag of the motor",
              "[friction.heading]"};
  std::vector<std::optional<Estimate>> rotations;
  for (const WheelFriction& wheel : fit.wheels) {
    const auto torque_Nm = [&](double value_V) { return robot::friction_torque_of_voltage_Nm(drive, value_V); };
    rotations.push_back(wheel.rotation_V ? std::optional(converted(*wheel.rotation_V, torque_Nm)) : std::nullopt);
  }
  if (const std::optional<Estimate> all = over_wheels(rotations)) {
    table.push_back(parameter("rotation", *all, 1e3, "mN m", 0.0, source, "mean of the wheels; " + conversion + ", less the motor's drag"));
  } else {
    table.insert(table.end(), rotation_lines.begin(), rotation_lines.end());
  }
  for (const WheelFriction& wheel : fit.wheels) {
    const Lines more = wheel_table(wheel, drive, conversion, source);
    table.insert(table.end(), more.begin(), more.end());
  }
  lines.insert(end_of_friction(lines, robot), table.begin(), table.end());
  return checked(lines, robot);
}

std::string with_measured_damping(const std::string& text, const robot::Robot& robot,
                                  const std::vector<std::optional<Estimate>>& wheel_damping_Nm_s_per_rad, const std::string& source) {
  const std::optional<Estimate> all = over_wheels(wheel_damping_Nm_s_per_rad);
  if (!all) {
    throw base::Failure(base::ExitCode::cannot_answer,
                        "no robot file is written, because a wheel has no roll-out; expected one or more of every wheel");
  }
  if (all->interval->high < 0.0) {
    throw DampingNegative(all->value);
  }
  Lines lines = lines_of(text);
  set_damping(lines, robot,
              parameter(kDamping, *all, 1e3, "mN m s/rad", 0.0, source, "mean of the wheels over roll-outs with open motors"));
  return checked(lines, robot);
}

}  // namespace heatsoak::friction
