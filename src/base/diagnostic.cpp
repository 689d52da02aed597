#include "base/diagnostic.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <numeric>
#include <tuple>

namespace heatsoak {
namespace {

std::string with_list(const std::string& message, const std::vector<Diagnostic>& diagnostics) {
  std::string text = message;
  for (const Diagnostic& each : diagnostics) {
    text += fmt::format("{}{}", text.empty() ? "" : "\n", to_string(each));
  }
  return text;
}

/// Levenshtein distance; the words are short.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (const char letter : a) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (letter == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string to_string(const Diagnostic& diagnostic) {
  std::string place = diagnostic.at.file;
  if (diagnostic.at.line > 0) {
    place += fmt::format(":{}:{}", diagnostic.at.line, diagnostic.at.column);
  }
  return fmt::format("{}{}error: {}{}{}", place, place.empty() ? "" : ": ", diagnostic.key, diagnostic.key.empty() ? "" : ": ",
                     diagnostic.message);
}

Failure::Failure(ExitCode code, std::string message, std::vector<Diagnostic> diagnostics)
    : std::runtime_error(with_list(message, diagnostics)),
      code_(code),
      message_(std::move(message)),
      diagnostics_(std::move(diagnostics)) {}

Failure bad_input(Location at, std::string key, std::string message) {
  std::vector<Diagnostic> one;
  one.push_back({std::move(at), std::move(key), std::move(message)});
  return {ExitCode::bad_input, "", std::move(one)};
}

void Diagnostics::add(Location at, std::string key, std::string message) {
  list_.push_back({std::move(at), std::move(key), std::move(message)});
}

void Diagnostics::throw_if_any() const {
  if (list_.empty()) {
    return;
  }
  std::vector<Diagnostic> sorted = list_;
  std::ranges::stable_sort(sorted, {}, [](const Diagnostic& d) { return std::tie(d.at.file, d.at.line, d.at.column); });
  throw Failure(ExitCode::bad_input, "", std::move(sorted));
}

std::string did_you_mean(std::string_view written, std::span<const std::string> candidates) {
  std::string given(written);
  std::ranges::transform(given, given.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  // Two letters of a short word are most of it.
  std::size_t best_distance = std::max<std::size_t>(given.size() < 4 ? 1 : 2, given.size() / 3) + 1;
  const std::string* best = nullptr;
  const std::string* begins_alike = nullptr;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(given, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = &candidate;
    }
  }
  for (std::size_t i = 0; !best && given.size() >= 3 && i < candidates.size(); ++i) {
    // What somebody leaves out: "tigers" for "tigers_v2020".
    best = candidates[i].find(given) != std::string::npos ? &candidates[i] : nullptr;
  }
  for (std::size_t i = 0; !best && given.size() >= 6 && i < candidates.size(); ++i) {
    // "roboteam_v2024" for "roboteam_twente_v2024".
    auto left = given.begin();
    for (const char c : candidates[i]) {
      left += left != given.end() && *left == c ? 1 : 0;
    }
    best = left == given.end() ? &candidates[i] : nullptr;
  }
  // What begins alike: "iron_lossX" for "iron_loss_eddy".
  std::size_t longest_match = std::max<std::size_t>(3, (2 * given.size() + 2) / 3) - 1;
  for (std::size_t i = 0; !best && i < candidates.size(); ++i) {
    const auto match = static_cast<std::size_t>(std::ranges::mismatch(given, candidates[i]).in1 - given.begin());
    begins_alike = match > longest_match ? &candidates[i] : begins_alike;
    longest_match = std::max(longest_match, match);
  }
  best = best ? best : begins_alike;
  return best ? fmt::format("; did you mean '{}'?", *best) : std::string();
}

}  // namespace heatsoak
