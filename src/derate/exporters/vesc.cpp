// LispBM script for VESC controllers. Names and law: vedderb/bldc at b9d287b3b8323f4b02618b02dc55e57d54a84996, lispBM/README.md
// (override-temp-motor, conf-set, get-current, get-rpm), motor/mc_interface.c (update_override_limits), motor/mcpwm_foc.c (the current
// limits hold for the vector of i_d and i_q), motor/mcconf_default.h, datatypes.h (mc_motor_type).
#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <set>
#include <string>
#include <string_view>

#include "base/diagnostic.h"
#include "derate/export_text.h"
#include "derate/exporter.h"
#include "derate/rate_lines.h"

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

/// Names of the function's inputs.
std::string signal_name(observed::Signal signal) {
  return signal == observed::current ? "hs-current-A" : signal == observed::speed ? "hs-speed-rad-per-s" : "hs-ambient-C";
}

std::string state_name(const Observer& observer, std::size_t node, std::string_view what) {
  return lisp_name("hs-", fmt::format("{}_{}", identifier(observer.state_names()[node]), what));
}

/// Throws Failure (bad_input) if two nodes have the same name in the script, where each character other than a letter or digit is "-".
void require_different_names(const Observer& observer) {
  std::set<std::string> names;
  for (std::size_t node = 0; node < observer.state_count(); ++node) {
    if (!names.insert(state_name(observer, node, "C")).second) {
      throw base::Failure(base::ExitCode::bad_input,
                          fmt::format("vesc: two nodes have the name {} in the script; rename one", state_name(observer, node, "C")));
    }
  }
}

/// One Euler step over `dt` seconds. The rounding of each step is carried to the next (Kahan 1965).
std::string step_function(const Observer& observer) {
  LineStyle style{.literal = literal, .signal = signal_name, .square_root = "sqrt", .exponential = "exp", .power = "pow"};
  style.notation = Notation::lisp;
  style.prefix = "hs-";
  style.reserved = {"current_A", "speed_rad_per_s", "ambient_C", "may_drive", "last_A", "longest_s"};
  for (const std::string& node : observer.state_names()) {
    for (const std::string_view what : {"C", "carry_K", "change_K", "next_C", "rate_K_per_s"}) {
      style.reserved.insert(fmt::format("{}_{}", identifier(node), what));
    }
  }
  std::string text =
      "(defun hs-step (hs-current-A hs-speed-rad-per-s hs-ambient-C dt-s) {\n" + RateLines(observer, observer.rate_steps(), style).text();
  for (std::size_t node = 0; node < observer.state_count(); ++node) {
    text += fmt::format("  (var {} (- (* dt-s {}) {}))\n", state_name(observer, node, "change_K"),
                        state_name(observer, node, "rate_K_per_s"), state_name(observer, node, "carry_K"));
  }
  for (std::size_t node = 0; node < observer.state_count(); ++node) {
    text += fmt::format(
        "  (var {3} (+ {0} {2}))\n"
        "  (setq {1} (- (- {3} {0}) {2}))\n"
        "  (setq {0} {3})\n",
        state_name(observer, node, "C"), state_name(observer, node, "carry_K"), state_name(observer, node, "change_K"),
        state_name(observer, node, "next_C"));
  }
  return text + fmt::format("  {}\n}})\n", state_name(observer, 0, "C"));
}

std::string states(const Derating& derating) {
  std::string text;
  for (std::size_t node = 0; node < derating.observer.state_count(); ++node) {
    text += fmt::format("(define {} hs-start-C)\n(define {} 0.0)  ; rounding error of the last step\n",
                        state_name(derating.observer, node, "C"), state_name(derating.observer, node, "carry_K"));
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
  require_different_names(derating.observer);
  const double dc_per_phase_ratio = derating.is_brushless ? kDcPerIq_ratio : 1.0;
  const MotorType& type = derating.is_brushless ? kFoc : kDc;
  return provenance_lines(derating, ";") + ramp_lines(derating, RampSignal::winding, ramp, 1.0 / dc_per_phase_ratio, ";") +
         moved_ramp_lines(derating, ramp, 1.0 / dc_per_phase_ratio) + setting_lines(type) + law_lines(derating, ";") +
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
