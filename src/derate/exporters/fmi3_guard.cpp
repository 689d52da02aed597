#include "derate/exporter.h"
#include "derate/fmi/fmu.h"

namespace heatsoak::derate::exporters {
namespace {

std::string write_fmi3_guard(const Derating& derating) {
  return zip_archive(fmu_files(guard_fmu(derating, "fmi3_guard"), FmiVersion::fmi3));
}

std::string write_compiled_fmi3_guard(const Derating& derating, const std::string& compiler) {
  const FmuModel model = guard_fmu(derating, "fmi3_guard");
  return zip_archive(with_binary(fmu_files(model, FmiVersion::fmi3), model, FmiVersion::fmi3, compiler));
}

}  // namespace

ExporterType fmi3_guard() {
  return {.name = {},
          .summary = "the firmware's guard as co-simulation FMU (3.0) with sources; --compiler adds a binary",
          .write = write_fmi3_guard,
          .write_compiled = write_compiled_fmi3_guard};
}

}  // namespace heatsoak::derate::exporters
