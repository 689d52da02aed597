// Stage 1, second part: compares sensors with each other over tens of milliseconds. The tests take turns, so that no step runs all of
// them.
#include "robot_core/drive_stages.h"

// Optimised for size; a part of it runs in about every fifth step.
#pragma GCC optimize("Os")

namespace robot_core {
namespace {

// A sample counts as stuck if it stays exactly constant for this time while other evidence shows a change.
constexpr float kStuck_s = 0.05F;
// Sliding contacts make wheels disagree for a while. A disagreement above this share of the fastest speed is not sliding.
constexpr float kDisagreement_share = 0.06F;
constexpr float kSameDisagreement_share = 0.02F;  // limit for a sample that does not change at all
// A wheel sensor counts as wrong if it alone is off by kWrong_m_per_s plus kWrong_share of the speed limit for kWrong_s. In simulation a
// sliding wheel is off by 0.24 m/s for up to 0.5 s (40 drives with jumps of the command), pushed with 15 N for up to 1.1 s.
constexpr float kWrong_s = 1.0F;
constexpr float kWrong_m_per_s = 0.0625F;
constexpr float kWrong_share = 0.0625F;
constexpr float kAlone_share = 0.875F;  // smallest share of the residual that one wrong sensor explains
// A wrong sensor recovers while the implied speed exceeds this multiple of its error plus this share of the threshold.
constexpr float kRecovery_ratio = 1.0F / kSlipAndNoise_share;
constexpr float kTurning_share = 0.125F;
constexpr float kYawDisagreement_rad_per_s = 2.0F;
// Upper bound of winding resistance over coldest resistance: 2 is copper at 280 degC.
constexpr float kHotResistance_ratio = 2.0F;
// Settling and delay as a share of the explained current, in addition to Config's margin.
constexpr float kSettling_share = 0.15F;
// Swapped sensors: time constant, smallest contradiction, and smallest ratio of contradiction to confirmation.
constexpr float kSwap_s = 0.3F;
constexpr float kLeastContradiction_share = 0.008F;
constexpr float kMuchMore_ratio = 4.0F;
// A comparison counts if it exceeds this share of the smallest contradiction.
constexpr float kClear_share = 0.1F;
// Confirmation in wheel-by-wheel modes, as a multiple of the smallest contradiction: the wheels slide for a while afterwards.
constexpr float kWheelwise_ratio = 10.0F;
// Sums of the sizes of the rim speeds: of a robot that runs away, of one that stands again, and the decrease of one that slows down.
constexpr float kRuns_m_per_s = 0.5F;
constexpr float kStands_m_per_s = 0.1F;
constexpr float kSlows_m_per_s = 0.05F;
// Reference velocity from which currents are compared with what they do.
constexpr float kDriven_m_per_s = 0.1F;
// A wheel that accelerates by more than this multiple of the acceleration limits slides.
constexpr float kGripping_ratio = 2.0F;
// Residual below which the speeds of four wheels without sliding count as consistent.
constexpr float kLeastResidual_m_per_s = 0.03F;

struct CurrentRange {
  float low_A = 0.0F;
  float high_A = 0.0F;
};

constexpr std::uint64_t kSeed = 0x434F4D5041524521U;

constexpr std::uint8_t code(Reason reason) { return static_cast<std::uint8_t>(reason); }

[[gnu::noinline]] std::uint64_t check_sum_of(const ComparisonState& comparison) {
  return check_sum_of_words<1, sizeof(ComparisonState) / sizeof(std::uint64_t)>(&comparison, kSeed);
}

void copy_faults(State& state) {
  unsigned fitted = 0;
  for (int i = 0; i < kMostWheels; ++i) {
    state.comparison.speed_fault[i] = state.wheel[i].speed_fault;
    fitted |= static_cast<unsigned>(state.wheel[i].has_current | (state.wheel[i].has_stator << kMostWheels)) << static_cast<unsigned>(i);
  }
  state.comparison.fitted = static_cast<std::uint8_t>(fitted);
  state.comparison.ambient_C = state.ambient_C;
  state.comparison.yaw_fault = state.yaw_fault;
}

/// Range of currents that a voltage explains at a speed, over all winding temperatures.
CurrentRange explained_current(const Config& config, float voltage_V, float speed_rad_per_s) {
  const float cold_A =
      (voltage_V - config.derived.geared_constant_V_s_per_rad * speed_rad_per_s) * config.derived.per_lowest_resistance_A_per_V;
  constexpr float kHot_share = 1.0F / kHotResistance_ratio;
  const float hot_A = cold_A * kHot_share;
  return {smaller(cold_A, hot_A), larger(cold_A, hot_A)};
}

/// Returns true if a sample fits neither the last period nor the one before; the delay of samples and voltages is unknown.
bool current_contradicts(const Config& config, const WheelState& wheel, float sensed_A, float speed_rad_per_s) {
  const CurrentRange last = wheel.is_open != 0 ? CurrentRange{} : explained_current(config, wheel.voltage_V, speed_rad_per_s);
  const CurrentRange earlier = explained_current(config, wheel.earlier_V, speed_rad_per_s);
  const float margin_A = config.derived.current_margin_A + kSettling_share * larger(absolute(last.high_A), absolute(last.low_A));
  const bool is_sample = absolute(sensed_A) <= config.derived.most_sensed_A;
  return is_sample &&
         !(sensed_A >= smaller(last.low_A, earlier.low_A) - margin_A && sensed_A <= larger(last.high_A, earlier.high_A) + margin_A);
}

[[gnu::cold]] void compare_yaw_rate(const Config& config, State& state, const Validated& validated, float since_s) {
  ComparisonState& comparison = state.comparison;
  const float apart_rad_per_s = absolute(state.raw_yaw_rate_rad_per_s - yaw_rate_of_wheels(config, validated));
  const bool disagrees = validated.are_all_sensed && apart_rad_per_s > kYawDisagreement_rad_per_s;
  const bool is_accepted = state.yaw_fault == 0;
  const bool is_evidence = is_accepted ? state.is_yaw_same != 0 && disagrees : state.was_yaw_implausible == 0 && !disagrees;
  comparison.yaw_evidence_s = is_evidence ? comparison.yaw_evidence_s + since_s : 0.0F;
  if (comparison.yaw_evidence_s > (is_accepted ? kStuck_s : kSteadyAgain_s)) {
    state.yaw_fault = is_accepted ? code(Reason::yaw_rate_stuck) : 0;
    comparison.yaw_evidence_s = 0.0F;
  }
  state.was_yaw_implausible = 0;
}

bool is_controlled(Mode mode) { return mode == Mode::body_velocity || mode == Mode::pose_target; }

/// False while the robot should stand, and if the body is not controlled.
[[gnu::noinline]] bool is_asked_to_move(const Config& config, const Vector3& asked, const Validated& validated) {
  return is_controlled(validated.mode) &&
         absolute(asked.x) + absolute(asked.y) + config.contact_radius_m * absolute(asked.yaw) > kDriven_m_per_s;
}

/// Checks all speeds at once, because sensors that are dead together agree with each other.
[[gnu::cold]] void compare_standing(const Config& config, State& state, const Validated& validated, float since_s) {
  bool is_driven = false;
  for (int i = 0; i < config.wheel_count; ++i) {
    const WheelState& wheel = state.wheel[i];
    if (wheel.same_steps < kStepsPerComparison) {
      state.comparison.standing_s = 0.0F;
      return;
    }
    const float driven_V = wheel.voltage_V - config.derived.geared_constant_V_s_per_rad * wheel.raw_speed_rad_per_s;
    // The limits may leave less than the limp current: without spare sensors, or if the gyro contradicts wheels that seem to stand.
    const bool is_held_back =
        validated.mode != Mode::coast && ((validated.is_redundancy_reduced && state.is_limited != 0) || validated.is_any_possible ||
                                          validated.spread_V > config.lowest_resistance_ohm * config.limp_current_A);
    is_driven = is_driven || is_held_back || absolute(driven_V) > config.lowest_resistance_ohm * config.limp_current_A;
  }
  // Counts up to twice the threshold: the limp current keeps the evidence below it afterwards.
  float& standing_s = state.comparison.standing_s;
  standing_s = is_driven ? smaller(standing_s + since_s, 2.0F * kStanding_s) : standing_s;
}

/// Swapped wheel sensors make the control drive a standing robot, once it is pushed, instead of holding it. The command decides whether the
/// robot should stand, because the reference follows a robot that rolls out.
[[gnu::cold, gnu::noinline]] void compare_runaway(const Config& config, State& state, const Input& input, const Validated& validated,
                                                  float since_s) {
  ComparisonState& comparison = state.comparison;
  float rim_m_per_s = 0.0F;
  for (int i = 0; i < config.wheel_count; ++i) {
    rim_m_per_s += absolute(rim_speed_m_per_s(config, i, state.wheel[i].raw_speed_rad_per_s));
  }
  const Vector3& asked = validated.mode == Mode::pose_target ? state.plan_velocity : input.command.velocity;
  const bool should_stand = (is_controlled(validated.mode) || validated.mode == Mode::brake) &&
                            !is_asked_to_move(config, asked, validated) && comparison.is_checked == 0;
  const bool is_runaway = comparison.runaway_s >= kRunaway_s;
  if (!should_stand || !(rim_m_per_s > (is_runaway ? kStands_m_per_s : kRuns_m_per_s))) {
    comparison.runaway_s = 0.0F;
    return;
  }
  const bool slows = rim_m_per_s < comparison.runaway_m_per_s - kSlows_m_per_s && !is_runaway;
  if (comparison.runaway_s == 0.0F || slows) {
    comparison.runaway_s = 0.0F;
    comparison.runaway_m_per_s = rim_m_per_s;
  }
  comparison.runaway_s += since_s;
}

/// Reaction of one wheel: driving voltage (V − K·n·ω), and speed gained since the last comparison.
struct WheelResponse {
  float driving_V;
  float gained_rad_per_s;
  bool is_usable;
};

void find_responses(const Config& config, State& state, const Validated& validated, float since_s, WheelResponse* response) {
  const float turning_rad = validated.velocity.yaw * since_s;
  const float gripping_m_per_s =
      kGripping_ratio * since_s * (config.acceleration_limit_m_per_s2 + config.contact_radius_m * config.yaw_acceleration_limit_rad_per_s2);
  for (int i = 0; i < config.wheel_count; ++i) {
    const WheelState& wheel = state.wheel[i];
    const WheelConfig& at = config.wheel[i];
    float& last_rad_per_s = state.comparison.last_rad_per_s[i];
    // In the frame of a turning robot the velocity turns without any force.
    const float turned_m_per_s = turning_rad * (at.rolling_x_share * validated.velocity.y - at.rolling_y_share * validated.velocity.x);
    const float gained_rad_per_s = wheel.raw_speed_rad_per_s - last_rad_per_s - turned_m_per_s * at.speed_per_rim_per_m;
    last_rad_per_s = wheel.raw_speed_rad_per_s;
    response[i] = {wheel.voltage_V - config.derived.geared_constant_V_s_per_rad * wheel.raw_speed_rad_per_s, gained_rad_per_s,
                   wheel.is_open == 0 && validated.wheel[i].is_speed_sensed &&
                       absolute(rim_speed_m_per_s(config, i, gained_rad_per_s)) <= gripping_m_per_s};
  }
}

/// Mean square residual of the speed samples, as rim speeds, against one motion of the body, with the samples of the wheels `a` and `b`
/// exchanged. It is 0 for three wheels, whose speeds fit some motion with the gyro even after two samples were exchanged.
[[gnu::cold, gnu::noinline]] float contradiction_m2_per_s2(const Config& config, const State& state, const Validated& validated, int a,
                                                           int b) {
  const float turning_m_per_s = config.contact_radius_m * validated.velocity.yaw;
  float x = 0.0F;
  float y = 0.0F;
  float all = 0.0F;
  for (int i = 0; i < config.wheel_count; ++i) {
    const int from = i == a ? b : i == b ? a : i;
    const float rim_m_per_s = rim_speed_m_per_s(config, i, state.wheel[from].raw_speed_rad_per_s) - turning_m_per_s;
    x += config.wheel[i].rolling_x_share * rim_m_per_s;
    y += config.wheel[i].rolling_y_share * rim_m_per_s;
    all += rim_m_per_s * rim_m_per_s;
  }
  // Least-squares residual: Σ r² − bᵀ·P·b with b = Σ t·r.
  const DerivedConfig& derived = config.derived;
  const float explained = derived.plane_xx_factor * x * x + 2.0F * derived.plane_xy_factor * x * y + derived.plane_yy_factor * y * y;
  return larger(0.0F, all - explained) / static_cast<float>(config.wheel_count);
}

/// Returns true if a wheel speed alone contradicts all others, or possibly does: with one sensor less the wrong one cannot be determined.
/// `apart_rad_per_s`: size of the difference from the speed that the others imply. Leaving the wheel out of the fit lowers the sum of
/// squared residuals by d²·(1 − leverage), where d is that difference.
bool is_wrong(const Config& config, const State& state, const Validated& validated, float apart_rad_per_s, float most_rad_per_s, int i) {
  const WheelConfig& wheel = config.wheel[i];
  constexpr float kShare_ratio = kAlone_share * static_cast<float>(kMostWheels);
  return apart_rad_per_s > most_rad_per_s &&
         (validated.is_redundancy_reduced ||
          apart_rad_per_s * apart_rad_per_s >
              kShare_ratio * wheel.others_rad_per_m * wheel.speed_per_rim_per_m * contradiction_m2_per_s2(config, state, validated, 0, 0));
}

/// Rejects the wrong sensor, and that of an opposite wheel, which contradicts the others almost equally. The right one then agrees with the
/// rest and recovers. No sensor has been rejected before.
[[gnu::noinline]] void reject_wrong(State& state) {
  for (int i = 0; i < kMostWheels; ++i) {
    float& evidence_s = state.comparison.evidence_s[i];
    if (evidence_s > 0.5F * kWrong_s) {
      state.wheel[i].speed_fault = code(Reason::wheel_speed_wrong);
      evidence_s = 0.0F;
    }
  }
}

/// Compares speed and current sensor of one wheel with the other wheels and the motor equation.
[[gnu::cold]] void compare_wheel(const Config& config, State& state, const Input& input, const Validated& validated, int i, float since_s) {
  WheelState& wheel = state.wheel[i];
  ComparisonState& comparison = state.comparison;
  const float sample = wheel.raw_speed_rad_per_s;
  const float implied_rad_per_s = validated.wheel[i].implied_rad_per_s;
  const float apart_rad_per_s = absolute(sample - implied_rad_per_s);
  const float wrong_rad_per_s = (kWrong_m_per_s + kWrong_share * config.speed_limit_m_per_s) * config.wheel[i].speed_per_rim_per_m;
  const bool is_wrong_now = is_wrong(config, state, validated, apart_rad_per_s, wrong_rad_per_s, i);
  const bool is_same = static_cast<float>(wheel.same_steps) * config.period_s > kStuck_s;
  const float most_apart_rad_per_s = (is_same ? kSameDisagreement_share : kDisagreement_share) * config.fastest_wheel_rad_per_s;
  const bool contradicts = current_contradicts(config, wheel, input.motor_current_A[i], sample);
  const bool agrees = apart_rad_per_s <= most_apart_rad_per_s && !contradicts;
  // Counts up to kSteadyAgain_s beyond the threshold, so that the sensor must agree for that time before it is accepted again.
  float& current_error_s = comparison.current_error_s[i];
  current_error_s = contradicts ? smaller(current_error_s + since_s, kStuck_s + kSteadyAgain_s) : larger(0.0F, current_error_s - since_s);
  wheel.is_current_distrusted = current_error_s > kStuck_s ? 1 : 0;
  float& evidence_s = comparison.evidence_s[i];
  const std::uint8_t fault = wheel.speed_fault;
  if (fault == 0) {
    comparison.disagreement_s[i] = agrees ? 0.0F : comparison.disagreement_s[i] + since_s;
    if (is_wrong_now && !validated.is_redundancy_reduced && is_controlled(validated.mode)) {
      evidence_s += since_s;
      if (evidence_s > kWrong_s) {
        reject_wrong(state);
      }
    } else {
      evidence_s = larger(0.0F, evidence_s - since_s);
    }
    // A wheel that stands has a constant sample. It contradicts a wrong sensor, but not alone.
    if (is_same && comparison.disagreement_s[i] > kStuck_s && (is_wrong_now || contradicts)) {
      wheel.speed_fault = code(Reason::wheel_speed_stuck);
      evidence_s = 0.0F;
    }
  } else if (fault != code(Reason::wheel_speed_swapped)) {
    const bool is_comparable = validated.wheel[i].is_speed_known || validated.are_samples_compared;
    bool is_confirmed = agrees && is_comparable && wheel.was_implausible == 0;
    float more_s = since_s;
    if (fault == code(Reason::wheel_speed_wrong)) {
      is_confirmed = is_confirmed && !is_wrong_now;
      // A wrong scale or sign does not show while the wheel hardly turns. An error of an eighth is within slip and noise.
      more_s = absolute(implied_rad_per_s) > kTurning_share * wrong_rad_per_s + kRecovery_ratio * apart_rad_per_s ? since_s : 0.0F;
    }
    evidence_s = is_confirmed ? evidence_s + more_s : 0.0F;
    // A sensor with a constant sample may recover only while no current flows.
    if (evidence_s >= kSteadyAgain_s && (!is_same || wheel.is_open != 0)) {
      wheel.speed_fault = 0;  // accepted from the next step on
      comparison.disagreement_s[i] = 0.0F;
      evidence_s = 0.0F;
    }
  }
  wheel.was_implausible = 0;
}

/// Returns true if the evidence that does not depend on pushes also speaks for a swap of two sensors: their exchange makes four speeds fit
/// one motion, and the exchanged speeds fit the sensed currents better, by V = R·I + K·n·ω. Without current samples the second is not
/// known.
[[gnu::cold, gnu::noinline]] bool is_exchange_better(const Config& config, const State& state, const Input& input,
                                                     const Validated& validated, int i, int j) {
  constexpr float kLeast_m2_per_s2 = kLeastResidual_m_per_s * kLeastResidual_m_per_s;
  if (kMuchMore_ratio * (contradiction_m2_per_s2(config, state, validated, i, j) - kLeast_m2_per_s2) >
      contradiction_m2_per_s2(config, state, validated, 0, 0)) {
    return false;
  }
  const WheelState& a = state.wheel[i];
  const WheelState& b = state.wheel[j];
  const float apart_V =
      (a.voltage_V - input.motor_current_A[i] / a.conductance_A_per_V) - (b.voltage_V - input.motor_current_A[j] / b.conductance_A_per_V);
  return !(apart_V * (a.raw_speed_rad_per_s - b.raw_speed_rad_per_s) > 0.0F);
}

/// Finds swapped sensors. The difference of two wheels' currents accelerates the difference of their speeds. With swapped sensors it seems
/// to decelerate it; the control then increases the difference until the product of both is large. Used only in body modes: wheels driven
/// against each other follow the strongest one.
void compare_pairs(const Config& config, State& state, const Input& input, const Validated& validated, float since_s) {
  ComparisonState& comparison = state.comparison;
  if (comparison.is_checked != 0) {
    return;  // wiring does not change while driving, but pushed robots slide as if it had
  }
  const float keep = 1.0F - smaller(1.0F, since_s / kSwap_s);
  // If wheels and gyro disagree about the rotation, one of them is wrong.
  const bool is_turning_known =
      state.yaw_fault == 0 && absolute(yaw_rate_of_wheels(config, validated) - validated.velocity.yaw) < kYawDisagreement_rad_per_s;
  // Pushes on a standing robot look like swapped sensors.
  const bool is_driven = is_asked_to_move(config, state.velocity_reference, validated);
  const bool is_wheelwise = validated.mode == Mode::wheel_speed || validated.mode == Mode::wheel_torque;
  const float fastest_rad_per_s = config.fastest_wheel_rad_per_s;
  float most = kLeastContradiction_share * config.derived.geared_constant_V_s_per_rad * fastest_rad_per_s * fastest_rad_per_s;
  const float clear = kClear_share * most;
  bool is_checked = true;
  // The body couples its wheels, so a current may slow its own wheel down. Four samples then still fit one motion of the body.
  float& residual_m2_per_s2 = comparison.residual_m2_per_s2;
  residual_m2_per_s2 += (1.0F - keep) * (contradiction_m2_per_s2(config, state, validated, 0, 0) - residual_m2_per_s2);
  const bool is_contradiction = config.wheel_count < 4 || residual_m2_per_s2 > kLeastResidual_m_per_s * kLeastResidual_m_per_s;
  WheelResponse response[kMostWheels];
  find_responses(config, state, validated, since_s, response);
  int worst[2] = {-1, -1};
  int pair = 0;
  for (int i = 0; i < config.wheel_count; ++i) {
    for (int j = i + 1; j < config.wheel_count; ++j, ++pair) {
      const bool is_usable = is_turning_known && is_driven && response[i].is_usable && response[j].is_usable;
      const float gained_rad_per_s = response[i].gained_rad_per_s - response[j].gained_rad_per_s;
      const float product = is_usable ? (response[i].driving_V - response[j].driving_V) * gained_rad_per_s : 0.0F;
      // Friction decelerates against the drive. Only a difference that grows against the drive shows a swap.
      const float apart_rad_per_s = state.wheel[i].raw_speed_rad_per_s - state.wheel[j].raw_speed_rad_per_s;
      const bool grows = apart_rad_per_s * gained_rad_per_s > 0.0F;
      float& with = comparison.with_V_rad_per_s[pair];
      float& against = comparison.against_V_rad_per_s[pair];
      with = is_wheelwise ? kWheelwise_ratio * most : keep * with + larger(0.0F, product);
      against = is_wheelwise ? 0.0F : keep * against + (grows ? larger(0.0F, -product) : 0.0F);
      std::uint8_t& confirmations = comparison.confirmations[pair];
      if (against > clear) {
        confirmations = 0;
      } else if (!is_wheelwise && product > clear && with > kMuchMore_ratio * against && confirmations < kConfirmations) {
        ++confirmations;
      }
      is_checked = is_checked && confirmations >= kConfirmations;
      if (is_contradiction && against > kMuchMore_ratio * with && against > most &&
          is_exchange_better(config, state, input, validated, i, j)) {
        most = against;
        worst[0] = i;
        worst[1] = j;
      }
    }
  }
  comparison.is_checked = is_checked && worst[0] < 0 ? 1 : 0;
  for (const int i : worst) {
    if (i >= 0) {
      state.wheel[i].speed_fault = code(Reason::wheel_speed_swapped);
    }
  }
}

}  // namespace

float yaw_rate_of_wheels(const Config& config, const Validated& validated) {
  float yaw_rate_rad_per_s = 0.0F;
  for (int i = 0; i < config.wheel_count; ++i) {
    yaw_rate_rad_per_s += config.wheel[i].inverse_yaw_per_m * rim_speed_m_per_s(config, i, validated.wheel[i].speed_rad_per_s);
  }
  return yaw_rate_rad_per_s;
}

[[gnu::cold]] void note_faults(State& state) {
  ComparisonState& comparison = state.comparison;
  if (comparison.check_sum == check_sum_of(comparison)) {
    copy_faults(state);
    seal(comparison);
  }  // else damaged: the next comparison reports it
}

[[gnu::cold]] bool recall_sensors(const ComparisonState& known, State& state) {
  if (known.check_sum != check_sum_of(known)) {
    return false;
  }
  for (int i = 0; i < kMostWheels; ++i) {
    state.wheel[i].has_current = (known.fitted >> i) & 1U;
    state.wheel[i].has_stator = (known.fitted >> (kMostWheels + i)) & 1U;
  }
  state.ambient_C = known.ambient_C;
  return true;
}

[[gnu::cold]] void recall_faults(const ComparisonState& known, State& state) {
  if (recall_sensors(known, state)) {
    state.comparison = known;
    for (int i = 0; i < kMostWheels; ++i) {
      state.wheel[i].was_implausible = 1;  // a fault since the last comparison has changed the meaning of evidence_s
      state.wheel[i].speed_fault = known.speed_fault[i];
      state.wheel[i].is_current_distrusted = known.current_error_s[i] > kStuck_s ? 1 : 0;
    }
    state.yaw_fault = known.yaw_fault;
    state.was_yaw_implausible = 1;
  }
}

void seal(ComparisonState& comparison) { comparison.check_sum = check_sum_of(comparison); }

namespace {

/// Speeds before a gap in time cannot be compared with those after it. Earlier findings stay.
[[gnu::cold, gnu::noinline]] void restart_comparisons(State& state) {
  ComparisonState& comparison = state.comparison;
  constexpr unsigned kFirst = __builtin_offsetof(ComparisonState, disagreement_s);
  constexpr unsigned kEnd = __builtin_offsetof(ComparisonState, current_error_s);
  __builtin_memset(reinterpret_cast<unsigned char*>(&comparison) + kFirst, 0, kEnd - kFirst);
  for (int i = 0; i < kMostWheels; ++i) {
    comparison.last_rad_per_s[i] = state.wheel[i].raw_speed_rad_per_s;
  }
  copy_faults(state);
  seal(state.comparison);
}

}  // namespace

void compare_sensors(const Config& config, State& state, const Input& input, Validated& validated) {
  if (validated.robot_fault == Reason::time_jump) {
    restart_comparisons(state);
    return;
  }
  // Step 0: two wheels. Step 8: the other two and the yaw rate. Step 4: all pairs.
  const std::uint32_t turn = state.steps % kStepsPerComparison;
  if (turn != 0 && turn != 4 && turn != 8) {
    return;
  }
  validated.were_sensors_compared = true;
  if (state.comparison.check_sum != check_sum_of(state.comparison)) {
    // The speed faults are also in `wheel`. Assume the worst for the rest: currents distrusted and speeds dead until they agree again.
    state.comparison = {};
    for (float& error_s : state.comparison.current_error_s) {
      error_s = kStuck_s + kSteadyAgain_s;
    }
    state.comparison.standing_s = 2.0F * kStanding_s;
    validated.robot_fault = validated.robot_fault == Reason::period_invalid ? validated.robot_fault : Reason::state_corrupted;
  }
  const float since_s = validated.elapsed_s * static_cast<float>(kStepsPerComparison);
  if (turn == 4) {
    compare_pairs(config, state, input, validated, since_s);
  } else {
    const int first = turn == 0 ? 0 : 2;
    for (int i = first; i < first + 2 && i < config.wheel_count; ++i) {
      compare_wheel(config, state, input, validated, i, since_s);
    }
    if (turn == 8) {
      compare_standing(config, state, validated, since_s);
      compare_runaway(config, state, input, validated, since_s);
      compare_yaw_rate(config, state, validated, since_s);
    }
  }
  copy_faults(state);
  seal(state.comparison);
}

}  // namespace robot_core
