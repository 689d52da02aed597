#include "derate/derating_job.h"

#include <utility>

namespace heatsoak::derate {

DeratingAnswer run_derating(const DeratingJob& job, const base::Progress& progress) {
  std::optional<TableCheck> check;
  if (!job.committed.empty()) {
    // Read first, so that an invalid file is reported before the computation.
    check = TableCheck{read_committed_table(job.committed), {}};
    if (std::optional<SensorDifference> difference = sensor_difference(check->committed, job.options.sensor)) {
      throw SensorsDiffer(job.committed, *std::move(difference));
    }
  }
  DeratingAnswer answer{.derating = derate(job.motor, job.robot, job.options, progress), .text = {}, .check = std::move(check)};
  answer.derating.provenance = provenance_of(job.motor, job.robot, job.options);
  if (job.exporter) {
    answer.text = job.compiler.empty() ? job.exporter->write(answer.derating) : job.exporter->write_compiled(answer.derating, job.compiler);
  }
  if (answer.check) {
    answer.check->found = compare(answer.check->committed, answer.derating);
  }
  return answer;
}

}  // namespace heatsoak::derate
