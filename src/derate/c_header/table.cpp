#include <fmt/format.h>

#include "derate/c_header/c_text.h"
#include "derate/c_header/parts.h"

namespace heatsoak::c_header {
namespace {

constexpr std::string_view kAllowed = R"(static inline int @_find(const float *axis, int count, float x, int *below, float *share) {
  int above = 1;
  if (!(x <= axis[count - 1])) {
    return 0;
  }
  while (above + 1 < count && x > axis[above]) {
    ++above;
  }
  *below = above - 1;
  *share = x > axis[above - 1] ? (x - axis[above - 1]) / (axis[above] - axis[above - 1]) : 0.0f;
  return 1;
}

static inline float @_allowed_A(float speed_rad_per_s, float stator_C, float winding_C) {
  int i, j, k, a, b;
  float at_speed, at_stator, at_winding, along[2], across[2];
  if (!@_find(@_speed_rad_per_s, @SPEEDS@, speed_rad_per_s, &i, &at_speed) ||
      !@_find(@_stator_C, @STATORS@, stator_C, &j, &at_stator) ||
      !@_find(@_winding_C, @WINDINGS@, winding_C, &k, &at_winding)) {
    return 0.0f;
  }
  for (a = 0; a < 2; ++a) {
    for (b = 0; b < 2; ++b) {
      const float *const line = @_current_A + ((i + a) * @STATORS@ + j + b) * @WINDINGS@ + k;
      along[b] = line[0] + at_winding * (line[1] - line[0]);
    }
    across[a] = along[0] + at_stator * (along[1] - along[0]);
  }
  return across[0] + at_speed * (across[1] - across[0]);
}

)";

}  // namespace

std::string tables(const Source& source) {
  const CurrentTable& table = source.derating.table;
  return array(source.prefix + "_speed_rad_per_s", table.speed_rad_per_s) + array(source.prefix + "_stator_C", table.stator_C) +
         array(source.prefix + "_winding_C", table.winding_C) + "/* in A: by speed, then stator, then winding */\n" +
         array(source.prefix + "_current_A", table.current_A) + "\n";
}

std::string allowed_function(const Source& source) {
  const CurrentTable& table = source.derating.table;
  return replaced(kAllowed, {{"@SPEEDS@", std::to_string(table.speed_rad_per_s.size())},
                             {"@STATORS@", std::to_string(table.stator_C.size())},
                             {"@WINDINGS@", std::to_string(table.winding_C.size())},
                             {"@", source.prefix}});
}

}  // namespace heatsoak::c_header
