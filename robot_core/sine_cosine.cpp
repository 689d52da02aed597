// Method: reduction to ±π/4 with π/2 in parts (Cody and Waite, Software Manual for the Elementary Functions, 1980), Taylor polynomials.
#include "robot_core/math.h"

// Optimised for size: otherwise GCC repeats both polynomials for every quarter turn.
#pragma GCC optimize("Os")

namespace robot_core {

SineCosine sine_cosine(float angle_rad) {
  const float x = clamped(angle_rad, -1000.0F, 1000.0F);
  const int quarter = static_cast<int>(x * 0.636619772F + (x < 0.0F ? -0.5F : 0.5F));
  const auto turns = static_cast<float>(quarter);
  const float r = ((x - turns * 1.5703125F) - turns * 4.837512969970703e-4F) - turns * 7.549790126e-8F;
  const float r2 = r * r;
  const float s = r * (1.0F + r2 * (-1.66666667e-1F + r2 * (8.33333333e-3F - r2 * 1.98412698e-4F)));
  const float c = 1.0F + r2 * (-0.5F + r2 * (4.16666667e-2F + r2 * (-1.38888889e-3F + r2 * 2.48015873e-5F)));
  switch (quarter & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

}  // namespace robot_core
