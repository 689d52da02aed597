// Functional mock-up units: compiled, loaded and driven like in a simulator, compared with the integrator and the guard of this program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <set>

#include "base/diagnostic.h"
#include "duty/duty.h"
#include "exported_motor.h"
#include "fmu_unit.h"
#include "robot/motor_drive.h"
#include "select/evaluate.h"
#include "support/skip_reasons.h"
#include "thermal/transient.h"

namespace heatsoak::derate {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr const char* kChassisInWind = R"([effects.chassis]
type = "third_node"
heat_capacity = { value = "60 J/K", origin = "estimated", derivation = "a test" }
conductance = { value = "0.3 W/K", origin = "estimated", derivation = "a test" }
leak_ratio = { value = "0.2", origin = "estimated", derivation = "a test" }
[effects.wind]
type = "vehicle_airflow"
conductance = { value = "0.05 W/K", origin = "estimated", derivation = "a test" }
exponent = { value = "0.8", origin = "estimated", derivation = "a test" }
)";

/// Demand of a wheel for a quarter of a second.
struct Moment {
  double duration_s = 0.0;
  double current_A = 0.0;
  double speed_rad_per_s = 0.0;
  double vehicle_speed_m_per_s = 0.0;
};

/// Demands of a generated match, limited by voltage and motor controller.
std::vector<Moment> random_match(const motor::Motor& motor, std::uint64_t seed) {
  const robot::Robot robot = twente();
  const duty::WheelDemand wheel =
      select::draw_demands(duty::read_duty(kSource / "duty_profiles/division_a_match.toml"), robot, seed, 1, 1).front();
  std::vector<Moment> moments;
  constexpr double kLongest_s = 240.0;
  double sum_s = 0.0;
  for (const duty::LoadBin& bin : wheel.bins) {
    const robot::DrivePoint point = robot::drive_point(motor.nominal, robot, {bin.torque_rms_Nm, bin.speed_rms_rad_per_s});
    const double sign = bin.torque_along_motion_Nm < 0.0 ? -1.0 : 1.0;
    moments.push_back(
        {bin.duration_s, sign * point.current_A, point.motor_speed_rad_per_s, bin.speed_mean_rad_per_s * robot.wheels.radius_m});
    sum_s += bin.duration_s;
    if (sum_s > kLongest_s) {
      break;
    }
  }
  return moments;
}

class Fmu : public testing::TestWithParam<int> {
 protected:
  [[nodiscard]] static std::string form(const char* kind) { return fmt::format("fmi{}_{}", GetParam(), kind); }
  static void give(FmuUnit& unit, const Moment& moment, double ambient_C) {
    EXPECT_EQ(unit.set("current_A", moment.current_A), 0);
    EXPECT_EQ(unit.set("speed_rad_per_s", moment.speed_rad_per_s), 0);
    EXPECT_EQ(unit.set("ambient_C", ambient_C), 0);
    if (unit.has("vehicle_speed_m_per_s")) {
      EXPECT_EQ(unit.set("vehicle_speed_m_per_s", moment.vehicle_speed_m_per_s), 0);
    }
  }
};

/// Returns the largest difference to CVODES over a match, in K.
double difference_K(FmuUnit& unit, const motor::Motor& motor, const std::vector<Moment>& match, const std::vector<std::string>& outputs) {
  constexpr double kAir_C = 31.0;
  constexpr double kStart_C = 44.0;
  const thermal::Network network = motor::datasheet_network(motor, motor::nominal_sample(motor));
  std::vector<double> state_C(static_cast<std::size_t>(network.state_count()), kStart_C);
  for (const std::string& output : outputs) {
    EXPECT_EQ(unit.set(output.substr(0, output.size() - 2) + "_start_C", kStart_C), 0);
  }
  EXPECT_EQ(unit.enter(), 0);
  EXPECT_EQ(unit.run(), 0);
  double now_s = 0.0;
  double most_K = 0.0;
  for (const Moment& moment : match) {
    EXPECT_EQ(unit.set("current_A", moment.current_A), 0);
    EXPECT_EQ(unit.set("speed_rad_per_s", moment.speed_rad_per_s), 0);
    EXPECT_EQ(unit.set("ambient_C", kAir_C), 0);
    if (unit.has("vehicle_speed_m_per_s")) {
      EXPECT_EQ(unit.set("vehicle_speed_m_per_s", moment.vehicle_speed_m_per_s), 0);
    }
    EXPECT_EQ(unit.step(now_s, moment.duration_s), 0);
    now_s += moment.duration_s;
    const std::array<double, observed::kSignalCount> signals{
        moment.current_A, moment.speed_rad_per_s, kAir_C, moment.vehicle_speed_m_per_s, kAir_C, 0.0, 0.0};
    thermal::TransientOptions options;
    options.start_C = state_C;
    state_C = thermal::run_transient(
                  network, network.values(),
                  std::vector<thermal::Interval>{{moment.duration_s, operating_point<double>(motor.nominal, twente(), signals)}}, options)
                  .end_C;
    for (std::size_t node = 0; node < outputs.size(); ++node) {
      most_K = std::max(most_K, std::abs(unit.get(outputs[node]) - state_C[node]));
    }
  }
  return most_K;
}

TEST_P(Fmu, MotorFollowsTheIntegratorOverRandomMatches) {
  FmuUnit plain(compiled(form("motor"), ecx_derating()), GetParam());
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    EXPECT_LT(difference_K(plain, ecx_32(), random_match(ecx_32(), seed), {"winding_C", "stator_C"}), 0.02);
    EXPECT_GT(plain.get("winding_peak_C"), 50.0) << "the match must heat the motor";
    EXPECT_EQ(plain.reset(), 0);
  }
}

TEST_P(Fmu, MotorWithEffectsFollowsTheIntegratorToo) {
  const motor::Motor motor = ecx_32_with(kChassisInWind);
  const Derating derating = derating_of(motor);
  FmuUnit unit(compiled(form("motor"), derating), GetParam());
  std::vector<std::string> outputs;
  for (const std::string& node : derating.observer.state_names()) {
    outputs.push_back(node + "_C");
  }
  ASSERT_EQ(outputs.size(), 3U);
  EXPECT_LT(difference_K(unit, motor, random_match(motor, 5), outputs), 0.02);
}

// A long step has many inner steps, so its result must equal that of short steps.
TEST_P(Fmu, MotorsLongStepsAreAsExactAsShortOnes) {
  const std::string bytes = compiled(form("motor"), ecx_derating());
  FmuUnit once(bytes, GetParam());
  FmuUnit often(bytes, GetParam());
  for (FmuUnit* unit : {&once, &often}) {
    EXPECT_EQ(unit->enter(), 0);
    EXPECT_EQ(unit->run(), 0);
    give(*unit, {0.0, 6.0, 300.0, 0.0}, 40.0);
  }
  constexpr double kLong_s = 40.0;
  EXPECT_EQ(once.step(0.0, kLong_s), 0);
  for (int i = 0; i < 400; ++i) {
    EXPECT_EQ(often.step(0.1 * i, 0.1), 0);
  }
  EXPECT_NEAR(once.get("winding_C"), often.get("winding_C"), 0.01);
  EXPECT_TRUE(once.get_boolean("over_limit"));
  EXPECT_EQ(once.get("winding_limit_C"), 155.0);
}

TEST_P(Fmu, RollbackGivesTheSameBits) {
  for (const char* kind : {"motor", "guard"}) {
    const std::string bytes = compiled(form(kind), ecx_derating());
    const std::vector<Moment> match = random_match(ecx_32(), 9);
    const std::vector<std::string> outputs = *kind == 'm'
                                                 ? std::vector<std::string>{"winding_C", "stator_C", "winding_peak_C"}
                                                 : std::vector<std::string>{"allowed_current_A", "guarded_winding_C", "nominal_winding_C"};
    FmuUnit unit(bytes, GetParam());
    EXPECT_EQ(unit.enter(), 0);
    EXPECT_EQ(unit.run(), 0);
    const auto drive = [&](FmuUnit& of, std::size_t first, std::size_t last) {
      std::vector<double> seen;
      double now_s = of.get("time_s");
      for (std::size_t i = first; i < last; ++i) {
        give(of, match[i], 30.0);
        EXPECT_EQ(of.step(now_s, match[i].duration_s), 0);
        now_s += match[i].duration_s;
        for (const std::string& output : outputs) {
          seen.push_back(of.get(output));
        }
      }
      return seen;
    };
    const auto same = [](const std::vector<double>& a, const std::vector<double>& b) {
      return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
    };
    drive(unit, 0, 200);
    void* const kept = unit.keep();
    const std::vector<double> first = drive(unit, 200, 400);
    EXPECT_EQ(unit.bring_back(kept), 0);
    EXPECT_TRUE(same(drive(unit, 200, 400), first)) << kind;
    // Restores the state in another instance from its bytes.
    const std::vector<char> state = unit.bytes_of(kept);
    FmuUnit other(bytes, GetParam());
    void* restored = nullptr;
    EXPECT_EQ(other.from_bytes(state, &restored), 0);
    EXPECT_EQ(other.bring_back(restored), 0);
    EXPECT_TRUE(same(drive(other, 200, 400), first)) << kind;
    std::vector<char> foreign = state;
    foreign[2] ^= 1;
    void* none = nullptr;
    EXPECT_NE(other.from_bytes(foreign, &none), 0);
    foreign.pop_back();
    EXPECT_NE(other.from_bytes(foreign, &none), 0);
    other.forget(restored);
    unit.forget(kept);
  }
}

TEST_P(Fmu, GuardIsTheOneOfTheFirmware) {
  FmuUnit unit(compiled(form("guard"), ecx_derating()), GetParam());
  constexpr double kStart_C = 35.0;
  EXPECT_EQ(unit.set("start_C", kStart_C), 0);
  EXPECT_EQ(unit.enter(), 0);
  EXPECT_EQ(unit.run(), 0);
  EXPECT_GT(unit.get("limp_current_A"), 0.0);
  ObserverRun<float> observer(ecx_derating().observer, 0.01F, static_cast<float>(kStart_C));
  RandomLoad driver(3);
  double now_s = 0.0;
  for (int i = 0; i < 6000; ++i) {
    const RandomLoad::Wish wish = driver.after(0.02);
    const double speed_rad_per_s = 0.9 * wish.speed_share * ecx_derating().rules.most_speed_rad_per_s;
    const double current_A = wish.current_share * unit.get("allowed_current_A");
    give(unit, {0.0, current_A, speed_rad_per_s, 0.0}, 40.0);
    EXPECT_EQ(unit.step(now_s, 0.02), 0);
    now_s += 0.02;
    const std::array<float, observed::kSignalCount> input_signals{
        static_cast<float>(current_A), static_cast<float>(speed_rad_per_s), 40.0F, 0.0F, 40.0F, 0.0F, 0.0F};
    observer.step(input_signals);
    observer.step(input_signals);
    ASSERT_NEAR(unit.get("guarded_winding_C"), observer.state_C()[motor::states::winding], 1e-3) << i;
    const double table_A = ecx_derating().table.allowed_A(static_cast<float>(speed_rad_per_s), observer.hottest_body_C(),
                                                          observer.state_C()[motor::states::winding]);
    ASSERT_LE(unit.get("allowed_current_A"), table_A + 1e-3) << i;
    ASSERT_GE(unit.get("allowed_current_A"), 0.95 * table_A - 0.05) << i;
  }
  EXPECT_LE(unit.get("guarded_winding_C"), 155.0);
}

TEST_P(Fmu, GuardTakesAnUnknownInputAtItsHottest) {
  FmuUnit unit(compiled(form("guard"), ecx_derating()), GetParam());
  EXPECT_EQ(unit.enter(), 0);
  EXPECT_EQ(unit.run(), 0);
  EXPECT_EQ(unit.step(0.0, 0.01), 0);
  EXPECT_NE(unit.get_item("reason"), 3);
  EXPECT_EQ(unit.set("speed_rad_per_s", NAN), 0);
  EXPECT_EQ(unit.step(0.01, 0.01), 0);
  EXPECT_EQ(unit.get_item("reason"), 3) << "input_unknown";
  EXPECT_EQ(unit.get("allowed_current_A"), 0.0);
}

TEST_P(Fmu, WrongCallsAreRefusedAndLogged) {
  const std::string bytes = compiled(form("motor"), ecx_derating());
  EXPECT_FALSE(FmuUnit(bytes, GetParam(), "another").is_made());
  FmuUnit unit(bytes, GetParam());
  fmu_log().clear();
  EXPECT_NE(unit.step(0.0, 0.1), 0) << "not initialised";
  EXPECT_EQ(unit.enter(), 0);
  EXPECT_NE(unit.enter(), 0);
  EXPECT_EQ(unit.run(), 0);
  EXPECT_NE(unit.set("current_A", NAN), 0);
  EXPECT_NE(unit.set("winding_C", 20.0), 0);
  EXPECT_NE(unit.set("winding_start_C", 20.0), 0);
  EXPECT_NE(unit.set_reference(999, 1.0), 0);
  EXPECT_NE(unit.step(0.0, -0.1), 0);
  EXPECT_NE(unit.step(7.0, 0.1), 0);
  EXPECT_EQ(fmu_log().size(), 8U);
  EXPECT_EQ(unit.step(0.0, 0.1), 0) << "a refused call changes nothing";
  EXPECT_EQ(unit.set("current_A", 1e200), 0);
  EXPECT_NE(unit.step(0.1, 10.0), 0) << "no temperature follows";
}

TEST_P(Fmu, SameInputsGiveTheSameBytesAndSourcesAlone) {
  for (const char* kind : {"motor", "guard"}) {
    const std::string bytes = exported(form(kind));
    setenv("TZ", "Pacific/Auckland", 1);
    tzset();
    EXPECT_EQ(exported(form(kind)), bytes);
    unsetenv("TZ");
    tzset();
    for (const auto& [path, content] : unpacked(bytes)) {
      EXPECT_FALSE(path.starts_with("binaries/"));
    }
    EXPECT_EQ(compiled(form(kind), ecx_derating()), compiled(form(kind), ecx_derating()));
  }
}

// Strict readers of ZIP files reject bytes behind the record at the end, which is 22 bytes long without a comment.
TEST_P(Fmu, EndsWithTheEndOfItsArchive) {
  const std::string bytes = exported(form("motor"));
  EXPECT_EQ(bytes.rfind("PK\x05\x06"), bytes.size() - 22);
}

TEST_P(Fmu, DescriptionHasUnitsStartValuesAndWhatItCanDo) {
  for (const char* kind : {"motor", "guard"}) {
    const std::string xml = unpacked(exported(form(kind))).at("modelDescription.xml");
    const Attributes can = elements_with(xml, "modelIdentifier").at(0);
    for (const char* ability : GetParam() == 2
                                   ? std::array{"canGetAndSetFMUstate", "canSerializeFMUstate", "canHandleVariableCommunicationStepSize"}
                                   : std::array{"canGetAndSetFMUState", "canSerializeFMUState", "canHandleVariableCommunicationStepSize"}) {
      EXPECT_EQ(can.at(ability), "true");
    }
    std::set<std::string> units;
    for (const Attributes& each : elements_with(xml, "name")) {
      if (each.at("") == "Unit") {
        units.insert(each.at("name"));
      }
    }
    for (const Attributes& each : elements_with(xml, "unit")) {
      EXPECT_TRUE(units.contains(each.at("unit"))) << each.at("unit");
    }
    EXPECT_THAT(xml, HasSubstr("<BaseUnit K=\"1\" offset=\"273.15\"/>"));
    EXPECT_FALSE(elements_with(xml, "stepSize").empty());
    std::size_t inputs = 0;
    for (const Attributes& each : elements_with(xml, "causality")) {
      inputs += each.at("causality") == "input" ? 1 : 0;
      EXPECT_TRUE(each.contains("variability")) << each.at("name");
    }
    EXPECT_EQ(inputs, 3U);
  }
}

// The official schemas are not part of the project. HEATSOAK_FMI_SCHEMAS names a folder with fmi2ModelDescription.xsd and its parts.
TEST_P(Fmu, DescriptionFollowsTheOfficialSchema) {
  const char* const folder = std::getenv("HEATSOAK_FMI_SCHEMAS");
  if (folder == nullptr) {
    GTEST_SKIP() << HEATSOAK_LACKS_CONSUMER("fmi") "HEATSOAK_FMI_SCHEMAS is not set";
  }
  for (const char* kind : {"motor", "guard"}) {
    const auto files = unpacked(exported(form(kind)));
    const fs::path file = fs::path(testing::TempDir()) / fmt::format("heatsoak_{}_{}.xml", form(kind), static_cast<int>(getpid()));
    const auto check = [&](const char* path, const char* schema) {
      std::ofstream(file) << files.at(path);
      EXPECT_EQ(
          std::system(fmt::format("xmllint --noout --schema '{}/fmi{}{}.xsd' '{}'", folder, GetParam(), schema, file.string()).c_str()), 0);
    };
    check("modelDescription.xml", "ModelDescription");
    if (GetParam() == 3) {
      check("sources/buildDescription.xml", "BuildDescription");
    }
    fs::remove(file);
  }
}

// FMPy (BSD) is a common reader of these files. It is no Debian package, so the test may be skipped.
TEST_P(Fmu, FmpyAcceptsAndRunsIt) {
  if (std::system("python3 -c 'import fmpy' > /dev/null 2>&1") != 0) {
    GTEST_SKIP() << HEATSOAK_LACKS_CONSUMER("fmpy") "python3 has no fmpy";
  }
  for (const char* kind : {"motor", "guard"}) {
    const fs::path file = fs::path(testing::TempDir()) / fmt::format("heatsoak_{}_{}.fmu", form(kind), static_cast<int>(getpid()));
    std::ofstream(file, std::ios::binary) << compiled(form(kind), ecx_derating());
    const std::string script = fmt::format(
        "import fmpy, fmpy.validation as v; f='{}'; p=v.validate_fmu(f); assert not p, p; "
        "r=fmpy.simulate_fmu(f, stop_time=1.0, step_size=0.01, output_interval=0.1); assert len(r)==11, len(r)",
        file.string());
    EXPECT_EQ(std::system(fmt::format("python3 -c \"{}\"", script).c_str()), 0) << kind;
    fs::remove(file);
  }
}

TEST_P(Fmu, SourcesCompileWithoutAWarning) {
  const fs::path folder = fs::path(testing::TempDir()) / fmt::format("heatsoak_{}_{}", form("sources"), static_cast<int>(getpid()));
  fs::create_directories(folder);
  for (const auto& [path, content] : unpacked(exported(form("motor")))) {
    if (path.starts_with("sources/")) {
      std::ofstream(folder / path.substr(8)) << content;
    }
  }
  EXPECT_EQ(std::system(fmt::format("cd '{}' && cc -std=c99 -Wall -Wextra -Wconversion -Wshadow -pedantic -Werror -fsyntax-only *.c",
                                    folder.string())
                            .c_str()),
            0);
  fs::remove_all(folder);
}

TEST_P(Fmu, RefusesAnEffectThatNoSimulationCanFeed) {
  Derating with_column = ecx_derating();
  with_column.effects.push_back({"fan", "tabulated", "", "fan_current_A"});
  try {
    static_cast<void>(exported(form("motor"), with_column));
    ADD_FAILURE() << "was accepted";
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
    EXPECT_THAT(failure.what(), HasSubstr(form("motor") + " cannot express fan (tabulated)"));
    EXPECT_THAT(failure.what(), HasSubstr("fan_current_A"));
  }
}

TEST_P(Fmu, SaysWhyACompilerMadeNothing) {
  const auto refusal = [](const std::string& compiler) {
    try {
      for (const ExporterType& each : all_exporters()) {
        if (each.name == form("motor")) {
          static_cast<void>(each.write_compiled(ecx_derating(), compiler));
        }
      }
    } catch (const base::Failure& failure) {
      return std::string(failure.what());
    }
    return std::string("accepted");
  };
  EXPECT_THAT(refusal("no_such_compiler"), HasSubstr("--compiler no_such_compiler: cannot be run"));
  EXPECT_THAT(refusal("false"), HasSubstr("expected a C99 compiler such as cc"));
}

INSTANTIATE_TEST_SUITE_P(Versions, Fmu, testing::Values(2, 3));

}  // namespace
}  // namespace heatsoak::derate
