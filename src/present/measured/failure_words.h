// Wording of failures that carry findings.
#pragma once

#include "base/diagnostic.h"

namespace heatsoak::present {

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
