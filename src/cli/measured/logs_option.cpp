#include "cli/measured/logs_option.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>
#include <set>

#include "base/diagnostic.h"
#include "cli/quantity_option.h"
#include "present/measured/log.h"
#include "recording/mapping.h"
#include "recording/quality.h"
#include "recording/read_recording.h"

namespace heatsoak {
namespace {

struct LogPart {
  std::string file;
  double from_share = 0.0;
  double to_share = 1.0;
};

/// Parses "run4.csv@0-60%": the first 60 % of the time of run4.csv.
LogPart log_part(const std::string& text) {
  const std::size_t at = text.rfind('@');
  if (at == std::string::npos || text.find_first_not_of("0123456789.-% ", at + 1) != std::string::npos) {
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
    throw Failure(ExitCode::bad_input, fmt::format("'{}': expected LOG@FROM-TO%, such as run4.csv@0-60%", text));
  }
  return part;
}
}  // namespace

void add_log_options(CLI::App& app, LogOptions& options) {
  app.add_option("--map", options.map, "mapping of columns to quantities; LOG.map.toml beside a log is found automatically")
      ->type_name("FILE.toml");
  add_quantity(app, "--ambient", options.ambient_C,
               {"ambient", "degC", Range::between(-60.0, 200.0), "air temperature of a log that has none"});
  app.add_flag("--as-is", options.takes_logs_as_they_are, "continue although units or sensors of a log look wrong");
}

std::vector<Recording> read_logs(const DataFolders& folders, const std::vector<std::string>& texts, const LogOptions& options,
                                 std::vector<std::string>& notes) {
  std::vector<Recording> all;
  for (const std::string& text : texts) {
    const LogPart part = log_part(text);
    RecordingReport report;
    const std::filesystem::path file = log_named(folders, part.file);
    Recording recording = read_recording(file, mapping_for(file, options.map), report);
    const auto tell = [&](std::string note) {
      // Several parts of one log give the same note; it is kept once.
      if (std::ranges::find(notes, note) == notes.end()) {
        notes.push_back(std::move(note));
      }
    };
    for (const std::string& note : report.notes) {
      tell(fmt::format("{}: {}", recording.name, note));
    }
    for (const std::string& sentence : present::left_out_sentences(report)) {
      tell(fmt::format("{}: left out: {}", recording.name, sentence));
    }
    if (part.from_share == 0.0 && part.to_share == 1.0) {
      all.push_back(std::move(recording));
      continue;
    }
    all.push_back(part_of(recording, part.from_share, part.to_share));
    all.back().blocking_of_whole = assess(recording, report, options.ambient_C).blocking;
  }
  return all;
}

namespace {

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

void make_names_distinct(std::vector<Recording>& fitted, std::vector<Recording>& held_out) {
  FilesOfName files;
  add_files(fitted, files);
  const FilesOfName of_fitted = files;
  add_files(held_out, files);
  make_names_distinct(held_out, files);
  make_names_distinct(fitted, of_fitted);
}

}  // namespace heatsoak
