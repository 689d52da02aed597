#include "simulate/sensing.h"

#include <cmath>
#include <numbers>

namespace heatsoak::simulate {
namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;
/// Number of samples per step of the bias. A random number for every sample would cost time without a visible effect.
constexpr int kSamplesPerDriftStep = 100;

constexpr DeclaredNumber<SensingConfig> kSensingNumbers[] = {
    {{"encoder_turn", "1", base::Range::between(0.0, 1e6), "number of counts per turn of the motor's shaft; 0: the true speed"},
     &SensingConfig::encoder_turn_count,
     base::Origin::third_party,
     base::Range::between(1024.0, 16384.0),
     "MILE 2048 impulses, four edges each (RoboTeam Twente, ETDP 2025, table 1)"},
    {{"gyro_noise", "rad/s", base::Range::between(0.0, 1.0), "standard deviation of one sample of the yaw rate"},
     &SensingConfig::gyro_noise_rad_per_s,
     base::Origin::derived,
     base::Range::between(0.001, 0.01),
     "MEMS gyro class of 0.003 to 0.014 deg/s per root Hz: 0.007 deg/s x sqrt(500 Hz) = 0.16 deg/s at 1 kHz without filter"},
    {{"gyro_bias", "rad/s", base::Range::between(0.0, 0.5), "standard deviation of the bias that is left after zeroing at the start"},
     &SensingConfig::gyro_bias_rad_per_s,
     base::Origin::estimated,
     base::Range::between(0.0002, 0.01),
     "0.1 deg/s: mean of 1 s at rest, and a board that vibrates; engineering judgement"},
    {{"gyro_drift", "rad s-1 s-0.5", base::Range::between(0.0, 0.1), "standard deviation of the random walk of the bias after 1 s"},
     &SensingConfig::gyro_drift_rad_per_s_per_root_s,
     base::Origin::estimated,
     base::Range::between(1e-5, 5e-4),
     "0.25 deg/s after 2000 s: MEMS gyros drift by 0.01 to 0.03 deg/s per K and the board warms by 10 K; engineering judgement"},
    {{"gyro_step", "rad/s", base::Range::between(0.0, 0.5), "resolution of the yaw rate"},
     &SensingConfig::gyro_step_rad_per_s,
     base::Origin::derived,
     base::Range::between(0.0002, 0.0011),
     "16 bits over +-2000 deg/s: 0.061 deg/s"},
    {{"current_noise", "A", base::Range::between(0.0, 10.0), "standard deviation of one sample of a motor current"},
     &SensingConfig::current_noise_A,
     base::Origin::estimated,
     base::Range::between(0.01, 0.1),
     "shunt of 1 mohm, gain 40 and 12 bits over 3.3 V: 20 mA per step, and the ripple of the commutation; engineering judgement"},
    {{"current_offset", "A", base::Range::between(0.0, 10.0), "standard deviation of the offset of a motor current"},
     &SensingConfig::current_offset_A,
     base::Origin::estimated,
     base::Range::between(0.01, 0.15),
     "two steps of the converter are left after zeroing; engineering judgement"},
    {{"battery_step", "V", base::Range::between(0.0, 5.0), "resolution of the battery voltage"},
     &SensingConfig::battery_step_V,
     base::Origin::derived,
     base::Range::between(0.004, 0.05),
     "12 bits over a divider to 33 V"},
    {{"temperature_step", "K", base::Range::between(0.0, 20.0), "resolution of temperatures"},
     &SensingConfig::temperature_step_K,
     base::Origin::estimated,
     base::Range::between(0.05, 1.0),
     "thermistor on a converter of 12 bits around 60 degC; engineering judgement"},
    {{"temperature_noise", "K", base::Range::between(0.0, 20.0), "standard deviation of one sample of a temperature"},
     &SensingConfig::temperature_noise_K,
     base::Origin::estimated,
     base::Range::between(0.02, 0.5),
     "half a step; engineering judgement"},
    {{"delay", "1", base::Range::between(0.0, 1.0), "number of control periods from sampling to actuation"},
     &SensingConfig::delay_periods_count,
     base::Origin::derived,
     base::Range::between(1.0, 1.0),
     "firmware reads its sensors, computes, and writes the PWM registers that act from the next period on"}};

double rounded_to(double value, double step) { return step > 0.0 ? step * std::round(value / step) : value; }

}  // namespace

std::span<const DeclaredNumber<SensingConfig>> sensing_numbers() { return kSensingNumbers; }

SensingConfig sensing_of(const robot::Robot& robot) {
  SensingConfig config;
  config.has_motor_current = robot.drive.current_limit_A.has_value();
  return config;
}

SensingConfig ideal_sensing() {
  SensingConfig config;
  for (const DeclaredNumber<SensingConfig>& each : sensing_numbers()) {
    config.*each.value = 0.0;
  }
  config.has_motor_current = config.has_stator = config.has_ambient = true;
  return config;
}

double noise(base::Random& random) {
  constexpr std::uint64_t kPart = (std::uint64_t{1} << 13) - 1;
  auto bits = static_cast<std::uint64_t>(random.uniform() * 0x1p52);
  std::uint64_t sum = 0;
  for (int part = 0; part < 4; ++part, bits >>= 13) {
    sum += bits & kPart;
  }
  // The sum has the mean 4·(2^13 − 1)/2 and the variance 4·(2^26 − 1)/12.
  constexpr double kMean = 2.0 * static_cast<double>(kPart);
  constexpr double kSpread = 1.7320507940 / 8192.0;
  return (static_cast<double>(sum) - kMean) * kSpread;
}

Sensing::Sensing(const SensingConfig& config, const SimulatedRobot& robot, double control_period_s, std::uint64_t seed)
    : config_(config),
      random_(seed, 1),
      wheel_count_(robot.wheel_count()),
      control_period_s_(control_period_s),
      count_per_rad_(config.encoder_turn_count * robot.plant().gear_ratio / kTurn_rad),
      last_rad_per_s_(robot.state().wheel_speed_rad_per_s),
      battery_V_(robot::open_circuit_V(robot.plant().battery, robot.state().battery_charge_A_s)) {
  require_declared_ranges(config, sensing_numbers());
  bias_rad_per_s_ = config_.gyro_bias_rad_per_s * noise(random_);
  for (int i = 0; i < wheel_count_; ++i) {
    offset_A_[i] = config_.current_offset_A * noise(random_);
    phase_count_[i] = random_.uniform();
  }
}

void Sensing::follow(const SimulatedRobot& robot, const robot::PlantOutput& out) {
  const robot::PerWheel& speed_rad_per_s = robot.state().wheel_speed_rad_per_s;
  for (int i = 0; i < wheel_count_; ++i) {
    angle_rad_[i] += 0.5 * SimulatedRobot::kPeriod_s * (last_rad_per_s_[i] + speed_rad_per_s[i]);
    current_A_[i] += out.current_A[i];
  }
  last_rad_per_s_ = speed_rad_per_s;
  battery_V_ = out.battery_V;
  ++periods_;
}

void Sensing::sample(const SimulatedRobot& robot, double ambient_C, robot_core::Input& input) {
  sample_wheels(input);
  sample_gyro(robot, input);
  input.battery_V = static_cast<float>(rounded_to(battery_V_, config_.battery_step_V));
  if (config_.has_stator) {
    for (int i = 0; i < wheel_count_; ++i) {
      input.stator_C[i] = static_cast<float>(temperature_C(robot.stator_C(i)));
    }
  }
  if (config_.has_ambient) {
    input.ambient_C = static_cast<float>(temperature_C(ambient_C));
  }
  periods_ = 0;
}

void Sensing::sample_wheels(robot_core::Input& input) {
  const bool is_counted = config_.encoder_turn_count > 0.0;
  const double rad_per_s_per_count = is_counted ? 1.0 / (count_per_rad_ * control_period_s_) : 0.0;
  for (int i = 0; i < wheel_count_; ++i) {
    if (is_counted) {
      const auto count = static_cast<std::int64_t>(std::floor(angle_rad_[i] * count_per_rad_ + phase_count_[i]));
      input.wheel_speed_rad_per_s[i] = static_cast<float>(static_cast<double>(count - counts_[i]) * rad_per_s_per_count);
      counts_[i] = count;
    } else {
      input.wheel_speed_rad_per_s[i] = static_cast<float>(last_rad_per_s_[i]);
    }
    if (config_.has_motor_current) {
      const double mean_A = periods_ > 0 ? current_A_[i] / periods_ : 0.0;
      const double noise_A = config_.current_noise_A > 0.0 ? config_.current_noise_A * noise(random_) : 0.0;
      input.motor_current_A[i] = static_cast<float>(mean_A + offset_A_[i] + noise_A);
    }
  }
  current_A_.fill(0.0);
}

void Sensing::sample_gyro(const SimulatedRobot& robot, robot_core::Input& input) {
  if (++samples_ == kSamplesPerDriftStep) {
    samples_ = 0;
    bias_rad_per_s_ += config_.gyro_drift_rad_per_s_per_root_s * std::sqrt(kSamplesPerDriftStep * control_period_s_) * noise(random_);
  }
  const double noise_rad_per_s = config_.gyro_noise_rad_per_s > 0.0 ? config_.gyro_noise_rad_per_s * noise(random_) : 0.0;
  const double seen_rad_per_s = robot.state().velocity.yaw_rad_per_s + bias_rad_per_s_ + noise_rad_per_s;
  input.yaw_rate_rad_per_s = static_cast<float>(rounded_to(seen_rad_per_s, config_.gyro_step_rad_per_s));
}

double Sensing::temperature_C(double true_C) {
  const double noise_K = config_.temperature_noise_K > 0.0 ? config_.temperature_noise_K * noise(random_) : 0.0;
  return rounded_to(true_C + noise_K, config_.temperature_step_K);
}

}  // namespace heatsoak::simulate
