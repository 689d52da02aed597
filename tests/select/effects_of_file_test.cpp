// Additional effects in a motor file, tested in all code that uses a motor.
#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "given_demand.h"
#include "motor/conditions.h"
#include "select/evaluate.h"
#include "select/load_simulation.h"
#include "support/source_folder.h"

namespace heatsoak::select {
namespace {

constexpr const char* kBase = "maxon_ecx_flat_42m_24v";

class MotorFile {
 public:
  explicit MotorFile(const std::string& effects) : path_(std::filesystem::path(testing::TempDir()) / unused_name()) {
    std::ostringstream base;
    base << std::ifstream(kSource / "motor_db" / (std::string(kBase) + ".toml")).rdbuf();
    std::ofstream(path_) << base.str() << effects;
  }
  MotorFile(const MotorFile&) = delete;
  MotorFile& operator=(const MotorFile&) = delete;
  ~MotorFile() { std::filesystem::remove(path_); }
  [[nodiscard]] motor::Motor read() const { return motor::read_motor(path_); }

 private:
  /// Returns a unique name, because tests run in parallel and one test reads several files.
  static std::string unused_name() {
    static int count = 0;
    return "heatsoak_effects_of_file_" + std::to_string(getpid()) + "_" + std::to_string(++count) + ".toml";
  }

  std::filesystem::path path_;
};

std::string estimated(const std::string& key, const std::string& value) {
  return key + " = { value = \"" + value + "\", origin = \"estimated\", derivation = \"test\" }\n";
}

const std::string kChassisAndSkin = "\n[effects.chassis]\ntype = \"third_node\"\n" + estimated("conductance", "0.4 W/K") +
                                    estimated("leak_ratio", "0.5") + estimated("heat_capacity", "60 J/K") +
                                    "\n[effects.skin]\ntype = \"ac_copper_loss\"\n" + estimated("share", "0.3");

/// Three nodes in a row with conduction only; the last is a probe without capacity. Closed-form solution by eigenvalues.
struct ClosedForm {
  Eigen::Matrix3d slope_per_s;
  Eigen::Vector3d drive_K_per_s;
  [[nodiscard]] Eigen::Vector3d rise_K(double time_s) const {
    const Eigen::EigenSolver<Eigen::Matrix3d> solver(slope_per_s);
    const Eigen::Vector3cd decay = (solver.eigenvalues() * time_s).array().exp() - 1.0;
    const Eigen::Matrix3cd V = solver.eigenvectors();
    const Eigen::Vector3cd rise =
        V * (decay.cwiseQuotient(solver.eigenvalues()).asDiagonal() * (V.inverse() * drive_K_per_s.cast<std::complex<double>>()));
    return rise.real();
  }
};

class EffectsOfAFile : public testing::Test {
 protected:
  EffectsOfAFile()
      : robot_(robot::read_robot(kSource / "robot_core/robots/roboteam_twente_v2024.toml")),
        duty_(duty::read_duty(kSource / "duty_profiles/paper_intermittent.toml")) {
    give(duty_, {{300.0, 0.08, 60.0, 0.0}, {300.0, 0.0, 0.0, 0.0}, {200.0, 0.05, 40.0, 0.0}});
  }
  [[nodiscard]] Trace trace(const motor::Motor& motor) const {
    return simulate_load({.robot = robot_, .motor = motor, .duty = duty_, .every_s = 5.0}).trace;
  }
  [[nodiscard]] MotorEvaluation evaluation(const motor::Motor& motor, int samples) const {
    EvaluateOptions options;
    options.samples = samples;
    const std::vector<motor::Motor> one{motor};
    return evaluate(robot_, duty_, duty_.demand(robot_, 1), one, options).front();
  }
  static double booked_W(const Trace& trace, std::string_view effect, std::string_view node) {
    double all_W = 0.0;
    for (const BookedHeat& each : trace.balance) {
      all_W += each.effect == effect && each.node == node ? each.mean_W : 0.0;
    }
    return all_W;
  }

  robot::Robot robot_;
  duty::Duty duty_;
};

TEST_F(EffectsOfAFile, balance_closes_with_a_node_of_an_effects_own) {
  const Trace with = trace(MotorFile(kChassisAndSkin).read());
  double into_motor_W = 0.0;
  double all_W = 0.0;
  for (const BookedHeat& each : with.balance) {
    into_motor_W += each.node == "ambient" ? 0.0 : each.mean_W;
    all_W += std::abs(each.mean_W);
  }
  EXPECT_NEAR(into_motor_W, with.stored_W, 1e-9 * all_W);
  // A node of 60 J/K that is warmer at the end than at the start has stored this heat.
  const double chassis_rise_K = with.rows.back().own_C.at(0) - with.rows.front().own_C.at(0);
  EXPECT_GT(chassis_rise_K, 1.0);
  EXPECT_NEAR(booked_W(with, "chassis", "chassis"), 60.0 * chassis_rise_K / with.rows.back().time_s, 1e-6);
}

// At 60 rad/s and 40 rad/s of a direct drive: k·(60/500)² and k·(40/500)² of the copper loss in these periods.
TEST_F(EffectsOfAFile, extra_copper_loss_is_its_share_of_the_copper_loss) {
  give(duty_, {{400.0, 0.08, 60.0, 0.0}});
  const Trace with = trace(MotorFile(kChassisAndSkin).read());
  EXPECT_NEAR(booked_W(with, "skin", "winding"), 0.3 * 0.12 * 0.12 * booked_W(with, "copper_loss", "winding"), 1e-9);
}

TEST_F(EffectsOfAFile, own_nodes_are_columns_of_the_trace) {
  const Trace with = trace(MotorFile(kChassisAndSkin).read());
  ASSERT_EQ(with.own_nodes, std::vector<std::string>{"chassis"});
  std::istringstream csv(to_csv(with));
  std::string header;
  std::string row;
  std::getline(csv, header);
  std::getline(csv, row);
  EXPECT_EQ(header, "time_s,winding_C,stator_C,ambient_C,chassis_C,current_A,speed_rad_per_s,torque_Nm,motor_V,power_in_W");
  EXPECT_EQ(std::ranges::count(row, ','), std::ranges::count(header, ','));
  EXPECT_EQ(with.rows.front().own_C, std::vector<double>{with.rows.front().ambient_C});
}

TEST_F(EffectsOfAFile, evaluate_shows_them_in_the_nominal_run_and_in_the_samples) {
  const MotorEvaluation plain = evaluation(MotorFile("").read(), 40);
  const MotorEvaluation cooled = evaluation(MotorFile(kChassisAndSkin).read(), 40);
  const MotorEvaluation heated =
      evaluation(MotorFile("\n[effects.lamp]\ntype = \"constant_heat\"\n" + estimated("power", "2 W")).read(), 40);
  EXPECT_LT(cooled.stator_peak_C.nominal, plain.stator_peak_C.nominal - 1.0);
  EXPECT_GT(heated.stator_peak_C.nominal, plain.stator_peak_C.nominal + 1.0);
  EXPECT_LT(*cooled.stator_peak_C.p50, *plain.stator_peak_C.p50 - 1.0);
  EXPECT_GT(*heated.stator_peak_C.p50, *plain.stator_peak_C.p50 + 1.0);
}

/// Sets a nearly zero spread. Without any spread the default would apply.
void make_certain(base::ParameterValue& parameter) {
  parameter.spread =
      base::Spread{base::Spread::Kind::range, parameter.value - 1e-9 * std::abs(parameter.value), parameter.value, parameter.value > 0.0};
}

/// Samples with nearly zero spread must equal the nominal run. The ensemble supports additional nodes and all quantities.
TEST_F(EffectsOfAFile, samples_agree_with_the_reference_where_nothing_is_uncertain) {
  std::string everything;
  for (const thermal::EffectType& type : thermal::all_effects()) {
    if (!type.candidacy.size_parameter) {
      continue;
    }
    everything += "\n[effects.my_" + std::string(type.name) + "]\ntype = \"" + std::string(type.name) + "\"\n";
    std::vector<double> values = type.candidacy.variants.front();
    values[static_cast<std::size_t>(*type.candidacy.size_parameter)] *= 0.2;
    for (std::size_t i = 0; i < values.size(); ++i) {
      everything += estimated(std::string(type.parameters[i].key), std::to_string(values[i]) + " " + std::string(type.parameters[i].unit));
    }
  }
  motor::Motor motor = MotorFile(everything).read();
  for (auto& [key, parameter] : motor.parameters) {
    make_certain(parameter);
  }
  for (motor::MotorEffect& effect : motor.effects) {
    std::ranges::for_each(effect.parameters, make_certain);
  }
  duty_.ambient_C.spread.reset();
  duty_.load.spread.reset();
  EvaluateOptions options;
  options.samples = 8;
  const std::vector<motor::Motor> one{motor};
  const MotorEvaluation result = evaluate_as_stated(robot_, duty_, duty_.demand(robot_, 1), one, options).front();
  EXPECT_NEAR(*result.winding_peak_C.p50, result.winding_peak_C.nominal, 2e-3);
  EXPECT_NEAR(*result.stator_peak_C.p50, result.stator_peak_C.nominal, 2e-3);
}

std::string under_a_condition(const std::string& name, const std::string& type, const std::string& size) {
  return "\n[effects." + name + "]\ntype = \"" + type + "\"\n" + size + "[effects." + name + ".condition]\ncooling = \"fan\"\n";
}

TEST_F(EffectsOfAFile, cooling_under_a_condition_counts_only_where_the_condition_is_declared) {
  const motor::Motor plain = MotorFile("").read();
  const motor::Motor fan = MotorFile(under_a_condition("fan", "airflow", estimated("conductance", "1 W/K"))).read();
  EXPECT_EQ(evaluation(fan, 0).winding_peak_C.nominal, evaluation(plain, 0).winding_peak_C.nominal);
  EXPECT_EQ(booked_W(trace(fan), "fan", "stator"), 0.0);
  const motor::Motor declared = motor::under(fan, {{"cooling", "fan"}});
  EXPECT_LT(evaluation(declared, 0).winding_peak_C.nominal, evaluation(plain, 0).winding_peak_C.nominal - 1.0);
  EXPECT_LT(booked_W(trace(declared), "fan", "stator"), 0.0);
}

TEST_F(EffectsOfAFile, heat_under_a_condition_counts_unless_the_condition_is_declared_otherwise) {
  const motor::Motor plain = MotorFile("").read();
  const motor::Motor lamp = MotorFile(under_a_condition("lamp", "constant_heat", estimated("power", "3 W"))).read();
  EXPECT_GT(evaluation(lamp, 0).winding_peak_C.nominal, evaluation(plain, 0).winding_peak_C.nominal + 1.0);
  EXPECT_NEAR(booked_W(trace(lamp), "lamp", "stator"), 3.0, 1e-9);
  const motor::Motor without = motor::under(lamp, {{"cooling", "still air"}});
  EXPECT_EQ(evaluation(without, 0).winding_peak_C.nominal, evaluation(plain, 0).winding_peak_C.nominal);
}

TEST_F(EffectsOfAFile, a_condition_that_no_effect_has_is_an_error_that_says_what_there_is) {
  const motor::Motor fan = MotorFile(under_a_condition("fan", "airflow", estimated("conductance", "1 W/K"))).read();
  try {
    motor::under(fan, {{"colour", "red"}});
    FAIL();
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
    EXPECT_NE(std::string(failure.what()).find("cooling=fan"), std::string::npos) << failure.what();
  }
}

// A glued-on probe follows the stator with its time constant. The temperatures and the verdict must not depend on it.
TEST_F(EffectsOfAFile, a_late_sensor_shows_the_response_of_first_order) {
  motor::Motor motor = MotorFile("\n[effects.sensor_lag_stator]\n" + estimated("time_constant", "20 s") +
                                 "\n[effects.cold_probe]\ntype = \"sensor_offset_stator\"\n" + estimated("offset", "-2 K"))
                           .read();
  motor::Motor bare = MotorFile("").read();
  EXPECT_EQ(evaluation(motor, 20).stator_peak_C.p95, evaluation(bare, 20).stator_peak_C.p95);
  motor.nominal.temperature_coefficient_per_K = bare.nominal.temperature_coefficient_per_K = 0.0;
  give(duty_, {{200.0, 0.14, 0.0, 0.0}});
  const Trace shown = trace(motor);
  EXPECT_EQ(shown.shown_at, (std::vector<std::string>{"stator"}));
  const motor::MotorValues& values = motor.nominal;
  const double winding_per_s = 1.0 / values.thermal_time_constant_winding_s;
  const double stator_J_per_K = values.thermal_time_constant_stator_s / values.thermal_resistance_stator_ambient_K_per_W;
  const double across_per_s = 1.0 / (values.thermal_resistance_winding_stator_K_per_W * stator_J_per_K);
  const double out_per_s = 1.0 / values.thermal_time_constant_stator_s;
  const double winding_J_per_K = values.thermal_time_constant_winding_s / values.thermal_resistance_winding_stator_K_per_W;
  ClosedForm closed;
  closed.slope_per_s << -winding_per_s, winding_per_s, 0.0, across_per_s, -across_per_s - out_per_s, 0.0, 0.0, 1.0 / 20.0, -1.0 / 20.0;
  closed.drive_K_per_s << booked_W(shown, "copper_loss", "winding") / winding_J_per_K, 0.0, 0.0;
  double most_behind_K = 0.0;
  for (const TraceRow& row : shown.rows) {
    const Eigen::Vector3d rise_K = closed.rise_K(row.time_s);
    EXPECT_NEAR(row.stator_C, row.ambient_C + rise_K[1], 2e-3) << row.time_s;
    ASSERT_EQ(row.sensor_C.size(), 1U);
    EXPECT_NEAR(row.sensor_C[0], row.ambient_C - 2.0 + rise_K[2], 5e-3) << row.time_s;
    most_behind_K = std::max(most_behind_K, rise_K[1] - rise_K[2]);
  }
  EXPECT_GT(most_behind_K, 1.0);
  const std::string csv = to_csv(shown);
  EXPECT_EQ(csv.rfind("time_s,winding_C,stator_C,ambient_C,stator_shown_C,current_A,", 0), 0U);
  EXPECT_EQ(to_csv(trace(bare)).find("shown"), std::string::npos);
}

}  // namespace
}  // namespace heatsoak::select
