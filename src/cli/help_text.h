// CLI11's help text with lines wrapped at the width of the terminal.
#pragma once

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cstddef>
#include <string>
#include <string_view>

namespace heatsoak::cli {

class HelpText final : public CLI::Formatter {
 public:
  explicit HelpText(std::size_t width);

  std::string make_option_name(const CLI::Option* option, bool is_positional) const override;
  std::string make_option_opts(const CLI::Option* option) const override;
  std::string make_option_desc(const CLI::Option* option) const override;
  std::string make_subcommand(const CLI::App* verb) const override;
  std::string make_description(const CLI::App* app) const override;

 private:
  [[nodiscard]] std::string beside_names(const std::string& text) const;
  std::size_t width_;
};

/// Breaks command lines, one in each line of `commands`, before options and with a backslash, so that they fit and can be pasted.
std::string folded_commands(std::string_view commands, std::size_t width);

}  // namespace heatsoak::cli
