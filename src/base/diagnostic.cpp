#include "base/diagnostic.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <numeric>
#include <optional>
#include <tuple>

namespace heatsoak::base {
namespace {

std::string with_list(const std::string& message, const std::vector<Diagnostic>& diagnostics) {
  std::string text = message;
  for (const Diagnostic& each : diagnostics) {
    text += fmt::format("{}{}", text.empty() ? "" : "\n", to_string(each));
  }
  return text;
}

std::string in_small_letters(std::string_view word) {
  std::string small(word);
  std::ranges::transform(small, small.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return small;
}

bool has_letters_in_order(std::string_view word, std::string_view letters) {
  for (const char c : word) {
    letters.remove_prefix(!letters.empty() && letters.front() == c ? 1 : 0);
  }
  return letters.empty();
}

/// Returns the Levenshtein distance. O(|a|·|b|).
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

std::string to_string(const Location& at) {
  std::string text = at.file;
  for (const std::optional<int> number : {at.line, at.column}) {
    text += number ? fmt::format(":{}", *number) : "";
  }
  return text;
}

std::string to_string(const Diagnostic& diagnostic) {
  const std::string place = to_string(diagnostic.at);
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
  const std::string given = in_small_letters(written);
  std::vector<std::string> known;
  std::ranges::transform(candidates, std::back_inserter(known), in_small_letters);
  // A short word allows one wrong letter only: two would match almost any other short word.
  std::size_t best_distance = std::max<std::size_t>(given.size() < 4 ? 1 : 2, given.size() / 3) + 1;
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < known.size(); ++i) {
    const std::size_t distance = edit_distance(given, known[i]);
    if (distance < best_distance) {
      best_distance = distance;
      best = i;
    }
  }
  const auto take_first = [&](const auto& is_meant) {
    const auto found = best ? known.end() : std::ranges::find_if(known, is_meant);
    best = found == known.end() ? best : static_cast<std::size_t>(found - known.begin());
  };
  // Abbreviations: "tigers" for "tigers_v2020", "roboteam_v2024" for "roboteam_twente_v2024".
  take_first([&](const std::string& each) { return given.size() >= 3 && each.find(given) != std::string::npos; });
  take_first([&](const std::string& each) { return given.size() >= 6 && has_letters_in_order(each, given); });
  // A common beginning: "iron_lossX" for "iron_loss_eddy".
  std::size_t longest_match = std::max<std::size_t>(3, (2 * given.size() + 2) / 3) - 1;
  std::optional<std::size_t> begins_alike;
  for (std::size_t i = 0; i < known.size(); ++i) {
    const auto match = static_cast<std::size_t>(std::ranges::mismatch(given, known[i]).in1 - given.begin());
    begins_alike = match > longest_match ? i : begins_alike;
    longest_match = std::max(longest_match, match);
  }
  best = best ? best : begins_alike;
  return best ? fmt::format("; did you mean '{}'?", candidates[*best]) : std::string();
}

}  // namespace heatsoak::base
