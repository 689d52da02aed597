// Which effects a model lacks: forward selection by evidence with a nonlinear refit of the best, backward check, driver scan.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "identify/attribution/changed_figures.h"
#include "identify/attribution/driver_scan.h"
#include "identify/attribution/ladder.h"
#include "identify/attribution/refit.h"

namespace heatsoak {

struct SelectionInput {
  ExtendedModel model;            ///< near its fit
  std::vector<MeasuredRun> runs;  ///< at least one
  bool scans_drivers = true;
  bool waits_for_others = true;  ///< takes curves too with which whole runs are followed worse until what balances them is found
  bool adds_terms = true;        ///< false: what is in question is looked at and nothing taken in
  std::map<std::string, std::string> refused;  ///< AcceptedTerm::own_name of terms that are refused in the end, and why
};

/// Thresholds in nats. An effect is named where the evidence for it is e^7 ≈ 1100 : 1 against the model without it.
struct SelectionRules {
  double least_gain_nats = 7.0;
  double ambiguous_within_nats = 5.0;
  double outside_beyond_nats = 10.0;  ///< that a curve over a driver must be ahead of all effects of the catalogue, and
  double outside_beyond_share = 0.2;  ///< of its own evidence: laws are never exact, and much data sees the least difference of shape
  double beside_curve_share = 0.05;   ///< of a curve's evidence: less than that beside it is what seven knots leave of its shape
  double beside_law_share = 0.03;     ///< the same of laws at one node: none is exact, and what it leaves looks like another
  double least_visibility_ratio = 0.02;
  double unmistakable_nats = 20.0;  ///< over the model without it and doubt in all figures: then it stays though little of it is visible
  double least_heat_share = 0.01;   ///< of the heat that the model knows: an effect of less on average, and of less than
  double least_peak_share = 0.04;   ///< that at its peak, is not named
  double least_deviation_share = 0.03;  ///< that some runs are said to have of heat or of a resistance
  double least_fault_share = 0.35;      ///< of what is typical: a sensor's fault that is less gets no name unless it is unmistakable
  int in_question = 12;                 ///< that a round judges, of which sets are made, and of which so many are
  int refitted = 6;                     ///< in the equations
  int most_terms = 4;
};

/// A round of the selection: what was in question and what came of it.
struct Round {
  std::vector<JudgedCandidate> ladder;  ///< best first
  std::vector<ScanResult> scan;         ///< best first
  double evidence_nats = 0.0;           ///< of the model at the beginning of the round
  /// Effects, curves and doubts in figures that were taken in, all of them together for so much evidence; the backward check may drop some.
  std::vector<std::string> taken;
  double taken_nats = 0.0;
};

/// A term that the selection took in.
struct AcceptedTerm {
  std::optional<Candidate> candidate;  ///< of the catalogue, or else:
  std::optional<ScanResult> curve;     ///< found by the driver scan
  std::string effect_name;             ///< of the instance in the network; empty for sensors
  double gain_nats = 0.0;              ///< when it was taken in
  double loss_without_nats = 0.0;      ///< of the final model, were it dropped
  double visibility_ratio = 0.0;
  bool is_of_set = false;                    ///< taken in together with others, none of them without the rest
  std::vector<std::string> confusable_with;  ///< ids within the ambiguity
  std::vector<std::string> experiments;      ///< that would tell them apart

  /// Id of the effect, or the driver of the curve.
  [[nodiscard]] const std::string& what(const std::vector<Driver>& all_drivers) const;
  /// Of two curves over one signal each has its own.
  [[nodiscard]] const std::string& own_name() const { return effect_name.empty() ? candidate->id : effect_name; }
  /// What could stand in the place of an effect of the catalogue, told once.
  void add_rival(const Candidate& other);
};

/// What explains something and still gets no name.
struct Refusal {
  std::string id;
  std::string words;           ///< "radiation: 12 nats, but the base parameters absorb all but 0.1 % of it"
  bool is_negligible = false;  ///< so little of it that nothing is missing without it
};

struct Selection {
  RefitResult before;
  RefitResult after;
  bool is_held = false;           ///< whole runs had decided the figures, and with nothing that was found they are followed plainly better
  bool waits_for_others = false;  ///< with one of the curves, when it was taken, whole runs were followed worse
  ExtendedModel base;             ///< the model as it was, with doubt where the runs contradict its file
  std::vector<ChangedFigure> changed;
  RefitResult own;  ///< `before` once more with that doubt: the model's own figures, nothing added
  std::vector<AcceptedTerm> terms;
  std::vector<Round> rounds;
  std::vector<Driver> drivers;  ///< that the scans looked at
  std::vector<std::string> not_judged;
  double mean_heat_W = 0.0;              ///< that the model knows of, over all runs
  std::optional<ScanResult> open_curve;  ///< that nothing in the network can follow, or physics forbids as it stands
  FluxGrid grid;
  SensorErrors errors;
  std::vector<std::string> unseen;  ///< effects that at their typical size would not show in these runs
  double seen_share = 1.0;          ///< of the effects that were judged
  std::vector<Refusal> refused;

  /// Heat is known to follow the curve's signal. Beside a law of much more evidence a curve is what that leaves of its shape, and need
  /// not be all.
  [[nodiscard]] bool is_known(const ScanResult& curve) const;
  /// Place of the driver of that name in the list, which then has this one.
  int place_of(Driver driver);
  /// Adds a round that began with so many terms and changed figures.
  void close(Round round, std::size_t terms_before, std::size_t changed_before);
  /// A curve of the other selection, its driver by this one's list.
  ScanResult with_drivers_of(const Selection& other, ScanResult curve);
  /// To a curve those of the scan that explain as much within the ambiguity.
  void tell_other_drivers(AcceptedTerm& term, const std::vector<ScanResult>& scan, double within_nats) const;
  void forget_refusal(const std::string& id);
  /// Takes the place of what was said of it before.
  void refuse(const std::string& id, double gain_nats, std::string_view why, bool is_negligible = false);
  /// Something may be missing that cannot be named.
  [[nodiscard]] bool leaves_doubt() const;
};

/// Why, of a refusal of what hardly changes how much heat is unknown.
inline constexpr std::string_view kMoreRemains = "more remains unexplained than it explains";
/// Why, of a refusal where whole runs decided the figures.
inline constexpr std::string_view kHardlyBetterTold =
    "whole runs, which decided the figures of the model, are followed hardly better with it";
/// Why, of a curve beside one over another column of the log.
inline constexpr std::string_view kNoRoom = "a model has room for one column of the logs";
/// Why, of a curve that something else may balance, which was not found.
inline constexpr std::string_view kStraysAlone = "with it alone whole runs are followed worse";
/// Then what an effect leaves of the error of free runs is at most this share, or it is not named.
inline constexpr double kPlainlyBetter_share = 0.85;

/// One way through the rounds.
Selection select_once(const SelectionInput& input, const SelectionRules& rules);
/// With a look at whole runs: curves that balance nothing are not waited with; where whole runs had decided the model's figures and are
/// followed hardly better with what was found, it is that model as it stands, with nothing added.
Selection select_effects(const SelectionInput& input, const SelectionRules& rules);

}  // namespace heatsoak
