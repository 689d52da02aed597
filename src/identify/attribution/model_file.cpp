#include "identify/attribution/model_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <regex>
#include <set>
#include <sstream>

#include "motor/datasheet_network.h"

namespace heatsoak {
namespace {

constexpr double kInterval_sd = 1.959964;

/// ± of a calibrated parameter in its logarithm before it is fitted again.
constexpr double kSpread = 1.1;

bool has_signal(const Recording& recording, Signal signal) {
  const std::vector<Signal> signals = signals_of(recording);
  return std::ranges::find(signals, signal) != signals.end();
}

void set_needed(ModelOfLogs& out, const Motor& motor, const std::vector<Recording>& recordings) {
  std::set<Signal> wanted;
  for (const EffectInPlace& effect : out.model.model.network.effects()) {
    wanted.insert(effect.type->needs.begin(), effect.type->needs.end());
  }
  bool has_heat = false;
  for (const Signal signal : wanted) {
    const bool is_anywhere = std::ranges::any_of(recordings, [&](const Recording& each) { return has_signal(each, signal); });
    if (is_anywhere) {
      out.needed.push_back(signal);
      has_heat = has_heat || signal == Signal::current || signal == Signal::input_power;
    }
  }
  if (!has_heat) {
    throw Failure(
        ExitCode::bad_input,
        fmt::format("no log has a heat input that {} turns into heat: current_A, or power_in_W with an effect input_power_loss", motor.id));
  }
  for (const EffectInPlace& effect : out.model.model.network.effects()) {
    for (const Signal signal : effect.type->needs) {
      if (std::ranges::find(out.needed, signal) == out.needed.end()) {
        out.notes.push_back(fmt::format("no log has what {} needs: it counts as 0", effect.name));
        break;
      }
    }
  }
}

std::string parameter_line(const FittedParameter& parameter, const ParameterSpec& spec) {
  const std::string unit = parameter.unit.empty() ? "" : " " + parameter.unit;
  std::string line = fmt::format("{} = {{ value = \"{:.5g}{}\", origin = \"measured\", source = \"heatsoak_diagnose\"", parameter.name,
                                 parameter.value, unit);
  const bool has_range =
      parameter.low < parameter.value && parameter.high > parameter.value && parameter.low > spec.range.low && parameter.low > 0.0;
  line += has_range ? fmt::format(", range = [\"{:.5g}{}\", \"{:.5g}{}\"]", parameter.low, unit, parameter.high, unit) : "";
  return line + " }\n";
}

/// One [effects.*] table.
std::string effect_table(const FoundEffect& effect, const RefitResult& fit) {
  const Network& network = fit.model.model.network;
  const auto in_place = std::ranges::find(network.effects(), effect.name, &EffectInPlace::name);
  std::string text = fmt::format("\n[effects.{}]\n", effect.name);
  if (in_place->type->name != effect.name) {
    text += fmt::format("type = \"{}\"\n", in_place->type->name);
  }
  for (std::size_t role = 0; role < in_place->node_index.size(); ++role) {
    const std::string_view node = network.node_name(in_place->node_index[role]);
    if (node != in_place->type->nodes[role].default_node) {
      text += fmt::format("{} = \"{}\"\n", in_place->type->nodes[role].role, node);
    }
  }
  for (std::size_t p = 0; p < in_place->parameter_index.size(); ++p) {
    const ParameterSpec& spec = in_place->type->parameters[p];
    const double value = fit.model.model.values[static_cast<std::size_t>(in_place->parameter_index[p])];
    if (!spec.choices.empty()) {
      text += fmt::format("{} = \"{}\"\n", spec.key, spec.choices[static_cast<std::size_t>(value)].name);
      continue;
    }
    text += parameter_line(*std::ranges::find(effect.parameters, spec.key, &FittedParameter::name), spec);
  }
  if (!effect.condition.empty()) {
    text += fmt::format("[effects.{}.condition]\n", effect.name);
    for (const auto& [key, value] : effect.condition) {
      text += fmt::format("{} = \"{}\"\n", key, value);
    }
  }
  return text;
}

/// The four thermal figures of the datasheet network as the final fit has them.
std::map<std::string, FittedParameter> thermal_figures(const RefitResult& fit) {
  const Model& model = fit.model.model;
  const auto of = [&](std::string_view name) {
    FittedParameter out;
    for (std::size_t i = 0; i < model.free.size(); ++i) {
      if (model.name(static_cast<Eigen::Index>(i)) == name) {
        const auto at = static_cast<Eigen::Index>(i);
        const double sd = std::sqrt(fit.covariance(at, at));
        out.value = model.values[static_cast<std::size_t>(model.free[i].place)];
        out.low = out.value * std::exp(-kInterval_sd * sd);
        out.high = out.value * std::exp(kInterval_sd * sd);
      }
    }
    return out;
  };
  const FittedParameter inner = of("winding_stator.thermal_resistance"), outer = of("stator_ambient.thermal_resistance");
  const FittedParameter winding = of("winding.heat_capacity"), stator = of("stator.heat_capacity");
  const auto product = [](const FittedParameter& a, const FittedParameter& b) {
    // Independent in the logarithm, which errs on the wide side: τ is better known than its factors.
    const double spread = std::hypot(std::log(a.high / a.value), std::log(b.high / b.value));
    return FittedParameter{"", "s", a.value * b.value, a.value * b.value * std::exp(-spread), a.value * b.value * std::exp(spread)};
  };
  std::map<std::string, FittedParameter> figures{{"thermal_resistance_winding_stator", inner},
                                                 {"thermal_resistance_stator_ambient", outer}};
  figures["thermal_resistance_winding_stator"].unit = figures["thermal_resistance_stator_ambient"].unit = "K/W";
  figures["thermal_time_constant_winding"] = product(inner, winding);
  figures["thermal_time_constant_stator"] = product(outer, stator);
  return figures;
}

}  // namespace

ModelOfLogs model_of_logs(const Motor& motor, const std::vector<Recording>& recordings) {
  ModelOfLogs out;
  Model& model = out.model.model;
  model.network = datasheet_network(motor, nominal_sample(motor));
  const auto have = [&](Signal signal) {
    return std::ranges::all_of(recordings, [&](const Recording& each) { return has_signal(each, signal); });
  };
  if (!have(Signal::current) && have(Signal::input_power)) {
    model.network.add_effect("input_power", *find_effect("input_power_loss"), std::vector<std::string>{"winding"},
                             std::vector<double>{1.0});
    out.notes.emplace_back(
        "no current in the logs: all electric power that goes in is taken as heat of the winding, the driver's share included");
  }
  model.values = model.network.values();
  model.prior = {Eigen::VectorXd(0), Eigen::MatrixXd(0, 0)};
  for (int node = 0; node < model.network.state_count(); ++node) {
    model.flux_nodes.push_back(node);
  }
  for (std::size_t place = 0; place < model.values.size(); ++place) {
    const std::string& name = model.network.parameters()[place].name;
    const double value = model.values[place];
    if ((name.ends_with(".heat_capacity") || name.ends_with(".thermal_resistance")) && value > 0.0) {
      model.set_free({static_cast<int>(place), true, 1.0, value / 100.0, value * 100.0}, kSpread);
    }
  }
  set_needed(out, motor, recordings);
  return out;
}

Recording part_of(const Recording& recording, double from_share, double to_share) {
  Recording part = recording;
  const double begin_s = recording.time_s.front();
  const double length_s = recording.time_s.back() - begin_s;
  const auto row_at = [&](double share) {
    const double time_s = begin_s + share * length_s;
    return share >= 1.0 ? recording.rows()
                        : static_cast<std::size_t>(std::ranges::lower_bound(recording.time_s, time_s) - recording.time_s.begin());
  };
  const std::size_t first = row_at(from_share);
  const std::size_t last = std::max(first, row_at(to_share));
  const auto cut = [&](auto& values) {
    using Values = std::remove_reference_t<decltype(values)>;
    values = Values(values.begin() + static_cast<std::ptrdiff_t>(first), values.begin() + static_cast<std::ptrdiff_t>(last));
  };
  cut(part.time_s);
  cut(part.line);
  for (Channel& channel : part.channels) {
    cut(channel.values);
  }
  part.run_begins = {0};
  for (const std::size_t begin : recording.run_begins) {
    if (begin > first && begin < last) {
      part.run_begins.push_back(begin - first);
    }
  }
  return part;
}

std::string extended_motor_file(const std::string& original, const Motor& motor, const Diagnosis& diagnosis) {
  const RefitResult& fit = diagnosis.selection.after;
  const std::map<std::string, FittedParameter> figures = thermal_figures(fit);
  std::string text;
  std::istringstream lines(original);
  for (std::string line; std::getline(lines, line);) {
    for (const auto& [key, figure] : figures) {
      if (std::regex_search(line, std::regex("^" + key + "\\s*=")) && figure.value > 0.0) {
        line = fmt::format(
            "{} = {{ value = \"{:.5g} {}\", origin = \"measured\", source = \"heatsoak_diagnose\", range = [\"{:.5g} {}\", \"{:.5g} {}\"] "
            "}}",
            key, figure.value, figure.unit, figure.low, figure.unit, figure.high, figure.unit);
      }
    }
    text += line + "\n";
    if (line == "[sources]" && !motor.sources.contains("heatsoak_diagnose")) {
      text += "heatsoak_diagnose = \"fitted to measured runs by heatsoak diagnose; ranges are 95 % intervals\"\n";
    }
  }
  for (const FoundEffect& effect : diagnosis.effects) {
    text += effect.name.empty() ? "" : effect_table(effect, fit);
  }
  return text;
}

}  // namespace heatsoak
