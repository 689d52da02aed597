#include <embedded/file_templates.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>

#include "cli/command.h"
#include "present/written_files.h"

namespace heatsoak::cli::commands {
namespace {

struct NewOptions {
  std::string kind;
  std::string file;
};

base::ExitCode run(const NewOptions& options, Session& session) {
  std::error_code unreadable;
  if (std::filesystem::exists(options.file, unreadable)) {
    throw base::bad_input({options.file}, "", "exists; give the new file another name");
  }
  const auto texts = embedded::file_templates();
  const auto found =
      std::ranges::find_if(texts, [&](const embedded::Text& each) { return each.path.ends_with("/" + options.kind + ".toml"); });
  session.write(options.file, std::string(found->text));
  session.show(present::new_file_document(options.kind, options.file));
  return base::ExitCode::done;
}

}  // namespace

Command new_command() {
  return {.name = {},
          .summary = "Writes a commented motor or robot file to fill in",
          .example = "heatsoak new motor my_motor.toml",
          .declare = [](CLI::App& app, Session& session) -> std::function<base::ExitCode()> {
            const auto options = std::make_shared<NewOptions>();
            app.add_option("kind", options->kind, "kind of the new file")->required()->check(CLI::IsMember({"motor", "robot"}));
            app.add_option("file", options->file, "name of the new file, which is the id")->required()->check([](const std::string& file) {
              const bool is_named = file.ends_with(".toml") && !std::filesystem::path(file).stem().string().starts_with(".");
              return is_named ? "" : "expected a name that ends in .toml; the part before .toml is the id";
            });
            session.add_answer_options(app);
            return [options, &session] { return run(*options, session); };
          }};
}

}  // namespace heatsoak::cli::commands
