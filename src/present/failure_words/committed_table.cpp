#include "derate/committed_table.h"

#include <fmt/format.h>

#include "present/derating.h"
#include "present/failure_words.h"

namespace heatsoak::present::failure_words {

FailureWords committed_table() {
  return {[](const base::Failure& failure) -> std::optional<base::Failure> {
    const auto* const found = dynamic_cast<const derate::SensorsDiffer*>(&failure);
    return found != nullptr
               ? std::optional<base::Failure>({found->code(), fmt::format("{}: {}", found->message(), words_of(found->difference()))})
               : std::nullopt;
  }};
}

}  // namespace heatsoak::present::failure_words
