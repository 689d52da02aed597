// Ablation study of SelectionRules: the diagnosis with each number disabled, halved and doubled, on a few synthetic motors with known
// effects.
//   heatsoak_attribution_ablation [NAME…]
//   Prints one table row per number; without names it tests all of them.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "scoring.h"

namespace {

using namespace heatsoak;
using namespace heatsoak::attribution::truth;

struct Sealed {
  Case made;
  diagnosis::DiagnosisInput input;
  const Subject* subject = nullptr;
  const Outsider* outsider = nullptr;
  bool is_logged = true;  ///< true if a logged signal follows the outsider's heat
};

std::vector<Sealed> cases() {
  std::vector<Sealed> all;
  const auto add = [&all](const Missing& missing, std::uint64_t seed) -> Sealed& {
    Sealed& one = all.emplace_back();
    one.made.missing = missing;
    one.made.seed = seed;
    one.input = question(one.made, record(one.made));
    return one;
  };
  for (std::uint64_t i = 0; i < 6; ++i) {
    add({}, 91000 + i);
  }
  for (std::size_t s = 0; s < subjects().size(); s += 3) {
    add(subjects()[s].make(1.0), 92000 + s).subject = &subjects()[s];
  }
  for (std::size_t o = 0; o < outsiders().size(); o += 2) {
    add(outsiders()[o].make(1.0), 93000 + o).outsider = &outsiders()[o];
  }
  for (std::size_t o = 0; o < strangers().size(); o += 2) {
    Sealed& one = add(strangers()[o].make(1.0), 94000 + o);
    one.outsider = &strangers()[o];
    one.is_logged = false;
  }
  return all;
}

struct Marks {
  Share false_alarm, single, outside, unlogged;
};

Marks marks_of(const std::vector<Sealed>& sealed, const attribution::SelectionRules& rules) {
  Marks marks;
  for (const Sealed& one : sealed) {
    Answer answer;
    answer.diagnosis = diagnosis::diagnose(one.input, rules);
    for (const attribution::AcceptedTerm& term : answer.diagnosis.selection.terms) {
      answer.named.push_back(term.candidate ? term.candidate->id : "curve");
    }
    if (one.subject) {
      marks.single.add(names_only(answer.named, {one.subject}));
    } else if (!one.outsider) {
      marks.false_alarm.add(!is_silent(answer));
    } else if (one.is_logged) {
      marks.outside.add(names_outsider(answer, *one.outsider));
    } else {
      marks.unlogged.add(leaves_unnamed(answer, *one.outsider));
    }
  }
  return marks;
}

std::string in_short(const Marks& marks) {
  const auto share = [](const Share& each) { return fmt::format("{}/{}", each.right, each.of); };
  return fmt::format("{}, {}, {}, {}", share(marks.false_alarm), share(marks.single), share(marks.outside), share(marks.unlogged));
}

/// A number of SelectionRules; `off` is the value that disables it.
struct Number {
  const char* name;
  double attribution::SelectionRules::*value;
  double off;
};

const std::vector<Number>& numbers() {
  constexpr double kInfinity = 1e9;
  static const std::vector<Number> all{
      {"inclusion_nats", &attribution::SelectionRules::inclusion_nats, 0.0},
      {"conditional_nats", &attribution::SelectionRules::conditional_nats, 0.0},
      {"size_sd", &attribution::SelectionRules::size_sd, 100.0},
      {"body_start_K", &attribution::SelectionRules::body_start_K, 1e-3},
      {"curve_nats", &attribution::SelectionRules::curve_nats, 0.0},
      {"curve_level_precision_ratio", &attribution::SelectionRules::curve_level_precision_ratio, 1e-4},
      {"curve_step_precision_ratio", &attribution::SelectionRules::curve_step_precision_ratio, 1e-4},
      {"named_probability", &attribution::SelectionRules::named_probability, 0.0},
      {"material_K", &attribution::SelectionRules::material_K, 0.0},
      {"material_share", &attribution::SelectionRules::material_share, 0.0},
      {"as_usual_ratio", &attribution::SelectionRules::as_usual_ratio, 0.0},
      {"curve_gain_nats", &attribution::SelectionRules::curve_gain_nats, 0.0},
      {"distinct_nats", &attribution::SelectionRules::distinct_nats, 0.0},
      {"curve_left_out_share", &attribution::SelectionRules::curve_left_out_share, kInfinity},
      {"beside_unknown_share", &attribution::SelectionRules::beside_unknown_share, kInfinity},
      {"better_share", &attribution::SelectionRules::better_share, kInfinity},
      {"plainly_better_share", &attribution::SelectionRules::plainly_better_share, kInfinity},
      {"least_seen_share", &attribution::SelectionRules::least_seen_share, 0.0},
      {"second_signal_nats", &attribution::SelectionRules::second_signal_nats, 0.0},
      {"same_shape_ratio", &attribution::SelectionRules::same_shape_ratio, 0.0},
  };
  return all;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<Sealed> sealed = cases();
  fmt::print("nothing missing: false alarms; single effects right; outside the catalogue right; followed by no signal, left unnamed\n");
  fmt::print("| number | value | off | half | double |\n|---|---|---|---|---|\n| all as they are | | {} | | |\n",
             in_short(marks_of(sealed, {})));
  for (const Number& number : numbers()) {
    bool is_wanted = argc < 2;
    for (int i = 1; i < argc; ++i) {
      is_wanted = is_wanted || number.name == std::string(argv[i]);
    }
    if (!is_wanted) {
      continue;
    }
    std::vector<std::string> cells;
    const double own = attribution::SelectionRules{}.*number.value;
    for (const double value : {number.off, 0.5 * own, 2.0 * own}) {
      attribution::SelectionRules rules;
      rules.*number.value = value;
      cells.push_back(in_short(marks_of(sealed, rules)));
    }
    fmt::print("| {} | {} | {} | {} | {} |\n", number.name, own, cells[0], cells[1], cells[2]);
    std::fflush(stdout);
  }
  return 0;
}
