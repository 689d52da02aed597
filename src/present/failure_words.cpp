#include "present/failure_words.h"

#include <exception>
#include <vector>

#include "base/collected_failures.h"
#include "present/failure_words_registry.h"

namespace heatsoak::present {
namespace {

base::Failure each_in_words(const base::SeveralFailures& several) {
  std::vector<base::Failure> parts;
  for (const auto& [failure, thrown] : several.parts()) {
    try {
      std::rethrow_exception(thrown);
    } catch (const base::Failure& own) {
      parts.push_back(in_words(own));
    }
  }
  return base::joined(parts);
}

}  // namespace

base::Failure in_words(const base::Failure& failure) {
  if (const auto* const several = dynamic_cast<const base::SeveralFailures*>(&failure)) {
    return each_in_words(*several);
  }
  for (const auto& [name, make] : failure_words::registry) {
    if (std::optional<base::Failure> worded = make().worded(failure)) {
      return *std::move(worded);
    }
  }
  return failure;
}

}  // namespace heatsoak::present
