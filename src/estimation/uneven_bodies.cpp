#include "estimation/uneven_bodies.h"

#include <algorithm>
#include <string>

namespace heatsoak::estimation {

std::vector<Columns> uneven_bodies(const std::vector<LinearisedRun>& fitted, const std::vector<MeasuredRun>& runs) {
  std::vector<std::string> signals;
  for (const MeasuredRun& run : runs) {
    for (const Sensor& sensor : run.sensors) {
      if (std::ranges::find(signals, sensor.signal) == signals.end()) {
        signals.push_back(sensor.signal);
      }
    }
  }
  std::vector<Columns> all;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const LinearisedRun& run = fitted[r];
    Columns& columns = all.emplace_back(Columns::Zero(run.residual_K.size(), static_cast<Eigen::Index>(signals.size()) * run.states));
    for (Eigen::Index sensor = 0; sensor < run.sensors(); ++sensor) {
      const Eigen::Index own = run.sensor_node[static_cast<std::size_t>(sensor)];
      const Eigen::Index first =
          (std::ranges::find(signals, runs[r].sensors[static_cast<std::size_t>(sensor)].signal) - signals.begin()) * run.states;
      for (Eigen::Index k = 0; k < run.samples(); ++k) {
        columns.row(k * run.sensors() + sensor).segment(first, run.states) =
            (run.state_C.col(k).array() - run.state_C(own, k)).matrix().transpose();
      }
    }
  }
  return all;
}

}  // namespace heatsoak::estimation
