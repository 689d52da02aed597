#include "duty/recorded_game.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "base/diagnostic.h"
#include "duty/log_bytes.h"
#include "duty/log_type.h"
#include "duty/logs_registry.h"
#include "duty/track_builder.h"

namespace heatsoak::duty {
namespace {

constexpr std::size_t kHead = 4096;

struct Signature {
  std::string_view begins;
  std::string_view advice;
};
using namespace std::string_view_literals;
constexpr std::array kForeign{
    Signature{"PK\x03\x04"sv, "is a zip archive; unpack it first"},
    Signature{"\xfd\x37zXZ"sv, "is packed by xz; unpack it first"},
    Signature{"\x28\xb5\x2f\xfd"sv, "is packed by zstd; unpack it first"},
    Signature{"BZh"sv, "is packed by bzip2; unpack it first"},
    Signature{"7z\xbc\xaf"sv, "is a 7z archive; unpack it first"},
    Signature{"\0\0\0\x18\0S\0S\0L"sv,
              "is an SSL log of version 0 (before 2013); logconvert of RoboCup-SSL/ssl-logtools makes version 1 of it"},
};

std::string printable(std::string_view bytes) {
  std::string text;
  for (const char c : bytes) {
    text += std::isprint(static_cast<unsigned char>(c)) != 0 ? std::string(1, c) : fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
  }
  return text;
}

base::Failure not_a_game(const std::filesystem::path& file, std::string_view head) {
  for (const auto& [begins, advice] : kForeign) {
    if (head.starts_with(begins)) {
      return base::bad_input({file.string()}, "", std::string(advice));
    }
  }
  if (head.empty()) {
    return base::bad_input({file.string()}, "", "is empty; expected a recorded game");
  }
  std::string expected;
  for (const LogType& type : all_logs()) {
    expected += fmt::format("{}{} ({})", expected.empty() ? "" : ", or ", type.name, type.summary);
  }
  const std::array<std::string, 2> known{"SSL_LOG_FILE", "t_s,team,robo"};
  const std::string begin = printable(head.substr(0, 12));
  const std::string meant = base::did_you_mean(begin, known);
  return base::bad_input(
      {file.string()}, "",
      fmt::format("is not a recorded game: it begins with \"{}\"{} Expected {}", begin, meant.empty() ? "." : meant, expected));
}

const LogType& log_type(const std::filesystem::path& file, const std::string& format) {
  if (!format.empty()) {
    std::vector<std::string> names;
    for (const LogType& type : all_logs()) {
      if (type.name == format) {
        return type;
      }
      names.emplace_back(type.name);
    }
    throw base::Failure(base::ExitCode::bad_input, fmt::format("there is no log format '{}'{}", format, base::did_you_mean(format, names)));
  }
  LogBytes bytes(file);
  const std::string_view head = bytes.peek(kHead);
  for (const LogType& type : all_logs()) {
    if (type.recognises(head.substr(0, kHead))) {
      return type;
    }
  }
  if (head.empty() && bytes.broken()) {
    throw base::bad_input({file.string()}, "", to_string(*bytes.broken()));
  }
  throw not_a_game(file, head);
}

}  // namespace

std::string_view to_string(Team team) { return team == Team::yellow ? "yellow" : "blue"; }
std::string to_string(const RobotName& name) { return fmt::format("{} {}", to_string(name.team), name.id); }

std::string_view to_string(GamePhase phase) {
  constexpr std::array<std::string_view, 8> kNames{"unknown",     "off play",       "halt",    "stop",
                                                   "preparation", "ball placement", "timeout", "running"};
  return kNames.at(static_cast<std::size_t>(phase));
}

const std::vector<LogType>& all_logs() {
  static const std::vector<LogType> kAll = [] {
    std::vector<LogType> all;
    for (const auto& [name, make] : logs::registry) {
      all.push_back(make());
      all.back().name = name;
    }
    return all;
  }();
  return kAll;
}

RecordedGame import_game(const std::filesystem::path& file, const ImportOptions& options) {
  const LogType& type = log_type(file, options.format);
  TrackBuilder builder(options);
  builder.report().format = type.name;
  type.read(file, options, builder);
  return builder.finish();
}

RobotTrack only_in(const RobotTrack& track, std::span<const PhaseSpan> phases, std::span<const GamePhase> wanted) {
  RobotTrack cut{track.robot, {}};
  for (const TrackSegment& segment : track.segments) {
    for (const PhaseSpan& span : phases) {
      if (std::ranges::find(wanted, span.phase) == wanted.end()) {
        continue;
      }
      const auto begin = std::ranges::lower_bound(segment, span.begin_s, {}, &TrackPoint::time_s);
      const auto end = std::ranges::lower_bound(segment, span.end_s, {}, &TrackPoint::time_s);
      if (begin == end) {
        continue;
      }
      // Consecutive wanted phases stay one segment.
      const bool goes_on =
          !cut.segments.empty() && begin != segment.begin() && cut.segments.back().back().time_s == std::prev(begin)->time_s;
      if (goes_on) {
        cut.segments.back().insert(cut.segments.back().end(), begin, end);
      } else {
        cut.segments.emplace_back(begin, end);
      }
    }
  }
  return cut;
}

}  // namespace heatsoak::duty
