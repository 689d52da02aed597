#include "base/collected_failures.h"

#include <algorithm>

namespace heatsoak::base {

bool CollectedFailures::keep(const Failure& failure) {
  const bool is_of_input = failure.code() == ExitCode::bad_input || failure.code() == ExitCode::cannot_answer;
  if (is_of_input) {
    failures_.emplace_back(failure, std::current_exception());
  }
  return is_of_input;
}

void CollectedFailures::throw_if_any() const {
  if (failures_.empty()) {
    return;
  }
  if (failures_.size() == 1) {
    std::rethrow_exception(failures_.front().second);
  }
  ExitCode code = ExitCode::cannot_answer;
  std::vector<Diagnostic> all;
  const auto add = [&all](const Diagnostic& diagnostic) {
    const std::string text = to_string(diagnostic);
    if (std::ranges::none_of(all, [&text](const Diagnostic& each) { return to_string(each) == text; })) {
      all.push_back(diagnostic);
    }
  };
  for (const auto& [failure, thrown] : failures_) {
    code = failure.code() == ExitCode::bad_input ? ExitCode::bad_input : code;
    if (!failure.message().empty()) {
      add({{}, {}, failure.message()});
    }
    std::ranges::for_each(failure.diagnostics(), add);
  }
  throw Failure(code, "", std::move(all));
}

}  // namespace heatsoak::base
