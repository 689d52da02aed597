#include "identify/mean_inputs.h"

#include <cmath>
#include <utility>

namespace heatsoak {
namespace {

OperatingPoint<double> squared(OperatingPoint<double> at) {
  at.current_rms_A *= at.current_rms_A;
  at.speed_rms_rad_per_s *= at.speed_rms_rad_per_s;
  at.resistive_headroom_V = 0.0;
  return at;
}

}  // namespace

OperatingPoint<double> Mean::zero() {
  OperatingPoint<double> at;
  for_each_quantity([](double& value) { value = 0.0; }, at);
  return at;
}

void Mean::add(const OperatingPoint<double>& at, double duration_s) {
  duration_s_ += duration_s;
  const OperatingPoint<double> squares = squared(at);
  for_each_quantity([&](double& sum, const double& value) { sum += duration_s * value; }, sum_, squares);
}

OperatingPoint<double> Mean::take() {
  OperatingPoint<double> mean = sum_;
  for_each_quantity([&](double& value) { value /= duration_s_; }, mean);
  mean.current_rms_A = std::sqrt(mean.current_rms_A);
  mean.speed_rms_rad_per_s = std::sqrt(mean.speed_rms_rad_per_s);
  mean.resistive_headroom_V = OperatingPoint<double>{}.resistive_headroom_V;
  *this = {};
  return mean;
}

void MeanInputs::add(const OperatingPoint<double>& at, double duration_s) {
  mean_.add(at, duration_s);
  other_.add(at, duration_s);
}

void MeanInputs::add_unknown(const OperatingPoint<double>& at, const OperatingPoint<double>& other, double duration_s) {
  mean_.add(at, duration_s);
  other_.add(other, duration_s);
  has_doubt_ = true;
}

void MeanInputs::take(MeasuredRun& run) {
  const OperatingPoint<double> other = other_.take();
  if (std::exchange(has_doubt_, false)) {
    run.unknown_inputs.push_back({static_cast<Eigen::Index>(run.at.size()), other});
  }
  run.at.push_back(mean_.take());
}

}  // namespace heatsoak
