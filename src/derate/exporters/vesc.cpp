// LispBM script for VESC controllers. Names and law: vedderb/bldc at b9d287b3b8323f4b02618b02dc55e57d54a84996, lispBM/README.md
// (override-temp-motor, conf-set, get-current, get-rpm), motor/mc_interface.c (update_override_limits), motor/mcpwm_foc.c (the current
// limits hold for the vector of i_d and i_q), motor/mcconf_default.h, datatypes.h (mc_motor_type).
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <string>

#include "derate/export_text.h"
#include "derate/exporter.h"
#include "derate/step_names.h"

namespace heatsoak::derate::exporters {
namespace {

/// VESC gives the full current up to this far beyond the start of its ramp.
constexpr double kFullBeyond_K = 0.1;

/// While driving, VESC moves both ends of its ramp by the share l-temp-accel-dec towards this temperature, so that a hot motor can still
/// brake. The share is 0.15 by default (MCCONF_L_LIM_TEMP_ACCEL_DEC); the script sets it to 0.
constexpr double kMovedTowards_C = 25.0;
constexpr double kDefaultMoved_share = 0.15;

/// A LispBM float, the shortest decimal that reads back to it. A number without a point would be an integer.
std::string literal(double value) {
  std::string text = fmt::format("{}", static_cast<float>(value));
  const std::size_t exponent = text.find('e');
  return text.find('.') != std::string::npos ? text : text.insert(std::min(exponent, text.size()), ".0");
}

/// Names of the steps by their index. Constants and inputs have none, because they stand where they are used.
using Names = std::map<int, std::string>;

std::string operand(const thermal::Formula& formula, const Names& names, int place) {
  const thermal::Formula::Step& step = formula.steps()[static_cast<std::size_t>(place)];
  if (step.operation == thermal::Operation::constant) {
    return literal(step.value);
  }
  if (step.operation != thermal::Operation::input) {
    return names.at(place);
  }
  const auto input = static_cast<std::size_t>(step.left);
  return input < observed::kSignalCount ? std::string("hs-") + (input == observed::current ? "current-A"
                                                                : input == observed::speed ? "speed-rad-per-s"
                                                                                           : "ambient-C")
                                        : fmt::format("hs-state{}-C", input - observed::kSignalCount);
}

std::string expression(const thermal::Formula& formula, const Names& names, const thermal::Formula::Step& step) {
  const std::string left = operand(formula, names, step.left);
  const std::string right = step.right ? operand(formula, names, *step.right) : "";
  switch (step.operation) {
    case thermal::Operation::add:
      return fmt::format("(+ {} {})", left, right);
    case thermal::Operation::subtract:
      return fmt::format("(- {} {})", left, right);
    case thermal::Operation::multiply:
      return fmt::format("(* {} {})", left, right);
    case thermal::Operation::divide:
      return fmt::format("(/ {} {})", left, right);
    case thermal::Operation::magnitude:
      return fmt::format("(if (< {0} 0.0) (- 0.0 {0}) {0})", left);
    case thermal::Operation::positive_part:
      return fmt::format("(if (> {0} 0.0) {0} 0.0)", left);
    case thermal::Operation::square_root:
      return fmt::format("(sqrt {})", left);
    case thermal::Operation::power:
      return fmt::format("(pow {} {})", left, right);
    default:
      return fmt::format("(exp {})", left);
  }
}

/// One Euler step over `dt` seconds. The rounding of each step is carried to the next (Kahan 1965).
std::string step_function(const Observer& observer) {
  const thermal::Formula& formula = observer.formula();
  const std::vector<char> needed = formula.needed_for(observer.rate_steps());
  StepNames unique(observer, {"current_A", "speed_rad_per_s", "ambient_C", "may_drive", "last_A", "longest_s"});
  Names names;
  std::string text = "(defun hs-step (hs-current-A hs-speed-rad-per-s hs-ambient-C dt-s) {\n";
  for (std::size_t i = 0; i < needed.size(); ++i) {
    const thermal::Formula::Step& step = formula.steps()[i];
    if (needed[i] != 0 && step.operation != thermal::Operation::constant && step.operation != thermal::Operation::input) {
      std::string name = "hs-" + unique.name_for(static_cast<int>(i));
      std::ranges::replace(name, '_', '-');
      text += fmt::format("  (var {} {})\n", name, expression(formula, names, step));
      names.emplace(static_cast<int>(i), std::move(name));
    }
  }
  for (std::size_t node = 0; node < observer.state_count(); ++node) {
    text += fmt::format("  (var change{0}-K (- (* dt-s {1}) hs-carry{0}-K))\n", node, operand(formula, names, observer.rate_steps()[node]));
  }
  for (std::size_t node = 0; node < observer.state_count(); ++node) {
    text += fmt::format(
        "  (var next{0}-C (+ hs-state{0}-C change{0}-K))\n"
        "  (setq hs-carry{0}-K (- (- next{0}-C hs-state{0}-C) change{0}-K))\n"
        "  (setq hs-state{0}-C next{0}-C)\n",
        node);
  }
  return text + "  hs-state0-C\n})\n";
}

std::string states(const Derating& derating) {
  std::string text;
  for (std::size_t node = 0; node < derating.observer.state_count(); ++node) {
    text +=
        fmt::format("(define hs-state{0}-C hs-start-C)  ; {1}\n(define hs-carry{0}-K 0.0)\n", node, derating.observer.state_names()[node]);
  }
  return text;
}

/// The controller measures another current with another motor type, so the limits hold only for one.
struct MotorType {
  std::string_view name;
  int place = 0;  ///< in mc_motor_type
};
constexpr MotorType kDc{"DC", 1};
constexpr MotorType kFoc{"FOC", 2};

/// VESC never limits below this current (MCCONF_CC_MIN_CURRENT), and scripts cannot set it.
constexpr double kLeastLimit_A = 0.05;

std::string limits(const CurrentRamp& ramp, double phase_per_dc_ratio, const MotorType& type) {
  const double most_A = rounded_down_A(ramp.most_current_A * phase_per_dc_ratio);
  return fmt::format(
      "(define hs-may-drive (= (conf-get 'motor-type) {3}.0))  ; {4}\n"
      "(conf-set 'l-current-max (if hs-may-drive {0:.3f} 0.0))\n"
      "(conf-set 'l-current-min (if hs-may-drive -{0:.3f} 0.0))\n"
      "(conf-set 'l-current-max-scale 1.0)\n"
      "(conf-set 'l-current-min-scale 1.0)\n"
      "(conf-set 'l-temp-motor-start {1:.1f})\n"
      "(conf-set 'l-temp-motor-end {2:.1f})\n"
      "(conf-set 'l-temp-accel-dec 0.0)\n",
      most_A, ramp.start_C, ramp.end_C, type.place, type.name);
}

/// Comment lines about settings of the controller that change the limit and are not in the script's reach.
std::string setting_lines(const MotorType& type) {
  return fmt::format(
      "; Settings of the controller (VESC Tool): motor type {0}; with another one the script sets the current limits to 0 A.\n"
      "; cc_min_current: the controller never limits below it; keep it at the default of {1} A or less. foc_temp_comp: off, because\n"
      "; it would take the pessimistic temperature for the real one. Until the script has started, the stored current limits apply at\n"
      "; any temperature: send no command before, and store no higher limits than those below.\n",
      type.name, kLeastLimit_A);
}

/// Comment lines about the setting l-temp-accel-dec and the cost of its default. The default is safe, but loses more than ramp_lines()
/// states.
std::string moved_ramp_lines(const Derating& derating, const CurrentRamp& ramp, double phase_per_dc_ratio) {
  const auto moved = [](double place_C) { return place_C + kDefaultMoved_share * (kMovedTowards_C - place_C); };
  CurrentRamp driving = ramp;
  driving.start_C = moved(ramp.start_C);
  driving.end_C = moved(ramp.end_C);
  const RampLoss loss = ramp_loss(derating, RampSignal::winding, driving);
  return fmt::format(
      "; The script sets l-temp-accel-dec to 0, for the MOSFET temperature too. A larger value moves both ramps towards {0:.0f} degC "
      "while\n"
      "; driving: with the controller's default of {1:.2f} this one would run from {2:.1f} to {3:.1f} degC and lose {4:.2f} A ({5:.1f} %) "
      "on\n"
      "; average. Writing another motor configuration, or a second script, undoes these settings until the script starts again.\n",
      kMovedTowards_C, kDefaultMoved_share, driving.start_C, driving.end_C, phase_per_dc_ratio * loss.mean_A(), loss.mean_percent());
}

/// A script that was held up integrates the time in steps of this share of the winding's time constant.
constexpr double kStepsPerTimeConstant = 20.0;

/// The observer runs in the script, the ramp in the controller: the script overrides the controller's motor temperature.
std::string write_vesc(const Derating& derating) {
  const CurrentRamp ramp = ramp_for("vesc", derating, RampSignal::winding, kFullBeyond_K);
  require_three_signals("vesc", derating);
  const double dc_per_phase_ratio = derating.is_brushless ? kDcPerIq_ratio : 1.0;
  const MotorType& type = derating.is_brushless ? kFoc : kDc;
  return provenance_lines(derating, ";") + ramp_lines(derating, RampSignal::winding, ramp, 1.0 / dc_per_phase_ratio, ";") +
         moved_ramp_lines(derating, ramp, 1.0 / dc_per_phase_ratio) + setting_lines(type) +
         fmt::format(
             "; Currents are {}. Set the motor temperature sensor to Disabled, or the override has no effect; set the motor's poles.\n"
             "; The motor temperature that the controller shows is the pessimistic winding temperature. The script samples the current "
             "every\n"
             "; {:.6g} s and takes the larger of two samples: peaks between them are not seen. If the script stops, the last temperature "
             "stays.\n"
             "; hs-start-C: temperature of the motor after a long rest; otherwise its limit, so that the motor stays off until it has "
             "cooled.\n",
             derating.is_brushless ? "peak phase currents (i_q)" : "motor currents", derating.options.period_s) +
         fmt::format("(define hs-start-C {})\n", literal(derating.rules.limits.winding_C)) + states(derating) +
         limits(ramp, 1.0 / dc_per_phase_ratio, type) + step_function(derating.observer) +
         fmt::format(
             "(define hs-pole-pairs (/ (conf-get 'si-motor-poles) 2.0))\n"
             "(define hs-last-A 0.0)\n"
             "(define hs-time (systime))\n"
             "(define hs-longest-s {})\n"
             "(defun hs-advance (current-A speed-rad-per-s left-s)\n"
             "  (if (> left-s hs-longest-s) {{\n"
             "    (hs-step current-A speed-rad-per-s {} hs-longest-s)\n"
             "    (hs-advance current-A speed-rad-per-s (- left-s hs-longest-s))\n"
             "  }}\n"
             "  (hs-step current-A speed-rad-per-s {} left-s)))\n"
             "(defun hs-magnitude (x) (if (< x 0.0) (- 0.0 x) x))\n"
             "(defun hs-cycle () {{\n"
             "  (var now-A (* {} (get-current)))\n"
             "  (var more-A (if (< (hs-magnitude now-A) (hs-magnitude hs-last-A)) hs-last-A now-A))\n"
             "  (setq hs-last-A now-A)\n"
             "  (var dt-s (secs-since hs-time))\n"
             "  (setq hs-time (systime))\n"
             "  (var speed-rad-per-s (hs-magnitude (/ (* (get-rpm) {}) hs-pole-pairs)))\n"
             "  (override-temp-motor (hs-advance more-A speed-rad-per-s dt-s))\n"
             "}})\n"
             "(loopwhile t {{\n"
             "  (hs-cycle)\n"
             "  (sleep {})\n"
             "}})\n",
             literal(derating.nominal.thermal_time_constant_winding_s / kStepsPerTimeConstant), literal(derating.rules.hottest_ambient_C),
             literal(derating.rules.hottest_ambient_C), literal(dc_per_phase_ratio), literal(std::numbers::pi / 30.0),
             literal(derating.options.period_s));
}

}  // namespace

ExporterType vesc() {
  return {.name = {},
          .summary = "LispBM script for VESC: limits, and the observer's winding temperature in place of the motor's sensor",
          .write = write_vesc};
}

}  // namespace heatsoak::derate::exporters
