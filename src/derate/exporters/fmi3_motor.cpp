#include "derate/exporter.h"
#include "derate/fmi/fmu.h"

namespace heatsoak::derate::exporters {
namespace {

std::string write_fmi3_motor(const Derating& derating) {
  return zip_archive(fmu_files(motor_fmu(derating, "fmi3_motor"), FmiVersion::fmi3));
}

std::string write_compiled_fmi3_motor(const Derating& derating, const std::string& compiler) {
  const FmuModel model = motor_fmu(derating, "fmi3_motor");
  return zip_archive(with_binary(fmu_files(model, FmiVersion::fmi3), model, FmiVersion::fmi3, compiler));
}

}  // namespace

ExporterType fmi3_motor() {
  return {.name = {},
          .summary = "motor with its effects as co-simulation FMU (3.0) with sources; --compiler adds a binary",
          .write = write_fmi3_motor,
          .write_compiled = write_compiled_fmi3_motor};
}

}  // namespace heatsoak::derate::exporters
