// Duty files with `base`, which contain only the differences from another file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "duty/duty.h"
#include "duty/file_kind.h"
#include "duty/match/match_duty.h"
#include "support/source_folder.h"

namespace heatsoak::duty {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Inheritance : public testing::Test {
 protected:
  Inheritance() : folder_(fs::path(testing::TempDir()) / ("heatsoak_inheritance_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
    fs::copy_file(kSource / "duty_profiles/division_a_match.toml", folder_ / "division_a_match.toml", fs::copy_options::overwrite_existing);
  }
  ~Inheritance() override { fs::remove_all(folder_); }
  Inheritance(const Inheritance&) = delete;
  Inheritance& operator=(const Inheritance&) = delete;

  fs::path write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  std::string refusal(const fs::path& file) {
    try {
      read_duty(file);
    } catch (const base::Failure& failure) {
      return failure.what();
    }
    return "";
  }
  fs::path folder_;
};

const MatchInputs& inputs_of(const Duty& duty) { return dynamic_cast<const MatchDuty&>(*duty.shape_data).inputs(); }

TEST_F(Inheritance, states_only_what_differs) {
  const fs::path file = write(
      "mine.toml",
      "base = \"division_a_match\"\nsummary = \"ours\"\nambient = { value = \"31 degC\", origin = \"estimated\", derivation = \"hall\" }\n"
      "[match]\nrole = \"keeper\"\n");
  EXPECT_EQ(file_kind(file), FileKind::duty);
  const Duty base = read_duty(folder_ / "division_a_match.toml");
  const Duty duty = read_duty(file);
  EXPECT_EQ(duty.id, "mine");
  EXPECT_EQ(duty.summary, "ours");
  EXPECT_EQ(duty.origin, base.origin);
  EXPECT_EQ(duty.ambient_C.value, 31.0);
  EXPECT_FALSE(duty.ambient_C.spread) << "a value is replaced as a whole";
  EXPECT_EQ(inputs_of(duty).role, Role::keeper);
  EXPECT_EQ(inputs_of(duty).nominal().running_mean_s, inputs_of(base).nominal().running_mean_s);
}

TEST_F(Inheritance, follows_a_chain_and_ends_a_circle) {
  write("middle.toml", "base = \"division_a_match\"\nsummary = \"middle\"\n");
  EXPECT_EQ(read_duty(write("last.toml", "base = \"middle.toml\"\n")).summary, "middle");
  EXPECT_THAT(refusal(write("self.toml", "base = \"self\"\n")), HasSubstr("check whether a file refers to itself"));
}

TEST_F(Inheritance, problems_have_their_place) {
  EXPECT_THAT(refusal(write("lost.toml", "base = \"nothing\"\n")),
              AllOf(HasSubstr("lost.toml:1:8: error: base: there is no"), HasSubstr("nothing.toml")));
  EXPECT_THAT(refusal(write("odd.toml", "base = 5\n")), HasSubstr("odd.toml:1:8: error: base: is a number"));
  EXPECT_THAT(refusal(write("wrong.toml", "base = \"division_a_match\"\n[match]\nroll = \"keeper\"\n")),
              HasSubstr("wrong.toml:3:8: error: match.roll"));
}

TEST_F(Inheritance, division_b_differs_from_division_a_by_field_and_distance) {
  const Duty a = read_duty(kSource / "duty_profiles/division_a_match.toml");
  const Duty b = read_duty(kSource / "duty_profiles/division_b_match.toml");
  EXPECT_EQ(inputs_of(a).division, Division::a);
  EXPECT_EQ(inputs_of(b).division, Division::b);
  int differences = 0;
  for (std::size_t i = 0; i < inputs_of(a).parameters.size(); ++i) {
    differences += inputs_of(a).parameters[i].value != inputs_of(b).parameters[i].value ? 1 : 0;
  }
  EXPECT_EQ(differences, 1);
  EXPECT_EQ(inputs_of(a).nominal().distance_median_m, 1.2);
  EXPECT_EQ(inputs_of(b).nominal().distance_median_m, 0.9);
}

}  // namespace
}  // namespace heatsoak::duty
