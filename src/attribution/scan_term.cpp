#include "attribution/scan_term.h"

#include <algorithm>
#include <array>

namespace heatsoak::attribution {

std::optional<int> flux_of(const estimation::Model& model, std::string_view node) {
  const std::optional<int> place = model.network.find_node(node);
  const auto found = place ? std::ranges::find(model.flux_nodes, *place) : model.flux_nodes.end();
  return found == model.flux_nodes.end() ? std::nullopt : std::optional(static_cast<int>(found - model.flux_nodes.begin()));
}

std::vector<ScanTerm> scan_terms(const estimation::Model& model, const std::vector<estimation::MeasuredRun>& runs) {
  std::vector<ScanTerm> terms;
  for (const int node : model.flux_nodes) {
    const std::string name(model.network.node_name(node));
    terms.push_back({name, "", Multiplier::source, 0});
    terms.push_back({name, "", Multiplier::excess, 0});
    if (name == "winding") {
      terms.push_back({name, "", Multiplier::copper, 0});
    }
  }
  const auto is_seen = [&](std::string_view node) {
    return flux_of(model, node) &&
           std::ranges::any_of(runs, [&](const estimation::MeasuredRun& run) { return run.sensor_at(node).has_value(); });
  };
  if (is_seen("winding") && is_seen("stator")) {
    terms.push_back({"winding", "stator", Multiplier::difference, 0});
  }
  // Losses that depend on a second signal arise in the stator.
  for (const auto& [signal, multiplier] :
       {std::pair(thermal::Signal::current, Multiplier::current), std::pair(thermal::Signal::speed, Multiplier::speed)}) {
    const bool is_logged = std::ranges::all_of(runs, [&, signal = signal](const estimation::MeasuredRun& run) { return run.has(signal); });
    if (is_logged && flux_of(model, "stator")) {
      terms.push_back({"stator", "", multiplier, 0});
    }
  }
  return terms;
}

const MultiplierSpec& spec_of(Multiplier multiplier) {
  static constexpr std::array kAll{
      MultiplierSpec{"heat", "W", "heat"},
      MultiplierSpec{"excess over ambient", "W/K", "per_difference", {}, true},
      MultiplierSpec{"copper loss", "", "per_copper_loss"},
      MultiplierSpec{"difference to the other node", "W/K", "per_difference", {}, true},
      MultiplierSpec{"current", "W/A", "per_current", "current"},
      MultiplierSpec{"speed", "W s/rad", "per_speed", "speed"},
  };
  return kAll[static_cast<std::size_t>(multiplier)];
}

Eigen::VectorXd multiplier_along(const ScanTerm& term, const estimation::Model& model, const estimation::LinearisedRun& fitted,
                                 const estimation::MeasuredRun& run) {
  const int node = model.network.node(term.node);
  Eigen::VectorXd along = Eigen::VectorXd::Ones(run.samples() - 1);
  if (term.multiplier == Multiplier::copper) {
    std::vector<double> heat_W(model.network.effects().size() * static_cast<std::size_t>(model.network.node_count()));
    for (Eigen::Index k = 0; k < along.size(); ++k) {
      const std::span<const double> state_C(fitted.state_C.col(k).data(), static_cast<std::size_t>(fitted.states));
      model.network.balance_W(run.at[static_cast<std::size_t>(k)], model.values, state_C, heat_W);
      along[k] = 0.0;
      for (std::size_t e = 0; e < model.network.effects().size(); ++e) {
        const bool is_copper = model.network.effects()[e].type->name == "copper_loss";
        along[k] += is_copper ? heat_W[e * static_cast<std::size_t>(model.network.node_count()) + static_cast<std::size_t>(node)] : 0.0;
      }
    }
    return along;
  }
  if (!spec_of(term.multiplier).second_signal.empty()) {
    for (Eigen::Index k = 0; k < along.size(); ++k) {
      const thermal::OperatingPoint<double>& at = run.at[static_cast<std::size_t>(k)];
      along[k] = term.multiplier == Multiplier::current ? at.current_rms_A : at.speed_mean_rad_per_s;
    }
    return along;
  }
  const std::optional<int> other = term.other.empty() ? std::nullopt : model.network.find_node(term.other);
  for (Eigen::Index k = 0; k < along.size() && term.multiplier != Multiplier::source; ++k) {
    const double other_C = other ? fitted.state_C(*other, k) : run.at[static_cast<std::size_t>(k)].ambient_C;
    along[k] = fitted.state_C(node, k) - other_C;
  }
  return along;
}

}  // namespace heatsoak::attribution
