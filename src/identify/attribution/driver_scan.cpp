#include "identify/attribution/driver_scan.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace heatsoak {
namespace {

constexpr int kKnots = 7;
/// Of the heat that the prior takes for usual, as a share of the mean heat.
constexpr double kUsual_share = 0.3;

std::vector<double> knots_of(const Driver& driver) {
  if (driver.kind == DriverKind::run) {
    return {1.0};
  }
  std::vector<double> knots(kKnots);
  for (int i = 0; i < kKnots; ++i) {
    knots[static_cast<std::size_t>(i)] = driver.low + (driver.high - driver.low) * i / (kKnots - 1.0);
  }
  return knots;
}

/// How the sensors answer to heats held over the intervals: `heat_W` (intervals × c) into the node with place `flux`, out of `other`.
Columns response(const LinearisedRun& run, const Columns& heat_W, int flux, int other) {
  Columns shown = Columns::Zero(run.residual_K.size(), heat_W.cols());
  Columns state = Columns::Zero(run.states, heat_W.cols());
  Columns next = state;
  for (Eigen::Index k = 0; k + 1 < run.samples(); ++k) {
    const double* const transition = run.transition.data() + k * run.states * run.states;
    const double* const injection = run.injection.data() + k * run.states * run.fluxes;
    for (Eigen::Index i = 0; i < run.states; ++i) {
      const double gain_K_per_W = injection[i * run.fluxes + flux] - (other >= 0 ? injection[i * run.fluxes + other] : 0.0);
      next.row(i) = gain_K_per_W * heat_W.row(k);
      for (Eigen::Index j = 0; j < run.states; ++j) {
        next.row(i) += transition[i * run.states + j] * state.row(j);
      }
    }
    state.swap(next);
    for (Eigen::Index sensor = 0; sensor < run.sensors(); ++sensor) {
      shown.row((k + 1) * run.sensors() + sensor) = state.row(run.sensor_node[static_cast<std::size_t>(sensor)]);
    }
  }
  return shown;
}

int flux_of(const Model& model, std::string_view node) {
  const int place = model.network.find_node(node);
  const auto found = std::ranges::find(model.flux_nodes, place);
  return found == model.flux_nodes.end() ? -1 : static_cast<int>(found - model.flux_nodes.begin());
}

/// What all terms at one node before one multiplier share: their columns stand side by side.
struct Batch {
  ScanTerm term;
  std::vector<int> drivers;
};

std::vector<Batch> batches_of(const ScanInput& input) {
  const Network& network = input.model->network;
  std::vector<int> all(input.drivers->size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i] = static_cast<int>(i);
  }
  std::vector<Batch> batches;
  for (const int node : input.model->flux_nodes) {
    const std::string name(network.node_name(node));
    batches.push_back({{name, "", Multiplier::source, 0}, all});
    batches.push_back({{name, "", Multiplier::excess, 0}, all});
    if (name == "winding") {
      batches.push_back({{name, "", Multiplier::copper, 0}, all});
    }
  }
  if (flux_of(*input.model, "winding") >= 0 && flux_of(*input.model, "stator") >= 0) {
    batches.push_back({{"winding", "stator", Multiplier::difference, 0}, all});
  }
  return batches;
}

/// Normal equations of a family's hats: with each other, with θ and the residual, start temperatures and θ taken out.
struct Family {
  ScanTerm term;
  std::vector<double> knots;
  double usual = 1.0;
};

struct Scored {
  double gain_nats = 0.0;  ///< at one place of the unknown heat
  Eigen::VectorXd curve;
  Eigen::MatrixXd covariance;
};

class Scanner {
 public:
  Scanner(const ScanInput& input, EvidenceTable& table, const SetScore& base) : input_(input), table_(table), base_(base) {}

  std::vector<ScanResult> run(int most) {
    std::vector<ScanResult> results;
    for (const Batch& batch : batches_of(input_)) {
      std::vector<Family> families;
      for (const int driver : batch.drivers) {
        families.push_back(family(batch.term, driver));
      }
      const std::vector<Scored> scored = score(families, base_.place);
      for (std::size_t f = 0; f < families.size(); ++f) {
        results.push_back(result(families[f], scored[f], base_.place, scored[f].gain_nats));
      }
    }
    const auto by_gain = [](const ScanResult& a, const ScanResult& b) { return a.gain_nats > b.gain_nats; };
    std::ranges::stable_sort(results, by_gain);
    results.resize(std::min<std::size_t>(results.size(), static_cast<std::size_t>(2 * most)));
    for (ScanResult& each : results) {
      climb(each);
    }
    std::ranges::stable_sort(results, by_gain);
    results.resize(std::min<std::size_t>(results.size(), static_cast<std::size_t>(most)));
    return results;
  }

 private:
  Family family(ScanTerm term, int driver) const {
    term.driver = driver;
    double squares = 0.0;
    double count = 0.0;
    for (std::size_t r = 0; r < input_.runs->size(); ++r) {
      const Eigen::VectorXd along = multiplier_along(term, *input_.model, (*input_.fitted)[r], (*input_.runs)[r]);
      squares += along.squaredNorm();
      count += static_cast<double>(along.size());
    }
    const double rms = std::sqrt(squares / std::max(1.0, count));
    return {term, knots_of((*input_.drivers)[static_cast<std::size_t>(driver)]), kUsual_share * input_.mean_heat_W / std::max(1e-9, rms)};
  }

  /// Heat of every hat of every family, in units of the families' usual sizes.
  [[nodiscard]] Columns heats_W(const std::vector<Family>& families, std::size_t r) const {
    Eigen::Index width = 0;
    for (const Family& family : families) {
      width += static_cast<Eigen::Index>(family.knots.size());
    }
    const MeasuredRun& run = (*input_.runs)[r];
    const Eigen::VectorXd multiplier = multiplier_along(families.front().term, *input_.model, (*input_.fitted)[r], run);
    const double sign = is_taken_out(families.front().term.multiplier) ? -1.0 : 1.0;
    Columns heat_W = Columns::Zero(run.samples() - 1, width);
    Eigen::Index at = 0;
    for (const Family& family : families) {
      const Driver& driver = (*input_.drivers)[static_cast<std::size_t>(family.term.driver)];
      const auto size = static_cast<Eigen::Index>(family.knots.size());
      for (Eigen::Index k = 0; k < heat_W.rows(); ++k) {
        const double value = driver.values[r][k];
        if (driver.kind == DriverKind::run) {
          heat_W(k, at) = sign * family.usual * multiplier[k] * value;
        } else if (!std::isnan(value)) {
          heat_W.row(k).segment(at, size) = sign * family.usual * multiplier[k] * hats(family.knots, value).transpose();
        }
      }
      at += size;
    }
    return heat_W;
  }

  static bool is_taken_out(Multiplier multiplier) { return multiplier == Multiplier::excess || multiplier == Multiplier::difference; }

  std::vector<Scored> score(const std::vector<Family>& families, const FluxGrid::Place& place) {
    const LatentFlux flux = table_.grid().at(place);
    const ScanTerm& term = families.front().term;
    const int into = flux_of(*input_.model, term.node);
    const int other = term.other.empty() ? -1 : flux_of(*input_.model, term.other);
    const Eigen::Index inner = table_.free_count() + static_cast<Eigen::Index>(base_.candidates.size());
    std::vector<Eigen::Index> chosen;
    for (Eigen::Index i = 0; i < table_.free_count(); ++i) {
      chosen.push_back(i);
    }
    for (const int candidate : base_.candidates) {
      chosen.push_back(table_.free_count() + candidate);
    }
    std::vector<std::vector<RunEvidence>> evidence(input_.runs->size());
    in_parallel(input_.runs->size(), 0, [&](std::size_t r) {
      const DesignRun& design = table_.runs()[r];
      const Columns shown = response(*design.run, heats_W(families, r), into, other);
      evidence[r] = evidence_of(design, design.columns(Eigen::all, chosen), shown, families, flux);
    });
    std::vector<Scored> scored(families.size());
    const double base_nats = table_.score(base_.candidates, place).evidence_nats - table_.grid().log_prior_nats(place);
    for (std::size_t f = 0; f < families.size(); ++f) {
      std::vector<RunEvidence> of_family;
      for (const std::vector<RunEvidence>& of_run : evidence) {
        of_family.push_back(of_run[f]);
      }
      scored[f] = solve(of_family, families[f], inner);
      scored[f].gain_nats -= base_nats;
    }
    return scored;
  }

  /// One per family, of [inner, hats, residual]. All families share the whitening and what does not concern their hats; a wide
  /// QR would spend its time on products of families with each other, so triangles come from normal matrices here.
  static std::vector<RunEvidence> evidence_of(const DesignRun& design, const Columns& inner, const Columns& shown,
                                              const std::vector<Family>& families, const LatentFlux& flux) {
    const Eigen::Index starts = design.run->states;
    const Eigen::Index shared = starts + inner.cols() + 1;
    Columns all(shown.rows(), shared + shown.cols());
    all << design.run->by_start, inner, design.run->residual_K, shown;
    const Whitening whitening(*design.run, flux, design.noise);
    whitening.apply(all);
    Eigen::MatrixXd of_shared = all.leftCols(shared).transpose() * all.leftCols(shared);
    const Eigen::VectorXd precision = design.start.sd_K.cwiseAbs2().cwiseInverse();
    of_shared.topLeftCorner(starts, starts).diagonal() += precision;
    of_shared.topRightCorner(starts, 1) += precision.cwiseProduct(design.start.mean_K);
    of_shared(shared - 1, shared - 1) += design.start.mean_K.dot(precision.cwiseProduct(design.start.mean_K));
    const Eigen::MatrixXd across = all.leftCols(shared).transpose() * all.rightCols(shown.cols());
    std::vector<RunEvidence> evidence;
    Eigen::Index at = 0;
    for (const Family& family : families) {
      const auto size = static_cast<Eigen::Index>(family.knots.size());
      const auto hats = all.middleCols(shared + at, size);
      const Eigen::Index before = shared - 1;
      Eigen::MatrixXd normal(shared + size, shared + size);
      normal.topLeftCorner(before, before) = of_shared.topLeftCorner(before, before);
      normal.block(0, before, before, size) = across.block(0, at, before, size);
      normal.block(before, before, size, size) = hats.transpose() * hats;
      normal.block(0, before + size, before, 1) = of_shared.block(0, before, before, 1);
      normal.block(before, before + size, size, 1) = across.block(before, at, 1, size).transpose();
      normal(before + size, before + size) = of_shared(before, before);
      // A hat that no sample reaches has an empty column.
      normal.diagonal().array() += 1e-12 * normal.diagonal().maxCoeff();
      const Eigen::MatrixXd triangle = normal.selfadjointView<Eigen::Upper>().llt().matrixU();
      const Eigen::Index rest = inner.cols() + size + 1;
      const double start_logs =
          triangle.topLeftCorner(starts, starts).diagonal().array().log().sum() + design.start.sd_K.array().log().sum();
      evidence.push_back({triangle.bottomRightCorner(rest, rest), whitening.log_determinant() + 2.0 * start_logs, whitening.count()});
      at += size;
    }
    return evidence;
  }

  [[nodiscard]] Scored solve(const std::vector<RunEvidence>& evidence, const Family& family, Eigen::Index inner) const {
    const auto size = static_cast<Eigen::Index>(family.knots.size());
    const ThetaPrior prior = table_.prior_of(base_.candidates);
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(inner + size);
    Eigen::MatrixXd precision = Eigen::MatrixXd::Zero(inner + size, inner + size);
    mean.head(inner) = prior.mean;
    precision.topLeftCorner(inner, inner) = prior.precision;
    precision.bottomRightCorner(size, size) = curve_precision(size);
    const LinearFit fit = linear_fit(evidence, mean, precision);
    return {fit.log_evidence, family.usual * fit.coefficients.tail(size),
            family.usual * family.usual * fit.covariance.bottomRightCorner(size, size)};
  }

  /// To the unknown heat under which the term with its curve is best.
  void climb(ScanResult& result) {
    const Family own = family(result.term, result.term.driver);
    const double base_nats = base_.evidence_nats;
    const auto total = [&](const FluxGrid::Place& place, Scored& scored) {
      scored = score({own}, place).front();
      return scored.gain_nats + table_.score(base_.candidates, place).evidence_nats - base_nats;
    };
    Scored scored;
    for (bool moved = true; moved;) {
      moved = false;
      for (std::size_t axis = 0; axis < result.place.size(); ++axis) {
        const auto count =
            static_cast<int>(axis + 1 < result.place.size() ? table_.grid().rms_W.size() : table_.grid().time_scale_s.size());
        for (const int step : {-1, 1}) {
          FluxGrid::Place place = result.place;
          place[axis] += step;
          if (place[axis] < 0 || place[axis] >= count) {
            continue;
          }
          const double gain_nats = total(place, scored);
          if (gain_nats > result.gain_nats + 1e-6) {
            result = this->result(own, scored, place, gain_nats);
            moved = true;
            break;
          }
        }
      }
    }
  }

  [[nodiscard]] ScanResult result(const Family& family, const Scored& scored, const FluxGrid::Place& place, double gain_nats) const {
    ScanResult out{family.term, family.usual, gain_nats, family.knots, scored.curve, scored.covariance, 0.0, 0.0, place};
    std::vector<double> magnitude_W;
    const Driver& driver = (*input_.drivers)[static_cast<std::size_t>(family.term.driver)];
    for (std::size_t r = 0; r < input_.runs->size(); ++r) {
      const Eigen::VectorXd multiplier = multiplier_along(family.term, *input_.model, (*input_.fitted)[r], (*input_.runs)[r]);
      for (Eigen::Index k = 0; k < multiplier.size(); ++k) {
        const double value = driver.values[r][k];
        if (driver.kind == DriverKind::run ? value > 0.5 : !std::isnan(value)) {
          const double curve = driver.kind == DriverKind::run ? scored.curve[0] : scored.curve.dot(hats(family.knots, value));
          magnitude_W.push_back(std::abs(curve * multiplier[k]));
        }
      }
    }
    if (!magnitude_W.empty()) {
      for (const double each_W : magnitude_W) {
        out.mean_W += each_W / static_cast<double>(magnitude_W.size());
      }
      const std::size_t place_of_peak = magnitude_W.size() * 99 / 100;
      std::nth_element(magnitude_W.begin(), magnitude_W.begin() + static_cast<std::ptrdiff_t>(place_of_peak), magnitude_W.end());
      out.peak_W = magnitude_W[place_of_peak];
    }
    return out;
  }

  const ScanInput& input_;
  EvidenceTable& table_;
  const SetScore& base_;
};

}  // namespace

std::vector<ScanResult> scan_drivers(const ScanInput& input, EvidenceTable& table, const SetScore& base, int most) {
  return Scanner(input, table, base).run(most);
}

std::string_view unit_of(Multiplier multiplier) {
  switch (multiplier) {
    case Multiplier::source:
      return "W";
    case Multiplier::excess:
    case Multiplier::difference:
      return "W/K";
    case Multiplier::copper:
      return "";
  }
  return "";
}

std::string_view to_string(Multiplier multiplier) {
  switch (multiplier) {
    case Multiplier::source:
      return "heat";
    case Multiplier::excess:
      return "excess over ambient";
    case Multiplier::copper:
      return "copper loss";
    case Multiplier::difference:
      return "difference to the other node";
  }
  return "";
}

Eigen::VectorXd multiplier_along(const ScanTerm& term, const Model& model, const LinearisedRun& fitted, const MeasuredRun& run) {
  const int node = model.network.find_node(term.node);
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
  const int other = term.other.empty() ? -1 : model.network.find_node(term.other);
  for (Eigen::Index k = 0; k < along.size() && term.multiplier != Multiplier::source; ++k) {
    const double other_C = other >= 0 ? fitted.state_C(other, k) : run.at[static_cast<std::size_t>(k)].ambient_C;
    along[k] = fitted.state_C(node, k) - other_C;
  }
  return along;
}

Eigen::MatrixXd curve_precision(Eigen::Index knots) {
  Eigen::MatrixXd precision = Eigen::MatrixXd::Identity(knots, knots) * (knots > 1 ? 0.1 : 1.0);
  for (Eigen::Index i = 0; i + 1 < knots; ++i) {
    precision(i, i) += 2.0;
    precision(i + 1, i + 1) += 2.0;
    precision(i, i + 1) -= 2.0;
    precision(i + 1, i) -= 2.0;
  }
  return precision;
}

Eigen::VectorXd hats(const std::vector<double>& knots, double value) {
  Eigen::VectorXd all = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(knots.size()));
  if (knots.size() == 1 || value <= knots.front()) {
    all[0] = 1.0;
  } else if (value >= knots.back()) {
    all[all.size() - 1] = 1.0;
  } else {
    const auto right = std::ranges::upper_bound(knots, value) - knots.begin();
    const double share = (value - knots[static_cast<std::size_t>(right - 1)]) /
                         (knots[static_cast<std::size_t>(right)] - knots[static_cast<std::size_t>(right - 1)]);
    all[right - 1] = 1.0 - share;
    all[right] = share;
  }
  return all;
}

}  // namespace heatsoak
