#include "recording/named_logs.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
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
};

/// Parses "run4.csv@0-60%": the first 60 % of the time of run4.csv.
LogPart log_part(const std::string& text) {
  const std::size_t at = text.rfind('@');
  const bool is_part =
      at != std::string::npos && (text.ends_with('%') || text.find_first_not_of("0123456789.-% ", at + 1) == std::string::npos);
  if (!is_part) {
    return {text};
  }
  const std::size_t dash = text.find('-', at);
  LogPart part{text.substr(0, at)};
  const auto number = [&](std::size_t begin, std::size_t end, double& share) {
    const auto result = std::from_chars(text.data() + begin, text.data() + end, share);
    share /= 100.0;
    return result.ec == std::errc() && result.ptr == text.data() + end;
  };
  const bool is_sound = text.ends_with('%') && dash != std::string::npos && number(at + 1, dash, part.from_share) &&
                        number(dash + 1, text.size() - 1, part.to_share) && part.from_share >= 0.0 && part.from_share < part.to_share &&
                        part.to_share <= 1.0;
  if (!is_sound) {
    throw base::Failure(base::ExitCode::bad_input, fmt::format("'{}': expected LOG@FROM-TO%, such as run4.csv@0-60%", text));
  }
  return part;
}

Recording read_one(const std::string& text, const LogChoice& choice, RecordingReport& report) {
  const LogPart part = log_part(text);
  const std::filesystem::path file = input::log_named(choice.folders, part.file);
  Recording whole = read_recording(file, mapping_for(file, choice.map), report);
  if (part.from_share == 0.0 && part.to_share == 1.0) {
    return whole;
  }
  Recording recording = part_of(whole, part.from_share, part.to_share);
  if (recording.rows() < 2) {
    throw base::bad_input(
        {file.string()}, "",
        fmt::format("'{}' has {} of the log's {} rows; expected a part with at least 2", text, recording.rows(), whole.rows()));
  }
  recording.blocking_of_whole = assess(whole, report, choice.ambient_C).blocking;
  return recording;
}

std::vector<Recording> read_each(const std::vector<std::string>& texts, const LogChoice& choice, std::vector<LogReading>& readings,
                                 base::CollectedFailures& failures) {
  std::vector<Recording> all;
  for (const std::string& text : texts) {
    RecordingReport report;
    if (std::optional<Recording> recording = failures.attempt([&] { return read_one(text, choice, report); })) {
      readings.push_back({recording->name, std::move(report)});
      all.push_back(*std::move(recording));
    }
  }
  return all;
}

/// Names of recordings, each with its files.
using FilesOfName = std::map<std::string, std::set<std::filesystem::path>>;

void add_files(const std::vector<Recording>& recordings, FilesOfName& files) {
  for (const Recording& each : recordings) {
    files[each.name].insert(std::filesystem::weakly_canonical(each.file));
  }
}

/// Recordings that share their name with another file are named by the shortest path suffix that is unique.
void make_names_distinct(std::vector<Recording>& recordings, const FilesOfName& files) {
  for (Recording& each : recordings) {
    const std::set<std::filesystem::path>& of_name = files.at(each.name);
    const std::filesystem::path own = std::filesystem::weakly_canonical(each.file);
    std::string name = each.name;
    auto same = static_cast<std::ptrdiff_t>(of_name.size());
    for (std::filesystem::path folder = own.parent_path(); same > 1 && !folder.filename().empty(); folder = folder.parent_path()) {
      name = folder.filename().string() + "/" + name;
      same = std::ranges::count_if(
          of_name, [&](const std::filesystem::path& other) { return (other.parent_path() / other.stem()).string().ends_with("/" + name); });
    }
    each.name = std::move(name);
  }
}

}  // namespace

NamedLogs read_usable_logs(const std::vector<std::string>& fitted, const std::vector<std::string>& held_out, const LogChoice& choice) {
  NamedLogs logs;
  logs.choice = choice;
  logs.fitted = read_each(fitted, choice, logs.readings, logs.unread);
  logs.held_out = read_each(held_out, choice, logs.readings, logs.unread);
  FilesOfName files;
  add_files(logs.fitted, files);
  const FilesOfName of_fitted = files;
  add_files(logs.held_out, files);
  make_names_distinct(logs.held_out, files);
  make_names_distinct(logs.fitted, of_fitted);
  return logs;
}

}  // namespace heatsoak::recording
