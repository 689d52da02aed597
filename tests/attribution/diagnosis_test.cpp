// Short form of the examination. The program heatsoak_attribution_table runs the long form.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "diagnosis/advisor.h"
#include "drive_rows.h"
#include "scoring.h"

namespace heatsoak::attribution::truth {
namespace {

Case sealed(const Missing& missing, std::uint64_t seed) {
  Case one;
  one.missing = missing;
  one.seed = seed;
  return one;
}

const Subject& subject(std::string_view name) { return *std::ranges::find(subjects(), name, &Subject::name); }

/// Returns the model fitted to the runs, with a standard deviation of sd_share for every parameter.
estimation::Model known_to(double sd_share, const diagnosis::DiagnosisInput& input) {
  estimation::Model known = diagnosis::diagnose(input, {}).selection.before.model;
  const Eigen::Index count = known.network_count();
  known.prior = {known.theta(), Eigen::MatrixXd::Identity(count, count) / (sd_share * sd_share)};
  return known;
}

/// Constant heat is balanced by air cooling at low supply voltage, so that neither acts like a known law alone. The cooling follows the bus
/// voltage; no effect of the catalogue may be named.
TEST(Examination, ACurveAndALawThatBalanceEachOtherAreUnexplainedHeat) {
  Missing missing;
  missing.heat.emplace_back([](const Moment& now, PerPart& q) {
    q[yoke] += 1.8;
    q[sleeve] -= now.in.bus_V < 23.5 ? 0.15 * (now.part_C[sleeve] - now.in.ambient_C) : 0.0;
  });
  Case one = sealed(missing, 12);
  one.is_calibrated = true;
  const Answer answer = examine(one);
  ASSERT_EQ(answer.diagnosis.verdict, diagnosis::DiagnosisVerdict::unexplained) << account(answer);
  EXPECT_EQ(answer.diagnosis.unexplained.front().node, "stator");
  EXPECT_THAT(answer.named, testing::ElementsAre("stator~bus_voltage"));
  EXPECT_LT(answer.after_K, 0.8 * answer.before_K) << account(answer);
}

/// Operating points have no sign of the current, only the log has it.
TEST(Examination, CurveOverAColumnOfTheLogIsPartOfTheModel) {
  Missing missing;
  missing.heat.emplace_back([](const Moment& now, PerPart& q) { q[slot] += now.in.current_A > 0.0 ? 0.5 * now.copper_loss_W : 0.0; });
  const Answer answer = examine(sealed(missing, 12));
  const diagnosis::Diagnosis& found_diagnosis = answer.diagnosis;
  ASSERT_EQ(found_diagnosis.effects.size(), 1U) << account(answer);
  EXPECT_EQ(found_diagnosis.effects.front().drivers, std::vector<std::string>{"current_A"}) << account(answer);
  EXPECT_THAT(found_diagnosis.selection.after.model.columns, testing::ElementsAre("current_A"));
  ASSERT_FALSE(found_diagnosis.unexplained.empty());
  EXPECT_TRUE(found_diagnosis.unexplained.front().is_in_model);
  EXPECT_LT(estimation::rms_K(answer.score.after), 0.3 * estimation::rms_K(answer.score.refitted)) << account(answer);
}

TEST(Examination, ConstantHeatInTheWindingOfAllRunsIsOneEffect) {
  constexpr double kHeat_W = 1.3;
  Missing missing;
  missing.heat.emplace_back([](const Moment&, PerPart& q) { q[slot] += kHeat_W; });
  const Answer answer = examine(sealed(missing, 12));
  ASSERT_EQ(answer.diagnosis.effects.size(), 1U) << account(answer);
  const diagnosis::FoundEffect& found = answer.diagnosis.effects.front();
  EXPECT_EQ(found.id, "constant_heat");
  EXPECT_EQ(found.node, "winding");
  EXPECT_THAT(found.condition, testing::IsEmpty());
  EXPECT_NEAR(found.mean_W, kHeat_W, 0.2 * kHeat_W);
  EXPECT_LT(answer.after_K, 0.3 * answer.before_K) << account(answer);
}

TEST(Examination, NothingMissingIsSaidToBeNothing) {
  for (const std::uint64_t seed : {1, 2}) {
    const Answer answer = examine(sealed({}, seed));
    EXPECT_TRUE(is_silent(answer)) << account(answer);
    EXPECT_EQ(answer.diagnosis.verdict, diagnosis::DiagnosisVerdict::nothing_missing);
  }
}

TEST(Examination, TypicalEffectsAreNamedAndHelpOnUnseenRuns) {
  Case one = sealed({}, 11);
  const double floor_of_all_K = floor_K(one);
  double after_over_floor = 0.0;
  const std::vector<std::string_view> some{"iron_loss_eddy", "speed_dependent_convection", "ac_copper_loss", "third_node",
                                           "sensor_lag_stator"};
  for (const std::string_view name : some) {
    one.missing = subject(name).make(1.0);
    const Answer answer = examine(one);
    EXPECT_TRUE(names_only(answer.named, {&subject(name)})) << name << account(answer);
    EXPECT_EQ(answer.diagnosis.verdict, diagnosis::DiagnosisVerdict::effect_found) << name;
    EXPECT_LT(answer.after_K, 0.7 * answer.before_K) << name << account(answer);
    after_over_floor += answer.after_K / floor_of_all_K / static_cast<double>(some.size());
  }
  EXPECT_LT(after_over_floor, 1.1);
}

TEST(Examination, HeatThatNoLawHasIsUnexplainedButDescribed) {
  const Outsider& resonance = outsiders().front();
  const Answer answer = examine(sealed(resonance.make(1.0), 3));
  EXPECT_TRUE(names_outsider(answer, resonance)) << account(answer);
  ASSERT_FALSE(answer.diagnosis.unexplained.empty());
  // The true curve has its peak of 3 W at 300 rad/s and hardly any heat at standstill.
  const diagnosis::Unexplained& heat = answer.diagnosis.unexplained.front();
  const auto top = std::ranges::max_element(heat.curve) - heat.curve.begin();
  EXPECT_NEAR(heat.knots[static_cast<std::size_t>(top)], 300.0, 50.0) << account(answer);
  EXPECT_NEAR(heat.curve[static_cast<std::size_t>(top)], 3.0, 1.0) << account(answer);
}

/// If it is modelled over |I| or |ω| alone, it looks like heat that follows one signal. The curve is the heat per ampere over speed.
TEST(Examination, HeatThatFollowsTwoSignalsIsReportedAsSuch) {
  const auto two = std::ranges::find(outsiders(), "current", &Outsider::times);
  const Answer answer = examine(sealed(two->make(1.0), 40004));
  ASSERT_TRUE(names_outsider(answer, *two)) << account(answer);
  const diagnosis::Unexplained& heat = answer.diagnosis.unexplained.front();
  EXPECT_EQ(heat.times, "current");
  EXPECT_EQ(heat.curve_unit, "W/A");
  EXPECT_TRUE(heat.is_in_model);
  const double least_K = floor_K(sealed({}, 40004));
  EXPECT_LT(answer.after_K * answer.after_K - least_K * least_K, 0.1 * (answer.before_K * answer.before_K - least_K * least_K))
      << account(answer) << ", floor " << least_K;
}

// 4·ε·σ·A·T³ is a nearly constant conductance to the air, so the base model explains nearly all of it.
TEST(Examination, EffectsThatTheBaseParametersNearlyExplainGetNoOtherName) {
  for (const std::string_view name : {"radiation", "natural_convection"}) {
    const Answer answer = examine(sealed(subject(name).make(1.0), 21));
    EXPECT_THAT(answer.named, testing::AnyOf(testing::IsEmpty(), testing::ElementsAre(std::string(name)))) << account(answer);
  }
}

// Heat follows the speed, but the logs contain speeds of other rows. Every name that refers to speed is therefore wrong.
TEST(Examination, HeatThatNoMeasuredSignalFollowsRarelyGetsAName) {
  int named = 0;
  for (std::uint64_t seed = 31; seed < 39; ++seed) {
    Case one = sealed(subject("iron_loss_eddy").make(1.0), seed);
    one.has_right_speed = false;
    named += gives_a_name(examine(one)) ? 1 : 0;
  }
  EXPECT_LE(named, 2);
}

/// The only sensor is in the stator. Heat into the stator may then also be heat into the winding that has flowed to the stator.
TEST(Examination, WithoutASensorInTheWindingTheHeatedNodeIsUnknown) {
  for (const int seed : {1, 2, 3}) {
    const auto lamp = std::ranges::find(strangers(), "a lamp that somebody turns on and off", &Outsider::name);
    Case one = sealed(lamp->make(1.0), static_cast<std::uint64_t>(seed));
    one.has_winding_sensor = false;
    const Answer answer = examine(one);
    ASSERT_TRUE(leaves_unnamed(answer, *lamp)) << account(answer);
    EXPECT_THAT(answer.diagnosis.unexplained.front().or_nodes, testing::ElementsAre("winding"));
  }
}

/// A logged signal that happens to correlate with this heat is not its cause.
TEST(Examination, HeatThatFollowsNoLoggedSignalIsReportedInWattsAndRarelyNamed) {
  int cases = 0;
  int unnamed = 0;
  for (const Outsider& one : strangers()) {
    for (std::uint64_t seed = 70100; seed < 70103; ++seed) {
      const Answer answer = examine(sealed(one.make(1.0), seed));
      ++cases;
      if (!leaves_unnamed(answer, one)) {
        continue;
      }
      ++unnamed;
      const diagnosis::Unexplained& heat = answer.diagnosis.unexplained.front();
      EXPECT_EQ(heat.node, one.node);
      EXPECT_GT(heat.rms_W, 0.2) << account(answer);
      EXPECT_LT(heat.rms_W, 2.0) << account(answer);
      EXPECT_THAT(answer.diagnosis.selection.after.model.network.effects(), testing::SizeIs(3)) << "nothing was added";
    }
  }
  EXPECT_GE(unnamed, 0.8 * cases);
}

// The motor's file states 1.4 times the true resistance to the air with an uncertainty of 2 %, as if the motor had been mounted elsewhere.
TEST(Examination, AnOutdatedParameterIsReportedAndRefittedAndIsNoEffect) {
  const Case one = sealed({}, 5);
  const Runs runs = record(one);
  diagnosis::DiagnosisInput input = question(one, runs);
  input.model = known_to(0.02, input);
  estimation::Model& known = input.model;
  EXPECT_THAT(diagnosis::diagnose(input, {}).changed, testing::IsEmpty());
  Eigen::Index coordinate = 0;
  while (known.name(coordinate) != "stator_ambient.thermal_resistance") {
    ++coordinate;
  }
  double& out_K_per_W = known.values[static_cast<std::size_t>(known.free[static_cast<std::size_t>(coordinate)].place)];
  const double true_K_per_W = out_K_per_W;
  out_K_per_W *= 1.4;
  known.prior.mean = known.theta();
  const diagnosis::Diagnosis found = diagnosis::diagnose(input, {});
  EXPECT_EQ(found.verdict, diagnosis::DiagnosisVerdict::not_identifiable) << account(found);
  EXPECT_THAT(found.effects, testing::IsEmpty()) << account(found);
  ASSERT_EQ(found.changed.size(), 1U) << account(found);
  EXPECT_EQ(found.changed.front().name, known.name(coordinate));
  EXPECT_NEAR(found.changed.front().before, 1.4 * true_K_per_W, 1e-9);
  EXPECT_NEAR(found.changed.front().value, true_K_per_W, 0.05 * true_K_per_W);
  EXPECT_LT(found.changed.front().low, true_K_per_W);
  EXPECT_GT(found.changed.front().high, true_K_per_W);
  const diagnosis::HoldoutScore score = diagnosis::score_holdout(input, found, holdout(runs));
  EXPECT_LT(estimation::rms_K(score.after), estimation::rms_K(score.before) / 3.0);
}

/// The conductance from winding to iron now rises by a seventh in 30 K, while the file has 1 % uncertainty for a constant resistance. The
/// law has no effect at 25 °C, but the file's value is right at 45 °C.
TEST(Examination, LawIsFoundDespiteANarrowPriorOfACorrelatedParameter) {
  Case one = sealed({}, 63);
  const Runs runs_before = record(one);
  diagnosis::DiagnosisInput input = question(one, runs_before);
  input.model = known_to(0.01, input);
  const double nothing_missing_K =
      estimation::rms_K(diagnosis::score_holdout(input, diagnosis::diagnose(input, {}), holdout(runs_before)).after);
  one.missing.heat.push_back([](const Moment& now, PerPart& heat_W) {
    const double more_W = 0.14 / 1.6 * (0.5 * (now.copper_C + now.iron_C) - 45.0) / 30.0 * (now.copper_C - now.iron_C);
    heat_W[slot] -= more_W;
    heat_W[tooth] += more_W;
  });
  const Runs runs = record(one);
  input.train = question(one, runs).train;
  const diagnosis::Diagnosis found = diagnosis::diagnose(input, {});
  ASSERT_EQ(found.effects.size(), 1U) << account(found);
  EXPECT_EQ(found.effects.front().id, "contact_temperature_dependence") << account(found);
  EXPECT_EQ(found.verdict, diagnosis::DiagnosisVerdict::effect_found);
  ASSERT_EQ(found.changed.size(), 1U) << account(found);
  EXPECT_EQ(found.changed.front().name, "winding_stator.thermal_resistance");
  EXPECT_GT(found.changed.front().value, 1.02 * found.changed.front().before) << "at 25 °C it is more than at 45";
  EXPECT_LT(estimation::rms_K(diagnosis::score_holdout(input, found, holdout(runs)).after), 1.1 * nothing_missing_K) << account(found);
}

/// In one of four runs a cover reduces the heat to the air by three tenths. The resistance is then 1 / 0.7 of its former value. Unseen runs
/// have no cover.
TEST(Examination, WorseCoolingInOneRunIsReportedAndStaysThere) {
  Case one = sealed({}, 61);
  Runs runs = record(one);
  one.missing.heat.push_back([air_K_per_W = runs.make.iron_to_air_K_per_W](const Moment& now, PerPart& heat_W) {
    heat_W[yoke] += 0.3 * (now.iron_C - now.in.ambient_C) / air_K_per_W;
  });
  runs.training[1] = record(one).training[1];
  const diagnosis::DiagnosisInput input = question(one, runs);
  const diagnosis::Diagnosis found = diagnosis::diagnose(input, {});
  ASSERT_EQ(found.effects.size(), 1U) << account(found);
  const diagnosis::FoundEffect& effect = found.effects.front();
  EXPECT_EQ(effect.id, "hindered_cooling") << account(found);
  EXPECT_EQ(effect.condition, (estimation::Condition{{"run", "run2"}}));
  EXPECT_NEAR(effect.parameters.front().value, 1.0 / 0.7 - 1.0, 0.06) << account(found);
  EXPECT_LT(estimation::rms_K(found.after_train), 0.5 * estimation::rms_K(found.before_train)) << account(found);
  const diagnosis::HoldoutScore score = diagnosis::score_holdout(input, found, holdout(runs));
  EXPECT_LT(estimation::rms_K(score.after), estimation::rms_K(score.before) + 0.02) << account(found);
}

/// A winding has come loose in one run: the contact conductance falls by a fifth, so the contact resistance is 1 / 0.8 of its former value.
TEST(Examination, LooseWindingInOneRunIsAnotherContactThere) {
  Case one = sealed({}, 62);
  Runs runs = record(one);
  one.missing.heat.push_back([contact_K_per_W = runs.make.copper_to_iron_K_per_W](const Moment& now, PerPart& heat_W) {
    const double kept_back_W = 0.2 * (now.copper_C - now.iron_C) / contact_K_per_W;
    heat_W[slot] += kept_back_W;
    heat_W[tooth] -= kept_back_W;
  });
  runs.training[1] = record(one).training[1];
  const diagnosis::DiagnosisInput input = question(one, runs);
  const diagnosis::Diagnosis found = diagnosis::diagnose(input, {});
  ASSERT_EQ(found.effects.size(), 1U) << account(found);
  EXPECT_EQ(found.effects.front().id, "changed_contact") << account(found);
  EXPECT_EQ(found.effects.front().condition, (estimation::Condition{{"run", "run2"}}));
  EXPECT_NEAR(found.effects.front().parameters.front().value, 0.25, 0.05) << account(found);
  const diagnosis::HoldoutScore score = diagnosis::score_holdout(input, found, holdout(runs));
  EXPECT_LT(estimation::rms_K(score.after), estimation::rms_K(score.before) + 0.02) << account(found);
}

/// The effect is less than half as wide as a seventh of the stator's temperature range. Knots spread over the whole range would not resolve
/// where the fan starts.
TEST(Examination, KnotsAreDrawnToWhereSomethingHappens) {
  const auto fan = std::ranges::find(outsiders(), "a fan that starts at 45 °C of the stator", &Outsider::name);
  const Answer answer = examine(sealed(fan->make(1.0), 40003));
  ASSERT_TRUE(names_outsider(answer, *fan)) << account(answer);
  const diagnosis::Unexplained& heat = answer.diagnosis.unexplained.front();
  EXPECT_LT(heat.knots.back() - heat.knots.front(), 12.0) << "K, of some 30";
  EXPECT_GT(heat.knots.back(), 45.0);
  EXPECT_LT(heat.knots.front(), 46.0);
  EXPECT_LT(answer.after_K, 0.25 * answer.before_K) << account(answer);
}

TEST(Examination, ConfoundedEffectsComeWithAnExperimentThatSeparatesThem) {
  const Answer answer = examine(sealed(subject("connection_resistance").make(1.0), 60906));
  ASSERT_EQ(answer.diagnosis.effects.size(), 1U) << account(answer);
  ASSERT_FALSE(answer.diagnosis.effects.front().confusable_with.empty()) << account(answer);
  ASSERT_EQ(answer.diagnosis.experiments.size(), answer.diagnosis.effects.front().confusable_with.size());
  for (const diagnosis::Experiment& experiment : answer.diagnosis.experiments) {
    EXPECT_EQ(experiment.effect, answer.named.front());
    EXPECT_FALSE(experiment.what.empty());
  }
  EXPECT_GT(answer.diagnosis.experiments.front().expected_nats, 1.0);
}

/// The copper and iron of the true motor are not isothermal. Without a term for this uncertainty the intervals of these cases held 2 of 6.
/// Where the term explains most of the effect, the effect gets no name.
TEST(Examination, IntervalsHoldTheTruthThoughBodiesAreUneven) {
  int held = 0, unnamed = 0;
  for (const std::uint64_t seed : {434028, 434035, 434042, 434049, 434056, 434070}) {
    const Answer answer = examine(sealed(subject("connection_resistance").make(1.0), seed));
    if (answer.diagnosis.effects.empty()) {
      ++unnamed;
      EXPECT_FALSE(answer.diagnosis.selection.refused.empty());
      continue;
    }
    ASSERT_EQ(answer.diagnosis.effects.size(), 1U) << account(answer);
    const diagnosis::FittedParameter& size = answer.diagnosis.effects.front().parameters.front();
    held += size.low <= 0.02 && 0.02 <= size.high ? 1 : 0;
    EXPECT_LT(size.high - size.low, 0.03) << account(answer);
  }
  EXPECT_GE(held, 5);
  EXPECT_LE(unnamed, 1);
}

/// An experiment must not hold a single-row peak for minutes: ten minutes of it would destroy the motor.
TEST(Examination, ExperimentsStayAsCoolAsTheRuns) {
  const Case one = sealed(subject("connection_resistance").make(1.0), 60906);
  diagnosis::DiagnosisInput input = question(one, record(one));
  const diagnosis::Diagnosis diagnosis = diagnosis::diagnose(input, {});
  input.train.front().at[100].current_rms_A = 200.0;
  const std::vector<diagnosis::Experiment> experiments = diagnosis::next_experiments(diagnosis.selection, input.train);
  ASSERT_FALSE(experiments.empty());
  ASSERT_TRUE(experiments.front().most_A);
  EXPECT_LT(*experiments.front().most_A, 200.0);
  EXPECT_GT(experiments.front().expected_nats, 1.0);
}

/// A winding for ten times the voltage with equal copper takes a tenth of the current and makes equal heat. The answer must not change.
TEST(Examination, WindingsForAnotherVoltageGetTheSameNames) {
  constexpr double kTurns_ratio = 10.0;
  for (const std::string_view name : {"connection_resistance", "saturation", "load_friction"}) {
    const Case one = sealed(subject(name).make(1.2), 60106);
    diagnosis::DiagnosisInput input = question(one, record(one));
    for (estimation::MeasuredRun& run : input.train) {
      run.columns.clear();
      for (thermal::OperatingPoint<double>& at : run.at) {
        at.current_rms_A /= kTurns_ratio;
      }
    }
    estimation::Model& model = input.model;
    for (std::size_t place = 0; place < model.values.size(); ++place) {
      if (model.network.parameters()[place].name == "copper_loss.terminal_resistance") {
        model.values[place] *= kTurns_ratio * kTurns_ratio;
      }
    }
    const diagnosis::Diagnosis diagnosis = diagnosis::diagnose(input, {});
    ASSERT_EQ(diagnosis.effects.size(), 1U) << name << ": " << account(diagnosis);
    EXPECT_TRUE(names({diagnosis.effects.front().id}, subject(name))) << account(diagnosis);
  }
}

TEST(Examination, TheBoundOfASearchIsReachedExactly) {
  estimation::Model model = model_before(record(sealed({}, 1)).make, 1);
  Eigen::VectorXd theta = model.theta();
  for (const double bound : {3.0, 0.7, 1.9}) {
    estimation::FreeParameter& first = model.free.front();
    first.low = first.high = bound;
    theta[0] = std::log(bound);
    EXPECT_EQ(model.values_at(theta)[static_cast<std::size_t>(first.place)], bound);
  }
}

TEST(Examination, OrderOfRunsChangesNothing) {
  const Case one = sealed(subject("iron_loss_eddy").make(0.8), 12);
  const Runs runs = record(one);
  SelectionInput forwards, backwards;
  forwards.model = backwards.model = model_before(runs.make, one.seed);
  SelectionRules rules;
  rules.scans_drivers = false;
  for (const TrueRun& run : runs.training) {
    forwards.runs.push_back(measured(run));
    backwards.runs.insert(backwards.runs.begin(), measured(run));
  }
  const Selection a = select_effects(forwards, rules), b = select_effects(backwards, rules);
  ASSERT_EQ(a.terms.size(), b.terms.size());
  EXPECT_NEAR(a.after.evidence_nats, b.after.evidence_nats, 1e-3 * std::abs(a.after.evidence_nats));
  EXPECT_EQ(a.terms.front().candidate->id, b.terms.front().candidate->id);
}

/// Checks the truth motor's integrator: steps four times as short change no sensor value noticeably, however light the parts.
TEST(TruthMotor, StepsAreShortEnoughForEveryMake) {
  Surprise quiet;
  quiet.flux_W = quiet.noise_K = quiet.step_K = quiet.outlier_probability = quiet.gap_probability = 0.0;
  const std::vector<RowInputs> rows = bench_rows(700, 5);
  for (const double share : {0.1, 0.37, 1.0, 1.25}) {
    MotorMake make;
    make.copper_capacity_J_per_K *= share;
    make.iron_capacity_J_per_K *= share;
    const TrueRun usual = run_motor(make, {}, quiet, rows, 0.0, 1, "usual");
    make.finer = 4;
    const TrueRun fine = run_motor(make, {}, quiet, rows, 0.0, 1, "fine");
    for (std::size_t k = 0; k < rows.size(); ++k) {
      EXPECT_NEAR(usual.winding_C[k], fine.winding_C[k], 1e-3) << share << " at " << k;
      EXPECT_NEAR(usual.stator_C[k], fine.stator_C[k], 1e-3) << share << " at " << k;
    }
  }
}

/// Energy balance: at standstill with constant current all copper loss leaves through the iron.
TEST(TruthMotor, LosesInTheEndWhatItTakesIn) {
  Surprise quiet;
  quiet.flux_W = quiet.noise_K = quiet.step_K = quiet.outlier_probability = quiet.gap_probability = 0.0;
  RowInputs held;
  held.current_A = 3.0;
  MotorMake make;
  make.copper_per_K = 0.0;
  const TrueRun run = run_motor(make, {}, quiet, std::vector<RowInputs>(7200, held), 0.0, 1, "held");
  const double heat_W = 9.0 * make.resistance_25C_ohm;
  // Iron parts are within 0.1 K of each other, so the sleeve matches the iron of the two-node formula within 1 %.
  EXPECT_NEAR(run.stator_C.back() - 25.0, heat_W * make.iron_to_air_K_per_W, 0.01 * heat_W * make.iron_to_air_K_per_W);
  EXPECT_NEAR(run.winding_C.back() - run.stator_C.back(), heat_W * make.copper_to_iron_K_per_W,
              0.02 * heat_W * make.copper_to_iron_K_per_W);
}

}  // namespace
}  // namespace heatsoak::attribution::truth
