#include "cli/guard_options.h"

#include <fmt/format.h>

#include "cli/condition_option.h"
#include "cli/quantity_option.h"
#include "derate/option_quantities.h"
#include "motor/conditions.h"

namespace heatsoak::cli {

void add_motor_options(CLI::App& app, GuardOptions& options) {
  app.add_option("--motor", options.motor, "id (see `heatsoak list motors`) or file")->type_name("M");
  app.add_option("--model", options.model, "motor file that `calibrate` or `diagnose` wrote, in place of --motor")->type_name("FILE.toml");
  add_conditions(app, options.conditions);
}

void add_derate_options(CLI::App& app, derate::DerateOptions& options) {
  derate::GuaranteeOptions& guarantee = options.guarantee;
  for (const derate::OptionQuantity& each : derate::option_quantities(options)) {
    std::visit([&](auto* value) { add_quantity(app, fmt::format("--{}", each.spec.key), *value, each.spec); }, each.value);
  }
  const base::Range& bytes = derate::kTableSize_byte;
  app.add_option(
         "--size", options.table.most_bytes,
         fmt::format("largest size of the table in bytes, {:.0f} to {:.0f}; it takes precedence over --error", bytes.low, bytes.high))
      ->check([](const std::string& text) {
        const base::Range& range = derate::kTableSize_byte;
        const bool is_number = whole_number(static_cast<std::uint64_t>(range.high))(text).empty();
        return is_number && range.contains(std::stod(text))
                   ? std::string()
                   : fmt::format("'{}' is not a whole number of bytes from {:.0f} to {:.0f}", text, range.low, range.high);
      })
      ->capture_default_str();
  app.add_option("--samples", guarantee.samples,
                 "number of motors that are drawn to determine the safety factor on heat")
      ->check(whole_number(100'000))
      ->capture_default_str();
  add_seed(app, guarantee.seed, "seed of the draws; the same seed gives the same bytes");
  app.add_option("--threads", guarantee.threads, "number of threads, 0 for all cores; the result does not depend on it")
      ->check(whole_number(1024))
      ->capture_default_str();
}

motor::Motor guarded_motor(const GuardOptions& options, duty::NamedFiles& named) {
  if (options.motor.empty() && options.model.empty()) {
    throw base::Failure(base::ExitCode::bad_input, "the motor is missing; expected --motor M or --model FILE");
  }
  const std::optional<std::filesystem::path> file = options.motor.empty() ? std::nullopt : named.motor_file(options.motor);
  const std::optional<motor::Motor> motor = named.motor(options.model.empty() ? options.motor : options.model);
  named.throw_if_any();
  if (file && !options.model.empty() && motor->id != file->stem() && (!motor->fit || motor->fit->motor != file->stem())) {
    throw base::Failure(
        base::ExitCode::bad_input,
        fmt::format("--model {} is not a model of {}: it {}", options.model, file->stem().string(),
                    motor->fit ? fmt::format("was fitted from {}", motor->fit->motor) : std::string("has another name and no [fit]")));
  }
  return motor::under(*motor, options.conditions);
}

void check_derate_options(const derate::DerateOptions& options) {
  if (options.coldest_ambient_C >= options.hottest_ambient_C) {
    throw base::Failure(base::ExitCode::bad_input,
                        fmt::format("the hottest air (--ambient, {:.4g} °C) is not above the coldest air (--coldest, {:.4g} "
                                    "°C); expected --coldest COLDER or a hotter --ambient",
                                    options.hottest_ambient_C, options.coldest_ambient_C));
  }
}

}  // namespace heatsoak::cli
