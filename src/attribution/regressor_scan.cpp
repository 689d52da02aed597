#include "attribution/regressor_scan.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <span>

#include "attribution/curve.h"
#include "base/parallel.h"
#include "base/signals.h"
#include "estimation/heat_response.h"
#include "estimation/left_out_runs.h"
#include "estimation/size_evidence.h"
#include "estimation/thresholds.h"

namespace heatsoak::attribution {
namespace {

/// Hat functions of a signal, padded to the number of columns that are whitened at once.
using HatColumns = Eigen::Matrix<double, Eigen::Dynamic, kKnots + 1, Eigen::RowMajor>;
/// Prior standard deviation of a curve's heat, as a fraction of the mean heat.
constexpr double kUsual_share = 0.3;

/// True if a curve over `regressor` may be multiplied by `multiplier`. A loss may depend on two operating signals, but not on a signal and
/// its magnitude. Heat that depends on a temperature is cooling, or a copper or current loss that varies with that temperature.
bool goes_with(const Regressor& regressor, Multiplier multiplier) {
  if (regressor.kind == RegressorKind::node_temperature && multiplier == Multiplier::source) {
    return false;
  }
  const std::string_view second = spec_of(multiplier).second_signal;
  const std::size_t row = base::signal_row(regressor.name);
  return second.empty() || (regressor.kind == RegressorKind::operating_point && regressor.name != second &&
                            (row == base::kSignals.size() || base::kSignals[row].magnitude != second));
}

/// Evidence of a curve with its most probable subset and unknown heat.
struct Scored {
  double nats = -std::numeric_limits<double>::infinity();  ///< ln P, including the priors of the members
  std::size_t subset = 0;
  estimation::FluxPlace place;
};

/// A curve: term, signal and knots.
struct Family {
  ScanTerm term;
  std::vector<double> knots;
  double usual = 1.0;
  std::vector<Eigen::VectorXd> multiplier;  ///< per run
  std::vector<HatColumns> shown;            ///< per run, response to every hat at its typical size
  Scored scored;
};

/// Data of one run that all curves use, under one assumed unknown heat.
struct SharedRun {
  estimation::Whitening whitening;
  estimation::Columns columns;  ///< whitened: start temperatures, θ, members, residual
  Eigen::MatrixXd products;     ///< whitened columns times themselves, with the prior of the start temperatures
};

class Scanner {
 public:
  Scanner(const ScanInput& input, const SelectionRules& rules)
      : input_(input),
        rules_(rules),
        precision_(curve_precision(kKnots, rules)),
        members_(static_cast<Eigen::Index>(input.members.size())),
        set_(columns_of(input.members, *input.rules, rules.size_sd)),
        subsets_(std::size_t{1} << input.members.size()) {
    const Eigen::Index own = input.prior.mean.size();
    const Eigen::Index more = set_.precision.size() - members_;
    prior_.mean = Eigen::VectorXd::Zero(own + more);
    prior_.mean.head(own) = input.prior.mean;
    prior_.precision = Eigen::MatrixXd::Zero(own + more, own + more);
    prior_.precision.topLeftCorner(own, own) = input.prior.precision;
    prior_.precision.diagonal().tail(more) = set_.precision.tail(more);
    for (Eigen::Index& column : set_.columns) {
      column += own;
    }
  }

  std::vector<ScanResult> run(std::size_t most) {
    constexpr std::size_t kClimbed = 12;
    constexpr std::size_t kZoomed = 4;
    std::vector<Family> families = all_families();
    const double without_nats = best_without_nats();
    const std::vector<estimation::FluxPlace> places = beginnings();
    std::ranges::for_each(places, [&](const estimation::FluxPlace& place) { (void)shared_at(place); });
    base::in_parallel(families.size(), 0, [&](std::size_t i) {
      set_responses(families[i]);
      for (const estimation::FluxPlace& place : places) {
        take_better(families[i], score(families[i], shared_.at(place), place));
      }
      // The responses of all curves together take 100 MB; those of the best are computed again.
      families[i].shown.clear();
    });
    const auto keep_best = [&families](std::size_t count) {
      std::ranges::stable_sort(families, std::greater(), [](const Family& each) { return each.scored.nats; });
      families.resize(std::min(families.size(), count));
    };
    keep_best(kClimbed);
    base::in_parallel(families.size(), 0, [&](std::size_t i) { set_responses(families[i]); });
    for (Family& each : families) {
      climb(each);
    }
    keep_best(most);
    for (std::size_t i = 0; i < std::min(kZoomed, families.size()); ++i) {
      zoom(families[i]);
    }
    keep_best(most);
    std::vector<ScanResult> results;
    for (const Family& each : families) {
      results.push_back(result(each, without_nats));
    }
    return results;
  }

 private:
  std::vector<Family> all_families() const {
    std::vector<Family> families;
    for (const ScanTerm& term : scan_terms(*input_.model, *input_.runs)) {
      std::vector<Eigen::VectorXd> multiplier;
      double squares = 0.0;
      double count = 0.0;
      for (std::size_t r = 0; r < input_.runs->size(); ++r) {
        multiplier.push_back(multiplier_along(term, *input_.model, (*input_.fitted)[r], (*input_.runs)[r]));
        squares += multiplier.back().squaredNorm();
        count += static_cast<double>(multiplier.back().size());
      }
      const double usual = kUsual_share * input_.mean_heat_W / std::max(1e-9, std::sqrt(squares / std::max(1.0, count)));
      for (std::size_t regressor = 0; regressor < input_.regressors->size(); ++regressor) {
        const Regressor& of = (*input_.regressors)[regressor];
        if (!goes_with(of, term.multiplier)) {
          continue;
        }
        std::vector<std::vector<double>> knots{knots_between({of.low, of.high}, of.kind)};
        for (const Regressor::Range& range : of.inner) {
          knots.push_back(knots_between(range, of.kind));
        }
        for (std::vector<double>& each : knots) {
          Family family{term, std::move(each), usual, multiplier, {}, {}};
          family.term.regressor = static_cast<int>(regressor);
          families.push_back(std::move(family));
        }
      }
    }
    return families;
  }

  /// Returns the given grid points, and points with far less unknown heat: a correct curve leaves little of it.
  [[nodiscard]] std::vector<estimation::FluxPlace> beginnings() const {
    constexpr int kLess = 2;
    std::vector<estimation::FluxPlace> all = input_.places;
    for (estimation::FluxPlace place : input_.places) {
      for (std::size_t axis = 0; axis + 1 < place.size(); ++axis) {
        place[axis] = std::max(0, place[axis] - kLess);
      }
      all.push_back(std::move(place));
    }
    std::ranges::sort(all);
    const auto [first, last] = std::ranges::unique(all);
    all.erase(first, last);
    return all;
  }

  static void take_better(Family& family, Scored&& other) {
    if (other.nats > family.scored.nats) {
      family.scored = std::move(other);
    }
  }

  /// Moves to the most probable unknown heat for the curve.
  void climb(Family& family) {
    (void)estimation::most_probable(input_.grid, family.scored.place, [&](const estimation::FluxPlace& place) {
      Scored scored = score(family, shared_at(place), place);
      const double nats = scored.nats;
      take_better(family, std::move(scored));
      return nats;
    });
  }

  /// Concentrates the knots: a thermostat or a resonance is narrower than a seventh of the signal's range.
  void zoom(Family& family) {
    constexpr int kHalvings = 3;
    const Regressor& regressor = (*input_.regressors)[static_cast<std::size_t>(family.term.regressor)];
    for (int half = 0; half < kHalvings; ++half) {
      const double low = family.knots.front();
      const double quarter = 0.25 * (family.knots.back() - low);
      std::vector<Family> narrower;
      for (const double begin : {0.0, 1.0, 2.0}) {
        Family& other = narrower.emplace_back(family);
        other.knots = knots_between({low + begin * quarter, low + (begin + 2.0) * quarter}, regressor.kind);
        other.shown.clear();
        other.scored = {};
      }
      const std::vector<SharedRun>& shared = shared_at(family.scored.place);
      base::in_parallel(narrower.size(), 0, [&](std::size_t i) {
        set_responses(narrower[i]);
        take_better(narrower[i], score(narrower[i], shared, family.scored.place));
      });
      Family& best = *std::ranges::max_element(narrower, {}, [](const Family& each) { return each.scored.nats; });
      if (best.scored.nats < family.scored.nats + estimation::thresholds().distinct_nats) {
        return;
      }
      climb(best);
      family = std::move(best);
    }
  }

  /// Returns ln P of the best subset without a curve, at its own unknown heat.
  double best_without_nats() {
    double best_nats = -std::numeric_limits<double>::infinity();
    for (const estimation::FluxPlace& start : input_.places) {
      (void)estimation::most_probable(input_.grid, start, [&](const estimation::FluxPlace& place) {
        const estimation::Products sum = estimation::sum_of(without_starts(nullptr, shared_at(place)));
        const double own_nats = best_subset(estimation::reduced(sum, prior_), false, place).nats;
        best_nats = std::max(best_nats, own_nats);
        return own_nats;
      });
    }
    return best_nats;
  }

  void set_responses(Family& family) const {
    const int into = flux_of(*input_.model, family.term.node).value();
    const std::optional<int> other = family.term.other.empty() ? std::nullopt : flux_of(*input_.model, family.term.other);
    for (std::size_t r = 0; r < input_.runs->size(); ++r) {
      family.shown.push_back(estimation::heat_response((*input_.designs)[r].run, heats_W(family, r), into, other));
    }
  }

  /// Returns the heat of every hat along a run at the family's typical size.
  [[nodiscard]] HatColumns heats_W(const Family& family, std::size_t r) const {
    const double sign = spec_of(family.term.multiplier).is_conductance ? -1.0 : 1.0;
    const estimation::DesignRun& design = (*input_.designs)[r];
    const Regressor& regressor = (*input_.regressors)[static_cast<std::size_t>(family.term.regressor)];
    HatColumns heat_W = HatColumns::Zero(design.run.samples() - 1, kKnots + 1);
    for (Eigen::Index k = 0; k < family.multiplier[r].size(); ++k) {
      const double value = regressor.values[r][k];
      const std::optional<Eigen::Index> interval = design.interval_of[static_cast<std::size_t>(k)];
      if (!interval || std::isnan(value)) {
        continue;
      }
      const Eigen::Index row = *interval;
      const double share =
          (*input_.fitted)[r].duration_s[static_cast<std::size_t>(k)] / design.run.duration_s[static_cast<std::size_t>(row)];
      const double usual_W = sign * share * family.usual * family.multiplier[r][k];
      const HatsAt hats = hats_at(family.knots, value);
      heat_W(row, hats.left) += usual_W * (1.0 - hats.right_share);
      heat_W(row, hats.left + 1) += usual_W * hats.right_share;
    }
    return heat_W;
  }

  const std::vector<SharedRun>& shared_at(const estimation::FluxPlace& place) {
    const auto found = shared_.find(place);
    return found != shared_.end() ? found->second : shared_[place] = made_at(input_.grid.at(place));
  }

  [[nodiscard]] std::vector<SharedRun> made_at(const estimation::LatentFlux& flux) const {
    std::vector<SharedRun> shared;
    for (const estimation::DesignRun& design : *input_.designs) {
      shared.push_back({estimation::Whitening(design.run, flux, design.noise), {}, {}});
      const Eigen::Index starts = design.run.states;
      const Eigen::Index own = input_.prior.mean.size();
      const Eigen::Index more = prior_.mean.size() - own;
      const std::span<const Eigen::Index> set(set_.columns);
      estimation::Columns& columns = shared.back().columns;
      columns.resize(design.columns.rows(), starts + own + more + members_ + 1);
      columns.leftCols(starts) = design.run.by_start;
      columns.middleCols(starts, own) = design.columns.leftCols(own);
      columns.middleCols(starts + own, more) = design.columns(Eigen::all, set.last(static_cast<std::size_t>(more)));
      columns.middleCols(starts + own + more, members_) = design.columns(Eigen::all, set.first(static_cast<std::size_t>(members_)));
      columns.rightCols<1>() = design.run.residual_K;
      shared.back().whitening.apply(columns);
      Eigen::MatrixXd& products = shared.back().products;
      products = columns.transpose() * columns;
      estimation::add_start_prior(design.start, products);
    }
    return shared;
  }

  [[nodiscard]] std::vector<Eigen::Index> members_of(std::size_t subset) const {
    std::vector<Eigen::Index> members;
    for (Eigen::Index m = 0; m < members_; ++m) {
      if ((subset >> m & 1U) != 0) {
        members.push_back(m);
      }
    }
    return members;
  }

  /// Returns the ln evidence of a subset of the members, with or without the curve, minus that of no member. Writes the sizes (curve last)
  /// to `sizes` if it is set.
  [[nodiscard]] double gain_of(const estimation::Reduced& all, std::size_t subset, bool with_curve,
                               Eigen::VectorXd* sizes = nullptr) const {
    std::vector<Eigen::Index> places = members_of(subset);
    const auto members = static_cast<Eigen::Index>(places.size());
    std::vector<bool> has_sign;
    for (const Eigen::Index place : places) {
      has_sign.push_back(set_.has_sign[static_cast<std::size_t>(place)]);
    }
    for (Eigen::Index hat = 0; with_curve && hat < kKnots; ++hat) {
      places.push_back(members_ + hat);
      has_sign.push_back(false);
    }
    const auto count = static_cast<Eigen::Index>(places.size());
    Eigen::MatrixXd precision = Eigen::MatrixXd::Zero(count, count);
    precision.diagonal().head(members).setConstant(1.0 / (rules_.size_sd * rules_.size_sd));
    if (with_curve) {
      precision.bottomRightCorner(kKnots, kKnots) = precision_;
    }
    return estimation::size_gain_nats(all.products(places, places), all.right(places), precision, has_sign, sizes);
  }

  /// Returns the products of a run with the hats of a family between the members and the residual.
  [[nodiscard]] static Eigen::MatrixXd with_hats(const SharedRun& shared, HatColumns shown) {
    shared.whitening.apply(shown);
    const auto hats = shown.leftCols<kKnots>();
    const Eigen::Index before = shared.columns.cols() - 1;
    const Eigen::MatrixXd across = shared.columns.transpose() * hats;
    Eigen::MatrixXd square(before + kKnots + 1, before + kKnots + 1);
    square.topLeftCorner(before, before) = shared.products.topLeftCorner(before, before);
    square.block(0, before, before, kKnots) = across.topRows(before);
    square.block(before, 0, kKnots, before) = across.topRows(before).transpose();
    square.block(before, before, kKnots, kKnots).noalias() = hats.transpose() * hats;
    square.block(0, before + kKnots, before, 1) = shared.products.block(0, before, before, 1);
    square.block(before + kKnots, 0, 1, before) = shared.products.block(before, 0, 1, before);
    square.block(before, before + kKnots, kKnots, 1) = across.bottomRows(1).transpose();
    square.block(before + kKnots, before, 1, kKnots) = across.bottomRows(1);
    square(before + kKnots, before + kKnots) = shared.products(before, before);
    return square;
  }

  /// Returns the products of every run without its start temperatures; with the hats of a family, if there is one.
  [[nodiscard]] std::vector<estimation::Products> without_starts(const Family* family, const std::vector<SharedRun>& shared) const {
    std::vector<estimation::Products> parts(shared.size());
    for (std::size_t r = 0; r < shared.size(); ++r) {
      estimation::add_without_starts(family ? with_hats(shared[r], family->shown[r]) : shared[r].products, (*input_.designs)[r],
                                     shared[r].whitening, parts[r]);
    }
    return parts;
  }

  [[nodiscard]] Scored best_subset(const estimation::Reduced& all, bool with_curve, const estimation::FluxPlace& place) const {
    Scored best;
    for (std::size_t subset = 0; subset < subsets_; ++subset) {
      const double nats = all.base_nats + gain_of(all, subset, with_curve) + prior_of(subset);
      if (nats > best.nats) {
        best = {nats, subset, place};
      }
    }
    return best;
  }

  [[nodiscard]] Scored score(const Family& family, const std::vector<SharedRun>& shared, const estimation::FluxPlace& place) const {
    Scored best = best_subset(estimation::reduced(estimation::sum_of(without_starts(&family, shared)), prior_), true, place);
    const double signals = spec_of(family.term.multiplier).second_signal.empty() ? 1.0 : 2.0;
    best.nats += signals * rules_.curve_nats;
    return best;
  }

  [[nodiscard]] double prior_of(std::size_t subset) const {
    double nats = 0.0;
    for (const Eigen::Index member : members_of(subset)) {
      nats += (*input_.rules)[static_cast<std::size_t>(input_.members[static_cast<std::size_t>(member)])].prior_nats;
    }
    return nats;
  }

  [[nodiscard]] ScanResult result(const Family& family, double without_nats) {
    const std::size_t subset = family.scored.subset;
    ScanResult out;
    out.term = family.term;
    out.usual = family.usual;
    out.knots = family.knots;
    out.gain_nats = family.scored.nats - without_nats;
    const std::vector<estimation::Products> parts = without_starts(&family, shared_at(family.scored.place));
    const estimation::Reduced at = estimation::reduced(estimation::sum_of(parts), prior_);
    Eigen::VectorXd sizes;
    (void)gain_of(at, subset, true, &sizes);
    const Eigen::VectorXd hats = sizes.tail<kKnots>();
    out.curve = family.usual * hats;
    const Eigen::MatrixXd by_hats = at.products.block(members_, members_, kKnots, kKnots);
    out.curve_sd = family.usual * (by_hats + precision_).inverse().diagonal().cwiseSqrt();
    for (const Eigen::Index member : members_of(subset)) {
      out.beside.push_back(static_cast<int>(member));
    }
    const auto left_out_nats = [&](const std::vector<estimation::Products>& all, std::size_t members, bool with_curve) {
      return estimation::left_out_nats(estimation::by_recording(all, *input_.runs), prior_, [&](const estimation::Reduced& rest) {
        return rest.base_nats + gain_of(rest, members, with_curve);
      });
    };
    const std::vector<estimation::Products> bare = without_starts(nullptr, shared_at(family.scored.place));
    const Scored rival = best_subset(estimation::reduced(estimation::sum_of(bare), prior_), false, family.scored.place);
    out.left_out_gain_nats = left_out_nats(parts, subset, true) - left_out_nats(bare, rival.subset, false);
    set_heat(family, out);
    return out;
  }

  /// Sets the mean and the largest magnitude of the curve's heat.
  void set_heat(const Family& family, ScanResult& out) const {
    const Regressor& regressor = (*input_.regressors)[static_cast<std::size_t>(family.term.regressor)];
    double count = 0.0;
    for (std::size_t r = 0; r < family.multiplier.size(); ++r) {
      for (Eigen::Index k = 0; k < family.multiplier[r].size(); ++k) {
        if (const double value = regressor.values[r][k]; !std::isnan(value)) {
          const double heat_W = std::abs(value_at(family.knots, out.curve, value) * family.multiplier[r][k]);
          out.mean_W += heat_W;
          out.peak_W = std::max(out.peak_W, heat_W);
          count += 1.0;
        }
      }
    }
    out.mean_W /= std::max(1.0, count);
  }

  const ScanInput& input_;
  const SelectionRules& rules_;
  Eigen::MatrixXd precision_;
  Eigen::Index members_;  ///< number of effects in the best set
  SetColumns set_;        ///< their columns in the design, then those of their companions, which are free in every subset
  std::size_t subsets_;
  estimation::ThetaPrior prior_;  ///< prior of θ and the companions
  std::map<estimation::FluxPlace, std::vector<SharedRun>> shared_;
};

}  // namespace

std::vector<ScanResult> scan_regressors(const ScanInput& input, const SelectionRules& rules, std::size_t most) {
  return input.regressors->empty() ? std::vector<ScanResult>() : Scanner(input, rules).run(most);
}

}  // namespace heatsoak::attribution
