// Command line of a study program: a few words in a fixed order. --help prints the usage; a wrong word ends with exit code 2.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/version.h"

namespace heatsoak {

/// The message states the word and what was expected in its place.
class WrongWord : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Words behind the program's name. All functions throw WrongWord.
class StudyWords {
 public:
  StudyWords(std::vector<std::string> words, std::size_t most) : words_(std::move(words)) {
    for (const std::string& each : words_) {
      if (each.starts_with('-')) {
        throw WrongWord(fmt::format("there is no option {}", each));
      }
    }
    if (words_.size() > most) {
      throw WrongWord(fmt::format("'{}' is one word too many; expected at most {}", words_[most], most));
    }
  }

  [[nodiscard]] const std::vector<std::string>& all() const { return words_; }
  [[nodiscard]] bool has(std::size_t place) const { return place < words_.size(); }

  /// Returns the word, which must exist.
  [[nodiscard]] const std::string& required(std::size_t place, std::string_view name) const {
    if (!has(place)) {
      throw WrongWord(fmt::format("{} is missing", name));
    }
    return words_[place];
  }
  /// Returns the existing folder of that name, or `otherwise` without the word.
  [[nodiscard]] std::filesystem::path folder(std::size_t place, const std::filesystem::path& otherwise) const {
    const std::filesystem::path found = has(place) ? std::filesystem::path(words_[place]) : otherwise;
    if (!std::filesystem::is_directory(found)) {
      throw WrongWord(fmt::format("{} is no folder; make it first", found.string()));
    }
    return found;
  }
  /// Returns a whole number from `least` to `most`, or `otherwise` without the word.
  [[nodiscard]] std::uint64_t whole(std::size_t place, std::string_view name, std::uint64_t least, std::uint64_t otherwise,
                                    std::uint64_t most = std::numeric_limits<std::int32_t>::max()) const {
    std::uint64_t value = otherwise;
    if (has(place) && (!is_number(words_[place], value) || value < least || value > most)) {
      throw WrongWord(fmt::format("{} is '{}'; expected a whole number from {} to {}", name, words_[place], least, most));
    }
    return value;
  }
  /// Returns a finite number above 0, or `otherwise` without the word.
  [[nodiscard]] double positive(std::size_t place, std::string_view name, double otherwise) const {
    double value = otherwise;
    if (has(place) && (!is_number(words_[place], value) || !std::isfinite(value) || value <= 0.0)) {
      throw WrongWord(fmt::format("{} is '{}'; expected a number above 0", name, words_[place]));
    }
    return value;
  }
  /// Returns the word, which must be one of `names`, or an empty text without the word.
  [[nodiscard]] std::string one_of(std::size_t place, const std::vector<std::string_view>& names) const {
    if (!has(place)) {
      return {};
    }
    if (std::ranges::find(names, words_[place]) == names.end()) {
      throw WrongWord(fmt::format("'{}' is not known; expected one of {}", words_[place], fmt::join(names, ", ")));
    }
    return words_[place];
  }

 private:
  template <class Number>
  static bool is_number(std::string_view word, Number& value) {
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc() && end == word.data() + word.size();
  }

  std::vector<std::string> words_;
};

/// Runs `study(words)`, which returns the exit code, and prints the program's version to stderr. Returns 0 after --help, 2 after a wrong
/// word, 70 after any other exception.
template <class Study>
int run_study(int argc, char** argv, std::string_view usage, std::size_t most_words, const Study& study) {
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (std::ranges::any_of(words, [](const std::string& word) { return word == "--help" || word == "-h"; })) {
    fmt::print("{}", usage);
    return 0;
  }
  try {
    const int exit_code = study(StudyWords(std::move(words), most_words));
    // Study programs are not part of an ordinary build: the version shows an old one.
    fmt::print(stderr, "made with heatsoak {}\n", base::program_version());
    return exit_code;
  } catch (const WrongWord& wrong) {
    fmt::print(stderr, "{}\n{}", wrong.what(), usage);
    return 2;
  } catch (const std::exception& problem) {
    fmt::print(stderr, "{}\n", problem.what());
    return 70;
  }
}

}  // namespace heatsoak
