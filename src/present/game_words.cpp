#include "present/game_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <string_view>
#include <variant>

namespace heatsoak::present {
namespace {

std::string say(const duty::BytesSkipped& of) { return fmt::format("no valid message here; {} bytes skipped", of.bytes); }

std::string say(const duty::RestNotRead& of) {
  return fmt::format("no {}message in the {} bytes from here on; the rest of the log is not read", of.has_empty_messages ? "usable " : "",
                     of.bytes);
}

std::string say(const duty::EndsWithoutMessage& of) {
  return fmt::format("no message begins here, nor in the {} bytes that follow", of.bytes);
}

std::string say(const duty::MessageUndecodable& of) {
  constexpr std::array<std::string_view, 3> kKinds{"vision", "tracker", "referee"};
  return fmt::format("{} message that cannot be decoded; left out", kKinds.at(static_cast<std::size_t>(of.kind)));
}

std::string say(const duty::RefereeUndefined& of) {
  return fmt::format("referee message with stage {} and command {}; left out", of.stage, of.command);
}

std::string say(const duty::TimeNotIncreasing& of) {
  return fmt::format("{} at {} s, after {} s; time must increase for each robot; left out", to_string(of.robot), of.time_s, of.after_s);
}

std::string say(const duty::ClockRestarts& of) {
  return fmt::format("{} at {} s, after {} s: its clock restarts; the following rows are taken as {} s later", to_string(of.robot),
                     of.time_s, of.after_s, of.pause_s);
}

std::string say(const duty::BytesEndEarly& of) { return to_string(of) + "; what came before is used"; }

std::string say(const duty::NoFrameWithRobots& of) {
  return fmt::format("the log holds no frame of {} with robots", of.source == duty::PositionSource::Kind::tracker ? "a tracker" : "vision");
}

std::string say(const duty::RowsFarApart& of) {
  constexpr std::array<std::string_view, 3> kUnits{"milliseconds", "microseconds", "nanoseconds"};
  return fmt::format("t_s advances by {:.3g} s from row to row of a robot, expected at most {} s: is it in {}, or are rows missing?",
                     of.step_s, duty::kLongestBridge_s, kUnits.at(static_cast<std::size_t>(of.suspected)));
}

std::string say(const duty::RowsWithoutPosition& of) {
  return fmt::format("{} rows without a position left out: the robot was lost", of.rows);
}

std::string say(const duty::TimesRepeat& /*of*/) {
  return "most times repeat, as if t_s was rounded; expected increasing times for each robot: write t_s to the millisecond";
}

std::string say(const duty::RowsNotSorted& /*of*/) { return "most rows go back in time: expected the rows of each robot sorted by t_s"; }

std::string say(const duty::LastRowOmitted& of) {
  return fmt::format("line {}, the last, has no line break at its end and may be truncated: left out", of.line);
}

std::string source_words(const duty::PositionSource& source) {
  switch (source.kind) {
    case duty::PositionSource::Kind::vision:
      return fmt::format("vision, {} cameras", source.cameras);
    case duty::PositionSource::Kind::tracker:
      return fmt::format("tracker '{}'", source.tracker);
    case duty::PositionSource::Kind::table:
      return "positions in a table";
    case duty::PositionSource::Kind::unknown:
      break;
  }
  return "no source";
}

std::string channel_words(const duty::ChannelReport& channel, std::string_view name, std::string_view unit) {
  // With almost only noise its share is meaningless, so the bound of the acceleration is printed instead.
  const std::string trust = channel.is_mostly_noise()
                                ? fmt::format("the acceleration is below the noise, which is at most {:.2g} {}/s² rms",
                                              channel.acceleration_noise_m_or_rad_per_s2, unit)
                                : fmt::format("about {:.1f} % of the squared acceleration is noise", 100.0 * channel.noise_share);
  return fmt::format(
      "{}: bandwidth {:.1f} Hz (-3 dB; {:.1f} Hz during the {:.0f} % of the time that shows only noise), noise {:.1f} m{}, "
      "{}, {} outliers ignored",
      name, channel.bandwidth_Hz, channel.quiet_bandwidth_Hz, 100.0 * channel.quiet_share, 1e3 * channel.noise_m_or_rad, unit, trust,
      channel.outliers);
}

std::string smoothing_words(const duty::SmoothingReport& report) {
  return fmt::format("{} points at {:.1f} Hz; {}; {}", report.points, report.frame_rate_Hz, channel_words(report.place, "place", "m"),
                     channel_words(report.turn, "turn", "rad"));
}

}  // namespace

std::string words_of(const duty::LogFault& fault) {
  return std::visit([](const auto& each) { return say(each); }, fault);
}

std::string words_of(const duty::ImportNote& note) {
  return std::visit([](const auto& each) { return say(each); }, note);
}

std::vector<std::string> words_of(const duty::ImportReport& report) {
  std::vector<std::string> lines;
  const auto add_count = [&lines](std::uint64_t count, std::string_view what) {
    if (count > 0) {
      lines.push_back(fmt::format("{} {}", count, what));
    }
  };
  lines.push_back(fmt::format("{}: {} messages in {} bytes, {} frames of {} over {:.1f} s, {} detections of {} robots", report.format,
                              report.messages, report.bytes, report.frames, source_words(report.source), report.span_s, report.detections,
                              report.robots.size()));
  add_count(report.frames_of_other_sources, "frames of other sources not used");
  add_count(report.merged, "detections joined with those of another camera");
  add_count(report.doubled, "detections of a robot that one frame holds twice left out");
  add_count(report.outliers, "detections left out: too far from where the robot can be");
  add_count(report.implausible, "detections left out: not a number, no such robot, outside any field, or not in sight");
  add_count(report.out_of_order, "detections left out: not after the one before");
  add_count(report.bridged_gaps, fmt::format("gaps up to {} s bridged", duty::kLongestBridge_s));
  add_count(report.cuts, fmt::format("gaps longer than {} s: tracks cut there", duty::kLongestBridge_s));
  add_count(report.teleports, "times a robot reappeared elsewhere: tracks cut there");
  add_count(report.short_segments, "track segments left out because they are too short");
  add_count(report.clock_jumps, "jumps of the clock: all tracks cut there");
  add_count(report.frames_out_of_time, "frames left out: no other frame confirms their time of capture");
  if (report.full_at_s) {
    lines.push_back(
        fmt::format("points from {:.0f} s on are not used, because they do not fit into memory; split the log", *report.full_at_s));
  }
  if (report.truncated_at) {
    lines.push_back(fmt::format("the log ends inside a message that begins at byte {}; what came before is used", *report.truncated_at));
  }
  for (const duty::ImportNote& each : report.notes) {
    lines.push_back(words_of(each));
  }
  const std::string_view place = report.source.kind == duty::PositionSource::Kind::table ? "line" : "byte";
  for (const duty::LogProblem& each : report.problems) {
    lines.push_back(fmt::format("{} {}: {}", place, each.at, words_of(each.fault)));
  }
  add_count(report.problems_in_all - report.problems.size(), "more problems of this kind");
  return lines;
}

std::vector<std::string> words_of(const duty::GameDemand& game) {
  std::vector<std::string> lines = words_of(game.log);
  if (!game.smoothing) {
    return lines;
  }
  lines.push_back(fmt::format("{}: {}", game.player, smoothing_words(*game.smoothing)));
  if (game.low_sight_rate_Hz) {
    lines.push_back(
        fmt::format("{}: torques are uncertain and accelerations smoothed, because the robot is seen only {:.1f} times a second; expected "
                    "{:.0f} or more",
                    game.player, *game.low_sight_rate_Hz, duty::kFewestSights_Hz));
  }
  if (game.clock_jumps > 0) {
    lines.push_back(fmt::format("{}: the time jumps ahead by more than {:.0f} s {} times; these gaps are left out", game.player,
                                duty::kLongestAbsence_s, game.clock_jumps));
  }
  lines.push_back(fmt::format(
      "{}: {:.0f} s, {:.0f} s of them not seen (taken as standstill); the motion needed more grip than available in {:.1f} % of the time",
      game.player, game.wheels.front().duration_s(), game.unseen_s, 100.0 * game.wheels.front().slip_share));
  return lines;
}

base::Failure in_words(const duty::GameNotUsable& failure) {
  return {failure.code(), fmt::format("{}\n{}", failure.message(), fmt::join(words_of(failure.game()), "\n"))};
}

}  // namespace heatsoak::present
