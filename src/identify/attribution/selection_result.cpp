#include <fmt/format.h>

#include <algorithm>

#include "identify/attribution/selection.h"

namespace heatsoak {

void AcceptedTerm::add_rival(const Candidate& other) {
  if (other.id != candidate->id && std::ranges::find(confusable_with, other.id) == confusable_with.end()) {
    confusable_with.push_back(other.id);
    experiments.emplace_back(other.experiment());
  }
}

void Selection::forget_refusal(const std::string& id) {
  std::erase_if(refused, [&](const Refusal& known) { return known.id == id; });
}

bool Selection::leaves_doubt() const { return !std::ranges::all_of(refused, &Refusal::is_negligible); }

void Selection::refuse(const std::string& id, double gain_nats, std::string_view why, bool is_negligible) {
  forget_refusal(id);
  refused.push_back({id, fmt::format("{}: {:.0f} nats, but {}", id, gain_nats, why), is_negligible});
}

}  // namespace heatsoak
