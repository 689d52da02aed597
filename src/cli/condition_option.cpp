#include "cli/condition_option.h"

#include <fmt/format.h>

#include <vector>

namespace heatsoak::cli {

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
          "condition that holds, such as cooling=fan, for effects that were found only under this condition; unless given, such effects "
          "may heat, but not cool")
      ->type_name("KEY=VALUE");
}

}  // namespace heatsoak::cli
