#include "present/list.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "base/diagnostic.h"
#include "derate/exporter.h"
#include "duty/duty.h"
#include "duty/log_type.h"
#include "present/parameter_table.h"
#include "present/renderer.h"
#include "present/topics.h"
#include "report/chart.h"

namespace heatsoak::present {
namespace {

struct NamedThing {
  std::string id;
  std::string summary;
};
using Rows = std::vector<NamedThing>;

template <TopicList (*topics)(const input::DataFolders&)>
Rows rows_of(const input::DataFolders& folders) {
  Rows rows;
  for (const Topic& topic : topics(folders)) {
    rows.push_back({topic.id, topic.summary()});
  }
  return rows;
}

Rows formats(const input::DataFolders& /*folders*/) {
  Rows rows;
  for (const duty::ShapeType& shape : duty::all_shapes()) {
    rows.push_back({std::string(shape.name), fmt::format("duty: {}", shape.summary)});
  }
  for (const duty::LogType& log : duty::all_logs()) {
    rows.push_back({std::string(log.name), fmt::format("recorded game: {}; duty --import LOG", log.summary)});
  }
  for (const derate::ExporterType& exporter : derate::all_exporters()) {
    rows.push_back({std::string(exporter.name),
                    fmt::format("derating: {}; derate --to {}{}", exporter.summary, exporter.name,
                                exporter.file_ending.empty() ? "" : fmt::format(" or --out FILE{}", exporter.file_ending))});
  }
  for (const std::string_view ending : report::kPictureEndings) {
    rows.push_back({std::string(ending.substr(1)), fmt::format("picture: --plot FILE{}", ending)});
  }
  for (const Renderer& renderer : all_renderers()) {
    rows.push_back({std::string(renderer.name),
                    fmt::format("answer: {}{}", renderer.summary,
                                renderer.file_ending.empty() ? "" : fmt::format("; --report FILE{}", renderer.file_ending))});
  }
  return rows;
}

using Folder = std::filesystem::path input::DataFolders::*;

struct ListedKind {
  std::string_view name;
  Rows (*rows)(const input::DataFolders& folders);
  std::vector<Folder> read = {};  ///< folders of which each must have files
};

const std::vector<ListedKind>& kinds() {
  static const std::vector<ListedKind> all{
      {"motors", rows_of<motor_topics>, {&input::DataFolders::motors}},
      {"robots", rows_of<robot_topics>, {&input::DataFolders::robots}},
      {"duties", rows_of<duty_topics>, {&input::DataFolders::duties}},
      {"effects", rows_of<effect_topics>},
      {"formats", formats},
      {"thresholds", rows_of<threshold_topics>},
      {"signals", rows_of<signal_topics>},
      {"topics", rows_of<all_topics>, {&input::DataFolders::motors, &input::DataFolders::robots, &input::DataFolders::duties}}};
  return all;
}

}  // namespace

std::vector<std::string> listed_kinds() {
  std::vector<std::string> names;
  std::ranges::transform(kinds(), std::back_inserter(names), [](const ListedKind& kind) { return std::string(kind.name); });
  return names;
}

Document list_document(const std::string& kind, const input::DataFolders& folders, std::span<const TableOutput> tables) {
  const auto found = std::ranges::find(kinds(), kind, &ListedKind::name);
  if (found == kinds().end()) {
    throw base::Failure(base::ExitCode::bad_input,
                        fmt::format("the kind of names to list is missing\nexpected one of {}\n`heatsoak list motors` lists the motors",
                                    fmt::join(listed_kinds(), ", ")));
  }
  for (const Folder folder : found->read) {
    // An empty folder indicates a wrong --db.
    if (input::ids_in(folders.*folder).empty()) {
      throw base::Failure(base::ExitCode::bad_input, fmt::format("there is no .toml file in {}", (folders.*folder).string()));
    }
  }
  Table table = labelled_table("");
  Json items = Json::array();
  Rows rows = found->rows(folders);
  for (const TableOutput& each : found->rows == formats ? tables : std::span<const TableOutput>()) {
    rows.push_back({each.ending.substr(1), fmt::format("{}; {} FILE{}", each.content, each.command, each.ending)});
  }
  for (const NamedThing& each : rows) {
    table.rows.push_back({{each.id}, {each.summary}});
    items.push_back({{"id", each.id}, {"summary", each.summary}});
  }
  return {.tables = {std::move(table)}, .data = {{"schema", "heatsoak.list/1"}, {"kind", kind}, {"items", items}}};
}

}  // namespace heatsoak::present
