#include "derate/exporter.h"
#include "derate/fmi/fmu.h"

namespace heatsoak::derate::exporters {
namespace {

std::string write(const Derating& derating) { return zip_archive(fmu_files(guard_fmu(derating, "fmi2_guard"), FmiVersion::fmi2)); }

std::string write_compiled(const Derating& derating, const std::string& compiler) {
  const FmuModel model = guard_fmu(derating, "fmi2_guard");
  return zip_archive(with_binary(fmu_files(model, FmiVersion::fmi2), model, FmiVersion::fmi2, compiler));
}

}  // namespace

ExporterType fmi2_guard() {
  return {.name = {},
          .summary = "the firmware's guard as co-simulation FMU (2.0) with sources; --compiler adds a binary",
          .write = write,
          .write_compiled = write_compiled};
}

}  // namespace heatsoak::derate::exporters
