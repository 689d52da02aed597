#include "scoring.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ranges>

namespace heatsoak::attribution::truth {
namespace {

/// Returns the id without the node: iron_loss_eddy for "iron_loss_eddy@stator".
std::string plain(const std::string& id) { return id.substr(0, id.find('@')); }

bool is_name_of(const std::string& id, const Subject& subject) {
  return plain(id) == subject.name || std::ranges::find(subject.same, plain(id)) != subject.same.end();
}

std::string curve_name(const Selection& selection, const ScanResult& curve) {
  return fmt::format("{}~{} x {}", curve.term.node, selection.regressors[static_cast<std::size_t>(curve.term.regressor)].name,
                     spec_of(curve.term.multiplier).name);
}

}  // namespace

std::string in_words(const Share& share) {
  if (share.of == 0) {
    return "no case";
  }
  const double n = share.of, p = share.right / n, z = 1.96;
  const double middle = (p + z * z / (2 * n)) / (1 + z * z / n);
  const double half = z * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n)) / (1 + z * z / n);
  return fmt::format("{:.1f} % ({}/{}; 95 %: {:.1f} to {:.1f})", 100 * p, share.right, share.of, 100 * std::max(0.0, middle - half),
                     100 * std::min(1.0, middle + half));
}

bool Claim::expect(bool holds, const std::string& what) {
  if (!holds) {
    missed_ += " " + what + ";";
  }
  return holds;
}

SeedRate rate_over_seeds(int count, const std::function<void(std::uint64_t, Claim&)>& check) {
  SeedRate rate;
  Share share;
  for (int seed = 1; seed <= count; ++seed) {
    Claim claim;
    check(static_cast<std::uint64_t>(seed), claim);
    share.add(claim.missed().empty());
    if (!claim.missed().empty()) {
      rate.misses += fmt::format("\nseed {}:{}", seed, claim.missed());
    }
  }
  rate.right = share.right;
  fmt::print("holds for {}{}\n", in_words(share), rate.misses);
  std::fflush(stdout);
  return rate;
}

bool names(const std::vector<std::string>& named, const Subject& subject) {
  return std::ranges::any_of(named, [&](const std::string& id) { return is_name_of(id, subject); });
}

bool names_only(const std::vector<std::string>& named, const std::vector<const Subject*>& subjects) {
  return named.size() == subjects.size() && std::ranges::all_of(subjects, [&](const Subject* subject) { return names(named, *subject); });
}

bool names_outsider(const Answer& answer, const Outsider& outsider) {
  const Selection& selection = answer.diagnosis.selection;
  const auto is_right = [&](const ScanResult& curve) {
    const std::string& regressor = selection.regressors[static_cast<std::size_t>(curve.term.regressor)].name;
    return curve.term.node == outsider.node && spec_of(curve.term.multiplier).second_signal == outsider.times &&
           std::ranges::find(outsider.regressors, regressor) != outsider.regressors.end();
  };
  // Only the first term counts as the answer; further terms may follow.
  const bool leads = !selection.terms.empty() && selection.terms.front().curve && is_right(*selection.terms.front().curve);
  return leads && answer.diagnosis.verdict == diagnosis::DiagnosisVerdict::unexplained;
}

bool gives_a_name(const Answer& answer) {
  const auto is_named = [](const diagnosis::Unexplained& heat) { return !heat.signals.empty() && heat.signals.front() != kTimeRegressor; };
  return std::ranges::any_of(answer.diagnosis.effects, &diagnosis::FoundEffect::is_from_catalogue) ||
         std::ranges::any_of(answer.diagnosis.unexplained, is_named);
}

bool leaves_unnamed(const Answer& answer, const Outsider& stranger) {
  return answer.diagnosis.verdict == diagnosis::DiagnosisVerdict::unexplained && !gives_a_name(answer) &&
         std::ranges::find(answer.diagnosis.unexplained, stranger.node, &diagnosis::Unexplained::node) !=
             answer.diagnosis.unexplained.end();
}

bool mentions(const Answer& answer, const Subject& subject) {
  return std::ranges::any_of(answer.diagnosis.selection.terms, [&](const AcceptedTerm& term) {
    return (term.candidate && is_name_of(term.candidate->id, subject)) || names(term.confusable_with, subject);
  });
}

bool is_silent(const Answer& answer) { return answer.named.empty(); }

std::string account(const Answer& answer) {
  const Selection& selection = answer.diagnosis.selection;
  std::string text = fmt::format("{:5.2f} s {:6.3f} -> {:6.3f} K {}", answer.seconds_s, answer.before_K, answer.after_K,
                                 diagnosis::to_string(answer.diagnosis.verdict));
  for (std::size_t i = 0; i < answer.named.size(); ++i) {
    const AcceptedTerm& term = selection.terms[i];
    text += fmt::format(" [{} {:.1f} nats, visible {:.2f}{}]", answer.named[i], term.loss_without_nats, term.visibility_ratio,
                        term.confusable_with.empty() ? "" : fmt::format(", or {}", fmt::join(term.confusable_with, "/")));
  }
  for (const Round& round : selection.rounds) {
    text += " |";
    for (std::size_t i = 0; i < std::min<std::size_t>(4, round.ladder.size()); ++i) {
      const JudgedCandidate& each = round.ladder[i];
      text += fmt::format(" {}:{:.1f}(v{:.2f},P{:.2f})", each.candidate.id, each.gain_nats, each.visibility_ratio, each.probability);
    }
    for (std::size_t i = 0; i < std::min<std::size_t>(3, round.scan.size()); ++i) {
      text += fmt::format(" {}:{:.1f}", curve_name(selection, round.scan[i]), round.scan[i].gain_nats);
    }
  }
  for (const Refusal& each : selection.refused) {
    text += fmt::format(" | refused {}, reason {}, P {:.2f}", each.id, static_cast<int>(each.reason), each.probability);
  }
  for (const diagnosis::Unexplained& heat : answer.diagnosis.unexplained) {
    text += fmt::format(" | unexplained {}~{} {:.2f} W", heat.node, fmt::join(heat.signals, "/"), heat.rms_W);
  }
  const estimation::LatentFlux& flux = selection.after.flux;
  return text +
         fmt::format(" | unknown {:.2f} W, {:.0f} s of {:.1f} W", fmt::join(flux.rms_W, ", "), flux.time_scale_s, selection.mean_heat_W) +
         fmt::format(" | left {:.2f} W of {:.2f} W", fmt::join(std::views::values(selection.left_W), ", "), selection.material_W);
}

std::string account(const diagnosis::Diagnosis& diagnosis) {
  std::string text(diagnosis::to_string(diagnosis.verdict));
  for (const diagnosis::FoundEffect& effect : diagnosis.effects) {
    text += fmt::format(" [{}@{} {:.1f} nats, {:.2f} W]", effect.id, effect.node, effect.gain_nats, effect.mean_W);
  }
  for (const diagnosis::ChangedParameter& parameter : diagnosis.changed) {
    text += fmt::format(" | {}: {:.3g} -> {:.3g}", parameter.name, parameter.before, parameter.value);
  }
  for (const diagnosis::Unexplained& heat : diagnosis.unexplained) {
    text += fmt::format(" | unexplained {}~{} {:.2f} W", heat.node, fmt::join(heat.signals, "/"), heat.rms_W);
  }
  return text;
}

}  // namespace heatsoak::attribution::truth
