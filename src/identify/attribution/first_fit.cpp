#include "identify/attribution/first_fit.h"

#include <algorithm>

#include "identify/attribution/mean_heat.h"
#include "identify/averaged_run.h"

namespace heatsoak {

FirstFit first_fit(const ExtendedModel& model, const std::vector<MeasuredRun>& runs) {
  FirstFit first;
  first.mean_heat_W = mean_heat_W(model.model, runs);
  RefitOptions& options = first.options;
  options.grid = flux_grid(std::max(0.05, first.mean_heat_W), longest_s(runs) / 2.0);
  options.place.assign(model.model.flux_nodes.size(), 3);
  options.place.push_back(static_cast<int>(options.grid.time_scale_s.size()) / 2);
  first.place = options.place;
  std::vector<std::vector<double>> start_C;
  for (const MeasuredRun& run : runs) {
    start_C.push_back(measured_start_C(model.model.network, run));
    options.merged.push_back(mergeable_samples(linearise(model, start_C.back(), run)));
  }
  first.fit = refit(model, runs, start_C, options);
  return first;
}

}  // namespace heatsoak
