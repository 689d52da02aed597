#include "recording/named_logs.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "base/collected_failures.h"
#include "base/diagnostic.h"
#include "recording/mapping.h"
#include "recording/quality.h"
#include "recording/read_recording.h"

namespace heatsoak::recording {
namespace {

struct LogPart {
  std::string file;
  double from_share = 0.0;
  double to_share = 1.0;
  std::string suffix = {};  ///< "@0-60%" as the user wrote it; empty for a whole log
};

/// A recording and the part of its log that the user named.
struct ReadLog {
  Recording recording;
  std::string suffix;
};

/// Returns what is wrong with a part from `from` % to `to` %; empty for a part that a log can have.
std::string wrong_range(double from, double to) {
  const bool are_numbers = std::isfinite(from) && std::isfinite(to);
  if (are_numbers && (from < 0.0 || to > 100.0)) {
    return "the part is not within 0 to 100 % of the log; ";
  }
  if (are_numbers && from >= to) {
    return from > to ? fmt::format("the part ends at {} %, before its begin at {} %; ", to, from)
                     : fmt::format("the part begins and ends at {} %; ", from);
  }
  return are_numbers ? "" : "the part has no number; ";
}

/// Parses "run4.csv@0-60%": the first 60 % of the time of run4.csv.
LogPart log_part(const std::string& text) {
  const std::size_t at = text.rfind('@');
  const bool is_part =
      at != std::string::npos && (text.ends_with('%') || text.find_first_not_of("0123456789.-% ", at + 1) == std::string::npos);
  if (!is_part) {
    return {text};
  }
  const std::size_t dash = text.find('-', at);
  const auto number = [&](std::size_t begin, std::size_t end) -> std::optional<double> {
    double value = 0.0;
    const auto result = std::from_chars(text.data() + begin, text.data() + end, value);
    return result.ec == std::errc() && result.ptr == text.data() + end ? std::optional(value) : std::nullopt;
  };
  const bool has_form = text.ends_with('%') && dash != std::string::npos;
  const std::optional<double> from = has_form ? number(at + 1, dash) : std::nullopt;
  const std::optional<double> to = has_form ? number(dash + 1, text.size() - 1) : std::nullopt;
  const std::string wrong = from && to ? wrong_range(*from, *to) : "";
  if (!from || !to || !wrong.empty()) {
    throw base::Failure(base::ExitCode::bad_input, fmt::format("'{}': {}expected LOG@FROM-TO%, such as run4.csv@0-60%", text, wrong));
  }
  return {text.substr(0, at), *from / 100.0, *to / 100.0, text.substr(at)};
}

ReadLog read_one(const std::string& text, const LogChoice& choice, RecordingReport& report) {
  const LogPart part = log_part(text);
  const std::filesystem::path file = input::log_named(choice.folders, part.file);
  Recording whole = read_recording(file, mapping_for(file, choice.map), report);
  if (part.from_share == 0.0 && part.to_share == 1.0) {
    return {std::move(whole), {}};
  }
  Recording recording = part_of(whole, part.from_share, part.to_share);
  if (recording.rows() < 2) {
    throw base::bad_input(
        {file.string()}, "",
        fmt::format("'{}' has {} of the log's {} rows; expected a part with at least 2", text, recording.rows(), whole.rows()));
  }
  recording.blocking_of_whole = assess(whole, report, choice.ambient_C).blocking;
  return {std::move(recording), part.suffix};
}

std::vector<ReadLog> read_each(const std::vector<std::string>& texts, const LogChoice& choice,
                               std::set<std::filesystem::path>& reported, std::vector<LogReading>& readings,
                               base::CollectedFailures& failures) {
  std::vector<ReadLog> all;
  for (const std::string& text : texts) {
    RecordingReport report;
    if (std::optional<ReadLog> log = failures.attempt([&] { return read_one(text, choice, report); })) {
      // The report of a part is that of its whole log.
      if (reported.insert(std::filesystem::weakly_canonical(log->recording.file)).second) {
        readings.push_back({log->recording.name, std::move(report)});
      }
      all.push_back(*std::move(log));
    }
  }
  return all;
}

/// Names of recordings, each with its files.
using FilesOfName = std::map<std::string, std::set<std::filesystem::path>>;

void add_files(const std::vector<ReadLog>& logs, FilesOfName& files) {
  for (const ReadLog& each : logs) {
    files[each.recording.name].insert(std::filesystem::weakly_canonical(each.recording.file));
  }
}

/// Recordings that share their name with another file are named by the shortest path suffix that is unique.
void add_folders(std::vector<ReadLog>& logs, const FilesOfName& files) {
  for (ReadLog& each : logs) {
    const std::set<std::filesystem::path>& of_name = files.at(each.recording.name);
    const std::filesystem::path own = std::filesystem::weakly_canonical(each.recording.file);
    std::string name = each.recording.name;
    auto same = static_cast<std::ptrdiff_t>(of_name.size());
    for (std::filesystem::path folder = own.parent_path(); same > 1 && !folder.filename().empty(); folder = folder.parent_path()) {
      name = folder.filename().string() + "/" + name;
      same = std::ranges::count_if(
          of_name, [&](const std::filesystem::path& other) { return (other.parent_path() / other.stem()).string().ends_with("/" + name); });
    }
    each.recording.name = std::move(name);
  }
}

/// Returns the recordings. Parts of one log are named with their part, "bench@0-60%".
std::vector<Recording> with_distinct_names(std::vector<ReadLog> logs, const FilesOfName& files) {
  add_folders(logs, files);
  std::map<std::string, int> count;
  for (const ReadLog& each : logs) {
    ++count[each.recording.name];
  }
  std::vector<Recording> recordings;
  for (ReadLog& each : logs) {
    each.recording.name += count[each.recording.name] > 1 ? each.suffix : "";
    recordings.push_back(std::move(each.recording));
  }
  return recordings;
}

}  // namespace

NamedLogs read_usable_logs(const std::vector<std::string>& fitted, const std::vector<std::string>& held_out, const LogChoice& choice) {
  NamedLogs logs;
  logs.choice = choice;
  std::set<std::filesystem::path> reported;
  std::vector<ReadLog> of_fit = read_each(fitted, choice, reported, logs.readings, logs.unread);
  std::vector<ReadLog> of_holdout = read_each(held_out, choice, reported, logs.readings, logs.unread);
  FilesOfName files;
  add_files(of_fit, files);
  logs.fitted = with_distinct_names(std::move(of_fit), files);
  add_files(of_holdout, files);
  logs.held_out = with_distinct_names(std::move(of_holdout), files);
  return logs;
}

}  // namespace heatsoak::recording
