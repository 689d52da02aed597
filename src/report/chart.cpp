#include "report/chart.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "base/diagnostic.h"
#include "report/chart_plugin.h"

namespace heatsoak::report {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> plugin_folders() {
  std::vector<fs::path> folders;
  if (const char* chosen = std::getenv("HEATSOAK_PLUGINS"); chosen != nullptr && *chosen != '\0') {
    folders.emplace_back(chosen);
  }
  std::error_code unreadable;
  const fs::path program = fs::read_symlink("/proc/self/exe", unreadable);
  if (!unreadable) {
    folders.push_back(program.parent_path().parent_path() / "lib" / "heatsoak");
    folders.push_back(program.parent_path());
  }
  return folders;
}

/// Returns the path of the drawing library; empty if it is missing. `searched` receives the folders.
fs::path find_plugin(std::string& searched) {
  for (const fs::path& folder : plugin_folders()) {
    std::error_code ignored;
    if (fs::exists(folder / kChartPluginFile, ignored)) {
      return folder / kChartPluginFile;
    }
    searched += "\n  " + folder.string();
  }
  return {};
}

/// `need` and `remedy` begin with a comma, or are empty.
fs::path found_plugin(const std::string& need, const std::string& remedy) {
  std::string searched;
  fs::path plugin = find_plugin(searched);
  if (plugin.empty()) {
    throw base::Failure(base::ExitCode::bad_input,
                        fmt::format("the drawing library {} is missing{}; set HEATSOAK_PLUGINS to its folder{}; searched:{}",
                                    kChartPluginFile, need, remedy, searched));
  }
  return plugin;
}

/// The library is never closed: VTK's object factories do not survive unloading. Opening it again is cheap.
void* plugin_function(const char* name) {
  const fs::path plugin = found_plugin("", "");
  void* library = dlopen(plugin.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* function = library != nullptr ? dlsym(library, name) : nullptr;
  if (function == nullptr) {
    throw base::Failure(base::ExitCode::bug,
                        fmt::format("cannot open the drawing library: {}; is it of the same build as the program?", dlerror()));
  }
  return function;
}

void check_lengths(const Chart& chart) {
  const auto fail = [](const std::string& name) {
    throw base::Failure(base::ExitCode::bug, fmt::format("chart: the columns of '{}' differ in length", name));
  };
  for (const ChartPanel& panel : chart.panels) {
    for (const ChartCurve& curve : panel.curves) {
      if (curve.x.size() != curve.y.size()) {
        fail(curve.name);
      }
    }
    for (const ChartBand& band : panel.bands) {
      if (band.x.size() != band.low.size() || band.x.size() != band.high.size()) {
        fail(band.name);
      }
    }
  }
}

}  // namespace

void require_drawing(std::string_view what, std::string_view remedy) {
  found_plugin(fmt::format(", which {} needs", what), fmt::format(", or {}", remedy));
}

std::string draw_svg(const Chart& chart) {
  check_lengths(chart);
  std::string text;
  if (!reinterpret_cast<DrawSvg>(plugin_function(kChartPluginFunction))(&chart, &text, kChartLayout)) {
    throw base::Failure(base::ExitCode::bug, "drawing failed: " + text);
  }
  return text;
}

std::string draw_picture(const Chart& chart, const std::string& file) {
  std::string svg = draw_svg(chart);
  if (!file.ends_with(".png")) {
    return svg;
  }
  std::string png;
  if (!reinterpret_cast<SvgToPng>(plugin_function(kPngPluginFunction))(&svg, &png)) {
    throw base::Failure(base::ExitCode::bug, "drawing failed: " + png);
  }
  return png;
}

}  // namespace heatsoak::report
