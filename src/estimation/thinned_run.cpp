#include <algorithm>

#include "estimation/mean_inputs.h"
#include "estimation/measured_run.h"

namespace heatsoak::estimation {

MeasuredRun thinned(const MeasuredRun& run, int merged) {
  MeasuredRun thin;
  thin.name = run.name;
  thin.sensors = run.sensors;
  thin.signals = run.signals;
  thin.conditions = run.conditions;
  std::vector<Eigen::Index> kept{0};
  MeanInputs mean;
  auto unknown = run.unknown_inputs.begin();
  for (std::size_t k = 0; k + 1 < run.time_s.size(); ++k) {
    const double duration_s = run.time_s[k + 1] - run.time_s[k];
    mean.add(run.at[k], duration_s);
    for (; unknown != run.unknown_inputs.end() && unknown->interval == static_cast<Eigen::Index>(k); ++unknown) {
      mean.add_uncertainty(run.at[k], unknown->other, duration_s);
    }
    if ((k + 1) % static_cast<std::size_t>(merged) == 0 || k + 2 == run.time_s.size()) {
      mean.take(thin);
      kept.push_back(static_cast<Eigen::Index>(k) + 1);
    }
  }
  thin.measured_C.resize(static_cast<Eigen::Index>(kept.size()), run.measured_C.cols());
  for (std::size_t k = 0; k < kept.size(); ++k) {
    thin.time_s.push_back(run.time_s[static_cast<std::size_t>(kept[k])]);
    thin.measured_C.row(static_cast<Eigen::Index>(k)) = run.measured_C.row(kept[k]);
  }
  return thin;
}

std::vector<MeasuredRun> roughly(std::span<const MeasuredRun> runs) {
  std::vector<MeasuredRun> rough;
  for (const MeasuredRun& run : runs) {
    const double step_s = (run.time_s.back() - run.time_s.front()) / static_cast<double>(run.at.size());
    constexpr double kRoughStep_s = 15.0;
    constexpr int kLeastRows = 60;
    const int merged = std::min(static_cast<int>(kRoughStep_s / step_s), static_cast<int>(run.at.size()) / kLeastRows);
    rough.push_back(merged > 1 ? thinned(run, merged) : run);
  }
  return rough;
}

}  // namespace heatsoak::estimation
