#include "cli/condition_option.h"

#include <fmt/format.h>

#include <vector>

namespace heatsoak {

CLI::Option* add_conditions(CLI::App& app, std::map<std::string, std::string>& conditions) {
  return app
      .add_option_function<std::vector<std::string>>(
          "--condition",
          [&conditions](const std::vector<std::string>& all) {
            for (const std::string& each : all) {
              const std::size_t equals = each.find('=');
              if (equals == std::string::npos || equals == 0 || equals + 1 == each.size()) {
                throw CLI::ValidationError("--condition", fmt::format("'{}': expected KEY=VALUE, such as cooling=fan", each));
              }
              conditions[each.substr(0, equals)] = each.substr(equals + 1);
            }
          },
          "condition of effects that were found under it only, such as cooling=fan; without it their heat counts, their "
          "cooling does not")
      ->type_name("KEY=VALUE...");
}

}  // namespace heatsoak
