#include "derate/sensed/kalman_design.h"

#include <algorithm>
#include <cmath>

#include "derate/sensed/riccati.h"
#include "thermal/linearised.h"

namespace heatsoak::derate {
namespace {

/// Hot operating point for the linearisation: continuous current, winding at its limit, bodies halfway between air and limit.
struct HotPoint {
  thermal::OperatingPoint<double> at;
  std::vector<double> state_C;
};

HotPoint hot_point(const motor::Motor& motor, const robot::Robot& robot, const BarrierRules& rules, double current_A, int states,
                   double speed_share) {
  const HotCase plain = plain_case(rules);
  HotPoint point{operating_point<double>(motor.nominal, robot, plain.signals(rules, current_A, speed_share * rules.most_speed_rad_per_s)),
                 std::vector<double>(static_cast<std::size_t>(states), 0.5 * (rules.hottest_ambient_C + rules.limits.winding_C))};
  point.state_C[motor::states::winding] = rules.limits.winding_C;
  return point;
}

Eigen::VectorXd rates(const thermal::Network& network, const HotPoint& point) {
  const std::vector<double> values = network.values();
  std::vector<double> temperature_C = point.state_C;
  temperature_C.push_back(point.at.ambient_C);
  std::vector<double> rate(point.state_C.size());
  network.rate_K_per_s<double>(point.at, values, temperature_C, rate);
  return Eigen::Map<const Eigen::VectorXd>(rate.data(), static_cast<Eigen::Index>(rate.size()));
}

Eigen::MatrixXd second_moments(const motor::Motor& motor, const thermal::Network& nominal, std::span<const HotPoint> points, int samples,
                               std::uint64_t seed) {
  const int states = nominal.state_count();
  Eigen::MatrixXd moments = Eigen::MatrixXd::Zero(states, states);
  for (int i = 0; i < samples; ++i) {
    base::Random random(seed, static_cast<std::uint64_t>(i));
    const thermal::Network drawn = motor::datasheet_network(motor, motor::draw_sample(motor, random));
    for (const HotPoint& point : points) {
      const Eigen::VectorXd error_K_per_s = rates(drawn, point) - rates(nominal, point);
      moments += error_K_per_s * error_K_per_s.transpose();
    }
  }
  return moments / (static_cast<double>(samples) * static_cast<double>(points.size()));
}

}  // namespace

SensorGain sensor_gain(const motor::Motor& motor, const robot::Robot& robot, const BarrierRules& rules, const SensorOptions& options,
                       double period_s, double lasting_current_A, int samples, std::uint64_t seed) {
  const thermal::Network nominal = motor::datasheet_network(motor, motor::nominal_sample(motor));
  const int states = nominal.state_count();
  std::vector<HotPoint> points;
  for (const double speed_share : {0.0, 0.3, 0.6}) {
    points.push_back(hot_point(motor, robot, rules, lasting_current_A, states, speed_share));
  }
  thermal::Linearised linear;
  nominal.linearise(points[1].at, nominal.values(), points[1].state_C, linear);
  const bool lags = options.lag_s > 0.0;
  const int size = states + (lags ? 1 : 0);
  LinearObserver observer;
  observer.transition = Eigen::MatrixXd::Identity(size, size);
  observer.transition.topLeftCorner(states, states) += period_s * linear.by_state;
  observer.output = Eigen::RowVectorXd::Zero(size);
  observer.output[lags ? states : options.node] = 1.0;
  if (lags) {
    observer.transition(states, options.node) = period_s / options.lag_s;
    observer.transition(states, states) -= period_s / options.lag_s;
  }
  observer.process_noise = Eigen::MatrixXd::Zero(size, size);
  observer.process_noise.topLeftCorner(states, states) = period_s * period_s * second_moments(motor, nominal, points, samples, seed);
  // The sensor error is uniformly distributed within the accuracy.
  observer.sensor_sd_K = options.accuracy_K / std::sqrt(3.0);
  // A node that cools when the sensor reads more would let a hot reading add current.
  const Eigen::VectorXd gain = steady_kalman_gain(observer).cwiseMax(0.0);
  return {.gain = {gain.data(), gain.data() + states}, .lag_gain_ratio = lags ? gain[states] : 0.0};
}

}  // namespace heatsoak::derate
