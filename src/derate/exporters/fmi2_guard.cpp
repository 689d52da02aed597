#include "derate/exporter.h"
#include "derate/fmi/fmu.h"

namespace heatsoak::derate::exporters {
namespace {

std::string write_fmi2_guard(const Derating& derating) {
  return zip_archive(fmu_files(guard_fmu(derating, "fmi2_guard"), FmiVersion::fmi2));
}

std::string write_compiled_fmi2_guard(const Derating& derating, const std::string& compiler) {
  const FmuModel model = guard_fmu(derating, "fmi2_guard");
  return zip_archive(with_binary(fmu_files(model, FmiVersion::fmi2), model, FmiVersion::fmi2, compiler));
}

}  // namespace

ExporterType fmi2_guard() {
  return {.name = {},
          .summary = "the firmware's guard as co-simulation FMU (2.0) with sources; --compiler adds a binary",
          .write = write_fmi2_guard,
          .write_compiled = write_compiled_fmi2_guard};
}

}  // namespace heatsoak::derate::exporters
