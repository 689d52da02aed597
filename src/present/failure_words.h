// Wording of failures that carry findings. Each file in src/present/failure_words has the words of some types.
#pragma once

#include <optional>

#include "base/diagnostic.h"

namespace heatsoak::present {

struct FailureWords {
  /// Returns the failure in words; nothing if it has none of these types.
  std::optional<base::Failure> (*worded)(const base::Failure& failure) = nullptr;
};

/// Returns the failure with its findings in words, as diagnostics or as part of its message. A failure without findings stays as it is.
base::Failure in_words(const base::Failure& failure);

/// Returns the result of `run`, or throws its failure in words.
template <class Run>
auto with_words(const Run& run) {
  try {
    return run();
  } catch (const base::Failure& failure) {
    throw in_words(failure);
  }
}

}  // namespace heatsoak::present
