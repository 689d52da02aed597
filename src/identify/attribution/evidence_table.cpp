#include "identify/attribution/evidence_table.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/parallel.h"

namespace heatsoak {

LatentFlux FluxGrid::at(const Place& place) const {
  LatentFlux flux;
  for (std::size_t node = 0; node + 1 < place.size(); ++node) {
    flux.rms_W.push_back(rms_W[static_cast<std::size_t>(place[node])]);
  }
  flux.time_scale_s = time_scale_s[static_cast<std::size_t>(place.back())];
  return flux;
}

double FluxGrid::log_prior_nats(const Place& place) const {
  constexpr double kUnusual_share = 0.1;
  static const double decay = -std::log(0.05) / kUnusual_share;
  double nats = 0.0;
  for (std::size_t node = 0; node + 1 < place.size() && mean_heat_W > 0.0; ++node) {
    nats -= decay * rms_W[static_cast<std::size_t>(place[node])] / mean_heat_W;
  }
  return nats;
}

bool FluxGrid::leaves_heat(const Place& before, const Place& with, int flux) const {
  constexpr double kTolerable_share = 0.05;
  constexpr double kPlainlyLess_share = 0.3;
  const auto unknown_W = [&](const Place& place) {
    const std::vector<double> each_W = at(place).rms_W;
    return flux < 0 ? std::accumulate(each_W.begin(), each_W.end(), 0.0) : each_W[static_cast<std::size_t>(flux)];
  };
  const double left_W = unknown_W(with);
  return left_W > kTolerable_share * mean_heat_W && left_W > kPlainlyLess_share * unknown_W(before);
}

FluxGrid FluxGrid::finer() const {
  const auto between = [](std::span<const double> values) {
    std::vector<double> all;
    for (const double value : values) {
      if (!all.empty()) {
        all.push_back(std::sqrt(all.back() * value));
      }
      all.push_back(value);
    }
    return all;
  };
  FluxGrid grid{{rms_W.front()}, between(time_scale_s), mean_heat_W};
  const std::vector<double> strengths_W = between(std::span(rms_W).subspan(1));
  grid.rms_W.insert(grid.rms_W.end(), strengths_W.begin(), strengths_W.end());
  return grid;
}

FluxGrid::Place FluxGrid::in_finer(Place place) {
  std::for_each(place.begin(), place.end() - 1, [](int& strength) { strength = std::max(0, 2 * strength - 1); });
  place.back() *= 2;
  return place;
}

FluxGrid flux_grid(double mean_heat_W, double longest_s) {
  FluxGrid grid{{0.0}, {}, mean_heat_W};
  for (double rms_W = 0.004 * mean_heat_W; rms_W < 3.0 * mean_heat_W; rms_W *= 2.0) {
    grid.rms_W.push_back(rms_W);
  }
  for (double time_s = 20.0; time_s < std::max(longest_s, 50.0); time_s *= 2.2) {
    grid.time_scale_s.push_back(time_s);
  }
  return grid;
}

EvidenceTable::EvidenceTable(std::vector<DesignRun> runs, FluxGrid grid, ThetaPrior prior, std::vector<CandidateColumn> candidates)
    : runs_(std::move(runs)), grid_(std::move(grid)), prior_(std::move(prior)), candidates_(std::move(candidates)) {}

EvidenceTable EvidenceTable::only(std::span<const int> few) && {
  const std::vector<Eigen::Index> columns = columns_of(few);
  for (DesignRun& run : runs_) {
    run.columns = Columns(run.columns(Eigen::all, columns));
  }
  std::vector<CandidateColumn> rules;
  std::ranges::transform(few, std::back_inserter(rules), [&](int j) { return candidates_[static_cast<std::size_t>(j)]; });
  EvidenceTable narrow(std::move(runs_), std::move(grid_), prior_, std::move(rules));
  for (auto& [key, reduced] : reduced_) {
    if (key.second) {
      reduced.all = selected(reduced.all, few);
      std::ranges::transform(reduced.run, reduced.run.begin(), [&](const RunEvidence& run) { return selected(run, few); });
    }
    narrow.reduced_.emplace(std::pair(key.first, key.second && !few.empty()), std::move(reduced));
  }
  return narrow;
}

const EvidenceTable::Reduced& EvidenceTable::at(const FluxGrid::Place& place, bool has_candidates) {
  has_candidates = has_candidates && !candidates_.empty();
  const auto found = reduced_.find({place, has_candidates});
  if (found != reduced_.end()) {
    return found->second;
  }
  const LatentFlux flux = grid_.at(place);
  Reduced reduced;
  reduced.run.resize(runs_.size());
  in_parallel(runs_.size(), 0, [&](std::size_t i) {
    const DesignRun& design = runs_[i];
    const Whitening whitening(design.run, flux, design.noise);
    reduced.run[i] = has_candidates ? run_evidence_of_many(design.run, design.columns, free_count(), whitening, design.start)
                                    : run_evidence(design.run, design.columns.leftCols(free_count()), whitening, design.start);
  });
  reduced.all.triangle = stacked(reduced.run);
  for (const RunEvidence& run : reduced.run) {
    reduced.all.log_determinant += run.log_determinant;
    reduced.all.count += run.count;
  }
  return reduced_.emplace(std::pair(place, has_candidates), std::move(reduced)).first->second;
}

std::vector<Eigen::Index> EvidenceTable::columns_of(std::span<const int> set) const {
  std::vector<Eigen::Index> columns;
  for (Eigen::Index i = 0; i < free_count(); ++i) {
    columns.push_back(i);
  }
  for (const int candidate : set) {
    columns.push_back(free_count() + candidate);
  }
  return columns;
}

RunEvidence EvidenceTable::selected(const RunEvidence& run, std::span<const int> set) const {
  std::vector<Eigen::Index> columns = columns_of(set);
  columns.push_back(run.triangle.cols() - 1);
  const Eigen::MatrixXd tall = run.triangle(Eigen::all, columns);
  const Eigen::HouseholderQR<Eigen::MatrixXd> decomposition(tall);
  return {decomposition.matrixQR().topRows(tall.cols()).triangularView<Eigen::Upper>(), run.log_determinant, run.count};
}

ThetaPrior EvidenceTable::prior_of(std::span<const int> set) const {
  const auto count = free_count() + static_cast<Eigen::Index>(set.size());
  ThetaPrior prior{Eigen::MatrixXd::Zero(count, count), Eigen::VectorXd::Zero(count)};
  prior.mean.head(free_count()) = prior_.mean;
  prior.precision.topLeftCorner(free_count(), free_count()) = prior_.precision;
  for (std::size_t i = 0; i < set.size(); ++i) {
    const double sd_share = candidates_[static_cast<std::size_t>(set[i])].prior_sd_share;
    const Eigen::Index own = free_count() + static_cast<Eigen::Index>(i);
    prior.precision(own, own) = 1.0 / (sd_share * sd_share);
  }
  return prior;
}

double EvidenceTable::misfit_now(const FluxGrid::Place& place) {
  return at(place, false).all.triangle.rightCols<1>().squaredNorm() + prior_.mean.dot(prior_.precision * prior_.mean);
}

LinearFit EvidenceTable::fit(std::span<const RunEvidence> runs, std::span<const int> set) const {
  const ThetaPrior prior = prior_of(set);
  return linear_fit(runs, prior.mean, prior.precision);
}

SetScore EvidenceTable::score(std::span<const int> set, const FluxGrid::Place& place) {
  const RunEvidence chosen = selected(at(place, !set.empty()).all, set);
  const LinearFit fitted = fit({&chosen, 1}, set);
  SetScore out;
  out.candidates.assign(set.begin(), set.end());
  out.evidence_nats = fitted.log_evidence + grid_.log_prior_nats(place);
  out.place = place;
  out.coefficient = fitted.coefficients;
  out.covariance = fitted.covariance;
  for (std::size_t i = 0; i < set.size(); ++i) {
    const bool is_negative = out.coefficient[free_count() + static_cast<Eigen::Index>(i)] < 0.0;
    out.is_allowed = out.is_allowed && (candidates_[static_cast<std::size_t>(set[i])].may_be_negative || !is_negative);
  }
  return out;
}

namespace {

/// One axis after the other, then along the ridges that strengths and time scale form.
std::vector<FluxGrid::Place> directions(std::size_t axes, Search search) {
  std::vector<FluxGrid::Place> all;
  for (std::size_t axis = 0; axis < axes; ++axis) {
    all.emplace_back(axes, 0)[axis] = 1;
  }
  if (search == Search::rough) {
    return all;
  }
  for (std::size_t axis = 0; axis + 1 < axes && axes > 2; ++axis) {
    all.emplace_back(axes, 0)[axis] = 1;
    all.back().back() = 1;
  }
  all.emplace_back(axes, 1);
  all.emplace_back(axes, 1).back() = 0;
  return all;
}

}  // namespace

SetScore EvidenceTable::best(std::span<const int> set, const FluxGrid::Place& start, Search search) {
  SetScore best = score(set, start);
  const auto is_inside = [&](const FluxGrid::Place& place) {
    for (std::size_t axis = 0; axis < place.size(); ++axis) {
      const std::size_t count = axis + 1 < place.size() ? grid_.rms_W.size() : grid_.time_scale_s.size();
      if (place[axis] < 0 || place[axis] >= static_cast<int>(count)) {
        return false;
      }
    }
    return true;
  };
  const std::vector<FluxGrid::Place> ways = directions(start.size(), search);
  for (bool moved = true; moved;) {
    moved = false;
    for (std::size_t way = 0; way < ways.size() && !(way >= start.size() && moved); ++way) {
      for (const int sign : {-1, 1}) {
        for (FluxGrid::Place place = best.place;;) {
          std::ranges::transform(place, ways[way], place.begin(), [&](int index, int step) { return index + sign * step; });
          if (!is_inside(place)) {
            break;
          }
          SetScore next = score(set, place);
          if (next.evidence_nats <= best.evidence_nats + 1e-6) {
            break;
          }
          best = std::move(next);
          moved = true;
        }
      }
    }
  }
  return best;
}

namespace {

/// The base's and those with less unknown heat: what explains something takes its place.
std::vector<FluxGrid::Place> places_of_less(const FluxGrid::Place& base) {
  std::vector<FluxGrid::Place> places{base};
  for (std::size_t axis = 0; axis + 1 < base.size(); ++axis) {
    for (int less = 1; less <= 3; ++less) {
      FluxGrid::Place place = base;
      place[axis] = std::max(0, place[axis] - less);
      places.push_back(place);
    }
  }
  FluxGrid::Place all_less = base;
  std::for_each(all_less.begin(), all_less.end() - 1, [](int& index) { index = std::max(0, index - 2); });
  places.push_back(all_less);
  std::ranges::sort(places);
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

}  // namespace

double EvidenceTable::best_nats_with(const ThetaPrior& prior, const SetScore& base) {
  double best_nats = -std::numeric_limits<double>::infinity();
  ThetaPrior all = prior_of(base.candidates);
  all.mean.head(free_count()) = prior.mean;
  all.precision.topLeftCorner(free_count(), free_count()) = prior.precision;
  for (const FluxGrid::Place& place : places_of_less(base.place)) {
    const RunEvidence chosen = selected(at(place, !base.candidates.empty()).all, base.candidates);
    best_nats = std::max(best_nats, linear_fit({&chosen, 1}, all.mean, all.precision).log_evidence + grid_.log_prior_nats(place));
  }
  return best_nats;
}

std::vector<double> EvidenceTable::single_gains_nats(const SetScore& base) {
  std::vector<double> gain_nats(candidates_.size(), 0.0);
  for (const FluxGrid::Place& place : places_of_less(base.place)) {
    for (std::size_t j = 0; j < candidates_.size(); ++j) {
      if (std::ranges::find(base.candidates, static_cast<int>(j)) != base.candidates.end()) {
        continue;
      }
      std::vector<int> set = base.candidates;
      set.push_back(static_cast<int>(j));
      const SetScore with = score(set, place);
      if (with.is_allowed) {
        gain_nats[j] = std::max(gain_nats[j], with.evidence_nats - base.evidence_nats);
      }
    }
  }
  return gain_nats;
}

std::vector<double> EvidenceTable::left_out_gains_nats(const SetScore& base, const SetScore& set) {
  const Reduced& reduced = at(set.place);
  const auto misfits = [&](std::span<const int> which) {
    std::vector<double> misfit;
    for (std::size_t out = 0; out < reduced.run.size(); ++out) {
      std::vector<RunEvidence> others;
      for (std::size_t r = 0; r < reduced.run.size(); ++r) {
        if (r != out) {
          others.push_back(selected(reduced.run[r], which));
        }
      }
      const RunEvidence left_out = selected(reduced.run[out], which);
      Eigen::VectorXd error(left_out.triangle.cols());
      error << (others.empty() ? Eigen::VectorXd::Zero(error.size() - 1) : Eigen::VectorXd(-fit(others, which).coefficients)), 1.0;
      misfit.push_back((left_out.triangle * error).squaredNorm());
    }
    return misfit;
  };
  const std::vector<double> before = misfits(base.candidates);
  const std::vector<double> after = misfits(set.candidates);
  std::vector<double> gain_nats(before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    gain_nats[i] = 0.5 * (before[i] - after[i]);
  }
  return gain_nats;
}

Eigen::MatrixXd EvidenceTable::unabsorbed(std::span<const int> base, const FluxGrid::Place& place, const std::vector<int>& candidates) {
  const Eigen::MatrixXd& triangle = at(place).all.triangle;
  const Eigen::MatrixXd absorbing = triangle(Eigen::all, columns_of(base));
  std::vector<Eigen::Index> places;
  for (const int candidate : candidates) {
    places.push_back(free_count() + candidate);
  }
  const Eigen::MatrixXd columns = triangle(Eigen::all, places);
  return absorbing.cols() == 0 ? columns : columns - absorbing * absorbing.colPivHouseholderQr().solve(columns);
}

double EvidenceTable::visibility_ratio(std::span<const int> base, const FluxGrid::Place& place, int candidate) {
  const double all = at(place).all.triangle.col(free_count() + candidate).squaredNorm();
  return all > 0.0 ? unabsorbed(base, place, {candidate}).squaredNorm() / all : 0.0;
}

std::vector<double> EvidenceTable::typical_gains_nats(const SetScore& base) {
  std::vector<int> all(candidates_.size());
  std::iota(all.begin(), all.end(), 0);
  const Eigen::VectorXd squares = unabsorbed(base.candidates, base.place, all).colwise().squaredNorm();
  std::vector<double> gain_nats(all.size());
  std::ranges::transform(squares, gain_nats.begin(), [](double square) { return 0.5 * square; });
  return gain_nats;
}

double EvidenceTable::cosine_ratio(const SetScore& base, int a, int b) {
  const Eigen::MatrixXd left = unabsorbed(base.candidates, base.place, {a, b});
  return left.col(0).dot(left.col(1)) / (left.col(0).norm() * left.col(1).norm());
}

std::vector<SizeInRun> EvidenceTable::size_by_run(const SetScore& set, int candidate) {
  const Reduced& reduced = at(set.place);
  const std::vector<Eigen::Index> columns = columns_of(set.candidates);
  const auto place = std::ranges::find(set.candidates, candidate) - set.candidates.begin();
  const Eigen::Index own = free_count() + place;
  constexpr double kSilent_ratio = 1e-12;  // rounding is no response
  const double silence = kSilent_ratio * reduced.all.triangle.col(columns[static_cast<std::size_t>(own)]).squaredNorm();
  std::vector<SizeInRun> sizes;
  for (const RunEvidence& run : reduced.run) {
    Eigen::VectorXd others = set.coefficient;
    others[own] = 0.0;
    const Eigen::VectorXd column = run.triangle.col(columns[static_cast<std::size_t>(own)]);
    const Eigen::VectorXd left = run.triangle.rightCols<1>() - run.triangle(Eigen::all, columns) * others;
    const double power = column.squaredNorm();
    sizes.push_back(power > silence ? SizeInRun{column.dot(left) / power, 1.0 / std::sqrt(power)} : SizeInRun{});
  }
  return sizes;
}

}  // namespace heatsoak
