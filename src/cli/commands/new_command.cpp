#include <embedded/file_templates.h>
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"

namespace heatsoak::commands {
namespace {

struct Options {
  std::string kind;
  std::string file;
};

ExitCode run(const Options& options, Session& session) {
  std::error_code unreadable;
  if (std::filesystem::exists(options.file, unreadable)) {
    throw Failure(ExitCode::bad_input, fmt::format("{} exists; give the new file another name", options.file));
  }
  const auto texts = embedded::file_templates();
  const auto found =
      std::ranges::find_if(texts, [&](const embedded::Text& each) { return each.path.ends_with("/" + options.kind + ".toml"); });
  session.write(options.file, std::string(found->text));
  session.say(fmt::format("{}: replace every \"?\", then run `heatsoak lint {}`\n", options.file, options.file));
  session.answer({{"schema", "heatsoak.new/1"}, {"kind", options.kind}, {"file", options.file}});
  return ExitCode::done;
}

}  // namespace

Command new_command() {
  return {.name = {},
          .summary = "Writes a commented motor or robot file to fill in",
          .example = "heatsoak new motor my_motor.toml",
          .declare = [](CLI::App& app, Session& session) -> std::function<ExitCode()> {
            const auto options = std::make_shared<Options>();
            app.add_option("kind", options->kind, "motor or robot")->required()->check(CLI::IsMember({"motor", "robot"}));
            app.add_option("file", options->file, "name of the new file, which is the id")->required()->check([](const std::string& file) {
              return file.ends_with(".toml") ? "" : "expected a name that ends in .toml";
            });
            session.add_json_option(app);
            return [options, &session] { return run(*options, session); };
          }};
}

}  // namespace heatsoak::commands
