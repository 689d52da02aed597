// Scores an answer against the hidden label.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "examination.h"

namespace heatsoak::attribution::truth {

struct Share {
  int right = 0;
  int of = 0;
  void add(bool is_right) { right += is_right ? 1 : 0, ++of; }
};
/// Formats a share with Wilson's interval: "93.3 % (28/30; 95 %: 78.7 to 98.2)".
std::string in_words(const Share& share);

/// Collects what does not hold for one seed.
class Claim {
 public:
  /// Records `what` if it does not hold. Returns `holds`.
  bool expect(bool holds, const std::string& what);
  [[nodiscard]] const std::string& missed() const { return missed_; }

 private:
  std::string missed_;
};

/// Seeds for which a claim holds.
struct SeedRate {
  int right = 0;
  std::string misses;  ///< claims that do not hold, one line per seed
};
/// Number of seeds of most tests. The long form, heatsoak_attribution_table, takes hundreds. The tests require one right seed less than the
/// present method has, because a change in rounding may turn one.
constexpr int kSeeds = 8;
/// Checks a claim for the seeds 1 to `count` and prints the share for which it holds. Every range starts at 1, so that no test depends on
/// a choice of seeds.
SeedRate rate_over_seeds(int count, const std::function<void(std::uint64_t, Claim&)>& check);

/// True if one of the names is the subject's name or another name for the same heat.
bool names(const std::vector<std::string>& named, const Subject& subject);
/// True if the first name is right and there is no other.
bool names_only(const std::vector<std::string>& named, const std::vector<const Subject*>& subjects);
/// True if the verdict is "unexplained" and the first curve is at the right node over one of the right signals. No catalogue effect may be
/// named.
bool names_outsider(const Answer& answer, const Outsider& outsider);
/// True if the answer names a catalogue effect or attributes heat to a signal other than the clock.
bool gives_a_name(const Answer& answer);
/// True if the verdict is "unexplained", with heat at the stranger's node and without any name.
bool leaves_unnamed(const Answer& answer, const Outsider& stranger);
/// True if the subject is named or listed as confounded with a named effect.
bool mentions(const Answer& answer, const Subject& subject);
/// True if the answer contains neither an effect nor a curve.
bool is_silent(const Answer& answer);
/// Summarises an answer for failure messages: "[iron_loss_eddy 41 nats or windage] …" and the best entries of the ladder and the scan.
std::string account(const Answer& answer);
/// Summarises verdict, effects, contradicted parameters and unexplained heat for failure messages.
std::string account(const diagnosis::Diagnosis& diagnosis);

}  // namespace heatsoak::attribution::truth
