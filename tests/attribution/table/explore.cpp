// Prints one line per sealed case: what was missing, what was named, evidence, errors. Not a test.
#include <fmt/format.h>

#include <cstdlib>
#include <string>

#include "examination.h"

using namespace heatsoak;
using namespace heatsoak::truth;

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "null";
  const int first = argc > 2 ? std::atoi(argv[2]) : 1;
  const int count = argc > 3 ? std::atoi(argv[3]) : 3;
  const double size = argc > 4 ? std::atof(argv[4]) : 1.0;
  const bool scans = argc > 5 ? std::atoi(argv[5]) != 0 : true;
  const auto one = [&](const std::string& label, const Missing& missing, std::uint64_t seed) {
    Case sealed;
    sealed.missing = missing;
    sealed.seed = seed;
    const Answer answer = examine(sealed, scans);
    std::string text = fmt::format("{:32s} #{:<4d} {:5.2f} s  {:6.3f} -> {:6.3f} K  ", label, seed, answer.seconds_s, answer.before_K, answer.after_K);
    for (std::size_t i = 0; i < answer.named.size(); ++i) {
      const AcceptedTerm& term = answer.selection.terms[i];
      text += fmt::format(" [{} {:.1f} nats, vis {:.2f}{}]", answer.named[i], term.gain_nats, term.visibility_ratio,
                          term.confusable_with.empty() ? "" : fmt::format(", or {}", fmt::join(term.confusable_with, "/")));
    }
    const Round& round = answer.selection.rounds.front();
    text += "  |";
    for (std::size_t i = 0; i < std::min<std::size_t>(3, round.ladder.size()); ++i) {
      text += fmt::format(" {}:{:.1f}(v{:.2f} l{:.0f})", round.ladder[i].candidate.id, round.ladder[i].gain_nats, round.ladder[i].visibility_ratio, round.ladder[i].left_out_gain_nats);
    }
    for (std::size_t i = 0; i < std::min<std::size_t>(3, round.scan.size()); ++i) {
      const ScanResult& s = round.scan[i];
      text += fmt::format(" {}~{}*{}:{:.1f}", s.term.node, answer.selection.drivers[s.term.driver].name, static_cast<int>(s.term.multiplier), s.gain_nats);
    }
    const LatentFlux flux = flux_grid(std::max(0.05, answer.selection.mean_heat_W), 900).at(answer.selection.after.place);
    text += fmt::format(" flux {:.2f} {:.2f} W {:.0f} s, mean {:.1f} W", flux.rms_W[0], flux.rms_W[1], flux.time_scale_s, answer.selection.mean_heat_W);
    fmt::print("{}\n", text);
    std::fflush(stdout);
  };
  for (int seed = first; seed < first + count; ++seed) {
    if (what == "null") {
      one("nothing", {}, static_cast<std::uint64_t>(seed));
      continue;
    }
    for (const Subject& subject : subjects()) {
      if (what == "all" || what == subject.name) {
        one(std::string(subject.name), subject.make(size), static_cast<std::uint64_t>(seed));
      }
    }
    for (const Outsider& outsider : outsiders()) {
      if (what == "outside") {
        one(std::string(outsider.name), outsider.make(size), static_cast<std::uint64_t>(seed));
      }
    }
  }
}
