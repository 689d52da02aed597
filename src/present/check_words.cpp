#include "present/check_words.h"

#include <fmt/format.h>

#include <type_traits>
#include <variant>

#include "base/counted.h"
#include "check/limit.h"
#include "check/limit_words.h"

namespace heatsoak::present {
namespace {

std::string comparison_words(const check::Outcome& outcome) {
  const check::ThresholdType& type = *outcome.limit.type;
  const std::string limit = check::shown(outcome.limit.value, type);
  if (outcome.measured->is_never) {
    return fmt::format("it never happens; expected it within {}", limit);
  }
  return fmt::format("{} is {} the limit of {}", value_words(outcome), type.direction == check::Bound::at_most ? "above" : "below", limit);
}

std::string cause_words(const check::NotRewritten& cause, const check::ThresholdType& type) {
  return std::visit(
      [&type](const auto& each) -> std::string {
        using Kind = std::decay_t<decltype(each)>;
        if constexpr (std::is_same_v<Kind, check::Looseness>) {
          return check::words_of(each, type);
        } else if constexpr (std::is_same_v<Kind, check::LimitInvalid>) {
          return check::words_of(each.problem, type);
        } else {
          static_assert(std::is_same_v<Kind, check::NoTimeSuffices>);
          return "no time is long enough";
        }
      },
      cause);
}

}  // namespace

std::string conclusion_words(std::span<const check::Outcome> outcomes) {
  const check::OutcomeCounts counts = check::count(outcomes);
  if (counts.broken + counts.not_evaluated == 0) {
    return fmt::format("{} {}", base::counted(counts.all, "limit"), counts.all == 1 ? "holds" : "hold");
  }
  std::string text;
  if (counts.broken > 0) {
    text = fmt::format("{} of {} {} not hold", base::counted(counts.broken, "limit"), counts.all, counts.broken == 1 ? "does" : "do");
  }
  if (counts.not_evaluated > 0) {
    text += fmt::format("{}{} of {} cannot be evaluated and {} as failed", text.empty() ? "" : "; ",
                        base::counted(counts.not_evaluated, "limit"), counts.all, counts.not_evaluated == 1 ? "counts" : "count");
  }
  return text;
}

std::string value_words(const check::Outcome& outcome) {
  return outcome.measured ? check::shown(outcome.measured->value, *outcome.limit.type) : "–";
}

std::string margin_words(const check::Outcome& outcome) {
  if (!outcome.measured || outcome.measured->is_never) {
    return "–";
  }
  const double margin = *outcome.margin_value();
  const check::ThresholdType& type = *outcome.limit.type;
  if (type.unit == "degC") {
    return fmt::format("{:+.1f} K", margin);
  }
  const std::string text = check::shown(margin, type);
  return margin > 0.0 ? "+" + text : text;
}

std::string limit_words(const check::Outcome& outcome) {
  const check::ThresholdType& type = *outcome.limit.type;
  return fmt::format("{} {}", check::to_string(type.direction), check::shown(outcome.limit.value, type));
}

std::string subject_words(const check::Check& check) {
  std::string text;
  const auto add = [&text](const std::string& id) { text += (text.empty() ? "" : ", ") + id; };
  if (!check.command.empty()) {
    add(check.command);
  }
  if (check.motor) {
    add(check.motor->id);
  }
  if (check.robot) {
    add(check.robot->id);
  }
  if (check.duty) {
    add(check.duty->id);
  }
  return text;
}

std::string reason_words(const check::Outcome& outcome) {
  std::string text;
  if (outcome.reason) {
    text = words_of(*outcome.reason, outcome.limit);
  } else if (outcome.status() == check::Status::broken) {
    text = comparison_words(outcome);
  }
  if (outcome.not_rewritten) {
    text +=
        fmt::format("{}the limit is not rewritten: {}", text.empty() ? "" : "; ", cause_words(*outcome.not_rewritten, *outcome.limit.type));
  }
  return text;
}

std::string explanation_words(const check::Outcome& outcome) {
  const std::string basis = basis_words(outcome);
  if (outcome.passed()) {
    return basis;
  }
  return basis.empty() ? reason_words(outcome) : fmt::format("{}: {}", reason_words(outcome), basis);
}

}  // namespace heatsoak::present
