#include "base/collected_failures.h"

#include <algorithm>

namespace heatsoak::base {
namespace {

std::vector<Failure> first_of(const std::vector<SeveralFailures::Part>& parts) {
  std::vector<Failure> failures;
  for (const auto& [failure, thrown] : parts) {
    failures.push_back(failure);
  }
  return failures;
}

}  // namespace

Failure joined(std::span<const Failure> failures) {
  ExitCode code = ExitCode::cannot_answer;
  std::vector<Diagnostic> all;
  const auto add = [&all](const Diagnostic& diagnostic) {
    const std::string text = to_string(diagnostic);
    if (std::ranges::none_of(all, [&text](const Diagnostic& each) { return to_string(each) == text; })) {
      all.push_back(diagnostic);
    }
  };
  for (const Failure& failure : failures) {
    code = failure.code() == ExitCode::bad_input ? ExitCode::bad_input : code;
    if (!failure.message().empty()) {
      add({{}, {}, failure.message()});
    }
    std::ranges::for_each(failure.diagnostics(), add);
  }
  return {code, "", std::move(all)};
}

SeveralFailures::SeveralFailures(std::vector<Part> parts) : Failure(joined(first_of(parts))), parts_(std::move(parts)) {}

bool CollectedFailures::keep(const Failure& failure) {
  const bool is_of_input = failure.code() == ExitCode::bad_input || failure.code() == ExitCode::cannot_answer;
  if (const auto* const several = dynamic_cast<const SeveralFailures*>(&failure)) {
    failures_.insert(failures_.end(), several->parts().begin(), several->parts().end());
  } else if (is_of_input) {
    failures_.emplace_back(failure, std::current_exception());
  }
  return is_of_input;
}

void CollectedFailures::throw_if_any() const {
  if (failures_.size() == 1) {
    std::rethrow_exception(failures_.front().second);
  }
  if (!failures_.empty()) {
    throw SeveralFailures(failures_);
  }
}

}  // namespace heatsoak::base
