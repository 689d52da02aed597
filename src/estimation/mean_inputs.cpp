#include "estimation/mean_inputs.h"

#include <algorithm>
#include <cmath>

namespace heatsoak::estimation {
namespace {

thermal::OperatingPoint<double> squared(thermal::OperatingPoint<double> at) {
  for (const thermal::OperatingQuantity<double>& each : thermal::kQuantities<double>) {
    double& value = at.*each.value;
    value = each.averaging == thermal::AveragingRule::rms ? value * value : each.averaging == thermal::AveragingRule::limit ? 0.0 : value;
  }
  return at;
}

thermal::OperatingPoint<double> rooted(thermal::OperatingPoint<double> at) {
  const thermal::OperatingPoint<double> unlimited;
  for (const thermal::OperatingQuantity<double>& each : thermal::kQuantities<double>) {
    double& value = at.*each.value;
    value = each.averaging == thermal::AveragingRule::rms     ? std::sqrt(std::max(0.0, value))
            : each.averaging == thermal::AveragingRule::limit ? unlimited.*each.value
                                                              : value;
  }
  return at;
}

/// Copies the motion of `from`. Motion and torque are independent: a motor may push hard at standstill, or turn fast with little torque.
void set_motion(thermal::OperatingPoint<double>& at, const thermal::OperatingPoint<double>& from) {
  for (const thermal::OperatingQuantity<double>& each : thermal::kQuantities<double>) {
    at.*each.value = each.is_motion ? from.*each.value : at.*each.value;
  }
}

}  // namespace

thermal::OperatingPoint<double> MeanInputs::zero() {
  thermal::OperatingPoint<double> at;
  thermal::for_each_quantity([](double& value) { value = 0.0; }, at);
  at.known = ~thermal::QuantitySet{0};
  return at;
}

void MeanInputs::add(const thermal::OperatingPoint<double>& at, double duration_s) {
  duration_s_ += duration_s;
  const thermal::OperatingPoint<double> squares = squared(at);
  thermal::for_each_quantity([&](double& sum, const double& value) { sum += duration_s * value; }, sum_, squares);
  sum_.known &= at.known;
}

void MeanInputs::add_uncertainty(const thermal::OperatingPoint<double>& at, const thermal::OperatingPoint<double>& other,
                                 double duration_s) {
  const thermal::OperatingPoint<double> known = squared(at);
  const thermal::OperatingPoint<double> possible = squared(other);
  thermal::for_each_quantity(
      [&](double& sum, const double& a, const double& b) {
        const double off = duration_s * (b - a);
        sum += off * off;
      },
      variance_, known, possible);
  has_uncertainty_ = true;
}

void MeanInputs::take(MeasuredRun& run) {
  thermal::OperatingPoint<double> mean = sum_;
  thermal::for_each_quantity([&](double& value) { value /= duration_s_; }, mean);
  if (has_uncertainty_) {
    thermal::OperatingPoint<double> other = mean;
    thermal::for_each_quantity([&](double& value, const double& square) { value += std::sqrt(square) / duration_s_; }, other, variance_);
    thermal::OperatingPoint<double> moves = mean;
    set_motion(moves, other);
    set_motion(other, mean);
    for (const thermal::OperatingPoint<double>& each : {other, moves}) {
      bool is_uncertain = false;
      thermal::for_each_quantity([&](const double& value, const double& usual) { is_uncertain = is_uncertain || value != usual; }, each,
                                 mean);
      if (is_uncertain) {
        run.unknown_inputs.push_back({static_cast<Eigen::Index>(run.at.size()), rooted(each)});
      }
    }
  }
  run.at.push_back(rooted(mean));
  *this = {};
}

}  // namespace heatsoak::estimation
