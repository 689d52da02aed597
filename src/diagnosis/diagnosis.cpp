#include "diagnosis/diagnosis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>

#include "attribution/curve.h"
#include "attribution/terms.h"
#include "base/parallel.h"
#include "base/quantity.h"
#include "calibration/unlogged_speed.h"
#include "diagnosis/advisor.h"
#include "diagnosis/coverage.h"
#include "diagnosis/heat_of_effects.h"
#include "diagnosis/unexplained_heat.h"
#include "estimation/fit.h"
#include "estimation/interval.h"
#include "estimation/log_columns.h"
#include "estimation/smoothed_path.h"
#include "estimation/thresholds.h"

namespace heatsoak::diagnosis {
namespace {

/// Change of a parameter's logarithm from which another mounting is assumed.
constexpr double kOtherMounting = 0.1;

/// Ratio from which an error counts as larger.
constexpr double kWorse_ratio = 1.1;

class DiagnosisReport {
 public:
  DiagnosisReport(const DiagnosisInput& input, attribution::Selection selection) : input_(input) {
    out_.selection = std::move(selection);
    estimation::set_columns(input_.train, out_.selection.after.model.columns);
  }

  Diagnosis result() {
    input_.progress.begin(attribution::selection_phases::kLastFit);
    for (const attribution::AcceptedTerm& term : out_.selection.terms) {
      if (term.curve && term.effect_name.empty()) {
        continue;  // the model does not contain it
      }
      FoundEffect& effect = out_.effects.emplace_back(found_effect(term, out_.selection, input_.train));
      if (!effect.condition.empty()) {
        effect.same_conditions = estimation::same_as(effect.condition, input_.train);
      }
    }
    report_changed_parameters();
    out_.runs = input_.train;
    report_errors();
    report_flux();
    report_balance();
    out_.tests_before = tests_of(out_.selection.before);
    out_.tests_after = tests_of(out_.selection.after);
    out_.unexplained = unexplained_heat(out_, input_.train);
    out_.verdict = verdict();
    out_.experiments = next_experiments(out_.selection, input_.train);
    return std::move(out_);
  }

 private:
  [[nodiscard]] const estimation::Posterior& after() const { return out_.selection.after; }

  void report_changed_parameters() {
    const estimation::Model& model = after().model;
    const Eigen::VectorXd theta = model.theta();
    for (const auto& [own, gain_nats] : out_.selection.changed_nats) {
      const double reach = estimation::kInterval_sd * std::sqrt(after().covariance(own, own));
      const auto place = static_cast<std::size_t>(model.free[static_cast<std::size_t>(own)].place);
      const thermal::NetworkParameter& parameter = model.network.parameters()[place];
      out_.changed.push_back({parameter.name, std::string(parameter.unit), gain_nats, input_.model.values[place],
                              model.value_of(own, theta[own]), model.value_of(own, theta[own] - reach),
                              model.value_of(own, theta[own] + reach)});
    }
  }

  void report_errors() {
    out_.before_train = estimation::open_loop_errors(input_.model, input_.train, {});
    out_.refitted_train = estimation::open_loop_errors(out_.selection.own.model, input_.train, {});
    out_.after_train = estimation::open_loop_errors(after().model, input_.train, {});
    estimation::Model file = after().model;
    file.deviations.clear();  // the motor file does not contain them
    std::map<std::string, std::vector<estimation::MeasuredRun>> recordings;
    for (const estimation::MeasuredRun& run : input_.train) {
      recordings[estimation::recording_of(run)].push_back(run);
    }
    for (const auto& [name, runs] : recordings) {
      const estimation::Errors given = estimation::open_loop_errors(input_.model, runs, {});
      const estimation::Errors refitted = estimation::open_loop_errors(out_.selection.own.model, runs, {});
      const estimation::Errors of_file = estimation::open_loop_errors(file, runs, {});
      for (const auto& [signal, error] : estimation::open_loop_errors(after().model, runs, {})) {
        out_.train_errors.push_back({name, signal, given.at(signal), refitted.at(signal), error, of_file.at(signal)});
      }
    }
  }

  void report_flux() {
    const auto smoothed = [&](const estimation::Posterior& fit) {
      return estimation::smoothed_flux(fit, input_.train, out_.selection.weights, {});
    };
    const std::vector<estimation::FluxEstimate> before = smoothed(out_.selection.before);
    const std::vector<estimation::FluxEstimate> now = smoothed(after());
    const Eigen::VectorXd rms_before_W = estimation::rms_W(before);
    const Eigen::VectorXd rms_now_W = estimation::rms_W(now);
    const std::vector<int>& nodes = input_.model.flux_nodes;
    for (std::size_t f = 0; f < nodes.size(); ++f) {
      const std::string node(input_.model.network.node_name(nodes[f]));
      const auto row = static_cast<Eigen::Index>(f);
      out_.flux_rms_before_W[node] = rms_before_W[row];
      out_.flux_rms_after_W[node] = rms_now_W[row];
    }
    for (std::size_t r = 0; r < input_.train.size(); ++r) {
      for (std::size_t f = 0; f < nodes.size(); ++f) {
        const auto row = static_cast<Eigen::Index>(f);
        FluxTrace trace{input_.train[r].name, std::string(input_.model.network.node_name(nodes[f])), input_.train[r].time_s, {}, {}, {}};
        trace.before_W.assign(before[r].mean_W.row(row).begin(), before[r].mean_W.row(row).end());
        trace.after_W.assign(now[r].mean_W.row(row).begin(), now[r].mean_W.row(row).end());
        trace.after_sd_W.assign(now[r].sd_W.row(row).begin(), now[r].sd_W.row(row).end());
        out_.flux.push_back(std::move(trace));
      }
    }
  }

  void report_balance() {
    const estimation::Model& model = after().model;
    const thermal::Network& network = model.network;
    const auto nodes = static_cast<std::size_t>(network.node_count());
    const std::size_t effects = network.effects().size();
    std::vector<double> energy_J((effects + model.deviations.size()) * nodes, 0.0);  // effects first, then deviations
    double time_s = 0.0;
    for (std::size_t r = 0; r < input_.train.size(); ++r) {
      const estimation::MeasuredRun& run = input_.train[r];
      std::vector<double> in_run_J(effects * nodes, 0.0);
      heat_along(after(), run, after().fitted[r], [&](std::size_t k, std::span<const double> heat_W) {
        const double duration_s = run.time_s[k + 1] - run.time_s[k];
        time_s += duration_s;
        for (std::size_t i = 0; i < in_run_J.size(); ++i) {
          in_run_J[i] += duration_s * heat_W[i];
        }
      });
      std::ranges::transform(in_run_J, energy_J, energy_J.begin(), std::plus<>());
      for (std::size_t d = 0; d < model.deviations.size(); ++d) {
        add_part(model.deviations[d], run, in_run_J, energy_J, (effects + d) * nodes);
      }
    }
    for (std::size_t row_of = 0; row_of * nodes < energy_J.size(); ++row_of) {
      BalanceRow row{row_of < effects ? network.effects()[row_of].name : name_of(model.deviations[row_of - effects]), {}};
      for (std::size_t n = 0; n < nodes; ++n) {
        if (energy_J[row_of * nodes + n] != 0.0) {
          row.heat_W[std::string(network.node_name(static_cast<int>(n)))] = energy_J[row_of * nodes + n] / time_s;
        }
      }
      out_.balance.push_back(std::move(row));
    }
  }

  static std::string name_of(const estimation::RunDeviation& deviation) {
    return fmt::format("{} in {}", deviation.type->name, estimation::in_words(deviation.condition));
  }

  /// Moves the heat that a deviation causes in a run from the rows of its effects to its own row, which starts at `own`.
  void add_part(const estimation::RunDeviation& deviation, const estimation::MeasuredRun& run, std::span<const double> in_run_J,
                std::span<double> energy_J, std::size_t own) const {
    const thermal::Network& network = after().model.network;
    const auto nodes = static_cast<std::size_t>(network.node_count());
    if (!run.has(deviation.condition)) {
      return;
    }
    for (std::size_t e = 0; e < network.effects().size(); ++e) {
      if (!deviation.type->concerns(network, network.effects()[e])) {
        continue;
      }
      for (std::size_t n = 0; n < nodes; ++n) {
        const double part_J = deviation.type->part_ratio(deviation.deviation_share) * in_run_J[e * nodes + n];
        energy_J[e * nodes + n] -= part_J;
        energy_J[own + n] += part_J;
      }
    }
  }

  [[nodiscard]] std::vector<estimation::InnovationTests> tests_of(const estimation::Posterior& fit) const {
    std::map<std::string, Eigen::VectorXd> innovations;
    std::map<std::string, std::vector<estimation::NamedInput>> inputs;
    const std::vector<estimation::DesignRun> designs =
        estimation::design(fit.model.network, fit.fitted, input_.train, out_.selection.weights, {}, {});
    for (std::size_t r = 0; r < fit.fitted.size(); ++r) {
      const estimation::LinearisedRun& path = fit.fitted[r];
      const Eigen::VectorXd standardised =
          estimation::Whitening(path, fit.flux, designs[r].noise).innovations(path.residual_K).standardised;
      const Eigen::VectorXd& weight = out_.selection.weights[r];
      for (Eigen::Index sensor = 0; sensor < path.sensors(); ++sensor) {
        const std::string& signal = input_.train[r].sensors[static_cast<std::size_t>(sensor)].signal;
        Eigen::VectorXd& all = innovations[signal];
        const Eigen::Index begin = all.size();
        all.conservativeResize(begin + path.samples() + estimation::kMostLag);
        all.tail<estimation::kMostLag>().setConstant(std::nan(""));
        for (Eigen::Index k = 0; k < path.samples(); ++k) {
          const Eigen::Index row = k * path.sensors() + sensor;
          const bool counts = !std::isnan(path.residual_K[row]) && (weight.size() == 0 || weight[row] > 0.0);
          all[begin + k] = counts ? standardised[row] : std::nan("");
        }
        add_inputs(input_.train[r], inputs[signal]);
      }
    }
    std::vector<estimation::InnovationTests> tests(innovations.size());
    base::in_parallel(tests.size(), 0, [&](std::size_t i) {
      const auto& [signal, all] = *std::next(innovations.begin(), static_cast<std::ptrdiff_t>(i));
      tests[i] = estimation::test_innovations(signal, all, inputs.at(signal));
    });
    return tests;
  }

  static void add_inputs(const estimation::MeasuredRun& run, std::vector<estimation::NamedInput>& inputs) {
    for (const thermal::Signal signal : {thermal::Signal::current, thermal::Signal::speed, thermal::Signal::input_power}) {
      const thermal::OperatingQuantity<double>& quantity = thermal::quantity_of(signal);
      auto found = std::ranges::find(inputs, quantity.lacking, &estimation::NamedInput::name);
      if (found == inputs.end()) {
        inputs.push_back({std::string(quantity.lacking), {}});
        found = inputs.end() - 1;
      }
      // A run without the signal takes its rows, too: inputs and innovations are compared row by row.
      const Eigen::Index begin = found->values.size();
      found->values.conservativeResize(begin + run.samples() + estimation::kMostLag);
      found->values.tail<estimation::kMostLag>().setConstant(std::nan(""));
      for (Eigen::Index k = 0; k < run.samples(); ++k) {
        found->values[begin + k] =
            run.has(signal) ? run.at[static_cast<std::size_t>(std::min(k, run.samples() - 2))].*quantity.value : std::nan("");
      }
    }
  }

  [[nodiscard]] DiagnosisVerdict verdict() const {
    if (out_.selection.is_unexplained) {
      return DiagnosisVerdict::unexplained;
    }
    if (!out_.effects.empty()) {
      return DiagnosisVerdict::effect_found;
    }
    if (out_.selection.is_as_usual) {
      return DiagnosisVerdict::nothing_missing;
    }
    const bool is_same_mounting = std::ranges::none_of(out_.changed, [](const ChangedParameter& parameter) {
      return std::abs(std::log(parameter.value / parameter.before)) > kOtherMounting;
    });
    const bool would_show = out_.selection.seen_share >= estimation::thresholds().least_seen_share;
    return !out_.selection.is_undecided() && is_same_mounting && would_show ? DiagnosisVerdict::nothing_missing
                                                                            : DiagnosisVerdict::not_identifiable;
  }

  DiagnosisInput input_;
  Diagnosis out_;
};

}  // namespace

bool is_plainly_worse(double error_K, double than_K) {
  return error_K > than_K + estimation::thresholds().matters_K && error_K > kWorse_ratio * than_K;
}

std::string_view to_string(DiagnosisVerdict verdict) {
  switch (verdict) {
    case DiagnosisVerdict::effect_found:
      return "effect_found";
    case DiagnosisVerdict::nothing_missing:
      return "nothing_missing";
    case DiagnosisVerdict::unexplained:
      return "unexplained";
    case DiagnosisVerdict::not_identifiable:
      return "not_identifiable";
  }
  return "?";
}

double net_share(const std::vector<FluxTrace>& flux) {
  std::map<std::string, std::vector<double>> of_run_W;
  for (const FluxTrace& trace : flux) {
    std::vector<double>& sum_W = of_run_W[trace.run];
    sum_W.resize(trace.after_W.size(), 0.0);
    std::ranges::transform(sum_W, trace.after_W, sum_W.begin(), std::plus<>());
  }
  double net_W = 0.0;
  double size_W = 0.0;
  for (const auto& [run, sum_W] : of_run_W) {
    for (const double each_W : sum_W) {
      net_W += each_W;
      size_W += std::abs(each_W);
    }
  }
  return size_W > 0.0 ? net_W / size_W : 0.0;
}

Diagnosis diagnose(const DiagnosisInput& input, const attribution::SelectionRules& rules) {
  return DiagnosisReport(input, attribution::select_effects({input.model, input.train, input.usual, input.progress}, rules)).result();
}

}  // namespace heatsoak::diagnosis
