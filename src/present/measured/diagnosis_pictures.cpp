#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "attribution/scan_term.h"
#include "base/confidence.h"
#include "estimation/interval.h"
#include "present/measured/diagnosis_output.h"
#include "present/measured/diagnosis_words.h"
#include "present/measured/run_words.h"

namespace heatsoak::present {
namespace {

constexpr double kGap = std::numeric_limits<double>::quiet_NaN();

/// Places runs one after the other on the time axis, with a gap between them.
struct Axis {
  double begin_min = 0.0;
  void put(const estimation::MeasuredRun& run, std::vector<double>& x) const {
    for (const double time_s : run.time_s) {
      x.push_back(begin_min + (time_s - run.time_s.front()) / 60.0);
    }
    x.push_back(x.back());
  }
};

/// Lists the runs in the order in which they are drawn.
std::string listed(const std::vector<std::string>& runs) {
  constexpr std::size_t kMost = 6;
  constexpr std::size_t kMostLetters = 40;  // titles of panels are one line
  std::string names = runs.size() > kMost ? fmt::format("{} runs, {} to {}", runs.size(), runs.front(), runs.back())
                                          : fmt::format("{}", fmt::join(runs, ", "));
  return names.size() <= kMostLetters ? names : fmt::format("{} run{}", runs.size(), runs.size() == 1 ? "" : "s");
}

/// The two models whose residuals are compared.
struct Compared {
  const estimation::Model& before;
  const estimation::Model& after;
};

/// Adds the residuals of the runs that have the signal to the panel, and their names to its title. `earlier`: runs before the hold-out
/// runs, whose end may be the start of these; empty for training runs.
void add_residuals(const std::string& signal, const Compared& models, const std::vector<estimation::MeasuredRun>& runs,
                   const std::vector<estimation::MeasuredRun>& earlier, Axis& axis, report::ChartPanel& panel) {
  const bool is_held_out = !earlier.empty();
  const std::string suffix = is_held_out ? ", hold-out" : "";
  report::ChartCurve old{"before" + suffix, {}, {}, 1, is_held_out}, now{"after" + suffix, {}, {}, 0, is_held_out};
  std::vector<std::string> names;
  for (const estimation::MeasuredRun& run : runs) {
    const auto found = std::ranges::find(run.sensors, signal, &estimation::Sensor::signal);
    if (found == run.sensors.end()) {
      continue;
    }
    names.push_back(run.name);
    const Eigen::Index sensor = found - run.sensors.begin();
    for (const auto& [curve, model] : {std::pair(&old, &models.before), std::pair(&now, &models.after)}) {
      const Eigen::VectorXd off_K = run.measured_C.col(sensor) - estimation::open_loop_C(*model, run, earlier).col(sensor);
      curve->y.insert(curve->y.end(), off_K.begin(), off_K.end());
      curve->y.push_back(kGap);
      axis.put(run, curve->x);
    }
    axis.begin_min = now.x.back() + 0.5;
  }
  if (!names.empty()) {
    panel.title += fmt::format("{} {}", is_held_out ? "; hold-out" : ": training", listed(names));
    panel.curves.push_back(std::move(old));
    panel.curves.push_back(std::move(now));
  }
}

DiagnosisPicture residuals(const diagnosis::Diagnosis& diagnosis, const diagnosis::DiagnosisInput& input,
                           const diagnosis::HoldoutScore& score) {
  report::Chart chart{
      fmt::format("Residual in K: {}", verdict_words(diagnosis)),
      "before and after the diagnosis, runs one behind the other; the model runs freely from the first measured temperatures",
      "time / min",
      {}};
  const Compared models{input.model, diagnosis.selection.after.model};
  for (const auto& [signal, error] : diagnosis.before_train) {
    report::ChartPanel panel{part_of(signal), "measured − model / K", {}, {}, {}};
    Axis axis;
    add_residuals(signal, models, input.train, {}, axis, panel);
    add_residuals(signal, models, score.runs, input.train, axis, panel);
    chart.panels.push_back(std::move(panel));
  }
  chart.panel_height_px = 260;
  return {"residual_K", chart};
}

DiagnosisPicture unknown_heat(const diagnosis::Diagnosis& diagnosis) {
  report::Chart chart{
      fmt::format("Unknown heat in W: {}", verdict_words(diagnosis)),
      fmt::format("heat flux into the node that explains the measured temperatures, before and after the diagnosis; band: {} after, "
                  "given the model",
                  base::level_text(base::kInterval_share)),
      "time / min",
      {}};
  for (const auto& [node, rms_W] : diagnosis.flux_rms_after_W) {
    report::ChartPanel panel{"into the " + node, "heat / W", {}, {}, {}};
    report::ChartCurve old{"before", {}, {}, 1, false}, now{"after", {}, {}, 0, false};
    report::ChartBand band{base::level_text(base::kInterval_share), {}, {}, {}, 0};
    std::vector<std::string> names;
    double begin_min = 0.0;
    for (const diagnosis::FluxTrace& trace : diagnosis.flux) {
      if (trace.node != node) {
        continue;
      }
      names.push_back(trace.run);
      for (std::size_t k = 0; k < trace.time_s.size(); ++k) {
        const double x = begin_min + (trace.time_s[k] - trace.time_s.front()) / 60.0;
        old.x.push_back(x), old.y.push_back(trace.before_W[k]);
        now.x.push_back(x), now.y.push_back(trace.after_W[k]);
        band.x.push_back(x);
        band.low.push_back(trace.after_W[k] - estimation::kInterval_sd * trace.after_sd_W[k]);
        band.high.push_back(trace.after_W[k] + estimation::kInterval_sd * trace.after_sd_W[k]);
      }
      old.x.push_back(old.x.back()), old.y.push_back(kGap);
      now.x.push_back(now.x.back()), now.y.push_back(kGap);
      band.x.push_back(band.x.back()), band.low.push_back(kGap), band.high.push_back(kGap);
      begin_min = now.x.back() + 0.5;
    }
    panel.title += ": " + listed(names);
    panel.curves = {old, now};
    panel.bands = {band};
    chart.panels.push_back(panel);
  }
  chart.panel_height_px = 260;
  return {"unknown_heat_W", chart};
}

}  // namespace

std::vector<DiagnosisPicture> diagnosis_pictures(const diagnosis::DiagnosisAnswer& answer) {
  const diagnosis::Diagnosis& diagnosis = answer.diagnosis;
  std::vector<DiagnosisPicture> pictures{residuals(diagnosis, answer.input, answer.score), unknown_heat(diagnosis)};
  for (const diagnosis::Unexplained& heat : diagnosis.unexplained) {
    if (heat.knots.size() < 2) {
      continue;
    }
    report::Chart chart{fmt::format("Curve found at the {}: {}", heat.node, verdict_words(diagnosis)),
                        fmt::format("linear between seven knots; band: {}{}", base::level_text(base::kInterval_share),
                                    heat.is_in_model ? "" : "; the extended model does not have it"),
                        heat.signals.front() + (heat.signal_unit.empty() ? "" : " / " + heat.signal_unit),
                        {}};
    const attribution::MultiplierSpec& factor = attribution::spec_of(heat.multiplier);
    report::ChartPanel panel{"", factor.unit.empty() ? "share of the copper loss" : fmt::format("curve / {}", factor.unit), {}, {}, {}};
    report::ChartBand band{base::level_text(base::kInterval_share), heat.knots, {}, {}, 0};
    for (std::size_t i = 0; i < heat.curve.size(); ++i) {
      band.low.push_back(heat.curve[i] - estimation::kInterval_sd * heat.curve_sd[i]);
      band.high.push_back(heat.curve[i] + estimation::kInterval_sd * heat.curve_sd[i]);
    }
    panel.curves = {{"curve", heat.knots, heat.curve, 0, false}};
    panel.bands = {band};
    chart.panels = {panel};
    // The number keeps names unique: two curves may share node and input signal, such as a heating and a cooling one.
    pictures.push_back({fmt::format("curve_{}_{}_{}", pictures.size() - 1, heat.node, heat.signals.front()), chart});
  }
  return pictures;
}

}  // namespace heatsoak::present
