// Mistakes of usage are refused with a hint.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "program_run.h"
#include "short_runs.h"
#include "support/source_folder.h"

namespace heatsoak {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::MatchesRegex;

TEST(Usage, evaluate_takes_motor_as_the_other_verbs_do) {
  const Words rest{"--robot", "roboteam_twente_v2024", "--duty", "paper_intermittent", "--samples", "0", "maxon_ec45_flat_70w_24v"};
  const auto answer = [&](const std::string& option) {
    Words words{"evaluate"};
    words.insert(words.end(), rest.begin(), rest.end() - 1);
    words.insert(words.end(), {option, rest.back()});
    return run(words);
  };
  EXPECT_EQ(answer("--motor").exit_code, 0);
  EXPECT_EQ(answer("--motor").out, answer("--motors").out);
}

TEST(Usage, version) {
  const ProgramRun result = run({"--version"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, MatchesRegex("heatsoak [0-9]+\\.[0-9]+\\.[0-9]+\\+[0-9a-f]{8}\n"));
}

struct Mistake {
  std::string name;
  Words words;
  std::string said;
};
class Usage : public testing::TestWithParam<Mistake> {};

TEST_P(Usage, is_refused_with_a_hint) {
  const ProgramRun result = run(GetParam().words);
  EXPECT_EQ(result.exit_code, 2) << result.out << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, HasSubstr(GetParam().said));
}

INSTANTIATE_TEST_SUITE_P(
    mistakes, Usage,
    testing::Values(
        Mistake{"nothing", {}, "there is no verb; expected one, such as `heatsoak evaluate`"},
        Mistake{"unknown_verb", {"evaluat"}, "did you mean 'evaluate'?"}, Mistake{"far_verb", {"zzzzzzzz"}, "--help"},
        Mistake{"empty_verb", {""}, "--help"}, Mistake{"option_before_verb", {"--db", "/tmp", "list", "motors"}, "--db"},
        Mistake{"unknown_option", kShortEvaluate + Words{"--sample", "5"}, "did you mean '--samples'?"},
        Mistake{"missing_value", kShortSteady + Words{"--json"}, "--json"},
        Mistake{"an_option_in_place_of_a_value",
                {"diagnose", "--model", "maxon_ec45_flat_70w_24v", "--train", "a.csv", "--holdout", "--out", "D"},
                "--holdout has no value; expected LOG before --out"},
        Mistake{"option_twice", kShortSteady + Words{"--current-on", "5"}, "--current-on is given more than once; expected one value"},
        Mistake{"missing_option", {"steady", "--motor", "maxon_ec45_flat_70w_24v"}, "is required"},
        Mistake{"unknown_kind", {"list", "motor"}, "motors"}, Mistake{"no_kind", {"list"}, "motors, robots, duties, effects, formats"},
        Mistake{"empty_name_of_a_motor",
                {"evaluate", "--robot", "tigers_v2020", "--duty", "paper_intermittent", "--motors", ",", "--samples", "0"},
                "a name is missing before or after a comma"},
        Mistake{"lint_of_two_nothings", {"lint", "nosuch.toml", "maxon_foo"}, "nosuch.toml"},
        Mistake{"lint_of_nothing", {"lint", "maxon_ec45_flat_70w_24"}, "did you mean 'maxon_ec45_flat_70w_24v'?"},
        Mistake{"lint_of_an_empty_folder", {"lint", (kSource / "reports").string()}, "there is no .toml file in the folder"},
        Mistake{"unknown_motor",
                {"steady", "--motor", "maxon_ec45_flat_70w_24", "--current-on", "1", "--time-on", "1", "--time-off", "1"},
                "did you mean 'maxon_ec45_flat_70w_24v'?"},
        Mistake{"unknown_robot", {"evaluate", "--robot", "tigers_v2021", "--duty", "paper_intermittent"}, "did you mean 'tigers_v2020'?"},
        Mistake{
            "unknown_duty", {"evaluate", "--robot", "tigers_v2020", "--duty", "paper_intermitent"}, "did you mean 'paper_intermittent'?"},
        Mistake{"unknown_name", {"describe", "conducton"}, "did you mean 'conduction'?"},
        Mistake{"empty_motor",
                {"evaluate", "--robot", "tigers_v2020", "--duty", "paper_intermittent", "--motors", ""},
                "the value of --motors is empty"},
        Mistake{"current_in_volt",
                {"steady", "--motor", "maxon_ec45_flat_70w_24v", "--current-on", "6V", "--time-on", "1", "--time-off", "1"},
                "no unit of this quantity"},
        Mistake{"negative_current",
                {"steady", "--motor", "maxon_ec45_flat_70w_24v", "--current-on", "-6", "--time-on", "1", "--time-off", "1"},
                "out of range"},
        Mistake{"current_nan",
                {"steady", "--motor", "maxon_ec45_flat_70w_24v", "--current-on", "nan", "--time-on", "1", "--time-off", "1"},
                "not a finite number"},
        Mistake{"current_1e400",
                {"steady", "--motor", "maxon_ec45_flat_70w_24v", "--current-on", "1e400", "--time-on", "1", "--time-off", "1"},
                "too large"},
        Mistake{"current_1e200",
                {"steady", "--motor", "maxon_ec45_flat_70w_24v", "--current-on", "1e200A", "--time-on", "1", "--time-off", "1"},
                "1e200A is out of range; expected 0 A to 100000 A"},
        Mistake{"decimal_comma",
                {"steady", "--motor", "maxon_ec45_flat_70w_24v", "--current-on", "6,5A", "--time-on", "1", "--time-off", "1"},
                "decimal comma"},
        Mistake{"zero_time_on",
                {"steady", "--motor", "maxon_ec45_flat_70w_24v", "--current-on", "6", "--time-on", "0", "--time-off", "1"},
                "out of range"},
        Mistake{"cold_ambient", kShortSteady + Words{"--ambient", "-300 degC"}, "out of range"},
        Mistake{"negative_samples", kShortEvaluate + Words{"--samples", "-1"}, "--samples: '-1' is not a whole number from 0 to 1000000"},
        Mistake{"half_samples", kShortEvaluate + Words{"--samples", "2.5"}, "--samples"},
        Mistake{"too_many_samples", kShortEvaluate + Words{"--samples", "1000001"}, "--samples"},
        Mistake{"octal_samples", kShortEvaluate + Words{"--samples", "010"}, "--samples"},
        Mistake{"too_many_threads", kShortEvaluate + Words{"--threads", "1025"}, "--threads: '1025' is not a whole number from 0 to 1024"},
        Mistake{"negative_seed", kShortEvaluate + Words{"--seed", "-1"}, "--seed"},
        Mistake{"huge_seed", kShortEvaluate + Words{"--seed", "99999999999999999999"}, "--seed"},
        Mistake{"every_zero", kShortSimulate + Words{"--every", "0"}, "out of range"},
        Mistake{"db_missing", {"list", "motors", "--db", "/nonexistent"}, "no such folder"},
        Mistake{"db_is_a_file", {"list", "motors", "--db", "/dev/null"}, "no such folder"},
        Mistake{"db_name_too_long", {"list", "motors", "--db", std::string(5000, 'a')}, "no such folder"},
        Mistake{"motor_name_too_long", {"lint", std::string(5000, 'a') + ".toml"}, "File name too long"}),
    [](const auto& instance) { return instance.param.name; });

TEST(UsageOf, a_trace_that_would_fill_the_memory_is_refused) {
  const TemporaryFolder folder;
  write(folder.path() / "long.toml",
        "summary = \"x\"\norigin = \"x\"\nshape = \"intermittent\"\nambient = { value = \"25 degC\", origin = \"estimated\", derivation = "
        "\"x\" }\n[intermittent]\n"
        "torque_on = { value = \"50 mN m\", origin = \"estimated\", derivation = \"x\" }\nspeed_on = \"40 rad/s\"\ntime_on = \"4 "
        "s\"\ntime_off = \"6 s\"\nrepeats = \"90000\"\n");
  const ProgramRun result = run({"simulate", "--motor", "maxon_ec45_flat_70w_24v", "--robot", "roboteam_twente_v2024", "--duty",
                                 (folder.path() / "long.toml").string(), "--every", "1 ms"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("--every"));
  EXPECT_LT(result.memory_MB, 300.0);
}

TEST(UsageOf, negative_temperature_needs_no_quoting) {
  EXPECT_EQ(run(kShortSteady + Words{"--ambient", "-10degC"}).exit_code, 0);
  EXPECT_EQ(run(kShortSteady + Words{"--ambient", "-10"}).out, run(kShortSteady + Words{"--ambient=-10 degC"}).out);
}

}  // namespace
}  // namespace heatsoak
