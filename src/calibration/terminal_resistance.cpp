#include "calibration/terminal_resistance.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/copper.h"
#include "recording/quantities.h"

namespace heatsoak::calibration {
namespace {

/// Largest sum of squared voltage residuals, as a share of that of the resistive voltage.
constexpr double kFollows_share = 0.02;
constexpr double kFar_ratio = 1.15;

}  // namespace

std::optional<ResistanceDiffers> other_terminal_resistance(const motor::Motor& motor, std::span<const recording::Recording> recordings) {
  Eigen::Matrix2d products = Eigen::Matrix2d::Zero();
  Eigen::Vector2d with_voltage = Eigen::Vector2d::Zero();
  double squares_V2 = 0.0;
  for (const recording::Recording& recording : recordings) {
    const recording::Channel* const voltage = recording.find("motor_V");
    const recording::Channel* const current = recording.find(recording::column_of(base::Signal::current));
    const recording::Channel* const speed = recording.find(recording::column_of(base::Signal::speed));
    const recording::Channel* const winding = recording.find("winding_C");
    for (std::size_t row = 0; voltage && current && speed && row < recording.rows(); ++row) {
      const double winding_C = winding && !std::isnan(winding->values[row]) ? winding->values[row] : base::kSheetTemperature_C;
      const double hot_ratio = base::resistance_ratio(motor.nominal.temperature_coefficient_per_K, winding_C);
      const Eigen::Vector2d x(hot_ratio * current->values[row], speed->values[row]);
      const double voltage_V = voltage->values[row];
      if (std::isnan(x.sum() + voltage_V)) {
        continue;
      }
      products += x * x.transpose();
      with_voltage += voltage_V * x;
      squares_V2 += voltage_V * voltage_V;
    }
  }
  const Eigen::VectorXd found = Eigen::MatrixXd(products).completeOrthogonalDecomposition().solve(Eigen::VectorXd(with_voltage));
  const double stated_ohm = motor.nominal.terminal_resistance_ohm;
  if (!(squares_V2 - found.dot(with_voltage) < kFollows_share * stated_ohm * stated_ohm * products(0, 0)) || !(found[0] > 0.0)) {
    return std::nullopt;
  }
  const double ratio = found[0] / stated_ohm;
  return std::max(ratio, 1.0 / ratio) > kFar_ratio ? std::optional(ResistanceDiffers{found[0], stated_ohm}) : std::nullopt;
}

}  // namespace heatsoak::calibration
