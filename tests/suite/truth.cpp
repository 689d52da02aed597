// truth.json: what a motor is and what it lacks.
#include <nlohmann/json.hpp>

#include "motor_case.h"

namespace heatsoak::suite {
namespace {

using Json = nlohmann::ordered_json;

/// Names that a motor of eight bodies has for what two bodies lack.
const std::vector<std::string> kBodiesOfEight{"third_node", "enclosure_warm_up", "uneven_winding"};

Json fit_json(const TwoBodyFit& fit) {
  return {{"winding_J_per_K", fit.winding_J_per_K}, {"contact_K_per_W", fit.contact_K_per_W},     {"stator_J_per_K", fit.stator_J_per_K},
          {"air_K_per_W", fit.air_K_per_W},         {"no_load_current_A", fit.no_load_current_A}, {"winding_rmse_K", fit.winding_rmse_K},
          {"stator_rmse_K", fit.stator_rmse_K}};
}

Json network_json(const Network& network) {
  Json bodies = Json::object();
  for (const Body& body : network.bodies) {
    bodies[body.name + "_J_per_K"] = body.capacity_J_per_K;
  }
  Json links = Json::array();
  for (const Link& link : network.links) {
    links.push_back({network.bodies[link.first].name, network.bodies[link.second].name, link.conductance_W_per_K});
  }
  for (const AirLink& link : network.air_links) {
    links.push_back({network.bodies[link.body].name, "ambient", link.conductance_W_per_K});
  }
  return {{"bodies", bodies}, {"links_W_per_K", links}};
}

/// First and last second of each interval of outliers and stuck readings.
Json bad_s(const Log& log, bool Row::*has, bool Row::*is_good) {
  Json intervals = Json::array();
  double last_s = -10.0;
  for (const Row& row : log) {
    if (row.*has && !(row.*is_good)) {
      if (row.time_s - last_s > 1.5) {
        intervals.push_back({row.time_s, row.time_s});
      }
      intervals.back()[1] = row.time_s;
      last_s = row.time_s;
    }
  }
  return intervals;
}

Json bad_samples(const MotorCase& made) {
  Json all = Json::object();
  const auto add = [&](const std::string& name, const Log& log) {
    all[name] = {{"winding_C", bad_s(log, &Row::has_winding, &Row::winding_is_good)},
                 {"stator_C", bad_s(log, &Row::has_stator, &Row::stator_is_good)}};
  };
  for (std::size_t i = 0; i < made.train.size(); ++i) {
    add("train_" + std::to_string(i + 1), made.train[i]);
  }
  for (std::size_t i = 0; i < made.holdout.size(); ++i) {
    add("holdout_" + std::to_string(i + 1), made.holdout[i]);
  }
  return all;
}

}  // namespace

Json truth_of(const MotorCase& made, std::uint64_t seed) {
  Json truth{{"motor", made.plan.id}, {"group", made.plan.group}, {"seed", seed}, {"family", made.plan.family->name}};
  truth["effects"] = Json::array();
  std::vector<std::string> present = made.plan.has_eight_bodies ? kBodiesOfEight : std::vector<std::string>{};
  for (std::size_t i = 0; i < made.plan.effects.size(); ++i) {
    const PlannedEffect& effect = made.plan.effects[i];
    truth["effects"].push_back({{"id", effect.kind->id},
                                {"node", effect.kind->node},
                                {"law", effect.kind->law},
                                {"strength", effect.strength},
                                {"family", effect.kind->family},
                                {"signals", effect.kind->signals},
                                {"error_ratio", made.error_ratio[i]},
                                {"visible", made.error_ratio[i] >= kVisibleRatio}});
    present.insert(present.end(), effect.kind->family.begin(), effect.kind->family.end());
  }
  truth["present"] = present;
  truth["unknown_heat"] = {
      {"kind", name_of(made.plan.unknown_heat)}, {"winding_W", made.unknown_winding_W}, {"stator_W", made.unknown_stator_W}};
  truth["sensor_noise_K"] = {made.noise.winding_K, made.noise.stator_K};
  truth["sensor_step_K"] = {made.noise.winding_step_K, made.noise.stator_step_K};
  truth["load_factor"] = made.load_factor;
  truth["resistance_25C_ohm"] = made.motor.resistance_25C_ohm;
  truth["torque_constant_Nm_per_A"] = made.motor.torque_constant_Nm_per_A;
  truth["no_load_current_A"] = made.motor.no_load_current_A;
  truth["network"] = network_json(made.motor.network);
  truth["sensors_on"] = {made.motor.network.bodies[made.motor.winding_sensor].name,
                         made.motor.network.bodies[made.motor.stator_sensor].name};
  truth["two_body_fit"] = fit_json(made.fit);
  truth["two_body_fit_without_effects"] = fit_json(made.fit_without);
  truth["bad_samples_s"] = bad_samples(made);
  return truth;
}

}  // namespace heatsoak::suite
