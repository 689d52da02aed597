// One diagnosis with user settings: all effects of the catalogue, the scan of input signals and the description of the answer, for four
// half-hour runs at 1 Hz.
#include <benchmark/benchmark.h>

#include "diagnosis/diagnosis.h"
#include "examination.h"
#include "missing_effects.h"

namespace heatsoak::attribution::truth {
namespace {

void diagnose_four_half_hours(benchmark::State& state, const char* missing) {
  Case sealed;
  sealed.seed = 20000;
  const auto found = std::ranges::find(subjects(), missing, &Subject::name);
  if (found != subjects().end()) {
    sealed.missing = found->make(1.0);
  }
  const Runs runs = record(sealed);
  const diagnosis::DiagnosisInput input = question(sealed, runs);
  for (auto each : state) {
    (void)each;
    benchmark::DoNotOptimize(diagnosis::diagnose(input, {}));
  }
  state.counters["candidates"] = static_cast<double>(candidates_for(input.model, input.train).candidates.size());
}
BENCHMARK_CAPTURE(diagnose_four_half_hours, nothing_missing, "")->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK_CAPTURE(diagnose_four_half_hours, one_effect_missing, "iron_loss_eddy")
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace heatsoak::attribution::truth
