#include "derate/exporter.h"
#include "derate/fmi/fmu.h"

namespace heatsoak::derate::exporters {
namespace {

std::string write_fmi2_motor(const Derating& derating) {
  return zip_archive(fmu_files(motor_fmu(derating, "fmi2_motor"), FmiVersion::fmi2));
}

std::string write_compiled_fmi2_motor(const Derating& derating, const std::string& compiler) {
  const FmuModel model = motor_fmu(derating, "fmi2_motor");
  return zip_archive(with_binary(fmu_files(model, FmiVersion::fmi2), model, FmiVersion::fmi2, compiler));
}

}  // namespace

ExporterType fmi2_motor() {
  return {.name = {},
          .summary = "motor with its effects as co-simulation FMU (2.0) with sources; --compiler adds a binary",
          .write = write_fmi2_motor,
          .write_compiled = write_compiled_fmi2_motor};
}

}  // namespace heatsoak::derate::exporters
