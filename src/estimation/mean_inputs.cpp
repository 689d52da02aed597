#include "estimation/mean_inputs.h"

#include <algorithm>
#include <cmath>

namespace heatsoak {
namespace {

OperatingPoint<double> squared(OperatingPoint<double> at) {
  for (const OperatingQuantity<double>& each : kQuantities<double>) {
    double& value = at.*each.value;
    value = each.averaging == AveragingRule::rms ? value * value : each.averaging == AveragingRule::limit ? 0.0 : value;
  }
  return at;
}

OperatingPoint<double> rooted(OperatingPoint<double> at) {
  const OperatingPoint<double> unlimited;
  for (const OperatingQuantity<double>& each : kQuantities<double>) {
    double& value = at.*each.value;
    value = each.averaging == AveragingRule::rms     ? std::sqrt(std::max(0.0, value))
            : each.averaging == AveragingRule::limit ? unlimited.*each.value
                                                     : value;
  }
  return at;
}

/// Copies the motion of `from`. Motion and torque are independent: a motor may push hard at standstill, or turn fast with little torque.
void set_motion(OperatingPoint<double>& at, const OperatingPoint<double>& from) {
  for (const OperatingQuantity<double>& each : kQuantities<double>) {
    at.*each.value = each.is_motion ? from.*each.value : at.*each.value;
  }
}

}  // namespace

OperatingPoint<double> MeanInputs::zero() {
  OperatingPoint<double> at;
  for_each_quantity([](double& value) { value = 0.0; }, at);
  return at;
}

void MeanInputs::add(const OperatingPoint<double>& at, double duration_s) {
  duration_s_ += duration_s;
  const OperatingPoint<double> squares = squared(at);
  for_each_quantity([&](double& sum, const double& value) { sum += duration_s * value; }, sum_, squares);
}

void MeanInputs::add_uncertainty(const OperatingPoint<double>& at, const OperatingPoint<double>& other, double duration_s) {
  const OperatingPoint<double> known = squared(at);
  const OperatingPoint<double> possible = squared(other);
  for_each_quantity(
      [&](double& sum, const double& a, const double& b) {
        const double off = duration_s * (b - a);
        sum += off * off;
      },
      variance_, known, possible);
  has_uncertainty_ = true;
}

void MeanInputs::take(MeasuredRun& run) {
  OperatingPoint<double> mean = sum_;
  for_each_quantity([&](double& value) { value /= duration_s_; }, mean);
  if (has_uncertainty_) {
    OperatingPoint<double> other = mean;
    for_each_quantity([&](double& value, const double& square) { value += std::sqrt(square) / duration_s_; }, other, variance_);
    OperatingPoint<double> moves = mean;
    set_motion(moves, other);
    set_motion(other, mean);
    for (const OperatingPoint<double>& each : {other, moves}) {
      bool is_uncertain = false;
      for_each_quantity([&](const double& value, const double& usual) { is_uncertain = is_uncertain || value != usual; }, each, mean);
      if (is_uncertain) {
        run.unknown_inputs.push_back({static_cast<Eigen::Index>(run.at.size()), rooted(each)});
      }
    }
  }
  run.at.push_back(rooted(mean));
  *this = {};
}

}  // namespace heatsoak
