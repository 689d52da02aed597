// Regenerates reports/derate: millions of loads and motors test the guarantee of `derate`. Every run writes the same bytes except for the
// time, unless MINUTES ends it.
//   heatsoak_worst_use [FOLDER [TRIALS [MINUTES]]]
//   FOLDER: reports/derate of the checkout by default. TRIALS: per class, 1 000 000 by default; 0 only draws the picture again from the
//   table in FOLDER. MINUTES: for all classes, unlimited by default.
//   The files are rewritten after every class with the trials made until then. Progress goes to stderr.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <fstream>
#include <functional>
#include <limits>
#include <numeric>
#include <span>

#include "adversary.h"
#include "base/binomial_bound.h"
#include "base/files.h"
#include "base/lanes.h"
#include "report/chart.h"
#include "select/evaluate.h"
#include "support/shipped.h"
#include "support/study_words.h"

namespace heatsoak::derate::studies {
namespace {

constexpr std::uint64_t kSeed = 20'261;
/// First random stream of the motors. The streams of the search and of the check in `derate` have lower numbers.
constexpr std::uint64_t kMotors = std::uint64_t{1} << 40U;
constexpr std::uint64_t kPanel = std::uint64_t{1} << 41U;
constexpr std::uint64_t kFresh = std::uint64_t{1} << 42U;
constexpr int kMotorsPerUse = 64;

/// The paper's robot with the motor that failed in it, and their derating with the default options.
struct Subject {
  robot::Robot robot = twente();
  motor::Motor motor = motor::with_default_spreads(ecx_32());
  DerateOptions options = {};
  Derating derating = derate(ecx_32(), robot, options);
};

struct Worst {
  double winding_C = 0.0;
  std::uint64_t use = 0;    ///< number of the load script
  std::uint64_t motor = 0;  ///< its random stream, or number of the corner
  Script script;
};

struct Tally {
  std::string name;
  std::string meaning;
  std::uint64_t uses = 0;
  std::uint64_t trials = 0;
  std::uint64_t over = 0;
  Worst worst = {};
  static constexpr int kFrom_C = 0;
  static constexpr int kCells = 600;  ///< cells of 1 K
  std::vector<std::uint64_t> peaks = std::vector<std::uint64_t>(kCells);

  void take(const MotorPeak& peak, std::uint64_t use, std::uint64_t motor, const Script& script) {
    ++trials;
    over += peak.is_over ? 1 : 0;
    ++peaks[static_cast<std::size_t>(std::clamp(static_cast<int>(peak.winding_C) - kFrom_C, 0, kCells - 1))];
    if (peak.winding_C > worst.winding_C) {
      worst = {peak.winding_C, use, motor, script};
    }
  }
  /// Returns the temperature that this share of the trials stays below, with a resolution of 1 K.
  [[nodiscard]] int quantile_C(double share) const {
    std::uint64_t sum = 0;
    for (int cell = 0; cell < kCells; ++cell) {
      sum += peaks[static_cast<std::size_t>(cell)];
      if (static_cast<double>(sum) >= share * static_cast<double>(trials)) {
        return kFrom_C + cell + 1;
      }
    }
    return kFrom_C + kCells;
  }
};

std::vector<thermal::Network> drawn(const Subject& subject, std::uint64_t first_stream) {
  std::vector<thermal::Network> networks;
  for (int lane = 0; lane < base::kLanes; ++lane) {
    base::Random random(kSeed, first_stream + static_cast<std::uint64_t>(lane));
    networks.push_back(motor::datasheet_network(subject.motor, motor::draw_sample(subject.motor, random)));
  }
  return networks;
}

/// Returns a network with every parameter at the low or high end of its spread; the bits of `corner` select the ends.
thermal::Network at_the_ends(const Subject& subject, std::uint64_t corner) {
  motor::Motor motor = subject.motor;
  unsigned bit = 0;
  for (auto& [key, parameter] : motor.parameters) {
    if (motor::needs_spread(key) && parameter.spread) {
      parameter.value = ((corner >> bit++) & 1U) != 0 ? parameter.spread->high : parameter.spread->low;
    }
  }
  motor::refresh_values(motor);
  return motor::datasheet_network(motor, motor::nominal_sample(motor));
}

UsePlayed played(const Subject& subject, const Script& script) {
  return play(script, subject.derating.observer, subject.derating.table, subject.motor, subject.robot, subject.options.period_s);
}

/// Returns the heating of a fixed panel of motors by a load. The adversary maximises this score.
double heat_of(const UsePlayed& use, const Subject& subject, const std::vector<std::vector<thermal::Network>>& panel) {
  double sum_C = 0.0;
  for (const std::vector<thermal::Network>& motors : panel) {
    for (const MotorPeak& peak : peaks(motors, subject.derating.rules.limits, {&use, 1})) {
      sum_C += peak.winding_C;
    }
  }
  return sum_C;
}

/// Keeps the hottest loads so far. Half of the new loads are mutations of them.
class Adversary {
 public:
  explicit Adversary(const Subject& subject) : subject_(subject) {
    for (int block = 0; block < 2; ++block) {
      panel_.push_back(drawn(subject, kPanel + static_cast<std::uint64_t>(block * base::kLanes)));
    }
  }

  Script next(base::Random& random) const {
    const BarrierRules& rules = subject_.derating.rules;
    if (best_.empty() || random.uniform() < 0.5) {
      return bang_bang(rules, random);
    }
    const auto place = static_cast<std::size_t>(random.uniform() * static_cast<double>(best_.size()));
    return mutated(best_[place].second, rules, random);
  }
  void learn(const Script& script, const UsePlayed& use) {
    constexpr std::size_t kKept = 24;
    const double heat = heat_of(use, subject_, panel_);
    const auto place = std::ranges::lower_bound(best_, heat, std::greater<>(), &std::pair<double, Script>::first);
    best_.insert(place, {heat, script});
    if (best_.size() > kKept) {
      best_.pop_back();
    }
  }
  [[nodiscard]] std::vector<UsePlayed> best(std::size_t count) const {
    std::vector<UsePlayed> uses;
    for (std::size_t i = 0; i < std::min(count, best_.size()); ++i) {
      uses.push_back(played(subject_, best_[i].second));
    }
    return uses;
  }
  [[nodiscard]] const Script& hottest() const { return best_.front().second; }

 private:
  const Subject& subject_;
  std::vector<std::vector<thermal::Network>> panel_;
  std::deque<std::pair<double, Script>> best_;  ///< sorted, hottest first
};

/// Time limit and progress of a class.
class Clock {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit Clock(double minutes) : start_(now()), minutes_(minutes) {}
  [[nodiscard]] double elapsed_min() const { return minutes_between(start_, now()); }
  /// Divides the remaining time equally among the remaining classes.
  void begin_class(int classes_left) { class_end_min_ = elapsed_min() + (minutes_ - elapsed_min()) / classes_left; }
  [[nodiscard]] bool is_over() const { return elapsed_min() > class_end_min_; }
  void report(const Tally& tally, std::uint64_t trials) {
    constexpr double kEvery_min = 0.25;
    if (elapsed_min() - reported_min_ >= kEvery_min) {
      reported_min_ = elapsed_min();
      fmt::print(stderr, "{:.1f} min: {}, {} of {} trials\n", elapsed_min(), tally.name, tally.trials, trials);
    }
  }

 private:
  static Time now() { return std::chrono::steady_clock::now(); }
  static double minutes_between(Time from, Time to) { return std::chrono::duration<double>(to - from).count() / 60.0; }

  Time start_;
  double minutes_;
  double class_end_min_ = 0.0;
  double reported_min_ = 0.0;
};

using MakeScript = std::function<Script(base::Random& random)>;
/// Runs every load on newly drawn motors.
void run_class(Tally& tally, const Subject& subject, std::uint64_t trials, std::uint64_t number, Clock& clock, const MakeScript& make,
               const std::function<void(const Script&, const UsePlayed&)>& learn = {}) {
  const std::uint64_t uses = (trials + kMotorsPerUse - 1) / kMotorsPerUse;
  for (std::uint64_t use = 0; use < uses && !clock.is_over(); ++use) {
    clock.report(tally, trials);
    const std::uint64_t id = (number << 32U) + use;
    base::Random random(kSeed, id);
    const Script script = make(random);
    const UsePlayed done = played(subject, script);
    if (learn) {
      learn(script, done);
    }
    ++tally.uses;
    for (std::uint64_t i = 0; i < kMotorsPerUse; i += base::kLanes) {
      const std::uint64_t stream = kMotors + id * kMotorsPerUse + i;
      const auto found = peaks(drawn(subject, stream), subject.derating.rules.limits, {&done, 1});
      for (std::size_t lane = 0; lane < found.size(); ++lane) {
        tally.take(found[lane], id, stream + lane, script);
      }
    }
  }
}

/// Runs all corners of the tolerances under the hottest loads and under random ones.
void run_corners(Tally& tally, const Subject& subject, std::uint64_t trials, Clock& clock, const Adversary& adversary) {
  const auto values = static_cast<unsigned>(std::ranges::count_if(
      subject.motor.parameters, [](const auto& each) { return motor::needs_spread(each.first) && each.second.spread; }));
  const std::uint64_t corners = std::uint64_t{1} << values;
  std::vector<thermal::Network> networks;
  for (std::uint64_t corner = 0; corner < corners; ++corner) {
    networks.push_back(at_the_ends(subject, corner));
  }
  for (std::uint64_t use = 0; tally.trials < trials && !clock.is_over(); ++use) {
    clock.report(tally, trials);
    base::Random random(kSeed, (std::uint64_t{7} << 32U) + use);
    const Script script = use == 0 ? adversary.hottest() : bang_bang(subject.derating.rules, random);
    const UsePlayed done = played(subject, script);
    ++tally.uses;
    for (std::uint64_t corner = 0; corner + base::kLanes <= corners; corner += base::kLanes) {
      const auto found = peaks(std::span(networks).subspan(corner, base::kLanes), subject.derating.rules.limits, {&done, 1});
      for (std::size_t lane = 0; lane < found.size(); ++lane) {
        tally.take(found[lane], use, corner + lane, script);
      }
    }
  }
}

struct Retest {
  int motors = 0;
  int over_check = 0;  ///< motors over the limit in a load of the check
  int over_all = 0;    ///< motors over the limit in one of these loads or in one that the adversary found
};
/// Checks the guarantee on new motors, with the loads that `derate` checks and with the hottest ones found.
Retest retest(const Subject& subject, const Adversary& adversary, int motors) {
  constexpr std::size_t kHottest = 8;
  const std::vector<UsePlayed> found = adversary.best(kHottest);
  Retest result;
  for (; result.motors < motors; result.motors += base::kLanes) {
    const std::vector<thermal::Network> block = drawn(subject, kFresh + static_cast<std::uint64_t>(result.motors));
    const auto by_check = peaks(block, subject.derating.rules.limits, subject.derating.uses);
    const auto by_found = peaks(block, subject.derating.rules.limits, found);
    for (std::size_t lane = 0; lane < by_check.size(); ++lane) {
      result.over_check += by_check[lane].is_over ? 1 : 0;
      result.over_all += by_check[lane].is_over || by_found[lane].is_over ? 1 : 0;
    }
  }
  return result;
}

std::string share_text(std::uint64_t over, std::uint64_t of) {
  const auto count = static_cast<double>(over);
  const auto all = static_cast<double>(of);
  return fmt::format("{:.3g} % (at most {:.3g} %)", 100.0 * count / all, 100.0 * base::upper_bound_share(count, all, kCertainty_share));
}

std::string table_text(std::span<const Tally> tallies) {
  std::string text =
      "| class of use | uses | trials | over the limit | median °C | 95 % below °C | hottest °C |\n|---|--:|--:|---|--:|--:|--:|\n";
  for (const Tally& each : tallies) {
    text += fmt::format("| {} | {} | {} | {} | {} | {} | {:.1f} |\n", each.meaning, each.uses, each.trials,
                        share_text(each.over, each.trials), each.quantile_C(0.5), each.quantile_C(0.95), each.worst.winding_C);
  }
  text += "\nThe hottest trial of each class, to be made again with its numbers (`tests/derate/table/worst_use.cpp`):\n\n";
  for (const Tally& each : tallies) {
    text += fmt::format("- {}: {:.1f} °C, use {}, motor {}, start {:.0f} °C (observer {:.0f} °C): {}\n", each.name, each.worst.winding_C,
                        each.worst.use, each.worst.motor, each.worst.script.motor_start_C, each.worst.script.observer_start_C,
                        to_text(each.worst.script, 6));
  }
  return text;
}

std::string csv_text(std::span<const Tally> tallies) {
  std::string text = "class,winding_peak_below_C,trials\n";
  for (const Tally& each : tallies) {
    for (int cell = 0; cell < Tally::kCells; ++cell) {
      if (const std::uint64_t count = each.peaks[static_cast<std::size_t>(cell)]; count > 0) {
        text += fmt::format("{},{},{}\n", each.name, Tally::kFrom_C + cell + 1, count);
      }
    }
  }
  return text;
}

/// Classes of attack without trials.
std::vector<Tally> no_trials() {
  return {{"adversary", "on and off by an adversary that learns"},
          {"match", "wheels of division A matches, 1 to 3 times the current"},
          {"ambient", "the same adversary in air that jumps"},
          {"cold_observer", "observer starts 20 K below the motor"},
          {"ends", "every value at an end of its tolerance, all combinations"}};
}

/// Reads what csv_text() wrote.
std::vector<Tally> tallies_in(const std::filesystem::path& file) {
  std::vector<Tally> tallies = no_trials();
  std::ifstream table(file);
  std::string line;
  std::getline(table, line);
  for (std::string name; std::getline(table, name, ',');) {
    int below_C = 0;
    char comma = '\0';
    std::uint64_t count = 0;
    table >> below_C >> comma >> count >> std::ws;
    const auto tally = std::ranges::find(tallies, name, &Tally::name);
    if (tally != tallies.end()) {
      tally->peaks.at(static_cast<std::size_t>(below_C - Tally::kFrom_C - 1)) += count;
      tally->trials += count;
    }
  }
  return tallies;
}

report::Chart chart_of(std::span<const Tally> tallies, double limit_C) {
  report::Chart chart{
      .title = "Peak temperature of the winding with the guard, in each class of attack",
      .subtitle = fmt::format("ECX FLAT 32 L in roboteam_twente_v2024, limit {:.0f} °C, {:.1f} million trials, computed", limit_C,
                              1e-6 * std::accumulate(tallies.begin(), tallies.end(), 0.0,
                                                     [](double sum, const Tally& each) { return sum + static_cast<double>(each.trials); })),
      .x_label = "peak winding temperature / °C",
      .panels = {{.title = "share of trials with a higher peak", .y_label = "share / %", .logarithmic = true}}};
  for (std::size_t i = 0; i < tallies.size(); ++i) {
    report::ChartCurve curve{.name = tallies[i].meaning, .color_index = static_cast<int>(i)};
    std::uint64_t above = tallies[i].trials;
    for (int cell = 0; cell < Tally::kCells && above > 0; ++cell) {
      above -= tallies[i].peaks[static_cast<std::size_t>(cell)];
      if (above < tallies[i].trials) {
        curve.x.push_back(Tally::kFrom_C + cell + 1);
        curve.y.push_back(100.0 * static_cast<double>(above) / static_cast<double>(tallies[i].trials));
      }
    }
    chart.panels[0].curves.push_back(curve);
  }
  double first_C = limit_C;
  double last_C = limit_C;
  for (const report::ChartCurve& curve : chart.panels[0].curves) {
    first_C = curve.x.empty() ? first_C : std::min(first_C, curve.x.front());
    last_C = curve.x.empty() ? last_C : std::max(last_C, curve.x.back());
  }
  constexpr int kPromiseColor = 5;
  chart.panels[0].curves.push_back(
      {.name = "5 % of the trials", .x = {first_C, last_C}, .y = {5.0, 5.0}, .color_index = kPromiseColor, .dashed = true});
  chart.panels[0].curves.push_back({.name = fmt::format("limit of {:.0f} °C", limit_C),
                                    .x = {limit_C, limit_C},
                                    .y = {1e-4, 100.0},
                                    .color_index = std::nullopt,
                                    .dashed = true});
  return chart;
}

/// Calls `written` with the completed classes after each class.
std::vector<Tally> run_all(const Subject& subject, std::uint64_t trials, Clock& clock, Adversary& adversary,
                           const std::function<void(std::span<const Tally>)>& written) {
  const BarrierRules& rules = subject.derating.rules;
  std::vector<Tally> tallies = no_trials();
  int classes_left = static_cast<int>(tallies.size());
  const auto end_class = [&](std::size_t done) {
    written(std::span(tallies).first(done));
    clock.begin_class(std::max(1, --classes_left));
  };
  clock.begin_class(classes_left);
  run_class(
      tallies[0], subject, trials, 1, clock, [&](base::Random& random) { return adversary.next(random); },
      [&](const Script& script, const UsePlayed& use) { adversary.learn(script, use); });
  end_class(1);
  constexpr int kGames = 40;
  const std::vector<duty::WheelDemand> games =
      select::draw_demands(duty::read_duty(kSource / "duty_profiles/division_a_match.toml"), subject.robot, kSeed, kGames, 1);
  run_class(tallies[1], subject, trials, 2, clock, [&](base::Random& random) {
    const duty::WheelDemand& game = games[static_cast<std::size_t>(random.uniform() * kGames)];
    const double aggressiveness = 1.0 + 2.0 * random.uniform();
    return match(game, subject.motor, subject.robot, rules, aggressiveness, random.uniform());
  });
  end_class(2);
  run_class(tallies[2], subject, trials, 3, clock, [&](base::Random& random) {
    Script script = adversary.next(random);
    step_ambient(script, subject.options.coldest_ambient_C + 1.0, rules, random);
    return script;
  });
  end_class(3);
  run_class(tallies[3], subject, trials, 4, clock, [&](base::Random& random) {
    constexpr double kWrong_K = 20.0;
    Script script = adversary.next(random);
    script.motor_start_C = std::lerp(rules.hottest_ambient_C + kWrong_K, rules.limits.winding_C, random.uniform());
    script.observer_start_C = script.motor_start_C - kWrong_K;
    return script;
  });
  end_class(4);
  run_corners(tallies[4], subject, trials, clock, adversary);
  return tallies;
}

void write(const std::filesystem::path& folder, const Subject& subject, std::span<const Tally> tallies, double elapsed_min,
           const std::string& promise) {
  base::write_file(
      folder / "worst_use.md",
      fmt::format("Safety factor on heat {:.2f}, confidence {:.2f}, limit {:.0f} °C. Run time {:.0f} min, one thread.\n\n{}\n{}",
                  subject.derating.observer.heat_safety_factor(), subject.options.guarantee.required_share,
                  subject.derating.rules.limits.winding_C, elapsed_min, table_text(tallies), promise));
  base::write_file(folder / "worst_use.csv", csv_text(tallies));
  base::write_file(folder / "worst_use.svg", report::draw_svg(chart_of(tallies, subject.derating.rules.limits.winding_C)));
}

void run(const std::filesystem::path& folder, std::uint64_t trials, double minutes) {
  Clock clock(minutes);
  const Subject subject;
  if (trials == 0) {
    const std::vector<Tally> tallies = tallies_in(folder / "worst_use.csv");
    base::write_file(folder / "worst_use.svg", report::draw_svg(chart_of(tallies, subject.derating.rules.limits.winding_C)));
    return;
  }
  Adversary adversary(subject);
  const std::vector<Tally> tallies = run_all(subject, trials, clock, adversary, [&](std::span<const Tally> done) {
    write(folder, subject, done, clock.elapsed_min(), "The run has not ended: classes are missing.\n");
  });
  const Retest again = retest(subject, adversary, 20'000);
  const auto share = [&](int over) { return share_text(static_cast<std::uint64_t>(over), static_cast<std::uint64_t>(again.motors)); };
  write(folder, subject, tallies, clock.elapsed_min(),
        fmt::format("The promise on {} fresh motors: over a limit in one of the {} uses of the check {}, in one of those or of the "
                    "eight hottest that the adversary found {}.\n",
                    again.motors, subject.derating.uses.size(), share(again.over_check), share(again.over_all)));
}

}  // namespace
}  // namespace heatsoak::derate::studies

int main(int argc, char** argv) {
  constexpr const char* kUsage =
      "usage: heatsoak_worst_use [FOLDER [TRIALS [MINUTES]]]\n\n"
      "  FOLDER   an existing folder; reports/derate without it\n"
      "  TRIALS   per class, 1000000 without it; 0 only draws the picture again from the table in FOLDER\n"
      "  MINUTES  for all classes, unlimited without it\n";
  return heatsoak::run_study(argc, argv, kUsage, 3, [](const heatsoak::StudyWords& words) {
    const std::filesystem::path folder = words.folder(0, heatsoak::kSource / "reports" / "derate");
    const std::uint64_t trials = words.whole(1, "TRIALS", 0, 1'000'000);
    heatsoak::derate::studies::run(folder, trials, words.positive(2, "MINUTES", std::numeric_limits<double>::infinity()));
    return 0;
  });
}
