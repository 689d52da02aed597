// How the diagnosis does on motors of which everything is known: one table.
//   heatsoak_attribution_table [nothing N] [single N] [pair N] [outside N] [effect NAME SIZE SEED]
// Each wrong case is printed above the table with what the tool weighed.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <string>

#include "scoring.h"

namespace {

using namespace heatsoak;
using namespace heatsoak::truth;

struct Marks {
  Share false_alarm, detected, right_of_detected, right_of_visible, pairs_right, outsiders_right, interval_covers;
  double seconds_s = 0.0;
  int cases = 0;
  std::vector<double> after_over_floor;
};

Case sealed_case(const Missing& missing, std::uint64_t seed) {
  Case sealed;
  sealed.missing = missing;
  sealed.seed = seed;
  return sealed;
}

void say(const std::string& label, std::uint64_t seed, const Answer& answer, bool is_right) {
  fmt::print("{} {:58s} #{:<6d} {}\n", is_right ? "  " : "X ", label, seed, account(answer));
  std::fflush(stdout);
}

double size_of(Dice& dice) { return 0.3 * std::pow(5.0, dice.uniform(0.0, 1.0)); }

void count(Marks& marks, const Answer& answer) {
  marks.seconds_s += answer.seconds_s;
  ++marks.cases;
}

void examine_nothing(Marks& marks, int number) {
  for (int i = 0; i < number; ++i) {
    const auto seed = static_cast<std::uint64_t>(10000 + i);
    const Answer answer = examine(sealed_case({}, seed));
    marks.false_alarm.add(!answer.named.empty() || answer.selection.open_curve.has_value());
    count(marks, answer);
    say("nothing", seed, answer, answer.named.empty() && !answer.selection.open_curve);
  }
}

void cover(Marks& marks, const Answer& answer, const Subject& subject, double size) {
  if (subject.true_value == 0.0 || answer.selection.terms.size() != 1 || answer.named.front() != subject.name) {
    return;
  }
  const RefitResult& fit = answer.selection.after;
  const Eigen::Index own = fit.model.free_count() - 1;
  const Candidate& candidate = *answer.selection.terms.front().candidate;
  const double value = fit.model.theta()[own] * candidate.typical_size();
  const double sd = std::sqrt(fit.covariance(own, own)) * candidate.typical_size();
  marks.interval_covers.add(std::abs(value - size * subject.true_value) <= 1.96 * sd);
}

void examine_single(Marks& marks, const Subject& subject, double size, std::uint64_t seed) {
  const Answer answer = examine(sealed_case(subject.make(size), seed));
  const bool is_right = names_only(answer.named, {&subject});
  const bool is_silent = answer.named.empty() && !answer.selection.open_curve;
  marks.detected.add(!is_silent);
  if (!is_silent) {
    marks.right_of_detected.add(is_right);
  }
  if (subject.visibility == Visibility::visible) {
    marks.right_of_visible.add(is_right);
  }
  cover(marks, answer, subject, size);
  count(marks, answer);
  const Answer floor = examine(sealed_case({}, seed), false);
  marks.after_over_floor.push_back(answer.after_K / floor.before_K);
  say(fmt::format("{} x {:.2f} (floor {:.3f} K)", subject.name, size, floor.before_K), seed, answer, is_right);
}

void examine_pairs(Marks& marks, int number) {
  std::vector<const Subject*> visible;
  for (const Subject& subject : subjects()) {
    if (subject.visibility == Visibility::visible) {
      visible.push_back(&subject);
    }
  }
  for (int i = 0; i < number; ++i) {
    const auto seed = static_cast<std::uint64_t>(30000 + i);
    Dice dice(seed);
    const Subject* const a = visible[static_cast<std::size_t>(dice.below(static_cast<int>(visible.size())))];
    const Subject* b = a;
    while (b == a || std::ranges::find(a->same, b->name) != a->same.end()) {
      b = visible[static_cast<std::size_t>(dice.below(static_cast<int>(visible.size())))];
    }
    Missing both = a->make(size_of(dice));
    const Missing other = b->make(size_of(dice));
    both.heat.insert(both.heat.end(), other.heat.begin(), other.heat.end());
    for (int part = 0; part < part_count; ++part) {
      both.lump_capacity_J_per_K[static_cast<std::size_t>(part)] += other.lump_capacity_J_per_K[static_cast<std::size_t>(part)];
    }
    both.sensors.winding_offset_K += other.sensors.winding_offset_K;
    both.sensors.stator_offset_K += other.sensors.stator_offset_K;
    both.sensors.winding_lag_s += other.sensors.winding_lag_s;
    both.sensors.stator_lag_s += other.sensors.stator_lag_s;
    both.sensors.winding_gain_ratio *= other.sensors.winding_gain_ratio;
    const Answer answer = examine(sealed_case(both, seed));
    const bool is_right = names_only(answer.named, {a, b});
    marks.pairs_right.add(is_right);
    count(marks, answer);
    say(fmt::format("{} + {}", a->name, b->name), seed, answer, is_right);
  }
}

void examine_outsiders(Marks& marks, int number) {
  for (int i = 0; i < number; ++i) {
    for (const Outsider& outsider : outsiders()) {
      const auto seed = static_cast<std::uint64_t>(40000 + i);
      const Answer answer = examine(sealed_case(outsider.make(1.0), seed));
      const bool is_right = names_outsider(answer, outsider);
      marks.outsiders_right.add(is_right);
      count(marks, answer);
      say(std::string(outsider.name), seed, answer, is_right);
    }
  }
}

void print_table(Marks& marks) {
  std::ranges::sort(marks.after_over_floor);
  const double middle = marks.after_over_floor.empty() ? std::nan("") : marks.after_over_floor[marks.after_over_floor.size() / 2];
  fmt::print("\n{:44s} {:10s} {}\n", "score", "target", "reached");
  const auto row = [](const char* score, const char* target, const std::string& reached) { fmt::print("{:44s} {:10s} {}\n", score, target, reached); };
  row("nothing missing: false alarm", "<= 2 %", in_words(marks.false_alarm));
  row("single effects: detected", "", in_words(marks.detected));
  row("single effects: right of detected", ">= 98 %", in_words(marks.right_of_detected));
  row("single effects: right of visible", ">= 95 %", in_words(marks.right_of_visible));
  row("pairs: both right", ">= 90 %", in_words(marks.pairs_right));
  row("outside the catalogue: node and driver right", ">= 90 %", in_words(marks.outsiders_right));
  row("error after / floor, median", "<= 1.1", fmt::format("{:.2f}", middle));
  row("95 % intervals cover", "93-97 %", in_words(marks.interval_covers));
  row("time per case (this machine)", "<= 1 s", fmt::format("{:.2f} s", marks.seconds_s / std::max(1, marks.cases)));
}

}  // namespace

int main(int argc, char** argv) {
  Marks marks;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string what = argv[i];
    const int number = std::atoi(argv[i + 1]);
    if (what == "nothing") {
      examine_nothing(marks, number);
    } else if (what == "single") {
      for (int k = 0; k < number; ++k) {
        for (const Subject& subject : subjects()) {
          Dice dice(static_cast<std::uint64_t>(20000 + k) ^ std::hash<std::string_view>{}(subject.name));
          examine_single(marks, subject, size_of(dice), static_cast<std::uint64_t>(20000 + k));
        }
      }
    } else if (what == "pair") {
      examine_pairs(marks, number);
    } else if (what == "outside") {
      examine_outsiders(marks, number);
    } else if (what == "effect" && i + 3 < argc) {
      for (const Subject& subject : subjects()) {
        if (subject.name == argv[i + 1]) {
          examine_single(marks, subject, std::atof(argv[i + 2]), static_cast<std::uint64_t>(std::atoi(argv[i + 3])));
        }
      }
      i += 2;
    }
  }
  print_table(marks);
}
