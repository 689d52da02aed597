// Synthetic motor with two heat capacities, integrated in small steps and written in a logger's format.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "base/random.h"

namespace heatsoak::recording {

struct SyntheticLog {
  double period_s = 1.0;
  int rows = 1800;
  double noise_K = 0.05;
  double step_K = 0.0;   ///< resolution; 0 means full precision
  double delay_s = 0.0;  ///< delay of the temperatures' clock
  std::uint64_t seed = 1;
  std::function<double(double)> current_A = [](double t) { return std::fmod(t, 300.0) < 150.0 ? 6.0 : 0.0; };

  /// Returns winding and stator temperatures per row.
  [[nodiscard]] std::vector<std::pair<double, double>> temperatures_C() const {
    constexpr double kStep_s = 0.01;
    base::Random random(seed, 0);
    std::vector<std::pair<double, double>> rows_C;
    double winding_C = 22.0;
    double stator_C = 22.0;
    double time_s = -delay_s;
    for (int row = 0; row < rows; ++row) {
      for (; time_s < row * period_s - delay_s - 0.5 * kStep_s; time_s += kStep_s) {
        const double current = time_s < 0.0 ? 0.0 : current_A(time_s);
        const double flow_W = (winding_C - stator_C) / 1.5;
        winding_C += kStep_s * (0.45 * current * current * (1.0 + 0.0039 * (winding_C - 25.0)) - flow_W) / 12.0;
        stator_C += kStep_s * (flow_W - (stator_C - 22.0) / 4.0) / 60.0;
      }
      rows_C.emplace_back(seen(winding_C, random), seen(stator_C, random));
    }
    return rows_C;
  }

  [[nodiscard]] std::string csv() const {
    std::string text = "time_s,winding_C,stator_C,ambient_C,current_A\n";
    const auto rows_C = temperatures_C();
    for (int row = 0; row < rows; ++row) {
      const auto& [winding_C, stator_C] = rows_C[static_cast<std::size_t>(row)];
      text += fmt::format("{:.3f},{:.4f},{:.4f},22.0,{:.3f}\n", row * period_s, winding_C, stator_C, current_A(row * period_s));
    }
    return text;
  }

 private:
  [[nodiscard]] double seen(double true_C, base::Random& random) const {
    // The sum of twelve uniform numbers is approximately normal.
    double normal = -6.0;
    for (int i = 0; i < 12; ++i) {
      normal += random.uniform();
    }
    const double noisy_C = true_C + noise_K * normal;
    return step_K > 0.0 ? step_K * std::round(noisy_C / step_K) : noisy_C;
  }
};

}  // namespace heatsoak::recording
