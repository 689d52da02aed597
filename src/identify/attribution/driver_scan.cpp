#include "identify/attribution/driver_scan.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <set>

#include "base/parallel.h"
#include "identify/attribution/curve.h"

namespace heatsoak {
namespace {

/// All hats of a driver and what rounds them up to what is whitened at once.
using HatColumns = Eigen::Matrix<double, Eigen::Dynamic, kKnots + 1, Eigen::RowMajor>;
/// So many of the best curves may draw their knots together, by half and half again, where that explains more.
constexpr std::size_t kZoomed = 3;
constexpr int kHalvings = 3;
constexpr double kWorthZooming_nats = 10.0;
constexpr double kWorthKnots_nats = 5.0;
/// What two signals have to be ahead of one.
constexpr double kSecondSignal_nats = 20.0;
constexpr double kSecondSignal_share = 0.5;
/// Of the heat that the prior takes for usual, as a share of the mean heat.
constexpr double kUsual_share = 0.3;

/// With more evidence a curve is a part of the unknown heat whatever it leaves of it.
constexpr double kClear_nats = 50.0;

/// How the sensors answer to heats held over the intervals: `heat_W` (intervals × hats) into the node with place `flux`, out of `other`.
HatColumns response(const LinearisedRun& run, const HatColumns& heat_W, int flux, int other) {
  HatColumns shown = HatColumns::Zero(run.residual_K.size(), heat_W.cols());
  HatColumns state = HatColumns::Zero(run.states, heat_W.cols());
  HatColumns next = state;
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

struct Family {
  ScanTerm term;
  std::vector<double> knots;
  double usual = 1.0;
};

/// Losses go with two signals of the operation; what goes with a temperature besides is cooling. A temperature alone makes no heat: it says
/// how much moves, or how much of the copper's there is.
bool goes_with(const Driver& driver, Multiplier multiplier) {
  if (driver.kind == DriverKind::node_temperature && multiplier == Multiplier::source) {
    return false;
  }
  const std::string_view second = second_signal(multiplier);
  return second.empty() || (driver.kind == DriverKind::operating_point && driver.name != second);
}

struct Scored {
  double gain_nats = 0.0;
  Eigen::VectorXd curve;
  Eigen::MatrixXd covariance;
};

/// A family on its way to the unknown heat under which it is best.
struct Climber {
  Family family;
  Scored scored;
  FluxGrid::Place place;
};

/// What all families share in one run under one supposition about the unknown heat.
struct SharedRun {
  Whitening whitening;
  Columns columns;           ///< whitened: start temperatures, what is fitted already, residual
  Eigen::MatrixXd products;  ///< of the columns, the prior of the start temperatures included
};

class Scanner {
 public:
  Scanner(const ScanInput& input, const EvidenceTable& table, const SetScore& base) : input_(input), table_(table), base_(base) {
    for (Eigen::Index i = 0; i < table_.free_count(); ++i) {
      inner_.push_back(i);
    }
    for (const int candidate : base_.candidates) {
      inner_.push_back(table_.free_count() + candidate);
    }
  }

  void zoom(std::vector<ScanResult>& results) {
    in_parallel(std::min(kZoomed, results.size()), 0, [&](std::size_t i) {
      ScanResult& each = results[i];
      Climber climber{{each.term, each.knots, each.usual}, {each.gain_nats, each.curve, each.covariance}, each.place};
      zoom(climber);
      each = result(climber);
    });
    std::ranges::stable_sort(results, std::greater(), &ScanResult::gain_nats);
  }

  std::vector<ScanResult> run(int most) {
    if (input_.drivers->empty()) {
      return {};
    }
    constexpr double kAnyGain_nats = -std::numeric_limits<double>::infinity();
    std::vector<ScanResult> results = best_of(terms_of_one_signal(*input_.model, *input_.runs), most, base_.place, kAnyGain_nats);
    if (results.front().gain_nats > kWorthZooming_nats) {
      const double one_nats = results.front().gain_nats;
      const double least_nats = one_nats + std::max(kSecondSignal_nats, kSecondSignal_share * one_nats);
      // Beside the unknown heat that is best for one signal two must be ahead already.
      const FluxGrid::Place beside = results.front().place;
      for (ScanResult& each : best_of(terms_of_two_signals(*input_.model, *input_.runs), most, beside, one_nats)) {
        if (each.gain_nats > least_nats) {
          results.push_back(std::move(each));
        }
      }
      std::ranges::stable_sort(results, std::greater(), &ScanResult::gain_nats);
      results.resize(std::min(results.size(), static_cast<std::size_t>(most)));
    }
    return results;
  }

 private:
  /// Every driver for each of the terms, from the unknown heat at `begin` on; those that gain less there than `least_nats` go no further,
  /// and at most `most` come back.
  std::vector<ScanResult> best_of(const std::vector<ScanTerm>& terms, int most, const FluxGrid::Place& begin, double least_nats) {
    std::vector<Climber> climbers;
    for (const ScanTerm& term : terms) {
      const std::vector<Eigen::VectorXd> multiplier = multipliers(term);
      const std::size_t first = climbers.size();
      for (std::size_t driver = 0; driver < input_.drivers->size(); ++driver) {
        if (goes_with((*input_.drivers)[driver], term.multiplier)) {
          climbers.push_back({family(term, static_cast<int>(driver), multiplier), {}, begin});
        }
      }
      in_parallel(climbers.size() - first, 0, [&](std::size_t i) {
        Climber& climber = climbers[first + i];
        climber.scored = score(climber.family, responses(climber.family, multiplier), climber.place);
      });
    }
    const auto keep_best = [&climbers](int count) {
      std::ranges::stable_sort(climbers, [](const Climber& a, const Climber& b) { return a.scored.gain_nats > b.scored.gain_nats; });
      climbers.resize(std::min<std::size_t>(climbers.size(), static_cast<std::size_t>(count)));
    };
    std::erase_if(climbers, [&](const Climber& each) { return each.scored.gain_nats < least_nats; });
    keep_best(2 * most);
    in_parallel(climbers.size(), 0, [&](std::size_t i) { climb(climbers[i]); });
    keep_best(most);
    std::vector<ScanResult> results;
    for (const Climber& each : climbers) {
      results.push_back(result(each));
    }
    return results;
  }

  [[nodiscard]] std::vector<Eigen::VectorXd> multipliers(const ScanTerm& term) const {
    std::vector<Eigen::VectorXd> along;
    for (std::size_t r = 0; r < input_.runs->size(); ++r) {
      along.push_back(multiplier_along(term, *input_.model, (*input_.fitted)[r], (*input_.runs)[r]));
    }
    return along;
  }

  Family family(ScanTerm term, int driver, const std::vector<Eigen::VectorXd>& multiplier) const {
    term.driver = driver;
    double squares = 0.0;
    double count = 0.0;
    for (const Eigen::VectorXd& along : multiplier) {
      squares += along.squaredNorm();
      count += static_cast<double>(along.size());
    }
    const double rms = std::sqrt(squares / std::max(1.0, count));
    return {term, knots_over((*input_.drivers)[static_cast<std::size_t>(driver)]), kUsual_share * input_.mean_heat_W / std::max(1e-9, rms)};
  }

  /// Heat of every hat along a run, in units of the family's usual size.
  [[nodiscard]] HatColumns heats_W(const Family& family, const Eigen::VectorXd& multiplier, std::size_t r) const {
    const double sign = is_taken_out(family.term.multiplier) ? -1.0 : 1.0;
    const DesignRun& design = table_.runs()[r];
    const Driver& driver = (*input_.drivers)[static_cast<std::size_t>(family.term.driver)];
    HatColumns heat_W = HatColumns::Zero(design.run.samples() - 1, kKnots + 1);
    for (Eigen::Index k = 0; k < multiplier.size(); ++k) {
      const double value = driver.values[r][k];
      const Eigen::Index row = design.interval_of[static_cast<std::size_t>(k)];
      if (row < 0 || std::isnan(value)) {
        continue;
      }
      const double share =
          (*input_.fitted)[r].duration_s[static_cast<std::size_t>(k)] / design.run.duration_s[static_cast<std::size_t>(row)];
      const double usual_W = sign * share * family.usual * multiplier[k];
      const HatsAt hats = hats_at(family.knots, value);
      heat_W(row, hats.left) += usual_W * (1.0 - hats.right_share);
      heat_W(row, hats.left + 1) += usual_W * hats.right_share;
    }
    return heat_W;
  }

  static bool is_taken_out(Multiplier multiplier) { return multiplier == Multiplier::excess || multiplier == Multiplier::difference; }

  /// Per run, how the sensors answer to every hat.
  [[nodiscard]] std::vector<HatColumns> responses(const Family& family, const std::vector<Eigen::VectorXd>& multiplier) const {
    const int into = flux_of(*input_.model, family.term.node);
    const int other = family.term.other.empty() ? -1 : flux_of(*input_.model, family.term.other);
    std::vector<HatColumns> shown;
    for (std::size_t r = 0; r < multiplier.size(); ++r) {
      shown.push_back(response(table_.runs()[r].run, heats_W(family, multiplier[r], r), into, other));
    }
    return shown;
  }

  const std::vector<SharedRun>& shared_at(const FluxGrid::Place& place) {
    Shared* shared = nullptr;
    {
      const std::lock_guard lock(mutex_);
      shared = &shared_[place];
    }
    // Others that look at other places go on meanwhile.
    std::call_once(shared->is_made, [&] { shared->run = make_shared_runs(table_.grid().at(place)); });
    return shared->run;
  }

  [[nodiscard]] std::vector<SharedRun> make_shared_runs(const LatentFlux& flux) const {
    std::vector<SharedRun> shared;
    for (const DesignRun& design : table_.runs()) {
      shared.push_back({Whitening(design.run, flux, design.noise), {}, {}});
      const Eigen::Index starts = design.run.states;
      Columns& columns = shared.back().columns;
      columns.resize(design.columns.rows(), starts + static_cast<Eigen::Index>(inner_.size()) + 1);
      columns << design.run.by_start, design.columns(Eigen::all, inner_), design.run.residual_K;
      shared.back().whitening.apply(columns);
      Eigen::MatrixXd& products = shared.back().products;
      products = columns.transpose() * columns;
      const Eigen::VectorXd precision = design.start.sd_K.cwiseAbs2().cwiseInverse();
      const Eigen::Index last = columns.cols() - 1;
      products.topLeftCorner(starts, starts).diagonal() += precision;
      products.topRightCorner(starts, 1) += precision.cwiseProduct(design.start.mean_K);
      products(last, last) += design.start.mean_K.dot(precision.cwiseProduct(design.start.mean_K));
    }
    return shared;
  }

  /// Its gain over the base at the base's own best place.
  Scored score(const Family& family, const std::vector<HatColumns>& shown, const FluxGrid::Place& place) {
    const std::vector<SharedRun>& shared = shared_at(place);
    std::vector<RunEvidence> evidence;
    for (std::size_t r = 0; r < shown.size(); ++r) {
      evidence.push_back(evidence_of(table_.runs()[r], shared[r], shown[r], static_cast<Eigen::Index>(family.knots.size())));
    }
    Scored scored = solve(evidence, family);
    scored.gain_nats += table_.grid().log_prior_nats(place) - base_.evidence_nats;
    return scored;
  }

  /// Of [inner, hats, residual]. All families share the whitening and what does not concern their hats; a QR would spend its time on
  /// that, so triangles come from normal matrices here.
  static RunEvidence evidence_of(const DesignRun& design, const SharedRun& common, HatColumns shown, Eigen::Index size) {
    common.whitening.apply(shown);
    const auto hats = shown.leftCols(size);
    const Eigen::Index starts = design.run.states;
    const Eigen::Index shared = common.columns.cols();
    const Eigen::Index before = shared - 1;
    const Eigen::MatrixXd across = common.columns.transpose() * hats;
    Eigen::MatrixXd normal(shared + size, shared + size);
    normal.topLeftCorner(before, before) = common.products.topLeftCorner(before, before);
    normal.block(0, before, before, size) = across.topRows(before);
    normal.block(before, before, size, size) = hats.transpose() * hats;
    normal.block(0, before + size, before, 1) = common.products.block(0, before, before, 1);
    normal.block(before, before + size, size, 1) = across.bottomRows(1).transpose();
    normal(before + size, before + size) = common.products(before, before);
    // A hat that no sample reaches has an empty column.
    normal.diagonal().array() += 1e-12 * normal.diagonal().maxCoeff();
    const Eigen::MatrixXd triangle = normal.selfadjointView<Eigen::Upper>().llt().matrixU();
    const Eigen::Index rest = shared - starts + size;
    const double start_logs = triangle.topLeftCorner(starts, starts).diagonal().array().log().sum() + design.start.sd_K.array().log().sum();
    return {triangle.bottomRightCorner(rest, rest), common.whitening.log_determinant() + 2.0 * start_logs, common.whitening.count()};
  }

  [[nodiscard]] Scored solve(const std::vector<RunEvidence>& evidence, const Family& family) const {
    const auto size = static_cast<Eigen::Index>(family.knots.size());
    const auto inner = static_cast<Eigen::Index>(inner_.size());
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

  /// To the unknown heat under which the term with its curve is best, and to the knots that show the curve best.
  void climb(Climber& climber) {
    const std::vector<Eigen::VectorXd> multiplier = multipliers(climber.family.term);
    climb(climber, multiplier);
    const Driver& driver = (*input_.drivers)[static_cast<std::size_t>(climber.family.term.driver)];
    for (const Driver::Range& range : driver.inner) {
      take_better_knots(climber, {range}, 0.0, multiplier);
    }
  }

  /// Knots where something happens: a thermostat or a resonance is narrower than a seventh of all that the driver does.
  void zoom(Climber& climber) {
    const std::vector<Eigen::VectorXd> multiplier = multipliers(climber.family.term);
    for (int half = 0; half < kHalvings && climber.scored.gain_nats > kWorthZooming_nats; ++half) {
      const double low = climber.family.knots.front();
      const double high = climber.family.knots.back();
      const double quarter = 0.25 * (high - low);
      const std::vector<Driver::Range> halves{{low, high - 2.0 * quarter}, {low + quarter, high - quarter}, {low + 2.0 * quarter, high}};
      if (!take_better_knots(climber, halves, kWorthKnots_nats, multiplier)) {
        return;
      }
    }
  }

  /// True where knots over one of the ranges explain more than a given gain.
  bool take_better_knots(Climber& climber, const std::vector<Driver::Range>& ranges, double by_nats,
                         const std::vector<Eigen::VectorXd>& multiplier) {
    const Driver& driver = (*input_.drivers)[static_cast<std::size_t>(climber.family.term.driver)];
    std::optional<Climber> best;
    double least_nats = climber.scored.gain_nats + by_nats;
    for (const Driver::Range& range : ranges) {
      Climber other = climber;
      other.family.knots = knots_between(range, driver.kind);
      other.scored = score(other.family, responses(other.family, multiplier), other.place);
      if (other.scored.gain_nats > least_nats) {
        least_nats = other.scored.gain_nats;
        best = std::move(other);
      }
    }
    if (!best) {
      return false;
    }
    climb(*best, multiplier);
    climber = std::move(*best);
    return true;
  }

  void climb(Climber& climber, const std::vector<Eigen::VectorXd>& multiplier) {
    const std::vector<HatColumns> shown = responses(climber.family, multiplier);
    std::set<FluxGrid::Place> tried{climber.place};
    for (bool moved = true; moved;) {
      moved = false;
      for (std::size_t axis = 0; axis < climber.place.size(); ++axis) {
        const auto count =
            static_cast<int>(axis + 1 < climber.place.size() ? table_.grid().rms_W.size() : table_.grid().time_scale_s.size());
        for (const int step : {-1, 1}) {
          FluxGrid::Place place = climber.place;
          place[axis] += step;
          if (place[axis] < 0 || place[axis] >= count || !tried.insert(place).second) {
            continue;
          }
          Scored scored = score(climber.family, shown, place);
          if (scored.gain_nats > climber.scored.gain_nats + 1e-6) {
            climber.scored = std::move(scored);
            climber.place = std::move(place);
            moved = true;
            break;
          }
        }
      }
    }
  }

  [[nodiscard]] ScanResult result(const Climber& climber) const {
    const Family& family = climber.family;
    const Scored& scored = climber.scored;
    ScanResult out{family.term, family.usual, scored.gain_nats, family.knots, scored.curve, scored.covariance,
                   0.0,         0.0,          climber.place,    false};
    // Of heat that follows no signal some curve always takes a little.
    out.leaves_heat =
        scored.gain_nats < kClear_nats && table_.grid().leaves_heat(base_.place, climber.place, flux_of(*input_.model, family.term.node));
    std::vector<double> magnitude_W;
    const Driver& driver = (*input_.drivers)[static_cast<std::size_t>(family.term.driver)];
    const std::vector<Eigen::VectorXd> multiplier = multipliers(family.term);
    for (std::size_t r = 0; r < multiplier.size(); ++r) {
      for (Eigen::Index k = 0; k < multiplier[r].size(); ++k) {
        const double value = driver.values[r][k];
        if (!std::isnan(value)) {
          magnitude_W.push_back(std::abs(value_at(family.knots, scored.curve, value) * multiplier[r][k]));
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
  const EvidenceTable& table_;
  const SetScore& base_;
  std::mutex mutex_;
  std::vector<Eigen::Index> inner_;  ///< columns of the table that the base fits
  struct Shared {
    std::once_flag is_made;
    std::vector<SharedRun> run;
  };
  std::map<FluxGrid::Place, Shared> shared_;
};

}  // namespace

void zoom_in(const ScanInput& input, EvidenceTable& table, const SetScore& base, std::vector<ScanResult>& results) {
  Scanner(input, table, base).zoom(results);
}

std::vector<ScanResult> scan_drivers(const ScanInput& input, EvidenceTable& table, const SetScore& base, int most) {
  return Scanner(input, table, base).run(most);
}

}  // namespace heatsoak
