// Expects one sentence for every kind of finding.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

// The template looks up words_of() where it is defined.
#include "present/measured/calibration_words.h"
#include "present/measured/friction_words.h"
#include "present/measured/log_words.h"

namespace heatsoak::present {

template <class Finding>
using Sentences = std::vector<std::pair<Finding, const char*>>;

/// Expects the sentence of each finding, and that the list has every kind of finding. No sentence may have joined punctuation, as "?;" of
/// a question inside of a sentence, or a number with an exponent.
template <class Finding>
void expect_words(const Sentences<Finding>& sentences) {
  std::set<std::size_t> kinds;
  for (const auto& [finding, expected] : sentences) {
    const std::string words = words_of(finding);
    EXPECT_EQ(words, expected);
    EXPECT_THAT(words, testing::Not(testing::ContainsRegex("[?!.];|[0-9]e[+-][0-9]")));
    kinds.insert(finding.index());
  }
  EXPECT_EQ(kinds.size(), std::variant_size_v<Finding>);
}

}  // namespace heatsoak::present
