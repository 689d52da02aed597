#include <fmt/format.h>

#include <CLI/App.hpp>
#include <filesystem>
#include <memory>

#include "cli/command.h"
#include "cli/help_page.h"
#include "present/written_files.h"

namespace heatsoak::cli::commands {
namespace {

struct ManualOptions {
  std::string format;
  std::string folder;
};

base::ExitCode run(const ManualOptions& options, const CLI::App& program, Session& session) {
  const std::vector<HelpPage> pages = help_pages(program);
  const std::filesystem::path folder = options.folder;
  session.make_folder(folder);
  const bool is_man = options.format == "man";
  session.write(folder / (is_man ? "heatsoak.1" : "README.md"), is_man ? man_page_index(pages) : markdown_index(pages));
  for (const HelpPage& page : pages) {
    session.write(folder / (is_man ? fmt::format("heatsoak-{}.1", page.verb) : page.verb + ".md"),
                  is_man ? man_page_of(page) : markdown_of(page));
  }
  session.show(present::manual_document(pages.size() + 1, folder));
  return base::ExitCode::done;
}

}  // namespace

Command manual() {
  return {.name = {},
          .summary = "Writes the help of every verb as man pages or as Markdown",
          .example = "heatsoak manual --to man --out man1",
          .declare = [](CLI::App& app, Session& session) -> std::function<base::ExitCode()> {
            const auto options = std::make_shared<ManualOptions>();
            app.add_option("--to", options->format, "format of the pages")
                ->required()
                ->check(CLI::IsMember({"man", "markdown"}))
                ->type_name("FORMAT");
            app.add_option("--out", options->folder, "folder for the pages")->required()->type_name("DIR");
            session.add_answer_options(app);
            return [options, &app, &session] { return run(*options, *app.get_parent(), session); };
          }};
}

}  // namespace heatsoak::cli::commands
