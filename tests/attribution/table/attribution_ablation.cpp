// Ablation study: the diagnosis of synthetic motors with known effects, with each decision threshold switched off, halved and doubled.
//   heatsoak_attribution_ablation [NAME…]
//   Prints one table row per threshold of estimation/thresholds.h; these are the tables in reports/attribution/README.md. Names of priors
//   (members of SelectionRules) are accepted, too.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <string>
#include <vector>

#include "../../support/measured_data.h"
#include "../../support/study_words.h"
#include "estimation/thresholds.h"
#include "measured_cases.h"
#include "scoring.h"
#include "spoilt_logs.h"

namespace {

using namespace heatsoak;
using namespace heatsoak::attribution::truth;

/// A motor with its runs. Logs and model are prepared anew for every setting, because thresholds change both.
struct Sealed {
  Case made;
  Runs runs;
  const Subject* subject = nullptr;
  const Outsider* outsider = nullptr;
  bool is_logged = true;  ///< true if a logged signal follows the outsider's heat
};

Sealed sealed_of(const Case& made) { return {made, record(made)}; }

Case case_of(const Missing& missing, std::uint64_t seed) {
  Case made;
  made.missing = missing;
  made.seed = seed;
  return made;
}

const Subject& visible_subject(std::size_t number) {
  std::vector<const Subject*> visible;
  for (const Subject& subject : subjects()) {
    if (subject.visibility == Visibility::visible) {
      visible.push_back(&subject);
    }
  }
  return *visible[number % visible.size()];
}

/// Motors with ordinary logs: nothing missing, single effects, heat outside the catalogue, and heat without a logged input signal.
std::vector<Sealed> ordinary_motors() {
  std::vector<Sealed> all;
  for (std::uint64_t i = 0; i < 6; ++i) {
    all.push_back(sealed_of(case_of({}, 91000 + i)));
  }
  for (std::size_t s = 0; s < subjects().size(); s += 3) {
    all.push_back(sealed_of(case_of(subjects()[s].make(1.0), 92000 + s)));
    all.back().subject = &subjects()[s];
  }
  for (std::size_t o = 0; o < outsiders().size(); o += 2) {
    all.push_back(sealed_of(case_of(outsiders()[o].make(1.0), 93000 + o)));
    all.back().outsider = &outsiders()[o];
  }
  for (std::size_t o = 0; o < strangers().size(); o += 2) {
    all.push_back(sealed_of(case_of(strangers()[o].make(1.0), 94000 + o)));
    all.back().outsider = &strangers()[o];
    all.back().is_logged = false;
  }
  return all;
}

/// Motors with good and poor contact between their parts, calibrated before an effect appeared; every second one has no effect.
std::vector<Sealed> calibrated_motors() {
  std::vector<Sealed> all;
  std::size_t number = 0;
  for (const double metal_ratio : {0.05, 0.2, 1.0}) {
    for (const bool has_effect : {false, true}) {
      const Subject& subject = visible_subject(5 * number);
      Case made = case_of(has_effect ? subject.make(1.0) : Missing{}, 95000 + number++);
      made.is_calibrated = true;
      made.metal_ratio = metal_ratio;
      made.rows = 1200;
      made.training_runs = 3;
      all.push_back(sealed_of(made));
      all.back().subject = has_effect ? &subject : nullptr;
    }
  }
  return all;
}

/// Motors whose logs have one kind of defect each; every second motor lacks an effect.
std::vector<Sealed> motors_with_spoilt_logs() {
  std::vector<Sealed> all;
  for (std::size_t i = 0; i < log_defects().size(); ++i) {
    const bool has_effect = i % 2 == 1;
    const Subject& subject = visible_subject(3 * i);
    Case made = case_of(has_effect ? subject.make(1.0) : Missing{}, 96000 + i);
    made.rows = 1200;
    made.training_runs = 3;
    all.push_back(sealed_of(made));
    all.back().subject = has_effect ? &subject : nullptr;
    Dice dice(made.seed);
    for (TrueRun& run : all.back().runs.training) {
      log_defects()[i].spoil(run.log, dice);
    }
  }
  return all;
}

struct Marks {
  Share false_alarm, single, outside, unlogged;
  double log_error = 0.0;  ///< sum of ln of the error in K on unseen runs
  int count = 0;
};

Marks marks_of(const std::vector<Sealed>& sealed, const attribution::SelectionRules& rules) {
  Marks marks;
  for (const Sealed& one : sealed) {
    Answer answer;
    answer.diagnosis = diagnosis::diagnose(question(one.made, one.runs), rules);
    for (const attribution::AcceptedTerm& term : answer.diagnosis.selection.terms) {
      answer.named.push_back(term.candidate ? term.candidate->id : "curve");
    }
    marks.log_error += std::log(rms_error_K(answer.diagnosis.selection.after.model, one.runs.unseen));
    ++marks.count;
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
  std::string text;
  for (const Share& share : {marks.false_alarm, marks.single, marks.outside, marks.unlogged}) {
    text += share.of > 0 ? fmt::format("{}/{}, ", share.right, share.of) : "";
  }
  return text + fmt::format("{:.3f} K", std::exp(marks.log_error / marks.count));
}

/// Returns the marks with the thresholds in use.
using Study = std::function<std::string(const attribution::SelectionRules& rules)>;

Study study_of(const std::vector<Sealed>& sealed) {
  return [sealed](const attribution::SelectionRules& rules) { return in_short(marks_of(sealed, rules)); };
}

/// Real motors: how many of the effects that are known to be there are named, and the geometric mean of the errors on unseen recordings.
std::string marks_of_measured() {
  using namespace attribution::measured;
  Share named;
  double log_error = 0.0;
  int count = 0;
  const auto add = [&](const Diagnosed& found, std::string_view id) {
    named.add(id.empty() ? !found.diagnosis.effects.empty() : effect_of(found.diagnosis, id) != nullptr);
    for (const auto& [signal, error] : found.score.after) {
      log_error += std::log(error.rmse_K);
      ++count;
    }
  };
  const std::filesystem::path bench = *measured_data("ksu_propeller_bench");
  Drone flying = drone(*measured_data("tasrv_uav_motor"), false);
  add(diagnosed(flying, 0.6), "airflow");
  const PropellerBench mega = propeller_bench(bench);
  add(diagnosed(mega.start, {mega.january}, {mega.march}), "speed_dependent_convection");
  const recording::Recording other = of_bench(bench, "P80-1700_2020-02-11_162559");
  add(diagnosed(mega.start, {recording::part_of(other, 0.0, 0.7)}, {recording::part_of(other, 0.7, 1.0)}), "speed_dependent_convection");
  add(of_traction_motor(*measured_data("paderborn_pmsm"), 0.7), "");
  return fmt::format("{}/{}, {:.3g} K", named.right, named.of, std::exp(log_error / count));
}

/// Motors that exercise some of the thresholds; all thresholds if there are no names.
struct Group {
  const char* title;
  Study (*make)();
  std::vector<std::string_view> names;
  bool has_priors = false;
  Study study = {};
  std::string usual = {};

  [[nodiscard]] bool has(std::string_view name) const { return names.empty() || std::ranges::find(names, name) != names.end(); }
};

std::vector<Group> groups() {
  std::vector<Group> all{
      {"Motors with ordinary logs: false alarms, single effects, outside the catalogue, heat without a logged input signal; error",
       [] { return study_of(ordinary_motors()); },
       {"wrong_answer_share", "material_K", "clear_nats", "distinct_nats", "clearly_other_ratio", "beside_unknown_share",
        "same_signal_ratio", "least_seen_share"},
       true},
      {"Calibrated motors: false alarms, single effects; error",
       [] { return study_of(calibrated_motors()); },
       {"better_share", "well_known_ratio", "material_share", "seen_share", "matters_K"}},
      {"Motors with defects in the logs: false alarms, single effects; error",
       [] { return study_of(motors_with_spoilt_logs()); },
       {"wrong_rejection_share", "least_equal_count", "confirms_share", "most_rejected_share", "least_rows_count", "longest_pause_s",
        "jump_K", "slow_s", "most_unused_share", "off_step_ratio"}}};
  if (measured_data("ksu_propeller_bench") && measured_data("tasrv_uav_motor") && measured_data("paderborn_pmsm")) {
    all.push_back({"Measured motors: effects named; error on unseen recordings",
                   [] { return Study([](const attribution::SelectionRules&) { return marks_of_measured(); }); },
                   {}});
  }
  return all;
}

std::string marks_with(const Group& group, const estimation::Thresholds& changed, const attribution::SelectionRules& rules) {
  estimation::set_thresholds(changed);
  std::string text;
  try {
    text = group.study(rules);
  } catch (const std::exception&) {
    text = "refused";
  }
  estimation::set_thresholds({});
  return text == group.usual ? "same" : text;
}

void print_row(std::string_view name, double value, std::string_view rest, double off, const std::function<std::string(double)>& marks_at) {
  fmt::print("| `{}` | {:.4g} | {} |", name, value, rest);
  for (const double changed : {off, 0.5 * value, 2.0 * value}) {
    // A part of a run cannot be larger than the run.
    const bool is_possible = name != "seen_share" || changed < 1.0;
    fmt::print(" {} |", is_possible ? marks_at(changed) : "impossible");
    std::fflush(stdout);
  }
  fmt::print("\n");
}

/// A prior; `off_value` makes it vague.
struct PriorSpec {
  std::string_view name;
  double attribution::SelectionRules::*value;
  double off_value;
};

const std::vector<PriorSpec>& priors() {
  static const std::vector<PriorSpec> all{
      {"inclusion_nats", &attribution::SelectionRules::inclusion_nats, 0.0},
      {"conditional_nats", &attribution::SelectionRules::conditional_nats, 0.0},
      {"size_sd", &attribution::SelectionRules::size_sd, 100.0},
      {"body_start_K", &attribution::SelectionRules::body_start_K, 1e-3},
      {"curve_nats", &attribution::SelectionRules::curve_nats, 0.0},
      {"curve_level_precision_ratio", &attribution::SelectionRules::curve_level_precision_ratio, 1e-4},
      {"curve_step_precision_ratio", &attribution::SelectionRules::curve_step_precision_ratio, 1e-4},
  };
  return all;
}

bool is_in(const std::vector<std::string_view>& names, std::string_view name) { return std::ranges::find(names, name) != names.end(); }

void study(Group& group, const std::vector<std::string_view>& wanted) {
  group.study = group.make();
  group.usual = group.study({});
  fmt::print("\n{}. With all values as they are: {}.\n\n", group.title, group.usual);
  fmt::print("| threshold | value | unit | origin | off | half | double |\n|---|---|---|---|---|---|---|\n");
  for (const estimation::ThresholdSpec& spec : estimation::kThresholds) {
    if (group.has(spec.name) && is_in(wanted, spec.name)) {
      print_row(spec.name, estimation::Thresholds{}.*spec.value, fmt::format("{} | {}", spec.unit, spec.origin), spec.off_value,
                [&](double value) {
                  estimation::Thresholds changed;
                  changed.*spec.value = value;
                  return marks_with(group, changed, {});
                });
    }
  }
  for (const PriorSpec& spec : priors()) {
    if (group.has_priors && is_in(wanted, spec.name)) {
      print_row(spec.name, attribution::SelectionRules{}.*spec.value, " | prior", spec.off_value, [&](double value) {
        attribution::SelectionRules rules;
        rules.*spec.value = value;
        return marks_with(group, {}, rules);
      });
    }
  }
}

int run(const StudyWords& words) {
  std::vector<std::string_view> names;
  std::ranges::transform(estimation::kThresholds, std::back_inserter(names), &estimation::ThresholdSpec::name);
  std::vector<std::string_view> wanted = names;
  std::ranges::transform(priors(), std::back_inserter(names), &PriorSpec::name);
  if (words.has(0)) {
    wanted.assign(words.all().begin(), words.all().end());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      static_cast<void>(words.one_of(i, names));
    }
  }
  std::vector<Group> all = groups();
  for (Group& group : all) {
    const auto is_wanted = [&](std::string_view name) {
      return group.has(name) || (group.has_priors && std::ranges::find(priors(), name, &PriorSpec::name) != priors().end());
    };
    if (std::ranges::any_of(wanted, is_wanted)) {
      study(group, wanted);
    }
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  constexpr const char* kUsage =
      "usage: heatsoak_attribution_ablation [NAME…]\n\n"
      "  NAME  a threshold of estimation/thresholds.h or a prior; all thresholds without one\n";
  return run_study(argc, argv, kUsage, 100, run);
}
