// `heatsoak steady`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "program_run.h"
#include "short_runs.h"
#include "support/source_folder.h"

namespace heatsoak {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

TEST(Json, of_steady_keeps_the_contract) {
  const ProgramRun result = run(kShortSteady + Words{"--json", "-"});
  const json answer = result.json();
  EXPECT_EQ(answer.at("schema"), "heatsoak.steady/1");
  for (const char* key : {"current_rms_A", "winding_C", "stator_C"}) {
    EXPECT_TRUE(answer.at(key).is_number()) << key;
  }
  EXPECT_EQ(answer.at("runaway"), false);
  EXPECT_THAT(result.err, HasSubstr("winding"));  // the report for people goes to stderr
}

Words steady(const std::string& motor, const std::string& current_on, const std::string& time_on, const std::string& time_off) {
  return {"steady", "--motor", motor, "--current-on", current_on, "--time-on", time_on, "--time-off", time_off, "--json", "-"};
}

TEST(Steady, mean_of_a_long_cycle_is_that_of_the_network) {
  const json answer = run(steady("maxon_ecx_flat_32l_48v", "5A", "300s", "900s")).json();
  EXPECT_GT(answer.at("winding_mean_C"), answer.at("winding_C").get<double>() + 30.0);
  EXPECT_GT(answer.at("winding_peak_C"), answer.at("winding_mean_C"));
  const json brief = run(steady("maxon_ecx_flat_32l_48v", "5A", "0.3s", "0.9s")).json();
  EXPECT_NEAR(brief.at("winding_mean_C"), brief.at("winding_C"), 0.05);
  EXPECT_EQ(brief.at("winding_C"), answer.at("winding_C"));
}

TEST(Steady, phases_of_an_hour_are_no_failure) {
  const ProgramRun result = run(steady("maxon_ec45_flat_70w_24v", "6A", "1h", "1h"));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NEAR(result.json().at("winding_peak_C"), 509.2, 0.5);
}

TEST(Steady, destroyed_within_one_time_on_is_a_runaway) {
  const ProgramRun result = run(steady("maxon_ec45_flat_70w_24v", "20A", "100s", "100000s"));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.json().at("runaway"), true);
  EXPECT_TRUE(result.json().at("winding_peak_C").is_null());
  EXPECT_LT(result.json().at("destroyed_after_s"), 100.0);
  EXPECT_THAT(result.err, testing::ContainsRegex("1000[ \n]°C[ \n]are[ \n]exceeded"));
}

// The closed-form solution does not include the additional node of an effect.
TEST(Steady, with_effects_mean_and_peak_are_of_one_network) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "mine.toml";
  write(file, content_of(kSource / "motor_db" / "maxon_ec45_flat_70w_24v.toml") +
                  "\n[effects.third_node]\nnode = \"stator\"\n"
                  "conductance = { value = \"0.2 W/K\", origin = \"estimated\", derivation = \"x\" }\n"
                  "leak_ratio = { value = \"0.3\", origin = \"estimated\", derivation = \"x\" }\n"
                  "heat_capacity = { value = \"3000 J/K\", origin = \"estimated\", derivation = \"x\" }\n");
  double shorter_C = 0.0;
  double brief_C = 0.0;
  for (const auto& [on, off] : {std::pair("0.04s", "0.06s"), std::pair("0.4s", "0.6s"), std::pair("4s", "6s"), std::pair("40s", "60s")}) {
    const ProgramRun result = run(steady(file.string(), "6A", on, off));
    ASSERT_NE(result.exit_code, 2) << result.err;
    const json answer = result.json();
    EXPECT_GT(answer.at("winding_peak_C"), answer.at("winding_mean_C")) << on;
    EXPECT_GT(answer.at("winding_peak_C"), shorter_C) << on;
    shorter_C = answer.at("winding_peak_C");
    brief_C = brief_C == 0.0 ? shorter_C : brief_C;
    EXPECT_LT(answer.at("winding_C"), brief_C) << on;
  }
  const json bare = run(steady("maxon_ec45_flat_70w_24v", "6A", "4s", "6s")).json();
  EXPECT_LT(brief_C, bare.at("winding_C")) << "the body leads heat away";
}

TEST(Json, of_a_runaway_has_no_temperatures) {
  const ProgramRun result =
      run({"steady", "--motor", "maxon_ec45_flat_70w_24v", "--current-on", "60", "--time-on", "1", "--time-off", "0", "--json", "-"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.json().at("runaway"), true);
  EXPECT_TRUE(result.json().at("winding_C").is_null());
  EXPECT_TRUE(result.json().at("stator_C").is_null());
}

}  // namespace
}  // namespace heatsoak
