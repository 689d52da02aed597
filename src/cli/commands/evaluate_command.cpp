#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/closed_loop_rank.h"
#include "cli/command.h"
#include "cli/condition_option.h"
#include "cli/default_spreads.h"
#include "cli/named_files.h"
#include "cli/quantity_option.h"
#include "cli/silent_effects.h"
#include "cli/verdict_chart.h"
#include "cli/verdict_words.h"
#include "duty/duty.h"
#include "duty/match/match_duty.h"
#include "motor/conditions.h"
#include "motor/motor.h"
#include "report/chart.h"
#include "robot/assumed_friction.h"
#include "robot/robot.h"
#include "select/evaluate.h"

namespace heatsoak::commands {
namespace {

/// From the verdict that is named on, exit 1: those behind it are worse. In the order of Verdict, without pass.
const std::vector<std::string> kFailOn{"marginal", "fail", "infeasible"};

struct Options {
  std::string robot;
  std::string duty;
  std::optional<std::string> motors;
  std::string model;
  std::string plot;
  std::map<std::string, std::string> conditions;
  EvaluateOptions evaluate;
  bool is_closed_loop = false;
  int games = 3;
  std::string guard = "shadow";
  std::string fail_on = "fail";
};

/// A file whose name has commas is one motor.
std::vector<std::string> listed_motors(const Options& options) {
  if (!options.motors) {
    return options.model.empty() ? std::vector<std::string>{"all"} : std::vector<std::string>{};
  }
  std::error_code unreadable;
  if (options.motors->find(',') == std::string::npos || std::filesystem::exists(*options.motors, unreadable)) {
    return {*options.motors};
  }
  std::vector<std::string> names = CLI::detail::split(*options.motors, ',');
  std::ranges::for_each(names, [](std::string& name) { CLI::detail::trim(name); });
  return names;
}

/// A model takes the place of the motor that its fit began with, or stands alone where no motors are named.
std::vector<Motor> read_motors(const Options& options, NamedFiles& named) {
  std::vector<std::string> names;
  for (const std::string& name : listed_motors(options)) {
    const std::vector<std::string> all = name == "all" ? ids_in(named.folders().motors) : std::vector<std::string>{name};
    names.insert(names.end(), all.begin(), all.end());
  }
  std::vector<Motor> motors;
  const std::optional<Motor> model = options.model.empty() ? std::nullopt : named.motor(options.model);
  if (model) {
    motors.push_back(under(*model, options.conditions));
  }
  std::set<std::filesystem::path> taken;
  for (const std::string& name : names) {
    const std::optional<std::filesystem::path> file = named.motor_file(name);
    const bool is_replaced = file && model && model->fit && model->fit->motor == file->stem();
    if (!file || is_replaced || !taken.insert(*file).second) {
      continue;
    }
    const auto same =
        std::ranges::find_if(taken, [&](const std::filesystem::path& other) { return other != *file && other.stem() == file->stem(); });
    if (same != taken.end()) {
      throw Failure(ExitCode::bad_input, fmt::format("{} and {} are two motors of one id, '{}'; rename one of the files", same->string(),
                                                     file->string(), file->stem().string()));
    }
    if (const std::optional<Motor> motor = named.motor(name)) {
      motors.push_back(options.model.empty() ? under(*motor, options.conditions) : *motor);
    }
  }
  return motors;
}

std::string peak_text(const Spread95& peak) {
  return std::isfinite(peak.p05) ? fmt::format("{:4.0f} [{:.0f}…{:.0f}]", peak.nominal, peak.p05, peak.p95)
                                 : fmt::format("{:4.0f}", peak.nominal);
}

std::string row(std::size_t rank, const MotorEvaluation& each) {
  const std::string probability =
      std::isfinite(each.probability_over_limit) ? fmt::format("{:.0f} %", 100.0 * each.probability_over_limit) : "–";
  return fmt::format("{:3}  {:32} {:10}  {:20} {:16} {:5.0f}  {:6.0f} {:>5}  {:>6}  {:>8} {:+6.0f} {:>6}  {:5.2f}  {}\n", rank,
                     each.motor_id, to_string(each.verdict),
                     each.limiting_factor == LimitingFactor::none ? "–" : to_string(each.limiting_factor), peak_text(each.winding_peak_C),
                     each.winding_limit_C, each.stator_peak_C.nominal,
                     each.stator_limit_C ? fmt::format("{:.0f}", *each.stator_limit_C) : "–", probability,
                     each.time_to_limit_s ? duration_text(*each.time_to_limit_s) : "–", nearest_margin_K(each),
                     each.margin_A && each.verdict != Verdict::infeasible ? fmt::format("{:+.1f}", *each.margin_A) : "–",
                     each.current_rms_A, each.data_quality);
}

/// How far the number of samples alone can be trusted.
std::string sampling_error(const std::vector<MotorEvaluation>& results) {
  double probability_ratio = 0.0;
  double p95_K = 0.0;
  for (const MotorEvaluation& each : results) {
    probability_ratio = std::max(probability_ratio, 0.5 * (each.probability_interval->high - each.probability_interval->low));
    p95_K = std::max(p95_K, 0.5 * (each.winding_p95_interval_C->high - each.winding_p95_interval_C->low));
  }
  return fmt::format(
      "other samples would give P over within ±{:.0f} points and the upper end of the peak {} (95 %)\n",
      std::ceil(100.0 * probability_ratio),
      std::isfinite(p95_K) ? fmt::format("within ±{:.0f} K at most", std::ceil(p95_K)) : "anywhere above: take more samples");
}

std::string remarks(const std::vector<MotorEvaluation>& results, const Robot& robot, const EvaluateOptions& options) {
  std::string text = options.samples > 0 && options.draws.empty() && !results.empty() ? sampling_error(results) : "";
  bool estimated = false;
  for (const MotorEvaluation& each : results) {
    estimated = estimated || each.data_quality == "estimated";
    text += why_infeasible(each, robot);
    if (each.verdict != Verdict::infeasible && each.short_probability > kMarginalProbability) {
      text += fmt::format("{}: {:.0f} % of the samples cannot deliver what is demanded ({})\n", each.motor_id,
                          100.0 * each.short_probability, to_string(each.short_limit));
    }
    if (!options.draws.empty() && each.verdict != Verdict::infeasible) {
      const Interval95& p95_C = *each.winding_p95_interval_C;
      text += fmt::format("{}: other draws of the duty would give P over {:.0f} to {:.0f} % and a 95th percentile of {:.0f} {} (95 %)\n",
                          each.motor_id, 100.0 * each.probability_interval->low, 100.0 * each.probability_interval->high, p95_C.low,
                          std::isfinite(p95_C.high) ? fmt::format("to {:.0f} °C", p95_C.high) : "°C or more: take more samples");
    }
    if (each.destroyed) {
      text += fmt::format("{}: thermal runaway, the calculation ended at 1000 °C\n", each.motor_id);
    }
  }
  if (estimated) {
    text +=
        "data \"estimated\": thermal figures that nobody publishes are estimates from similar motors; the verdict rests on them\n"
        "(`heatsoak describe MOTOR` shows how each was found). Calibrate on a bench before you rely on it.\n";
  }
  return text;
}

std::string report(const std::vector<MotorEvaluation>& results, const Robot& robot, const Duty& duty, double duration_s,
                   const Options& options) {
  std::string text =
      fmt::format("{} on {}: {}, ambient {:.0f} °C, {}\nload: {}\n", robot.id, duty.id, duration_text(duration_s), duty.ambient_C.value,
                  options.evaluate.samples > 0 ? fmt::format("{} sample{} of all declared tolerances, seed {}", options.evaluate.samples,
                                                             options.evaluate.samples == 1 ? "" : "s", options.evaluate.seed)
                                               : "nominal figures only",
                  duty.origin);
  if (!options.evaluate.draws.empty()) {
    text += fmt::format(
        "spread of the duty is included: {} draw{} of its inputs and of the robot's figures, shared by the samples; P over and verdict are "
        "of all of them\nthe first peak, reached, K left, A left and A rms are of one game, that of the seed\n",
        options.evaluate.draws.size(), options.evaluate.draws.size() == 1 ? "" : "s");
  }
  text +=
      fmt::format("\n{:3}  {:32} {:10}  {:20} {:16} {:>5}  {:>6} {:>5}  {:>6}  {:>8} {:>6} {:>6}  {:>5}  {}\n", "", "motor", "verdict",
                  "limited by", "winding peak °C", "limit", "stator", "limit", "P over", "reached", "K left", "A left", "A rms", "data");
  for (std::size_t i = 0; i < results.size(); ++i) {
    text += row(i + 1, results[i]);
  }
  return text + "\n" + remarks(results, robot, options.evaluate);
}

nlohmann::ordered_json json(const Spread95& peak) {
  return {
      {"nominal", rounded(peak.nominal, 2)}, {"p05", rounded(peak.p05, 2)}, {"p50", rounded(peak.p50, 2)}, {"p95", rounded(peak.p95, 2)}};
}

nlohmann::ordered_json json(const MotorEvaluation& each) {
  const auto optional = [](const std::optional<double>& value, int decimals) {
    return value ? rounded(*value, decimals) : nlohmann::ordered_json();
  };
  const auto interval = [](const std::optional<Interval95>& value, int decimals) {
    return value ? nlohmann::ordered_json{rounded(value->low, decimals), rounded(value->high, decimals)} : nlohmann::ordered_json();
  };
  return {{"id", each.motor_id},
          {"winding_limit_C", rounded(each.winding_limit_C, 2)},
          {"winding_peak_C", json(each.winding_peak_C)},
          {"stator_peak_C", json(each.stator_peak_C)},
          {"probability_over_limit", rounded(each.probability_over_limit, 4)},
          {"probability_ci95", interval(each.probability_interval, 4)},
          {"winding_p95_ci95_C", interval(each.winding_p95_interval_C, 2)},
          {"time_to_limit_s", optional(each.time_to_limit_s, 3)},
          {"current_rms_A", rounded(each.current_rms_A, 4)},
          {"verdict", to_string(each.verdict)},
          {"limiting_factor", to_string(each.limiting_factor)},
          {"data_quality", each.data_quality},
          {"wheel", each.wheel},
          {"margin_K", rounded(each.margin_K, 2)},
          {"stator_margin_K", optional(each.stator_margin_K, 2)},
          {"margin_A", optional(each.margin_A, 4)},
          {"stator_limit_C", optional(each.stator_limit_C, 2)},
          {"delivered_share", rounded(each.least_torque_share, 4)},
          {"short_time_share", rounded(each.short_time_share, 4)},
          {"short_probability", rounded(each.short_probability, 4)},
          {"voltage_needed_V", rounded(each.highest_voltage_V, 3)},
          {"runaway", each.destroyed}};
}

ExitCode run(Options& options, Session& session) {
  NamedFiles named(session.folders());
  const std::optional<Robot> robot_read = named.robot(options.robot);
  const std::optional<Duty> duty_read = named.duty(options.duty);
  const std::vector<Motor> motors = read_motors(options, named);
  named.throw_if_any();
  const Duty& duty = *duty_read;
  if (motors.empty()) {
    throw Failure(ExitCode::bad_input, fmt::format("there is no motor file in {}", named.folders().motors.string()));
  }
  const auto match = std::dynamic_pointer_cast<const MatchDuty>(duty.shape_data);
  const Robot robot = match ? with_assumed_friction(*robot_read) : *robot_read;
  if (options.is_closed_loop && !match) {
    throw Failure(ExitCode::bad_input, fmt::format("--closed-loop drives matches; {} is {}. Expected a duty of the shape match, or no "
                                                   "--closed-loop",
                                                   duty.id, duty.shape));
  }
  if (!options.is_closed_loop && options.guard != Options{}.guard) {
    throw Failure(ExitCode::bad_input, "--guard is for --closed-loop; expected both or none");
  }
  options.evaluate.with_curves = !options.plot.empty();
  const std::vector<WheelDemand> wheels = duty.demand(robot, options.evaluate.seed);
  const std::vector<WheelDemand> draws = draw_demands(duty, robot, options.evaluate.seed, draw_count(duty, options.evaluate.samples),
                                                      options.evaluate.threads, progress_bar(fmt::format("playing draws of {}", duty.id)));
  options.evaluate.draws = draws;
  std::vector<MotorEvaluation> results = evaluate(robot, duty, wheels, motors, options.evaluate, progress_bar("evaluating"));
  std::vector<ClosedLoopRank> ranks;
  if (options.is_closed_loop) {
    const GameDriveOptions drive{
        options.games, options.evaluate.seed,   duty.ambient_C.value, options.guard == "off" ? GuardUse::off : GuardUse::shadow,
        false,         options.evaluate.threads};
    ranks = rank_closed_loop(drive_games(robot, match->inputs(), motors, drive, progress_bar("driving games")), results);
  }
  if (!options.plot.empty()) {
    session.write(options.plot, draw_svg(verdict_chart(results, robot, duty)));
  }
  session.say(report(results, robot, duty, wheels.front().duration_s(), options) + slip_text(wheels.front()) + silent_effects(motors) +
              default_spreads_text(motors) + assumed_friction_text(robot));
  if (options.is_closed_loop) {
    session.say(closed_loop_text(ranks, options.games, options.evaluate.seed));
  }
  if (!options.plot.empty()) {
    session.say(fmt::format("picture: {}\n", options.plot));
  }
  nlohmann::ordered_json answer{{"schema", "heatsoak.evaluate/1"},     {"robot", robot.id},
                                {"conditions", options.conditions},    {"duty", duty.id},
                                {"duty_origin", duty.origin},          {"seed", options.evaluate.seed},
                                {"samples", options.evaluate.samples}, {"duty_draws", draws.size()}};
  answer["default_spreads"] = default_spreads_json(motors);
  answer["is_friction_assumed"] = robot.is_friction_assumed;
  const Verdict least_bad = static_cast<Verdict>(std::ranges::find(kFailOn, options.fail_on) - kFailOn.begin() + 1);
  bool exceeded = false;
  answer["motors"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < results.size(); ++i) {
    answer["motors"].push_back(json(results[i]));
    Verdict verdict = results[i].verdict;
    if (options.is_closed_loop) {
      answer["motors"].back()["closed_loop"] = closed_loop_json(ranks[i], options.evaluate.seed);
      verdict = ranks[i].verdict;
    }
    exceeded = exceeded || verdict >= least_bad;
  }
  session.answer(answer);
  return exceeded ? ExitCode::limit_exceeded : ExitCode::done;
}

}  // namespace

Command evaluate_command() {
  return {
      .name = {},
      .summary = "Ranks motors on one duty of one robot: peak temperatures with uncertainty, what limits each; exit 1 if one of them fails",
      .example =
          "heatsoak evaluate --robot roboteam_twente_v2024 --duty paper_intermittent --motors "
          "maxon_ecx_flat_32l_48v,maxon_ecx_flat_42m_24v,nanotec_df45l024048_a2 --plot verdict.svg",
      .declare = [](CLI::App& app, Session& session) -> std::function<ExitCode()> {
        const auto options = std::make_shared<Options>();
        app.add_option("--robot", options->robot, "id (see `heatsoak list robots`) or file")->required()->type_name("R");
        app.add_option("--duty", options->duty, "id (see `heatsoak list duties`) or file")->required()->type_name("D");
        app.add_option("--motors", options->motors, "ids or files separated by commas, or all")->type_name("M,M")->default_str("all");
        app.add_option("--model", options->model,
                       "a calibrated motor (`heatsoak calibrate --out FILE`) in place of the one it was fitted from")
            ->type_name("FILE.toml");
        add_conditions(app, options->conditions);
        app.add_option("--samples", options->evaluate.samples, "draws of every declared tolerance and range; 0: nominal only")
            ->check(whole_number(1'000'000))
            ->capture_default_str();
        app.add_flag("--closed-loop", options->is_closed_loop,
                     "on a match: the drive core drives games with each motor, with slip, battery sag and real sensing; ranks by them, and "
                     "exit 1 follows them");
        app.add_option("--guard", options->guard,
                       "of --closed-loop: shadow counts for how long the motor's thermal guard would have limited it; off leaves that out, "
                       "which saves some seconds per motor")
            ->check(CLI::IsMember({"off", "shadow"}))
            ->type_name("G")
            ->capture_default_str();
        app.add_option("--games", options->games, "of --closed-loop, with successive seeds")
            ->check(CLI::Range(1, 1000))
            ->capture_default_str();
        app.add_option("--fail-on", options->fail_on, "exit 1 if a motor's verdict is this or worse: marginal, fail, infeasible")
            ->check(CLI::IsMember(kFailOn))
            ->type_name("VERDICT")
            ->capture_default_str();
        add_seed(app, options->evaluate.seed, "of the draws and games; same seed, same bytes");
        app.add_option("--threads", options->evaluate.threads, "0: all cores; the result does not depend on it")
            ->check(whole_number(1024))
            ->capture_default_str();
        add_picture(app, options->plot, "picture of stator and winding temperature over time");
        session.add_data_option(app);
        session.add_json_option(app);
        return [options, &session] { return run(*options, session); };
      }};
}

}  // namespace heatsoak::commands
