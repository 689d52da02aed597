#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/diagnostic.h"
#include "duty/duty.h"
#include "guard_study.h"
#include "support/source_folder.h"

namespace heatsoak::simulate::studies {
namespace {

struct HarderInput {
  const char* key;
  double value;
  const char* remark;
};
constexpr const char* kEnd = "end of the declared range";
constexpr HarderInput kHarder[] = {
    {"running_mean", 30.0, kEnd},
    {"stop_mean", 2.0, kEnd},
    {"placement_mean", 5.0, kEnd},
    {"halt_count", 0.5, kEnd},
    {"timeout_count", 0.5, kEnd},
    {"retarget_mean", 0.3, kEnd},
    {"distance_median", 2.5, kEnd},
    {"duels_per_min", 6.0, kEnd},
    {"duel_mean", 4.0, "end of the declared range; longer than referees usually let pushing go on"},
    {"duel_push_share", 1.0, kEnd},
};

struct HarderParameter {
  const char* name;
  const char* unit;
  std::optional<double>& (*value)(robot::Robot&);
  double hard;
  double per_unit;  ///< displayed unit per SI unit
  const char* remark;
};
constexpr HarderParameter kHarderParameters[] = {
    {"acceleration limit", "m/s²", [](robot::Robot& robot) -> auto& {return robot.limits.acceleration_m_per_s2;
}  // namespace
, 3.0, 1.0, "harsher than the team's own limit; the braking that TIGERs saw of the robot"
}  // namespace heatsoak::simulate::studies
, {"braking limit", "m/s²", [](robot::Robot& robot) -> auto& {return robot.limits.braking_m_per_s2;
}
, 3.0, 1.0, kEnd
}
, {"jerk limit", "m/s³", [](robot::Robot& robot) -> auto& {return robot.limits.jerk_m_per_s3;
}
, 20.0, 1.0, "harsher than the team's own limit"
}
, {"coefficient of traction", "", [](robot::Robot& robot) -> auto& {return robot.traction.coefficient_ratio;
}
, 1.0, 1.0, kEnd
}
, {"constant friction of a wheel", "mN m", [](robot::Robot& robot) -> auto& {return robot.friction.heading.constant_Nm;
}
, 0.038, 1e3, kEnd
}
,
}
;

}  // namespace

HardMatch make_hard_match(const robot::Robot& robot, double share) {
  constexpr double kHardAmbient_C = 40.0;
  const duty::Duty duty = duty::read_duty(kSource / "duty_profiles" / "division_a_match.toml");
  HardMatch match{robot,
                  std::dynamic_pointer_cast<const duty::MatchDuty>(duty.shape_data)->inputs(),
                  std::lerp(duty.ambient_C.value, kHardAmbient_C, share),
                  {}};
  match.changed.push_back({"air at the motors", fmt::format("{:.0f} °C", duty.ambient_C.value), fmt::format("{:.3g} °C", match.ambient_C),
                           "harsher than the declared 20 to 32 °C of a hall: 8 K more inside of a closed robot"});
  const auto specs = duty::match_input_specs();
  for (const HarderInput& harder : kHarder) {
    const auto spec = std::ranges::find_if(specs, [&](const duty::MatchInputSpec& each) { return each.spec.key == harder.key; });
    if (spec == specs.end()) {
      throw base::Failure(base::ExitCode::bug, fmt::format("a match has no input {}", harder.key));
    }
    base::ParameterValue& parameter = match.inputs.parameters.at(static_cast<std::size_t>(spec - specs.begin()));
    const std::string unit(spec->spec.unit);
    const double value = std::lerp(parameter.value, harder.value, share);
    match.changed.push_back(
        {harder.key, fmt::format("{:.3g} {}", parameter.value, unit), fmt::format("{:.3g} {}", value, unit), harder.remark});
    parameter.value = value;
  }
  for (const HarderParameter& harder : kHarderParameters) {
    double& value = harder.value(match.robot).value();
    const double changed = std::lerp(value, harder.hard, share);
    match.changed.push_back({harder.name, fmt::format("{:.3g} {}", value * harder.per_unit, harder.unit),
                             fmt::format("{:.3g} {}", changed * harder.per_unit, harder.unit), harder.remark});
    value = changed;
  }
  return match;
}

motor::Motor bench_tested(const motor::Motor& motor) {
  struct Tolerance {
    const char* key;
    double share;
  };
  constexpr Tolerance kTolerances[] = {{"thermal_resistance_winding_stator", 0.05},
                                       {"thermal_resistance_stator_ambient", 0.05},
                                       {"thermal_time_constant_winding", 0.1},
                                       {"thermal_time_constant_stator", 0.1},
                                       {"terminal_resistance", 0.02},
                                       {"torque_constant", 0.02},
                                       {"speed_constant", 0.02},
                                       {"no_load_current", 0.2}};
  motor::Motor tested = motor;
  for (const Tolerance& each : kTolerances) {
    base::ParameterValue* const parameter = motor::find_parameter(tested, each.key);
    if (parameter == nullptr) {
      throw base::Failure(base::ExitCode::bug, fmt::format("the motor has no {}", each.key));
    }
    // Tolerances this narrow would be replaced by the default for an estimate.
    parameter->origin = base::Origin::measured;
    parameter->spread = base::Spread{
        .kind = base::Spread::Kind::range, .low = parameter->value * (1.0 - each.share), .high = parameter->value * (1.0 + each.share)};
  }
  return tested;
}

Hardship drive_hard(const HardMatch& match, const Game& game, const Way& way, const motor::Motor& motor, std::uint64_t seed,
                    bool with_seconds) {
  robot::Robot known = match.robot;
  if (!std::isnan(way.cap_A)) {
    known.drive.current_limit_A = way.cap_A;
  }
  const MotorGuard none;
  const GuardedCore core(known, *way.motor, way.guard != nullptr ? GuardUse::on : GuardUse::off, way.guard != nullptr ? *way.guard : none);
  return drive_hard(match, game, core.config(), way.has_sensors, motor, seed, with_seconds);
}

Hardship drive_hard(const HardMatch& match, const Game& game, const robot_core::Config& core, bool has_sensors, const motor::Motor& motor,
                    std::uint64_t seed, bool with_seconds) {
  MatchRunOptions options;
  options.ambient_C = match.ambient_C;
  options.drive = sensed_drive(match.robot, seed, has_sensors);
  options.drive.sensing.has_ambient = has_sensors;
  Hardship hardship;
  Second open{.allowed_A = std::numeric_limits<double>::infinity()};
  double distance_m = 0.0;
  hardship.score = run_match(game, match.robot, motor, core, options, [&](const LoopMoment& moment) {
                     const robot::Pose plan = moment.plan->pose();
                     const robot::PlantState& state = moment.robot->state();
                     const double off_m = std::hypot(plan.x_m - state.pose.x_m, plan.y_m - state.pose.y_m);
                     hardship.off_plan_s += off_m > kOffPlan_m ? SimulatedRobot::kPeriod_s : 0.0;
                     distance_m += std::hypot(state.velocity.x_m_per_s, state.velocity.y_m_per_s) * SimulatedRobot::kPeriod_s;
                     if (!with_seconds) {
                       return;
                     }
                     open.off_plan_m = std::max(open.off_plan_m, off_m);
                     for (int i = 0; i < moment.robot->wheel_count(); ++i) {
                       const robot_core::Output& out = moment.drive->output();
                       open.winding_C = std::max(open.winding_C, moment.robot->winding_C(i));
                       open.observer_C = std::max(open.observer_C, static_cast<double>(out.winding_C[i]));
                       open.allowed_A = std::min(open.allowed_A, static_cast<double>(out.allowed_current_A[i]));
                     }
                     if (moment.time_s >= static_cast<double>(hardship.seconds.size() + 1)) {
                       open.time_s = moment.time_s;
                       open.distance_m = distance_m;
                       hardship.seconds.push_back(open);
                       open = {.allowed_A = std::numeric_limits<double>::infinity()};
                     }
                   }).score;
  return hardship;
}

std::vector<motor::Motor> drawn_motors(const motor::Motor& motor, std::size_t count) {
  constexpr std::uint64_t kSeed = 20250;
  std::vector<motor::Motor> motors(count, motor);
  for (std::size_t i = 0; i < count; ++i) {
    base::Random random(kSeed, i);
    motors[i].nominal = motor::draw_sample(motor, random).values;
  }
  return motors;
}

std::vector<motor::Motor> representative_motors(const motor::Motor& motor, std::size_t count) {
  constexpr std::size_t kDrawn = 1000;
  std::vector<motor::Motor> drawn = drawn_motors(motor, kDrawn);
  std::ranges::sort(drawn, {}, [](const motor::Motor& each) {
    const motor::MotorValues& values = each.nominal;
    return (values.thermal_resistance_winding_stator_K_per_W + values.thermal_resistance_stator_ambient_K_per_W) *
           values.terminal_resistance_ohm / std::pow(values.torque_constant_Nm_per_A, 2);
  });
  std::vector<motor::Motor> motors;
  for (std::size_t i = 0; i < count; ++i) {
    motors.push_back(drawn[(2 * i + 1) * kDrawn / (2 * count)]);
  }
  return motors;
}

double largest_cap_A(const HardMatch& match, const Game& game, const motor::Motor& core_motor, const motor::Motor& motor,
                     std::uint64_t seed) {
  double low_A = 0.5;
  double high_A = 12.0;
  while (high_A - low_A > 0.05) {
    const double tried_A = 0.5 * (low_A + high_A);
    const Way way{.name = {}, .motor = &core_motor, .cap_A = tried_A};
    const bool is_cool = drive_hard(match, game, way, motor, seed, false).score.winding_peak_C <= motor.nominal.winding_limit_C;
    (is_cool ? low_A : high_A) = tried_A;
  }
  return low_A;
}

}  // namespace heatsoak::simulate::studies
