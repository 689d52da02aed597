// Tests of all exporters, then of JSON and MuJoCo.
#include <dlfcn.h>
#include <expat.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/version.h"
#include "exported_motor.h"
#include "exported_text.h"
#include "motor/measured_power.h"
#include "support/skip_reasons.h"
#include "unpacked.h"

namespace heatsoak::derate {
namespace {

class EveryExporter : public testing::TestWithParam<const char*> {};

TEST_P(EveryExporter, SaysWhereItComesFromAndHowSureItIs) {
  const std::string text = readable(exported(GetParam()));
  EXPECT_EQ(exported(GetParam()), exported(GetParam()));
  EXPECT_THAT(text, HasSubstr(fmt::format("heatsoak {}", base::program_version())));
  EXPECT_THAT(text, HasSubstr(ecx_derating().provenance.input_hash));
  EXPECT_THAT(text, HasSubstr("155"));
  EXPECT_THAT(text, HasSubstr("0.95"));
  EXPECT_EQ(text.find("nan"), std::string::npos);
}

TEST_P(EveryExporter, RefusesWhatIsNoNumber) {
  Derating broken = ecx_derating();
  broken.table.heat_per_ohm_A2[3] = std::nan("");
  EXPECT_THAT(refusal(GetParam(), broken), HasSubstr("is not a number"));
}

INSTANTIATE_TEST_SUITE_P(All, EveryExporter,
                         testing::Values("c_header", "c_header_q15", "json", "csv", "moteus", "odrive", "vesc", "simplefoc", "mujoco",
                                         "fmi2_motor", "fmi2_guard", "fmi3_motor", "fmi3_guard"));

TEST(Exporters, ANameThatSuitsAnotherFormatIsNoticed) {
  const auto expected = [](std::string_view exporter, std::string_view file) {
    const ExporterType* const found = expected_by_name(*std::ranges::find(all_exporters(), exporter, &ExporterType::name), file);
    return found == nullptr ? std::string_view() : found->name;
  };
  EXPECT_EQ(expected("csv", "x.h"), "c_header");
  EXPECT_EQ(expected("c_header", "x.csv"), "csv");
  EXPECT_EQ(expected("fmi2_motor", "x.json"), "json");
  for (const auto& [exporter, file] :
       {std::pair("csv", "x.csv"), {"csv", "x"}, {"csv", "x.txt"}, {"c_header_q15", "x.h"}, {"simplefoc", "x.h"}}) {
    EXPECT_EQ(expected(exporter, file), "") << exporter << ' ' << file;
  }
}

TEST(Exporters, ConfidenceIsABoundThatTheDrawsShow) {
  const Guarantee& checked = ecx_derating().guarantee;
  const int most = most_over(ecx_derating().options.guarantee).value();
  EXPECT_LE(checked.over, most);
  // Definition: if the share were lower, so few exceedances would have a probability below 5 %.
  const auto chance_of = [&](int over) {
    constexpr double kOver = 0.05;
    double chance = 0.0;
    for (int k = 0; k <= over; ++k) {
      chance += std::exp(std::lgamma(checked.samples + 1.0) - std::lgamma(k + 1.0) - std::lgamma(checked.samples - k + 1.0) +
                         k * std::log(kOver) + (checked.samples - k) * std::log1p(-kOver));
    }
    return chance;
  };
  EXPECT_LE(chance_of(most), 1.0 - kCertainty_share);
  EXPECT_GT(chance_of(most + 1), 1.0 - kCertainty_share);
  const nlohmann::json guarantee = nlohmann::json::parse(exported("json"))["guarantee"];
  EXPECT_EQ(guarantee["certainty"], kCertainty_share);
  EXPECT_EQ(guarantee["least_samples"], 59);
  EXPECT_THAT(exported("csv"), HasSubstr("# Safety factor on heat"));
}

// The drawn motors selected the factor, so a larger share than the required one would be a promise that fresh motors refute.
TEST_P(EveryExporter, PromisesTheRequiredShareAndNoMore) {
  EXPECT_EQ(nlohmann::json::parse(exported("json"))["guarantee"]["least_kept_share"], 0.95);
  Derating lucky = ecx_derating();
  lucky.guarantee.over = 0;
  const std::string text = readable(exported(GetParam(), lucky));
  EXPECT_THAT(text, testing::AnyOf(HasSubstr("at least 95 % of the motors"), HasSubstr("\"least_kept_share\": 0.95,")));
  EXPECT_THAT(text, testing::AnyOf(HasSubstr("0 of the 400 drawn motors"), HasSubstr("\"over\": 0,")));
}

TEST(Exporters, DoubtfulValuesAreStated) {
  motor::Motor motor = ecx_32();
  motor.fit = motor::MotorFit{};
  EXPECT_EQ(motor::measured_power(motor), std::nullopt);
  motor.fit->heat_input = motor::HeatInput::current;
  EXPECT_EQ(motor::measured_power(motor), std::nullopt);
  motor.fit->heat_input = motor::HeatInput::input_power;
  Derating doubtful = ecx_derating();
  doubtful.measured_power = motor::measured_power(motor);
  doubtful.unmodelled_heat_share = 0.08;
  using motor::LintFact;
  const motor::LintClause estimated{motor::LintWords::estimated, {LintFact(std::string("friction")), LintFact(std::string("1 K/W"))}};
  doubtful.doubtful_values = {{motor::LintFinding::Level::warning, "estimates", estimated, {}, "friction"}};
  for (const char* form : {"c_header", "c_header_q15", "csv", "simplefoc"}) {
    const std::string text = exported(form, doubtful);
    EXPECT_THAT(text, HasSubstr("DOUBTFUL: the thermal values were fitted to heat from measured power (input_power)")) << form;
    EXPECT_THAT(text, HasSubstr("DOUBTFUL: the calibration found heat that the model lacks, 8 %")) << form;
    EXPECT_THAT(text, HasSubstr("DOUBTFUL: " + motor::words_of(doubtful.doubtful_values.front()))) << form;
    EXPECT_EQ(exported(form).find("DOUBTFUL"), std::string::npos) << form;
  }
  EXPECT_EQ(nlohmann::json::parse(exported("json", doubtful))["measured_power"], "input_power");
  EXPECT_TRUE(nlohmann::json::parse(exported("json"))["measured_power"].is_null());
  EXPECT_EQ(nlohmann::json::parse(exported("json", doubtful))["doubtful_values"].size(), 1U);
  EXPECT_TRUE(nlohmann::json::parse(exported("json"))["doubtful_values"].empty());
}

TEST(Exporters, InputHashFollowsTheOptions) {
  DerateOptions other;
  other.hottest_ambient_C = 41.0;
  EXPECT_NE(provenance_of(ecx_32(), twente(), other).input_hash, ecx_derating().provenance.input_hash);
}

TEST(JsonExporter, TableAndObserverAreThoseOfTheDerating) {
  const nlohmann::json file = nlohmann::json::parse(exported("json"));
  EXPECT_EQ(file["schema"], "heatsoak.derating/2");
  const nlohmann::json& table = file["table"];
  const CurrentTable& real = ecx_derating().table;
  ASSERT_EQ(table["heat_per_ohm_A2"].size(), real.heat_per_ohm_A2.size());
  ASSERT_EQ(table["current_A"].size(), real.heat_per_ohm_A2.size());
  EXPECT_FLOAT_EQ(table["resistance_at_0C_ratio"].get<float>(), static_cast<float>(real.resistance_at_0C_ratio));
  EXPECT_FLOAT_EQ(table["resistance_ratio_per_K"].get<float>(), static_cast<float>(real.resistance_ratio_per_K));
  for (std::size_t i = 0; i < real.heat_per_ohm_A2.size(); ++i) {
    EXPECT_LE(table["heat_per_ohm_A2"][i].get<double>(), real.heat_per_ohm_A2[i]);
    EXPECT_NEAR(table["heat_per_ohm_A2"][i].get<double>(), real.heat_per_ohm_A2[i], 1.01e-4);
    EXPECT_LE(table["current_A"][i].get<double>(), real.current_of_A(real.square_A2(i)));
    EXPECT_NEAR(table["current_A"][i].get<double>(), real.current_of_A(real.square_A2(i)), 1.01e-4);
  }
  const nlohmann::json& closed = file["observer"];
  const auto value = [&](const char* key) { return closed[key].get<double>(); };
  const double ratio = value("heat_reserve_ratio_r");
  constexpr double kWinding_C = 110.0;
  constexpr double kCurrent_A = 3.0;
  constexpr double kSpeed_rad_per_s = 200.0;
  ObserverRun<double> run(ecx_derating().observer, 1.0, kWinding_C);
  run.step(std::array<double, observed::kSignalCount>{kCurrent_A, kSpeed_rad_per_s, 40.0, 0.0, 40.0, 0.0, 0.0});
  const double copper_W = value("terminal_resistance_25C_ohm") * (1.0 + value("temperature_coefficient_per_K") * (kWinding_C - 25.0)) *
                          std::pow(value("heating_current_ratio_k") * kCurrent_A, 2.0);
  EXPECT_NEAR(run.state_C()[0], kWinding_C + ratio * copper_W / value("heat_capacity_winding_J_per_K"), 1e-6);
  const double drag_W = value("torque_constant_Nm_per_A") * value("no_load_current_A") * kSpeed_rad_per_s;
  EXPECT_NEAR(run.state_C()[1],
              kWinding_C + (ratio * drag_W - (kWinding_C - 40.0) / value("thermal_resistance_stator_ambient_K_per_W")) /
                               value("heat_capacity_stator_J_per_K"),
              1e-6);
}

constexpr const char* kChassis = R"([effects.chassis]
type = "third_node"
heat_capacity = { value = "60 J/K", origin = "estimated", derivation = "a test" }
conductance = { value = "0.3 W/K", origin = "estimated", derivation = "a test" }
leak_ratio = { value = "0.2", origin = "estimated", derivation = "a test" }
)";
constexpr const char* kAirflow = R"([effects.wind]
type = "vehicle_airflow"
conductance = { value = "0.05 W/K", origin = "estimated", derivation = "a test" }
exponent = { value = "0.8", origin = "estimated", derivation = "a test" }
)";

TEST(Exporters, RefuseByNameWhatTheyCannotExpress) {
  const Derating chassis = derating_of(ecx_32_with(kChassis));
  EXPECT_THAT(refusal("mujoco", chassis), HasSubstr("mujoco cannot express chassis (third_node)"));
  EXPECT_EQ(refusal("moteus", chassis), "accepted") << "the stator's sensor sees what the chassis does";
  EXPECT_EQ(refusal("vesc", chassis), "accepted");
  const Derating wind = derating_of(ecx_32_with(kAirflow));
  for (const char* name : {"vesc", "simplefoc"}) {
    EXPECT_THAT(refusal(name, wind), HasSubstr("wind (vehicle_airflow)")) << name;
    EXPECT_THAT(refusal(name, wind), HasSubstr("vehicle_speed_m_per_s")) << name;
    const Derating both = derating_of(ecx_32_with(std::string(kAirflow) + kChassis));
    EXPECT_THAT(refusal(name, both), testing::AllOf(HasSubstr("wind (vehicle_airflow)"), testing::Not(HasSubstr("chassis")))) << name;
  }
  const Derating soaked = derating_of(ecx_32_with(std::string(kChassis) + "node = \"winding\"\n"));
  for (const char* name : {"moteus", "odrive"}) {
    EXPECT_THAT(refusal(name, soaked), HasSubstr("cannot express chassis")) << name;
  }
  Derating brushed = ecx_derating();
  brushed.is_brushless = false;
  for (const char* name : {"moteus", "odrive", "simplefoc"}) {
    EXPECT_THAT(refusal(name, brushed), HasSubstr("brushed")) << name;
  }
}

// No-load loss is in every motor's network, so it is stated as omitted; see MujocoExporter.
TEST(MujocoExporter, RefusesEveryEffectAndLimitThatAFileMayAddByName) {
  for (const thermal::EffectType& type : thermal::all_effects()) {
    Derating with = ecx_derating();
    with.effects.push_back({.name = "own", .type = std::string(type.name), .equation = "", .column = ""});
    EXPECT_THAT(refusal("mujoco", with), testing::AllOf(HasSubstr(fmt::format("own ({})", type.name)), HasSubstr("--to fmi3_motor")));
  }
  Derating with_limit = ecx_derating();
  with_limit.rules.limits.stator_C = 90.0;
  EXPECT_THAT(refusal("mujoco", with_limit), testing::AllOf(HasSubstr("stator_limit of 90 °C"), HasSubstr("--to fmi3_motor")));
  Derating slow = ecx_derating();
  slow.reachable_speed_rad_per_s = 1.5 * slow.rules.most_speed_rad_per_s;
  EXPECT_THAT(refusal("mujoco", slow), testing::AllOf(HasSubstr("no_load_loss above"), HasSubstr("--to fmi3_motor")));
}

/// Compiles the lines as their 'language' states and returns dT/dt.
std::vector<double> rates_of_lines(const nlohmann::json& file, const std::vector<double>& signals, const std::vector<double>& state_C) {
  const std::filesystem::path stem =
      std::filesystem::path(testing::TempDir()) / fmt::format("heatsoak_rate_lines_{}", static_cast<int>(getpid()));
  std::string text =
      "#include <math.h>\nstatic inline double positive_power(double x, double y) { return x > 0.0 ? pow(x, y) : 0.0; }\n"
      "void rates(const double *in, const double *state_C, double *rate_K_per_s) {\n";
  for (std::size_t i = 0; i < file["signals"].size(); ++i) {
    text += fmt::format("  const double {0} = in[{1}];\n  (void){0};\n", file["signals"][i]["name"].get<std::string>(), i);
  }
  text += "  (void)positive_power;\n";
  for (const nlohmann::json& line : file["observer"]["rate_lines"]) {
    text += line.get<std::string>() + "\n";
  }
  std::ofstream(stem.string() + ".c") << text << "}\n";
  EXPECT_EQ(
      std::system(fmt::format("cc -std=c99 -Wall -Werror -ffp-contract=off -shared -fPIC -o '{0}.so' '{0}.c' -lm", stem.string()).c_str()),
      0)
      << text;
  void* const library = dlopen((stem.string() + ".so").c_str(), RTLD_NOW | RTLD_LOCAL);
  EXPECT_NE(library, nullptr) << dlerror();
  std::vector<double> rate_K_per_s(state_C.size());
  reinterpret_cast<void (*)(const double*, const double*, double*)>(dlsym(library, "rates"))(signals.data(), state_C.data(),
                                                                                             rate_K_per_s.data());
  dlclose(library);
  std::filesystem::remove(stem.string() + ".c");
  std::filesystem::remove(stem.string() + ".so");
  return rate_K_per_s;
}

// The equation of two nodes cannot express other effects, so their laws are written as statements. Before, the file had only names.
TEST(JsonExporter, LawsOfEveryEffectCanBeComputedFromTheFile) {
  for (const char* const laws : {kChassis, kAirflow, kPowerAndExponential}) {
    const Derating derating = derating_of(ecx_32_with(laws));
    const nlohmann::json file = nlohmann::json::parse(exported("json", derating));
    std::vector<double> state_C(derating.observer.state_count());
    for (std::size_t node = 0; node < state_C.size(); ++node) {
      state_C[node] = 120.0 - 17.0 * static_cast<double>(node);
    }
    std::vector<double> inputs{3.0, -200.0, 31.0, 1.5, 55.0, 100.0, 2.0};
    std::vector<double> used;
    for (std::size_t i = 0; i < observed::kSignalCount; ++i) {
      if (derating.observer.uses(static_cast<observed::Signal>(i))) {
        used.push_back(inputs[i]);
      }
    }
    inputs.insert(inputs.end(), state_C.begin(), state_C.end());
    std::vector<double> expected_K_per_s(state_C.size());
    thermal::FormulaRun<double>(derating.observer.formula(), derating.observer.rate_steps()).run(inputs, expected_K_per_s);
    const std::vector<double> found_K_per_s = rates_of_lines(file, used, state_C);
    for (std::size_t node = 0; node < state_C.size(); ++node) {
      // The C library and the formula may round an exponential differently.
      EXPECT_NEAR(found_K_per_s[node], expected_K_per_s[node], 1e-9 * (1.0 + std::abs(expected_K_per_s[node]))) << laws << node;
    }
  }
}

TEST(JsonExporter, EveryEffectHasItsParameters) {
  const nlohmann::json file = nlohmann::json::parse(exported("json", derating_of(ecx_32_with(kChassis))));
  const auto effect =
      std::ranges::find(file["effects"], "chassis", [](const nlohmann::json& each) { return each["id"].get<std::string>(); });
  ASSERT_NE(effect, file["effects"].end());
  EXPECT_THAT((*effect)["nodes"], testing::UnorderedElementsAre("chassis", "stator", "ambient"));
  std::map<std::string, nlohmann::json> by_key;
  for (const nlohmann::json& each : (*effect)["parameters"]) {
    by_key[each["key"]] = each;
  }
  EXPECT_EQ(by_key.at("heat_capacity")["value"], 60.0);
  EXPECT_EQ(by_key.at("heat_capacity")["unit"], "J/K");
  EXPECT_EQ(by_key.at("conductance")["value"], 0.3);
  EXPECT_EQ(by_key.at("leak_ratio")["value"], 0.2);
  for (const nlohmann::json& each : file["effects"]) {
    EXPECT_FALSE(each["parameters"].empty()) << each;
  }
}

TEST(JsonExporter, ChoiceOfAnEffectIsItsName) {
  const nlohmann::json file = nlohmann::json::parse(exported("json", derating_of(ecx_32_with(hump(R"(driver = "speed"
hot = "stator"
first_knot = { value = "0 rad/s", origin = "estimated", derivation = "a test" }
last_knot = { value = "360 rad/s", origin = "estimated", derivation = "a test" }
)",
                                                                                                  4.0)))));
  const nlohmann::json& hump_parameters = file["effects"].back()["parameters"];
  const auto form = std::ranges::find(hump_parameters, "form", [](const nlohmann::json& each) { return each["key"].get<std::string>(); });
  ASSERT_NE(form, hump_parameters.end());
  EXPECT_EQ((*form)["value"], "heat");
}

/// Returns the attributes of an element.
std::map<std::string, std::string> attributes_of(const std::string& xml, const std::string& element) {
  struct Search {
    std::string element;
    std::map<std::string, std::string> found;
  } search{element, {}};
  const XML_Parser parser = XML_ParserCreate(nullptr);
  XML_SetUserData(parser, &search);
  XML_SetStartElementHandler(parser, [](void* user, const XML_Char* name, const XML_Char** attributes) {
    auto& looking = *static_cast<Search*>(user);
    for (int i = 0; looking.element == name && attributes[i] != nullptr; i += 2) {
      looking.found[attributes[i]] = attributes[i + 1];
    }
  });
  EXPECT_EQ(XML_Parse(parser, xml.data(), static_cast<int>(xml.size()), 1), XML_STATUS_OK) << XML_ErrorString(XML_GetErrorCode(parser));
  XML_ParserFree(parser);
  return search.found;
}

// MuJoCo's own schema is not part of the project. HEATSOAK_MJCF_XSD names it (src/xml/generated/mjcf.xsd).
TEST(MujocoExporter, FollowsTheOfficialSchema) {
  const char* const schema = std::getenv("HEATSOAK_MJCF_XSD");
  if (schema == nullptr) {
    GTEST_SKIP() << HEATSOAK_LACKS_CONSUMER("mujoco_schema") "HEATSOAK_MJCF_XSD is not set";
  }
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / fmt::format("heatsoak_mujoco_{}.xml", static_cast<int>(getpid()));
  std::ofstream(file) << exported("mujoco");
  EXPECT_EQ(std::system(fmt::format("xmllint --noout --schema '{}' '{}'", schema, file.string()).c_str()), 0);
  std::filesystem::remove(file);
}

/// The model of a file as MuJoCo steps it (src/engine/engine_forward.c): dT/dt = (R·i² − T/R_th)/C with T above ambient. Order of the
/// attributes: doc/XMLreference.rst.
struct MujocoMotor {
  explicit MujocoMotor(const std::string& file) : attributes(attributes_of(file, "dcmotor")) {
    std::istringstream(attributes.at("thermal")) >> resistance_K_per_W >> capacity_J_per_K >> constant_s >> coefficient_per_K >>
        reference_C >> ambient_C;
  }
  void step(double current_A, double period_s) {
    const double hot_ohm = std::stod(attributes.at("resistance")) * (1.0 + coefficient_per_K * (rise_K + ambient_C - reference_C));
    rise_K += period_s * (hot_ohm * current_A * current_A - rise_K / resistance_K_per_W) / capacity_J_per_K;
  }

  std::map<std::string, std::string> attributes;
  double resistance_K_per_W = 0.0, capacity_J_per_K = 0.0, constant_s = -1.0, coefficient_per_K = 0.0, reference_C = 0.0, ambient_C = 0.0;
  double rise_K = 0.0;
};

TEST(MujocoExporter, HeldCurrentAtStandstillReachesTheObserversTemperature) {
  MujocoMotor motor(exported("mujoco"));
  EXPECT_EQ(motor.constant_s, 0.0);
  EXPECT_EQ(motor.ambient_C, 40.0);
  EXPECT_NEAR(std::stod(motor.attributes.at("motorconst")), ecx_derating().torque_constant_Nm_per_A, 1e-9);
  constexpr double kHeld_A = 2.0;
  ObserverRun<double> observer(ecx_derating().observer, 0.01, 40.0);
  for (int i = 0; i < 200'000; ++i) {
    motor.step(kHeld_A, 0.01);
    observer.step(std::array<double, observed::kSignalCount>{kHeld_A, 0.0, 40.0, 0.0, 40.0, 0.0, 0.0});
    ASSERT_GE(motor.rise_K + 40.0, observer.state_C()[0] - 1e-6) << "while it warms up it is never colder";
  }
  EXPECT_NEAR(motor.rise_K + 40.0, observer.state_C()[0], 0.05);
}

// The file has no no-load loss, so the rise with which a simulation compares allows for it.
TEST(MujocoExporter, StatedRiseIsReachedWhenALastingCurrentHeatsTheTurningMotorToItsLimit) {
  const std::string file = exported("mujoco");
  std::smatch stated;
  ASSERT_TRUE(std::regex_search(file, stated, std::regex("compare it with ([0-9.]+) K"))) << file;
  const double speed_rad_per_s = ecx_derating().rules.most_speed_rad_per_s;
  const auto winding_C = [&](double current_A) {
    ObserverRun<double> observer(ecx_derating().observer, 0.01, 40.0);
    for (int i = 0; i < 400'000; ++i) {
      observer.step(std::array<double, observed::kSignalCount>{current_A, speed_rad_per_s, 40.0, 0.0, 40.0, 0.0, 0.0});
    }
    return observer.state_C()[0];
  };
  double low_A = 0.0;
  double high_A = 3.0;
  ASSERT_GT(winding_C(high_A), 155.0);
  for (int i = 0; i < 14; ++i) {
    const double current_A = 0.5 * (low_A + high_A);
    (winding_C(current_A) > 155.0 ? high_A : low_A) = current_A;
  }
  MujocoMotor motor(file);
  for (int i = 0; i < 400'000; ++i) {
    motor.step(high_A, 0.01);
  }
  EXPECT_LT(std::stod(stated[1]), 100.0) << "the loss counts";
  EXPECT_NEAR(motor.rise_K, std::stod(stated[1]), 0.2);
}

}  // namespace
}  // namespace heatsoak::derate
