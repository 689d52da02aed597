#include "check/check_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "check/limit.h"
#include "input/reader.h"
#include "motor/conditions.h"

namespace heatsoak::check {
namespace {

namespace fs = std::filesystem;

/// More would be a file that somebody generated; each has a robot and a duty that are read.
constexpr std::size_t kMostChecks = 1000;

class CheckReader {
 public:
  /// `reported`: problems of other files that were reported before; several checks may name one file.
  CheckReader(input::Reader table, fs::path folder, const input::DataFolders& folders, std::set<std::string>& reported)
      : table_(std::move(table)), folder_(std::move(folder)), folders_(folders), reported_(reported) {}

  Check read() {
    check_.name = table_.text("name", input::Need::required).value_or("");
    check_.at = table_.at("name");
    read_limits();
    read_things();
    read_numbers();
    read_artefacts();
    read_derate();
    table_.finish();
    compare_settings();
    compare_with_loosest();
    return std::move(check_);
  }

 private:
  /// A path of the user's own begins at the check file, like every path in it.
  [[nodiscard]] std::string from_here(const std::string& name) const {
    const bool is_path = name.find('/') != std::string::npos || name.ends_with(".toml");
    return is_path ? (folder_ / name).lexically_normal().string() : name;
  }

  /// Problems of a name are reported where the check file has it, those inside of another file at their own place.
  template <class Read>
  auto named(std::string_view key, const Read& read) -> std::optional<decltype(read())> {
    try {
      return read();
    } catch (const base::Failure& failure) {
      if (failure.code() != base::ExitCode::bad_input) {
        throw;
      }
      if (failure.diagnostics().empty()) {
        table_.problem(key, failure.message());
      }
      for (base::Diagnostic each : failure.diagnostics()) {
        if (each.at.line == 0 && each.key.empty()) {
          table_.problem(key, fmt::format("{}: {}", each.at.file, each.message));  // the file cannot be read at all
          continue;
        }
        if (each.at.line == 0) {
          each.at = input::place_of(each.at.file, each.key);
        }
        if (reported_.insert(base::to_string(each)).second) {
          table_.add(each);
        }
      }
      return std::nullopt;
    }
  }

  /// Reads a file by its id or path. A path at which nothing exists is no mistake in the check file: the thresholds that need it fail.
  template <class Read>
  auto thing(Setting setting, const fs::path& folder, std::string_view kind, const std::string& name, const Read& read)
      -> std::optional<decltype(read(fs::path()))> {
    const std::string_view key = all_settings()[static_cast<std::size_t>(setting)].key;
    const std::optional<fs::path> file = named(key, [&] { return input::file_of(folder, kind, from_here(name)); });
    std::error_code error;
    if (file && !fs::exists(*file, error)) {
      check_.unreadable.emplace(setting, fmt::format("{}: cannot be read: No such file or directory", file->string()));
      return std::nullopt;
    }
    return file ? named(key, [&] { return read(*file); }) : std::nullopt;
  }

  std::optional<motor::Motor> motor(Setting setting, const std::string& name) {
    return thing(setting, folders_.motors, "motor", name, [](const fs::path& file) { return motor::read_motor(file); });
  }

  /// Motors to rank with. The motor itself or one named twice would make a rank that says nothing.
  void read_others() {
    std::vector<std::string> others = table_.texts("against", input::Need::optional);
    const bool is_all = others == std::vector<std::string>{"all"};
    if (is_all) {
      others = input::ids_in(folders_.motors);
    }
    for (const std::string& name : others) {
      std::optional<motor::Motor> other = motor(Setting::against, name);
      if (!other) {
        continue;
      }
      const auto is_other = [&](const motor::Motor& each) { return fs::weakly_canonical(each.file) == fs::weakly_canonical(other->file); };
      if (check_.motor && is_other(*check_.motor)) {
        if (!is_all) {
          table_.problem("against", fmt::format("{} is the motor of this check; expected other motors", name));
        }
      } else if (std::ranges::any_of(check_.against, is_other)) {
        table_.problem("against", fmt::format("names {} twice", name));
      } else {
        check_.against.push_back(std::move(*other));
      }
    }
    if (is_all && check_.motor && check_.against.empty()) {
      table_.problem("against", "the database has no other motor; expected one or more to rank with");
    }
  }

  void read_things() {
    if (std::optional<input::Reader> stated = table_.table("conditions", input::Need::optional)) {
      for (const std::string& key : stated->keys()) {
        check_.conditions[key] = stated->text(key, input::Need::required).value_or("");
      }
    }
    if (const auto name = table_.text("robot", input::Need::optional)) {
      check_.robot = thing(Setting::robot, folders_.robots, "robot", *name, [](const fs::path& file) { return robot::read_robot(file); });
    }
    if (const auto name = table_.text("duty", input::Need::optional)) {
      check_.duty = thing(Setting::duty, folders_.duties, "duty", *name, [](const fs::path& file) { return duty::read_duty(file); });
    }
    std::optional<motor::Motor> own;
    if (const auto name = table_.text("motor", input::Need::optional)) {
      own = motor(Setting::motor, *name);
    } else if (check_.robot && check_.robot->drive.motor != "none" && !has("motor") && is_used(Setting::motor)) {
      own = robots_motor();
    }
    if (own) {
      check_.motor = named("motor", [&] { return motor::under(*own, check_.conditions); });
    }
    read_others();
  }

  std::optional<motor::Motor> robots_motor() {
    return named("robot",
                 [&] { return motor::read_motor(input::file_of(folders_.motors, "motor", from_here(check_.robot->drive.motor))); });
  }

  /// A number of things: whole, and written as text like every other number.
  static std::optional<double> whole(input::Reader& table, const base::ParameterSpec& spec) {
    const std::optional<double> value = table.quantity(spec, input::Need::optional);
    if (value && *value != std::floor(*value)) {
      table.problem(spec.key, fmt::format("{} is not a whole number", significant_text(*value)));
      return std::nullopt;
    }
    return value;
  }
  static std::string significant_text(double value) { return fmt::format("{:.6g}", value); }

  void read_numbers() {
    constexpr double kMostExact = 9007199254740992.0;
    if (const auto samples = whole(table_, {"samples", "", base::Range::between(1.0, 1e6), "draws of every declared tolerance"})) {
      check_.samples = static_cast<int>(*samples);
    }
    if (const auto seed = whole(table_, {"seed", "", base::Range::between(0.0, kMostExact), "of draws and games"})) {
      check_.seed = static_cast<std::uint64_t>(*seed);
    }
    check_.temperature_C =
        table_.quantity({"temperature", "degC", base::Range::between(-60.0, 1000.0), "above which time is counted"}, input::Need::optional);
    check_.air_C =
        table_.quantity({"air", "degC", base::Range::between(-60.0, 200.0), "of a log that has no air temperature"}, input::Need::optional);
  }

  void read_artefacts() {
    const auto path = [&](std::string_view key) {
      const std::optional<std::string> name = table_.text(key, input::Need::optional);
      return name ? (folder_ / *name).lexically_normal() : fs::path();
    };
    check_.table = path("table");
    check_.mapping = path("map");
    for (const std::string& name : table_.texts("files", input::Need::optional)) {
      check_.files.push_back((folder_ / name).lexically_normal());
    }
    for (const std::string& name : table_.texts("logs", input::Need::optional)) {
      check_.logs.push_back((folder_ / name).lexically_normal());
    }
  }

  static std::optional<derate::SensorOptions> sensor_of(input::Reader& table) {
    constexpr std::array<std::string_view, 2> kNodes{"stator", "winding"};
    const std::optional<std::string> node = table.choice("thermistor", kNodes, input::Need::optional);
    const bool reads_resistance = table.flag("winding_resistance", input::Need::optional).value_or(false);
    if (node && reads_resistance) {
      table.problem("winding_resistance", "expected one sensor, not a thermistor as well");
    }
    if (!node && !reads_resistance) {
      return std::nullopt;
    }
    derate::SensorOptions sensor = derate::default_sensor(node ? derate::SensorKind::thermistor : derate::SensorKind::winding_resistance);
    if (node) {
      sensor.node = *node == "winding" ? motor::states::winding : motor::states::stator;
    }
    for (const derate::SensorParameter& each : derate::sensor_parameters()) {
      if (each.kind == sensor.kind) {
        sensor.*each.value = table.quantity(each.spec, input::Need::optional).value_or(sensor.*each.value);
      }
    }
    return sensor;
  }

  void read_derate() {
    std::optional<input::Reader> table = table_.table("derate", input::Need::optional);
    if (!table) {
      return;
    }
    const auto take = [&](const base::ParameterSpec& spec, double& value) {
      value = table->quantity(spec, input::Need::optional).value_or(value);
    };
    derate::DerateOptions& options = check_.derate;
    take({"ambient", "degC", base::Range::between(-40.0, 120.0), "hottest air at the motor"}, options.hottest_ambient_C);
    take({"coldest", "degC", base::Range::between(-60.0, 120.0), "coldest air"}, options.coldest_ambient_C);
    options.approach_s = table->quantity(
        {"approach", "s", base::Range::between(0.01, 100.0), "in which the winding may approach its limit"}, input::Need::optional);
    take({"period", "s", base::Range::between(1e-3, 1.0), "between two calls of the firmware"}, options.period_s);
    take({"confidence", "", base::Range::between(0.5, 0.999), "share of motors that keep their limits"}, options.guarantee.confidence);
    if (const auto samples =
            whole(*table, {"samples", "", base::Range::between(1.0, 1e5), "motors drawn to find the safety factor on heat"})) {
      options.guarantee.samples = static_cast<int>(*samples);
    }
    if (const auto seed = whole(*table, {"seed", "", base::Range::between(0.0, 9007199254740992.0), "of the draws"})) {
      options.guarantee.seed = static_cast<std::uint64_t>(*seed);
    }
    options.sensor = sensor_of(*table);
    if (options.coldest_ambient_C >= options.hottest_ambient_C) {
      table->problem("coldest", fmt::format("{:.4g} °C is not below the hottest air, {:.4g} °C", options.coldest_ambient_C,
                                            options.hottest_ambient_C));
    }
    table->finish();
  }

  void read_limits() {
    limits_ = table_.table("limits", input::Need::required);
    if (!limits_) {
      return;
    }
    std::vector<std::string> known;
    for (const ThresholdType& type : all_thresholds()) {
      known.emplace_back(type.name);
    }
    if (limits_->keys().empty()) {
      table_.problem("limits", fmt::format("is empty; expected one or more of {}", fmt::join(known, ", ")));
    }
    for (const std::string& key : limits_->keys()) {
      const ThresholdType* type = find_threshold(key);
      if (!type) {
        limits_->pass_over(key);
        limits_->problem(
            key, key == "forecast_error"
                     ? "this program was built without support for measured logs; `./bootstrap build` adds it"
                     : fmt::format("there is no such threshold{} (`heatsoak list thresholds` shows them)", base::did_you_mean(key, known)));
        continue;
      }
      const std::optional<std::string> text = limits_->text(key, input::Need::required);
      if (!text) {
        continue;
      }
      ParsedLimit parsed = parse_limit(*text, *type);
      if (!parsed.problem.empty()) {
        limits_->problem(key, parsed.problem);
        continue;
      }
      check_.limits.push_back({type, parsed.value, std::move(parsed.unit), *text, limits_->at(key)});
    }
  }

  [[nodiscard]] bool has(std::string_view key) const {
    const std::vector<std::string> keys = table_.keys();
    return std::ranges::find(keys, key) != keys.end();
  }

  [[nodiscard]] bool is_used(Setting setting) const {
    return std::ranges::any_of(check_.limits, [&](const Limit& limit) {
      return std::ranges::find(limit.type->needs, setting) != limit.type->needs.end() ||
             std::ranges::find(limit.type->takes, setting) != limit.type->takes.end();
    });
  }

  /// Reports limits that cannot fail. Needs the motors of the check.
  void compare_with_loosest() {
    for (const Limit& limit : check_.limits) {
      if (std::string problem = looseness_problem(limit.value, limit.text, *limit.type, check_); !problem.empty()) {
        limits_->problem(limit.type->name, std::move(problem));
      }
    }
  }

  void compare_settings() {
    std::set<Setting> missing;
    for (const Limit& limit : check_.limits) {
      for (const Setting setting : limit.type->needs) {
        const SettingText& text = all_settings()[static_cast<std::size_t>(setting)];
        const bool comes_with_robot = (check_.robot && check_.robot->drive.motor != "none") || check_.unreadable.contains(Setting::robot);
        const bool is_there = has(text.key) || (setting == Setting::motor && comes_with_robot);
        if (!is_there && missing.insert(setting).second) {
          table_.problem("limits", fmt::format("{} needs '{}' in this check: {}", limit.type->name, text.key, text.meaning));
        }
      }
    }
    if (check_.limits.empty()) {
      return;  // their settings are unknown
    }
    for (std::size_t i = 0; i < all_settings().size(); ++i) {
      const std::string_view key = all_settings()[i].key;
      if (has(key) && !is_used(static_cast<Setting>(i))) {
        table_.problem(key, "is not used by any limit of this check; remove it or move it to the check that needs it");
      }
    }
  }

  input::Reader table_;
  std::optional<input::Reader> limits_;
  fs::path folder_;
  const input::DataFolders& folders_;
  std::set<std::string>& reported_;
  Check check_;
};

}  // namespace

CheckFile read_check_file(const fs::path& path, const input::DataFolders& folders) {
  const input::Value root = input::read_toml(path);
  base::Diagnostics diagnostics;
  input::Reader top(root, "", diagnostics);
  CheckFile file{path, {}};
  std::vector<input::Reader> tables = top.tables("check");
  if (tables.size() > kMostChecks) {
    throw base::bad_input({path.string(), 1, 1}, "check",
                          fmt::format("contains {} checks; expected at most {}", tables.size(), kMostChecks));
  }
  if (tables.empty() && diagnostics.empty()) {
    diagnostics.add({path.string(), 1, 1}, "", "has no [[check]] table; `heatsoak check --help` shows an example");
  }
  std::set<std::string> names;
  std::set<std::string> reported;
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const base::Location at = tables[i].at("name");
    file.checks.push_back(CheckReader(std::move(tables[i]), path.parent_path(), folders, reported).read());
    const std::string& name = file.checks.back().name;
    if (!name.empty() && !names.insert(name).second) {
      diagnostics.add(at, fmt::format("check[{}].name", i),
                      fmt::format("\"{}\" is the name of another check, too; give each its own", name));
    }
  }
  top.finish();
  diagnostics.throw_if_any();
  return file;
}

}  // namespace heatsoak::check
