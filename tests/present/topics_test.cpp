// What `list` lists and `describe` describes.
#include "present/topics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "base/diagnostic.h"
#include "base/signals.h"
#include "present/list.h"
#include "present/renderer.h"
#include "report/chart.h"
#include "support/shipped_folders.h"
#include "support/source_folder.h"

namespace heatsoak::present {
namespace {

using testing::HasSubstr;

std::set<std::string> ids_of(const Document& list) {
  std::set<std::string> ids;
  for (const Json& item : list.data.at("items")) {
    ids.insert(item.at("id").get<std::string>());
  }
  return ids;
}

TEST(Topics, EachIsDescribedWithItsData) {
  for (const Topic& topic : all_topics(kShippedFolders)) {
    const Document document = description_of(topic.id, kShippedFolders);
    EXPECT_FALSE(topic.summary().empty()) << topic.id;
    EXPECT_FALSE(document.headline.empty()) << topic.id;
    EXPECT_EQ(document.data.at("schema"), "heatsoak.describe/1") << topic.id;
    EXPECT_EQ(document.data.at("id"), topic.id);
  }
}

/// describe takes the first topic of a name, so a second one could not be described.
TEST(Topics, IdsAreUnique) {
  std::set<std::string> seen;
  for (const Topic& topic : all_topics(kShippedFolders)) {
    EXPECT_TRUE(seen.insert(topic.id).second) << topic.id;
  }
}

TEST(Topics, AMisspeltNameIsAnsweredWithASimilarOne) {
  try {
    static_cast<void>(description_of("windagee", kShippedFolders));
    FAIL();
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
    EXPECT_THAT(failure.what(), HasSubstr("did you mean 'windage'"));
    EXPECT_THAT(failure.what(), HasSubstr("`heatsoak list topics` shows the names"));
  }
  try {
    static_cast<void>(description_of("vehicle_sped", kShippedFolders));
    FAIL();
  } catch (const base::Failure& failure) {
    EXPECT_THAT(failure.what(), HasSubstr("did you mean 'vehicle_speed'"));
  }
}

std::string labelled(const Table& table, std::string_view label) {
  for (const std::vector<Text>& row : table.rows) {
    if (row.front().words == label) {
      return row.back().words;
    }
  }
  return "";
}

TEST(Topics, ASignalIsDescribedFromItsRow) {
  const Document document = description_of("vehicle_speed", kShippedFolders);
  const Table& table = document.tables.front();
  EXPECT_EQ(labelled(table, "unit"), "m/s");
  EXPECT_THAT(labelled(table, "log column"), HasSubstr("vehicle_speed_m_per_s: speed of the robot over the ground"));
  EXPECT_EQ(labelled(table, "averaging"), "mean of an interval");
  EXPECT_EQ(labelled(table, "default"), "0 m/s");
  EXPECT_THAT(labelled(table, "worst case"), HasSubstr("heats winding and bodies most"));
  EXPECT_THAT(labelled(table, "needed by"), HasSubstr("vehicle_airflow"));
  EXPECT_EQ(document.data.at("log_column"), "vehicle_speed_m_per_s");
  EXPECT_THAT(labelled(description_of("age", kShippedFolders).tables.front(), "worst case"), HasSubstr("from 0.01 h to 100000 h"));
  EXPECT_EQ(labelled(description_of("copper_loss", kShippedFolders).tables.front(), "averaging"), "") << "the effect of this name";
}

TEST(Topics, EverySignalIsInTheirTable) {
  const Document document = description_of("signals", kShippedFolders);
  const std::vector<std::vector<Text>>& rows = document.tables.front().rows;
  ASSERT_EQ(rows.size(), base::kSignals.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].front().words, base::kSignals[i].name);
    EXPECT_EQ(description_of(std::string(base::kSignals[i].name), kShippedFolders).data.at("id"), base::kSignals[i].name);
  }
}

TEST(Topics, ASignalWithoutUnitSaysSo) {
  const auto unit_of = [](const char* signal) {
    return description_of(signal, kShippedFolders).tables.front().rows.front().back().words;
  };
  EXPECT_EQ(unit_of("modulation"), "a number without unit");
  EXPECT_EQ(unit_of("bus_voltage"), "V");
}

TEST(Topics, ALogColumnIsDescribedAsItsSignal) {
  EXPECT_EQ(description_of("torque_Nm", kShippedFolders).data.at("id"), "shaft_power");
  EXPECT_EQ(description_of("duty_ratio", kShippedFolders).data.at("id"), "modulation") << "the earlier name";
  EXPECT_THROW(static_cast<void>(description_of("", kShippedFolders)), base::Failure);
}

TEST(List, EachKindHasItsRowsInTableAndData) {
  const std::set<std::string> topics = ids_of(list_document("topics", kShippedFolders));
  for (const std::string& kind : listed_kinds()) {
    const Document document = list_document(kind, kShippedFolders);
    EXPECT_EQ(document.data.at("kind"), kind);
    ASSERT_EQ(document.tables.size(), 1U);
    EXPECT_FALSE(document.tables.front().rows.empty()) << kind;
    EXPECT_EQ(document.tables.front().rows.size(), document.data.at("items").size()) << kind;
    if (kind != "formats") {
      for (const std::string& id : ids_of(document)) {
        EXPECT_TRUE(topics.contains(id)) << id;
      }
    }
  }
}

TEST(List, FormatsAreThoseOfTheProgram) {
  const std::set<std::string> formats = ids_of(list_document("formats", kShippedFolders));
  for (const Renderer& renderer : all_renderers()) {
    EXPECT_TRUE(formats.contains(std::string(renderer.name)));
  }
  for (const std::string_view ending : report::kPictureEndings) {
    EXPECT_TRUE(formats.contains(std::string(ending.substr(1))));
  }
}

TEST(List, TablesOfVerbsAreFormats) {
  const std::vector<TableOutput> tables{{".csv", "table of every signal", "simulate --out"}};
  const Json items = list_document("formats", kShippedFolders, tables).data.at("items");
  EXPECT_EQ(items.back().at("id"), "csv");
  EXPECT_EQ(items.back().at("summary"), "table of every signal; simulate --out FILE.csv");
  EXPECT_FALSE(ids_of(list_document("motors", kShippedFolders, tables)).contains("csv"));
}

TEST(List, AFolderWithoutFilesIsAnError) {
  input::DataFolders some = kShippedFolders;
  some.robots = kSource / "src";  // it has no .toml file
  EXPECT_NO_THROW(static_cast<void>(list_document("motors", some)));
  EXPECT_THROW(static_cast<void>(list_document("robots", some)), base::Failure);
  EXPECT_THROW(static_cast<void>(list_document("topics", some)), base::Failure);
}

TEST(Topics, TheQuietFormOfTheVerdictsNamesThemAll) {
  RenderOptions options;
  options.is_quiet = true;
  const std::string quiet = terminal_text(description_of("verdict", kShippedFolders), options);
  for (const char* verdict : {"pass", "marginal", "fail", "infeasible", "Undecided"}) {
    EXPECT_THAT(quiet, HasSubstr(verdict));
  }
}

TEST(Topics, EachVerdictIsDescribedAndLeadsToTheOthers) {
  for (const char* verdict : {"pass", "marginal", "fail", "infeasible", "undecided"}) {
    const Document document = description_of(verdict, kShippedFolders);
    EXPECT_EQ(document.data.at("id"), verdict);
    EXPECT_FALSE(document.paragraphs.front().empty());
    ASSERT_EQ(document.notes.size(), 1U);
    EXPECT_THAT(document.notes.front().words, HasSubstr("describe verdict"));
  }
}

}  // namespace
}  // namespace heatsoak::present
