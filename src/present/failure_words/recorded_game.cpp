#include "present/failure_words.h"
#include "present/game_words.h"

namespace heatsoak::present::failure_words {

FailureWords recorded_game() {
  return {[](const base::Failure& failure) -> std::optional<base::Failure> {
    const auto* const found = dynamic_cast<const duty::GameNotUsable*>(&failure);
    return found != nullptr ? std::optional(in_words(*found)) : std::nullopt;
  }};
}

}  // namespace heatsoak::present::failure_words
