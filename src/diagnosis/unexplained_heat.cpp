#include "diagnosis/unexplained_heat.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "attribution/curve.h"
#include "attribution/terms.h"
#include "calibration/unlogged_speed.h"
#include "estimation/thresholds.h"

namespace heatsoak::diagnosis {
namespace {

class UnexplainedHeatReport {
 public:
  UnexplainedHeatReport(const Diagnosis& diagnosis, const std::vector<estimation::MeasuredRun>& train)
      : diagnosis_(diagnosis), train_(train) {}

  /// Returns the accepted curves or, without one, the node with the most unknown heat.
  std::vector<Unexplained> result() {
    for (const attribution::AcceptedTerm& term : diagnosis_.selection.terms) {
      if (term.curve) {
        add_curve(term);
      }
    }
    if (heats_.empty() && diagnosis_.selection.is_unexplained) {
      heats_.push_back(most());
    }
    return std::move(heats_);
  }

 private:
  /// Returns the unknown heat at the node with the largest RMS.
  [[nodiscard]] Unexplained most() const {
    Unexplained most;
    for (const auto& [node, members] : unknown_by_sensor()) {
      Unexplained heat = unnamed_heat(node, members);
      if (most.node.empty() || heat.rms_W > most.rms_W) {
        most = std::move(heat);
      }
    }
    const std::vector<attribution::ScanResult>& scan = diagnosis_.selection.rounds.back().scan;
    if (!scan.empty() && scan.front().gain_nats > estimation::thresholds().clear_nats) {
      most.unconfirmed_signal = diagnosis_.selection.regressors[static_cast<std::size_t>(scan.front().term.regressor)].name;
    }
    return most;
  }

  [[nodiscard]] const estimation::Posterior& after() const { return diagnosis_.selection.after; }
  [[nodiscard]] double time_scale_s() const { return after().flux.time_scale_s; }

  [[nodiscard]] bool has_sensor(const std::string& node) const {
    return std::ranges::any_of(train_, [&](const estimation::MeasuredRun& run) {
      return std::ranges::find(run.sensors, node, &estimation::Sensor::node) != run.sensors.end();
    });
  }

  /// Groups the nodes with unknown heat by the node whose sensor shows it: the node itself, or else the first one with a sensor.
  [[nodiscard]] std::map<std::string, std::vector<std::string>> unknown_by_sensor() const {
    std::map<std::string, std::vector<std::string>> shown;
    const auto first = std::ranges::find_if(diagnosis_.flux_rms_after_W, [&](const auto& each) { return has_sensor(each.first); });
    for (const auto& [node, rms_W] : diagnosis_.flux_rms_after_W) {
      shown[has_sensor(node) || first == diagnosis_.flux_rms_after_W.end() ? node : first->first].push_back(node);
    }
    return shown;
  }

  /// Returns the sum of the unknown heat of all `members`.
  [[nodiscard]] Unexplained unnamed_heat(const std::string& node, const std::vector<std::string>& members) const {
    Unexplained heat;
    heat.node = node;
    std::ranges::copy_if(members, std::back_inserter(heat.or_nodes), [&](const std::string& other) { return other != node; });
    heat.time_scale_s = time_scale_s();
    std::map<std::string, Eigen::VectorXd> of_run_W;
    for (const FluxTrace& trace : diagnosis_.flux) {
      if (std::ranges::find(members, trace.node) != members.end()) {
        const Eigen::Map<const Eigen::VectorXd> own_W(trace.after_W.data(), static_cast<Eigen::Index>(trace.after_W.size()));
        Eigen::VectorXd& sum_W = of_run_W[trace.run];
        sum_W = sum_W.size() == 0 ? Eigen::VectorXd(own_W) : Eigen::VectorXd(sum_W + own_W);
      }
    }
    double count = 0.0;
    for (const auto& [run, sum_W] : of_run_W) {
      heat.peak_W = std::max(heat.peak_W, sum_W.cwiseAbs().maxCoeff());
      heat.mean_W += sum_W.cwiseAbs().sum();
      heat.rms_W += sum_W.squaredNorm();
      count += static_cast<double>(sum_W.size());
    }
    heat.mean_W /= count;
    heat.rms_W = std::sqrt(heat.rms_W / count);
    return heat;
  }

  /// Reports an accepted curve, with the fitted values of the model if that contains it.
  void add_curve(const attribution::AcceptedTerm& term) {
    const attribution::ScanTerm& scanned = term.curve->term;
    const attribution::Regressor& regressor = diagnosis_.selection.regressors[static_cast<std::size_t>(scanned.regressor)];
    const auto effect = std::ranges::find(diagnosis_.effects, term.effect_name, &FoundEffect::name);
    Unexplained heat;
    heat.node = scanned.node;
    heat.signals = {regressor.name};
    heat.signals.insert(heat.signals.end(), term.confusable_with.begin(), term.confusable_with.end());
    heat.multiplier = scanned.multiplier;
    heat.other_node = scanned.other;
    heat.time_scale_s = time_scale_s();
    heat.gain_nats = term.curve->gain_nats;
    heat.signal_unit = regressor.unit;
    if (term.effect_name.empty()) {
      const Eigen::VectorXd& curve = term.curve->curve;
      heat.mean_W = heat.rms_W = term.curve->mean_W;
      heat.peak_W = term.curve->peak_W;
      heat.knots = term.curve->knots;
      heat.curve.assign(curve.begin(), curve.end());
      heat.curve_sd.assign(term.curve->curve_sd.begin(), term.curve->curve_sd.end());
      heats_.push_back(std::move(heat));
      return;
    }
    heat.is_in_model = true;
    heat.mean_W = heat.rms_W = effect->mean_W;
    heat.peak_W = effect->peak_W;
    const estimation::Model& model = after().model;
    const std::vector<int>& parameters = effect_named(model.network, term.effect_name)->parameter_index;
    const auto value = [&](std::size_t parameter) { return model.values[static_cast<std::size_t>(parameters[parameter])]; };
    const std::size_t first = parameters.size() - static_cast<std::size_t>(term.curve->curve.size());
    heat.knots = attribution::knots_from({value(first - 2), value(first - 1)});
    for (std::size_t knot = first; knot < parameters.size(); ++knot) {
      heat.curve.push_back(value(knot));
      const auto free = std::ranges::find(model.free, parameters[knot], &estimation::FreeParameter::place);
      const Eigen::Index own = free - model.free.begin();
      heat.curve_sd.push_back(free == model.free.end() ? 0.0 : free->scale * std::sqrt(after().covariance(own, own)));
    }
    heats_.push_back(std::move(heat));
  }

  const Diagnosis& diagnosis_;
  const std::vector<estimation::MeasuredRun>& train_;
  std::vector<Unexplained> heats_;
};

}  // namespace

std::vector<Unexplained> unexplained_heat(const Diagnosis& diagnosis, const std::vector<estimation::MeasuredRun>& train) {
  return UnexplainedHeatReport(diagnosis, train).result();
}

}  // namespace heatsoak::diagnosis
