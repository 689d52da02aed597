// CLI11's help text with lines wrapped at the width of the terminal.
#pragma once

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cstddef>
#include <string>

namespace heatsoak::cli {

class HelpText final : public CLI::Formatter {
 public:
  explicit HelpText(std::size_t width) : width_(width) {}

  std::string make_option_desc(const CLI::Option* option) const override;
  std::string make_subcommand(const CLI::App* verb) const override;
  std::string make_description(const CLI::App* app) const override;

 private:
  [[nodiscard]] std::string beside_names(const std::string& text) const;
  std::size_t width_;
};

}  // namespace heatsoak::cli
