#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <ranges>
#include <set>

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
  void put(const std::vector<double>& times_s, std::vector<double>& x) const {
    for (const double time_s : times_s) {
      x.push_back(begin_min + (time_s - times_s.front()) / 60.0);
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

/// Residuals of one signal in one run.
struct Residuals {
  std::string run;
  std::vector<double> time_s, before_K, after_K;
};

std::vector<Residuals> of_training(const std::string& signal, const diagnosis::Diagnosis& diagnosis,
                                   const diagnosis::DiagnosisInput& input) {
  std::vector<Residuals> all;
  for (const estimation::MeasuredRun& run : input.train) {
    const auto found = std::ranges::find(run.sensors, signal, &estimation::Sensor::signal);
    if (found == run.sensors.end()) {
      continue;
    }
    const auto off_K = [&](const estimation::Model& model) {
      const Eigen::Index sensor = found - run.sensors.begin();
      const Eigen::VectorXd off = run.measured_C.col(sensor) - estimation::open_loop_C(model, run, {}).col(sensor);
      return std::vector<double>(off.begin(), off.end());
    };
    all.push_back({run.name, run.time_s, off_K(input.model), off_K(diagnosis.selection.after.model)});
  }
  return all;
}

/// Those of the predictions that were scored.
std::vector<Residuals> of_holdout(const std::string& signal, const diagnosis::HoldoutScore& score) {
  std::vector<Residuals> all;
  for (std::size_t r = 0; r < score.runs_after.size(); ++r) {
    const auto off_K = [&](const calibration::PredictedRun& run) {
      std::vector<double> off;
      if (const auto found = std::ranges::find(run.signals, signal, &calibration::PredictedSignal::signal); found != run.signals.end()) {
        std::ranges::transform(found->measured_C, found->predicted_C, std::back_inserter(off), std::minus());
      }
      return off;
    };
    all.push_back({score.runs_after[r].name, score.runs_after[r].time_s, off_K(score.runs_before[r]), off_K(score.runs_after[r])});
  }
  std::erase_if(all, [](const Residuals& each) { return each.after_K.empty(); });
  return all;
}

/// Adds the residuals to the panel, and the names of the runs to its title.
void add_residuals(const std::vector<Residuals>& runs, bool is_held_out, Axis& axis, report::ChartPanel& panel) {
  if (runs.empty()) {
    return;
  }
  const std::string suffix = is_held_out ? ", hold-out" : "";
  report::ChartCurve old{"before" + suffix, {}, {}, 1, is_held_out}, now{"after" + suffix, {}, {}, 0, is_held_out};
  std::vector<std::string> names;
  for (const Residuals& run : runs) {
    names.push_back(run.run);
    for (const auto& [curve, off_K] : {std::pair(&old, &run.before_K), std::pair(&now, &run.after_K)}) {
      curve->y.insert(curve->y.end(), off_K->begin(), off_K->end());
      curve->y.push_back(kGap);
      axis.put(run.time_s, curve->x);
    }
    axis.begin_min = now.x.back() + 0.5;
  }
  panel.title += fmt::format("{} {}", is_held_out ? "; hold-out" : ": training", listed(names));
  panel.curves.push_back(std::move(old));
  panel.curves.push_back(std::move(now));
}

DiagnosisPicture residuals(const diagnosis::Diagnosis& diagnosis, const diagnosis::DiagnosisInput& input,
                           const diagnosis::HoldoutScore& score) {
  report::Chart chart{
      fmt::format("Residual in K: {}", verdict_words(diagnosis)),
      "free runs before and after the diagnosis, one behind the other; after: training by the extended model, hold-out by the motor file",
      "time / min",
      {}};
  std::set<std::string> signals;
  std::ranges::copy(std::views::keys(diagnosis.before_train), std::inserter(signals, signals.end()));
  std::ranges::transform(score.errors, std::inserter(signals, signals.end()), &diagnosis::ErrorInRun::signal);
  for (const std::string& signal : signals) {
    report::ChartPanel panel{part_of(signal), "measured − model / K", {}, {}, {}};
    Axis axis;
    add_residuals(of_training(signal, diagnosis, input), false, axis, panel);
    add_residuals(of_holdout(signal, score), true, axis, panel);
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
