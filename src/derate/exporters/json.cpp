#include "derate/derating_json.h"
#include "derate/export_text.h"
#include "derate/exporter.h"

namespace heatsoak::derate::exporters {
namespace {

std::string write_json(const Derating& derating) {
  require_finite(derating);
  return derating_json(derating).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace

ExporterType json() {
  return {.name = {},
          .summary = "table with axes and units, observer parameters, limit and confidence (heatsoak.derating/2)",
          .file_ending = ".json",
          .write = write_json};
}

}  // namespace heatsoak::derate::exporters
