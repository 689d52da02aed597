#include "diagnosis/advisor.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "base/diagnostic.h"

namespace heatsoak::diagnosis {
namespace {

constexpr int kSeconds = 600;

/// Largest values in the runs.
struct Levels {
  double current_A = 0.0;
  double speed_rad_per_s = 0.0;
  double bus_V = 0.0;
  double input_power_W = 0.0;
  double shaft_W_per_A_rad_per_s = 0.0;
  double ambient_C = 25.0;
  double measured_C = 0.0;
};

Levels levels_of(const std::vector<estimation::MeasuredRun>& runs) {
  Levels most;
  for (const estimation::MeasuredRun& run : runs) {
    for (const thermal::OperatingPoint<double>& at : run.at) {
      most.current_A = std::max(most.current_A, at.current_rms_A);
      most.speed_rad_per_s = std::max(most.speed_rad_per_s, at.speed_mean_rad_per_s);
      most.bus_V = std::max(most.bus_V, at.bus_V);
      most.input_power_W = std::max(most.input_power_W, at.input_power_W);
      if (const double turns_A_rad_per_s = at.current_rms_A * at.speed_mean_rad_per_s; turns_A_rad_per_s > 0.0) {
        most.shaft_W_per_A_rad_per_s = std::max(most.shaft_W_per_A_rad_per_s, std::abs(at.shaft_power_W) / turns_A_rad_per_s);
      }
    }
  }
  most.ambient_C = runs.front().at.front().ambient_C;
  // A temperature rise of 10 K is harmless even if the runs stayed colder.
  constexpr double kHarmless_K = 10.0;
  most.measured_C = most.ambient_C + kHarmless_K;
  for (const estimation::MeasuredRun& run : runs) {
    for (std::size_t sensor = 0; sensor < run.sensors.size(); ++sensor) {
      for (const double sensor_C : run.measured_C.col(static_cast<Eigen::Index>(sensor))) {
        most.measured_C = std::fmax(most.measured_C, motor::true_at_rest_C(run.sensors[sensor].faults, sensor_C));
      }
    }
  }
  return most;
}

struct Primitive {
  PlannedRun run{};
  /// Fractions of the highest speed and of the highest current, as a function of the time in s.
  std::function<std::pair<double, double>(int)> shares;
};

/// Returns the step, from 0, of a staircase with steps of `length_s`.
int step_of(int time_s, int length_s) { return time_s / length_s; }

const std::vector<Primitive>& menu() {
  static const std::vector<Primitive> all{
      {PlannedRun::speeds_without_load, [](int s) { return std::pair(0.2 * (1 + step_of(s, 120)), 0.05); }},
      {PlannedRun::pulses_at_standstill, [](int s) { return std::pair(0.0, s % 60 < 25 ? 0.4 + 0.12 * step_of(s, 120) : 0.0); }},
      {PlannedRun::spin_after_standstill, [](int s) { return s < 300 ? std::pair(0.0, 0.6) : std::pair(0.9, 0.05); }},
      {PlannedRun::rest_after_spin, [](int s) { return s < 300 ? std::pair(0.9, 0.05) : std::pair(0.0, 0.0); }},
      {PlannedRun::one_current_at_speeds, [](int s) { return std::pair(0.25 * (1 + step_of(s, 150)), 0.5); }},
      {PlannedRun::one_speed_with_currents, [](int s) { return std::pair(0.6, 0.2 * (1 + step_of(s, 150))); }},
      {PlannedRun::rest_after_standstill, [](int s) { return s < 300 ? std::pair(0.0, 0.6) : std::pair(0.0, 0.0); }},
  };
  return all;
}

estimation::MeasuredRun planned(const Primitive& primitive, const Levels& levels, const estimation::MeasuredRun& like) {
  estimation::MeasuredRun run;
  run.name = "planned";
  run.sensors = like.sensors;
  run.signals = like.signals;
  for (int s = 0; s <= kSeconds; ++s) {
    run.time_s.push_back(s);
    if (s < kSeconds) {
      const auto [speed_share, current_share] = primitive.shares(s);
      thermal::OperatingPoint<double> at;
      at.current_rms_A = current_share * levels.current_A;
      at.speed_mean_rad_per_s = at.speed_rms_rad_per_s = at.velocity_rad_per_s = speed_share * levels.speed_rad_per_s;
      at.input_power_W = current_share * current_share * levels.input_power_W;
      at.shaft_power_W = levels.shaft_W_per_A_rad_per_s * at.current_rms_A * at.speed_mean_rad_per_s;
      at.bus_V = levels.bus_V;
      at.modulation_ratio = std::min(1.0, 0.9 * speed_share);
      at.ambient_C = levels.ambient_C;
      run.at.push_back(at);
    }
  }
  // The readings are placeholders: only the columns of the run are used.
  run.measured_C = Eigen::MatrixXd::Constant(run.samples(), static_cast<Eigen::Index>(run.sensors.size()), levels.ambient_C);
  return run;
}

/// An experiment that stays below the measured temperatures, with the model's path along it.
struct Plan {
  const Primitive* primitive = nullptr;
  estimation::MeasuredRun run;
  estimation::LinearisedRun path;
};

double hottest_C(const estimation::Model& model, const estimation::MeasuredRun& run, estimation::LinearisedRun& path) {
  const std::vector<double> start_C(static_cast<std::size_t>(model.network.state_count()), run.at.front().ambient_C);
  try {
    path = estimation::linearise(model, start_C, run);
  } catch (const base::Failure&) {
    return std::numeric_limits<double>::infinity();
  }
  return path.state_C.maxCoeff();
}

/// Sets the kind and the largest current and speed of a planned experiment.
void describe(const Primitive& primitive, const estimation::MeasuredRun& run, Experiment& experiment) {
  const double most_A = std::ranges::max(run.at, {}, &thermal::OperatingPoint<double>::current_rms_A).current_rms_A;
  const double fastest_rad_per_s =
      std::ranges::max(run.at, {}, &thermal::OperatingPoint<double>::speed_mean_rad_per_s).speed_mean_rad_per_s;
  experiment.planned = primitive.run;
  experiment.most_A = most_A > 0.0 ? std::optional(most_A) : std::nullopt;
  experiment.most_rad_per_s = fastest_rad_per_s > 0.0 ? std::optional(fastest_rad_per_s) : std::nullopt;
}

/// Returns the planned experiments. Reduces the current of each one until it stays below the temperatures of the runs, because a logged
/// peak of 0.1 s must not be held for minutes.
std::vector<Plan> plans(const attribution::Selection& selection, const std::vector<estimation::MeasuredRun>& runs) {
  constexpr double kStep_ratio = 0.7;
  constexpr int kTries = 12;
  const Levels most = levels_of(runs);
  std::vector<Plan> all;
  for (const Primitive& primitive : menu()) {
    Levels levels = most;
    for (int i = 0; i < kTries; ++i, levels.current_A *= kStep_ratio, levels.input_power_W *= kStep_ratio * kStep_ratio) {
      Plan plan{&primitive, planned(primitive, levels, runs.front()), {}};
      if (hottest_C(selection.after.model, plan.run, plan.path) <= levels.measured_C &&
          hottest_C(selection.before.model, plan.run, plan.path) <= levels.measured_C) {
        all.push_back(std::move(plan));
        break;
      }
    }
  }
  return all;
}

/// Returns ½‖column − its projection on θ and the rival‖² in whitened space, with the posterior of θ as prior.
double separation_nats(const estimation::Posterior& fit, const estimation::LatentFlux& flux,
                       const std::vector<attribution::Candidate>& pair, double size_share, const Plan& plan) {
  const std::vector<estimation::MeasuredRun> runs{plan.run};
  const std::vector<estimation::LinearisedRun> path{plan.path};
  const std::vector<estimation::DesignRun> designs =
      estimation::design(fit.model.network, path, runs, {}, {}, {attribution::candidate_columns(pair, fit.model, path.front(), plan.run)});
  const estimation::Whitening whitening(path.front(), flux, designs.front().noise);
  const Eigen::MatrixXd triangle =
      estimation::run_evidence(path.front(), designs.front().columns, whitening, designs.front().start).triangle;
  const Eigen::Index own = fit.model.free_count();
  std::vector<Eigen::Index> absorbing;
  for (Eigen::Index i = 0; i < own; ++i) {
    absorbing.push_back(i);
  }
  absorbing.push_back(own + 1);
  // θ can absorb the difference only within its posterior from the runs so far.
  const Eigen::MatrixXd precision = (fit.covariance + 1e-12 * Eigen::MatrixXd::Identity(own, own)).inverse();
  Eigen::MatrixXd others = Eigen::MatrixXd::Zero(triangle.rows() + own, own + 1);
  others.topRows(triangle.rows()) = triangle(Eigen::all, absorbing);
  others.bottomLeftCorner(own, own) = precision.llt().matrixU();
  Eigen::VectorXd column = Eigen::VectorXd::Zero(others.rows());
  column.head(triangle.rows()) = size_share * triangle.col(own);
  return 0.5 * (column - others * others.colPivHouseholderQr().solve(column)).squaredNorm();
}

bool has_nodes_of(const thermal::Network& network, const attribution::Candidate& candidate) {
  bool has_all = true;
  for (std::size_t role = 0; role < candidate.nodes.size(); ++role) {
    has_all = has_all && (candidate.type->nodes[role].own_capacity.has_value() || network.find_node(candidate.nodes[role]));
  }
  return has_all;
}

/// Returns the candidate as evaluated in the first round that contains it; null if no round does.
const attribution::JudgedCandidate* judged(const attribution::Selection& selection, const std::string& id) {
  for (const attribution::Round& round : selection.rounds) {
    const auto found =
        std::ranges::find_if(round.ladder, [&](const attribution::JudgedCandidate& each) { return each.candidate.id == id; });
    if (found != round.ladder.end()) {
      return &*found;
    }
  }
  return nullptr;
}

}  // namespace

std::vector<Experiment> next_experiments(const attribution::Selection& selection, const std::vector<estimation::MeasuredRun>& runs) {
  std::vector<Experiment> experiments;
  const bool has_rivals =
      std::ranges::any_of(selection.terms, [](const attribution::AcceptedTerm& term) { return !term.confusable_with.empty(); });
  const std::vector<Plan> menu_here = has_rivals ? plans(selection, runs) : std::vector<Plan>();
  for (const attribution::AcceptedTerm& term : selection.terms) {
    for (std::size_t rival = 0; term.candidate && rival < term.confusable_with.size(); ++rival) {
      Experiment best{term.candidate->id, term.confusable_with[rival], term.experiments[rival]};
      const Experiment of_catalogue = best;
      const attribution::JudgedCandidate* const other = judged(selection, term.confusable_with[rival]);
      // The base model has no node for an effect at a body that another effect added.
      if (!other || !has_nodes_of(selection.before.model.network, *term.candidate) ||
          !has_nodes_of(selection.before.model.network, other->candidate)) {
        experiments.push_back(std::move(best));
        continue;
      }
      const attribution::JudgedCandidate* const own = judged(selection, term.candidate->id);
      const std::vector<attribution::Candidate> pair{*term.candidate, other->candidate};
      for (const Plan& plan : menu_here) {
        const double nats = separation_nats(selection.before, selection.after.flux, pair, own ? own->size_share : 1.0, plan);
        if (nats > best.expected_nats.value_or(0.0)) {
          best.expected_nats = nats;
          describe(*plan.primitive, plan.run, best);
        }
      }
      // If ten minutes do not separate the effects, use the catalogue's experiment, which needs another set-up.
      if (!best.expected_nats || *best.expected_nats < 1.0) {
        best = of_catalogue;
      }
      experiments.push_back(std::move(best));
    }
  }
  std::ranges::stable_sort(experiments, [](const Experiment& a, const Experiment& b) { return a.expected_nats > b.expected_nats; });
  return experiments;
}

}  // namespace heatsoak::diagnosis
