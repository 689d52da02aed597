// One calibration of five runs of 30 minutes at 1 Hz with two sensors, from reading the logs to the intervals.
#include <benchmark/benchmark.h>

#include "../calibration/study.h"

namespace heatsoak {
namespace {

void FiveRunsOfHalfAnHour(benchmark::State& state) {
  const study::Folder folder;
  const study::Sheet sheet;
  const Motor motor = sheet.motor(folder);
  const TwoNodeTruth truth = study::drawn_truth(sheet, motor, 1);
  LogMaking making;
  making.winding_is_sensed = state.range(0) == 2;
  std::vector<Recording> logs;
  for (std::uint64_t run = 0; run < 5; ++run) {
    logs.push_back(
        study::read_log(study::write_log(generated_log(truth, making, 1, run), folder.path() / ("run" + std::to_string(run) + ".csv"))));
  }
  for (auto _ : state) {
    benchmark::DoNotOptimize(calibrate(motor, logs, {}, {}));
  }
}
BENCHMARK(FiveRunsOfHalfAnHour)->ArgName("sensors")->Arg(2)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();

}  // namespace
}  // namespace heatsoak
