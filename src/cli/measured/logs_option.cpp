#include "cli/measured/logs_option.h"

#include <utility>

#include "base/air_range.h"
#include "cli/quantity_option.h"

namespace heatsoak::cli {

void add_log_options(CLI::App& app, recording::LogChoice& choice) {
  app.add_option("--map", choice.map, "mapping of columns to quantities; LOG.map.toml beside a log is found automatically")
      ->type_name("FILE.toml");
  add_quantity(app, "--ambient", choice.ambient_C, {"ambient", "degC", base::kPossibleAir_C, "air temperature of a log that has none"});
  app.add_flag("--as-is", choice.takes_logs_as_they_are, "continue although units or sensors of a log look wrong");
}

recording::LogChoice choice_of(recording::LogChoice choice, const Session& session) {
  choice.folders = session.folders();
  return choice;
}

void require_read(const recording::NamedLogs& logs, const Session& session) {
  if (session.stops_at_computation()) {
    logs.unread.throw_if_any();
  }
}

}  // namespace heatsoak::cli
