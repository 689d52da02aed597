// One calibration of five runs of 30 minutes at 1 Hz with two sensors, from reading the logs to the intervals.
#include <benchmark/benchmark.h>

#include "../calibration/study.h"

namespace heatsoak {
namespace {

void FiveRunsOfHalfAnHour(benchmark::State& state) {
  const calibration::study::Folder folder;
  const calibration::study::Sheet sheet;
  const motor::Motor motor = sheet.motor(folder);
  const estimation::TwoNodeTruth truth = calibration::study::drawn_truth(sheet, motor, 1);
  estimation::LogMaking making;
  making.winding_is_sensed = state.range(0) == 2;
  std::vector<recording::Recording> logs;
  for (std::uint64_t run = 0; run < 5; ++run) {
    logs.push_back(calibration::study::read_log(calibration::study::write_log(estimation::generated_log(truth, making, 1, run),
                                                                              folder.path() / ("run" + std::to_string(run) + ".csv"))));
  }
  for (auto _ : state) {
    benchmark::DoNotOptimize(calibration::calibrate(motor, logs, {}, {}));
  }
}
BENCHMARK(FiveRunsOfHalfAnHour)->ArgName("sensors")->Arg(2)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();

}  // namespace
}  // namespace heatsoak
