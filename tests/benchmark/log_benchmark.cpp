// Reading measured logs: our parser compared with libcsv alone, and with all checks.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "input/csv.h"
#include "input/number_table.h"
#include "recording/quality.h"
#include "recording/read_recording.h"
#include "recording/recording_stream.h"

namespace heatsoak {
namespace {

namespace fs = std::filesystem;

/// Two million rows of eight columns in a logger's format, about 120 MB.
class LongLog {
 public:
  LongLog() : path_(fs::temp_directory_path() / fmt::format("heatsoak_benchmark_{}.csv", ::getpid())) {
    std::ofstream file(path_, std::ios::binary);
    std::string text = "time_s,winding_C,stator_C,ambient_C,current_A,speed_rad_per_s,torque_Nm,bus_V\n";
    constexpr int kRows = 2'000'000;
    for (int i = 0; i < kRows; ++i) {
      const double t = 0.001 * i;
      fmt::format_to(std::back_inserter(text), "{:.3f},{:.3f},{:.3f},{:.2f},{:.4f},{:.3f},{:.5f},{:.3f}\n", t,
                     25.0 + 60.0 * (1.0 - std::exp(-t / 300.0)) + 0.05 * std::sin(1e4 * t),
                     25.0 + 30.0 * (1.0 - std::exp(-t / 900.0)) + 0.05 * std::sin(1.3e4 * t), 24.5, 6.0 * std::sin(0.7 * t),
                     300.0 * std::cos(0.3 * t), 0.2 * std::sin(0.7 * t), 22.0 + std::sin(t));
      if (text.size() > 1 << 20) {
        file << text;
        text.clear();
      }
    }
    file << text;
    file.close();
    bytes_ = static_cast<std::int64_t>(fs::file_size(path_));
  }
  LongLog(const LongLog&) = delete;
  LongLog& operator=(const LongLog&) = delete;
  ~LongLog() { fs::remove(path_); }
  [[nodiscard]] const fs::path& path() const { return path_; }
  [[nodiscard]] std::int64_t bytes() const { return bytes_; }

 private:
  fs::path path_;
  std::int64_t bytes_ = 0;
};

const LongLog& long_log() {
  static const LongLog log;
  return log;
}

void log_number_table(benchmark::State& state) {
  const LongLog& log = long_log();
  for (auto _ : state) {
    input::NumberTable table(log.path(), {});
    table.choose({0, 1, 2, 3, 4, 5, 6, 7});
    input::TableBlock block;
    double sum = 0.0;
    while (table.next(block)) {
      sum += block.columns[1].back();
    }
    benchmark::DoNotOptimize(sum);
  }
  state.SetBytesProcessed(state.iterations() * log.bytes());
}
BENCHMARK(log_number_table)->Unit(benchmark::kMillisecond);

void log_libcsv(benchmark::State& state) {
  const LongLog& log = long_log();
  const std::vector<std::string> columns{"time_s",    "winding_C",       "stator_C",  "ambient_C",
                                         "current_A", "speed_rad_per_s", "torque_Nm", "bus_V"};
  for (auto _ : state) {
    double sum = 0.0;
    input::read_csv(log.path(), columns, {}, [&](const input::CsvRow& row) { sum += row.values[1]; });
    benchmark::DoNotOptimize(sum);
  }
  state.SetBytesProcessed(state.iterations() * log.bytes());
}
BENCHMARK(log_libcsv)->Unit(benchmark::kMillisecond);

void log_read_recording(benchmark::State& state) {
  const LongLog& log = long_log();
  for (auto _ : state) {
    recording::RecordingReport report;
    benchmark::DoNotOptimize(recording::read_recording(log.path(), {}, report));
  }
  state.SetBytesProcessed(state.iterations() * log.bytes());
}
BENCHMARK(log_read_recording)->Unit(benchmark::kMillisecond);

/// The work of `log inspect`, from the bytes of the file to the report.
void log_inspect(benchmark::State& state) {
  const LongLog& log = long_log();
  for (auto _ : state) {
    recording::RecordingReport report;
    recording::RecordingStream stream(log.path(), {}, report);
    recording::Assessment assessment;
    for (recording::Recording part; stream.next(part);) {
      assessment.add(part);
    }
    benchmark::DoNotOptimize(assessment.conclude(report));
  }
  state.SetBytesProcessed(state.iterations() * log.bytes());
}
BENCHMARK(log_inspect)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace heatsoak
