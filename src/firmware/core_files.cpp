#include "firmware/core_files.h"

#include <embedded/core_sources.h>
#include <embedded/core_templates.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <regex>

#include "base/files.h"
#include "base/quantity.h"
#include "base/source_text.h"

namespace heatsoak::firmware {
namespace {

constexpr std::string_view kTemplates = "src/firmware/templates/";
constexpr std::size_t kLargestFile_bytes = std::size_t{1} << 24U;
constexpr std::string_view kShadowMode =
    "**Shadow mode: the thermal guard limits no current, so a motor can overheat.** It counts what it would have limited:\n"
    "`heatsoak_core_read_shadow`. Generate the folder again without `--shadow` before a match.\n\n";

using Words = std::map<std::string, std::string>;

/// "@WORD@" by what stands for it; a word without meaning is a bug.
std::string filled(std::string_view text, const Words& words) {
  static const std::regex kWord("@([A-Z_]+)@");
  std::string result;
  const char* begin = text.data();
  const char* const end = begin + text.size();
  std::cmatch match;
  while (std::regex_search(begin, end, match, kWord)) {
    const auto found = words.find(match[1]);
    if (found == words.end()) {
      throw base::Failure(base::ExitCode::bug, fmt::format("a template asks for @{}@", match[1].str()));
    }
    result.append(begin, match[0].first).append(found->second);
    begin = match[0].second;
  }
  return result.append(begin, end);
}

std::string_view source_text(std::string_view path) {
  const auto all = embedded::core_sources();
  const auto found = std::ranges::find(all, path, &embedded::Text::path);
  if (found == all.end()) {
    throw base::Failure(base::ExitCode::bug, fmt::format("the program has no {} to write", path));
  }
  return found->text;
}

std::string in_capitals(std::string name) {
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return name;
}

/// The reasons as C constants, and the checks that both are the same.
void add_reasons(Words& words) {
  static const std::regex kReason(R"(\n  (\w+) = (\d+),(?:\s*///< ([^\n]*))?)");
  const std::string header(source_text("robot_core/reason.h"));
  for (std::sregex_iterator each(header.begin(), header.end(), kReason), end; each != end; ++each) {
    const std::string name = "HEATSOAK_CORE_" + in_capitals((*each)[1]);
    words["REASONS"] +=
        fmt::format("  {} = {},{}\n", name, (*each)[2].str(), (*each)[3].matched ? fmt::format(" /* {} */", (*each)[3].str()) : "");
    words["SAME_REASONS"] += fmt::format("static_assert({} == int(Reason::{}));\n", name, (*each)[1].str());
  }
}

/// Members of a struct of drive_core.h by their names; both sides have the same.
void add_places(Words& words, const std::string& c, const std::string& cpp) {
  static const std::regex kMember(R"(^  [\w:]+ (\w+)(?:\[\w+\])?(?: = [^;]*|\{[^;]*\})?;)");
  const std::string header(source_text("robot_core/drive_core.h"));
  const std::size_t begin = header.find("struct " + cpp + " {");
  std::string body = header.substr(begin, header.find("\n};", begin) - begin);
  for (std::size_t line = body.find('\n'); line != std::string::npos; line = body.find('\n', line + 1)) {
    const std::string text = body.substr(line + 1, body.find('\n', line + 1) - line - 1);
    if (std::smatch found; std::regex_search(text, found, kMember)) {
      words["SAME_PLACES"] += fmt::format("SAME_PLACE({}, {}, {});\n", c, cpp, found[1].str());
    }
  }
}

std::string limitations(const robot::Robot& robot, const derate::Derating& derating, const std::vector<CoreNote>& notes) {
  std::string text = fmt::format(
      "- The thermal guard is computed from the files, not measured on this robot: {} thermal data of the motor. Air up to {:.0f} °C.\n"
      "- The example has not been run on a board. Its default board functions have no sensors, so the core keeps all bridges open.\n",
      derating.data_quality, derating.rules.hottest_ambient_C);
  text += robot.drive.current_limit_A
              ? ""
              : "- The robot file has no current limit of the driver: only the battery bounds the current until the guard does.\n";
  for (const CoreNote& note : notes) {
    text += fmt::format("- {}\n", to_string(note));
  }
  return text;
}

Words words_for(const CoreSource& source, const std::vector<CoreNote>& notes) {
  Words words{{"ROBOT", in_one_line(source.robot.id)},
              {"MOTOR", in_one_line(source.motor.id)},
              {"VERSION", source.version},
              {"PERIOD_S", float_literal(source.config.period_s)},
              {"PERIOD_US", fmt::format("{:.0f}u", 1e6 * source.options.period_s)},
              {"PERIOD_MS", fmt::format("{:.6g}", 1e3 * source.options.period_s)},
              {"WHEELS", std::to_string(source.config.wheel_count)},
              {"STATE_BYTES", std::to_string(sizeof(robot_core::State))},
              {"CHECK_SUM", fmt::format("0x{:08X}U", source.config.check_sum)},
              {"BATTERY_V", float_literal(0.5F * (source.config.battery_full_V + source.config.battery_lowest_V))},
              {"SHADOW", source.options.shadow_mode ? "1" : "0"},
              {"SHADOW_MODE", source.options.shadow_mode ? std::string(kShadowMode) : ""},
              {"LIMITATIONS", limitations(source.robot, source.derating, notes)}};
  add_reasons(words);
  add_places(words, "heatsoak_core_command", "Command");
  add_places(words, "heatsoak_core_input", "Input");
  add_places(words, "heatsoak_core_output", "Output");
  return words;
}

void require_watched_period(double period_s) {
  if (period_s > kLongestWatched_s) {
    throw base::Failure(
        base::ExitCode::bad_input,
        fmt::format("a control period of {:.4g} ms is too long for the watchdog of a generated core: expected at most {:.2f} ms",
                    1e3 * period_s, 1e3 * kLongestWatched_s));
  }
}

std::string options_text(const motor::Motor& motor, const CoreOptions& options, const derate::Derating& derating) {
  const derate::DerateOptions& derate = derating.options;
  std::string text = fmt::format(
      "--period {:.9g}s --ambient {:.9g}degC --coldest {:.9g}degC --approach {:.9g}s --confidence {:.9g} --samples {} --seed {}",
      options.period_s, derate.hottest_ambient_C, derate.coldest_ambient_C, derating.rules.approach_s, derate.guarantee.required_share,
      derate.guarantee.samples, derate.guarantee.seed);
  text += options.shadow_mode ? " --shadow" : "";
  for (const auto& [key, value] : motor.assumed) {
    text += fmt::format(" --condition {}={}", key, value);
  }
  return text;
}

bool is_for_firmware(std::string_view path) { return path != "robot_core/block_diagram.h"; }

}  // namespace

double guard_period_s(double period_s) {
  constexpr double kUsual_s = 0.01;
  return period_s * std::max(1.0, std::round(kUsual_s / period_s));
}

std::string float_literal(float value) {
  if (!std::isfinite(value)) {
    throw base::Failure(base::ExitCode::bug, "a value that is not finite cannot be written");
  }
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) {
    text += ".0";
  }
  return text + "F";
}

std::string in_one_line(std::string text) {
  std::ranges::replace_if(
      text, [](unsigned char c) { return c < ' ' || c == 0x7F; }, ' ');
  // A backslash at the end would continue a comment.
  std::ranges::replace(text, '\\', '/');
  for (std::size_t at = text.find("*/"); at != std::string::npos; at = text.find("*/")) {
    text.replace(at, 2, "* /");
  }
  return text;
}

CoreFolder core_files(const robot::Robot& robot, const motor::Motor& motor, const CoreOptions& options, const derate::Derating& derating,
                      std::string_view version) {
  require_watched_period(options.period_s);
  const HostGuard guard(derating);
  CoreSource source{.robot = robot,
                    .motor = motor,
                    .derating = derating,
                    .options = options,
                    .config = make_core_config(robot, motor, options, derating, guard),
                    .guard = guard.model(),
                    .version = std::string(version),
                    .options_text = options_text(motor, options, derating),
                    .hash = {}};
  require_driving_current(robot, motor, derating, source.config);
  source.hash = derate::input_hash(base::read_file(robot.file, kLargestFile_bytes) + '\n' +
                                   base::read_file(motor.file, kLargestFile_bytes) + '\n' + source.options_text);
  CoreFolder folder{.files = {},
                    .hash = source.hash,
                    .config_check_sum = source.config.check_sum,
                    .limp_current_A = source.config.limp_current_A,
                    .braking_reserve_K = source.config.braking_reserve_K,
                    .notes = notes_on(robot, motor, derating, source.config.braking_reserve_K)};
  if (options.shadow_mode) {
    folder.notes.insert(folder.notes.begin(), ShadowModeChosen{});
  }
  folder.files.push_back({"core_config.h", core_config_header(source)});
  folder.files.push_back({"motor_guard.h", motor_guard_header(source)});
  folder.files.push_back({"motor_guard.cpp", motor_guard_source(source)});
  const Words words = words_for(source, folder.notes);
  for (const embedded::Text& each : embedded::core_templates()) {
    folder.files.push_back({std::string(each.path.substr(kTemplates.size())), filled(each.text, words)});
  }
  for (const embedded::Text& each : embedded::core_sources()) {
    if (is_for_firmware(each.path)) {
      folder.files.push_back({std::string(each.path), std::string(each.text)});
    }
  }
  folder.files.push_back({kGeneratedFiles, {}});
  std::ranges::sort(folder.files, {}, &CoreFile::path);
  std::string paths;
  for (const CoreFile& file : folder.files) {
    paths += file.path + '\n';
  }
  std::ranges::find(folder.files, kGeneratedFiles, &CoreFile::path)->content = paths;
  return folder;
}

std::size_t code_bytes(std::string_view path, std::string_view content) {
  const bool is_code = path.ends_with(".h") || path.ends_with(".c") || path.ends_with(".cpp");
  return is_code ? base::without_comments(content).size() : 0;
}

std::size_t largest_core_bytes(std::size_t table_bytes) {
  constexpr std::size_t kCharactersPerByte = 4;  // a number of four bytes as text, "1234.56789F, "
  std::size_t bytes = kCharactersPerByte * table_bytes;
  for (const embedded::Text& each : embedded::core_templates()) {
    bytes += code_bytes(each.path, each.text);
  }
  for (const embedded::Text& each : embedded::core_sources()) {
    bytes += is_for_firmware(each.path) ? code_bytes(each.path, each.text) : 0;
  }
  return bytes;
}

GeneratedCore generate_core(const robot::Robot& robot, const motor::Motor& motor, const CoreOptions& options,
                            derate::DerateOptions derate_options, std::string_view version, const base::Progress& progress) {
  require_drive_values(robot, {&motor, 1});
  require_watched_period(options.period_s);
  static_cast<void>(make_core_config(robot, motor.nominal, options));
  derate_options.period_s = guard_period_s(options.period_s);
  derate::Derating derating = derate::derate(motor, robot, derate_options, progress);
  CoreFolder folder = core_files(robot, motor, options, derating, version);
  return {std::move(derating), std::move(folder)};
}

}  // namespace heatsoak::firmware
