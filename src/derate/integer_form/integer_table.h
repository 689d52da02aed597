/* The derating table in integers and how it is read: plain C99, because the exported header contains this text. Every rounding is down, so
   that the current is never above that of the table in single precision. */
#ifndef HEATSOAK_INTEGER_TABLE_H
#define HEATSOAK_INTEGER_TABLE_H 0x07e6fe11u /* check sum of this text */

#include <stdint.h>

/* Ascending places of an axis in thousandths; one place: the axis does not matter. */
typedef struct {
  const int32_t *points;
  int32_t count;
} heatsoak_integer_axis;

typedef struct {
  heatsoak_integer_axis speed_mrad_per_s;
  heatsoak_integer_axis stator_mC;
  heatsoak_integer_axis winding_mC;
  const int16_t *heat; /* [speed][stator][winding], I^2 * R / R25 in unit_mA2; negative: no current is too much already */
  uint32_t unit_mA2;
  int32_t resistance_at_first; /* of the winding at its first place, as a ratio to that at 25 degC, in 2^-20 */
  int32_t resistance_per_mK;   /* in 2^-40 */
  int32_t most_current_mA;
  int32_t straight_below_mA; /* a smaller current is square/straight_below, so that it falls to 0 with a finite slope */
  int32_t most_speed_mrad_per_s;
  int32_t no_current_speed_mrad_per_s;
  int32_t winding_per_stator_K; /* a stator above its axis counts as a winding that is so many times hotter */
} heatsoak_integer_table;

/* Rounded down, for a denominator above 0. */
static inline int64_t heatsoak_floor_quotient(int64_t numerator, int64_t denominator) {
  return (numerator >= 0) ? (numerator / denominator) : -((-numerator + denominator - 1) / denominator);
}

/* Segment of an axis, from 0; x is brought to the ends from outside. */
static inline int32_t heatsoak_integer_find(const heatsoak_integer_axis *axis, int32_t *x) {
  int32_t above = 1;
  if (*x < axis->points[0]) {
    *x = axis->points[0];
  }
  if (*x > axis->points[axis->count - 1]) {
    *x = axis->points[axis->count - 1];
  }
  while (((above + 1) < axis->count) && (*x > axis->points[above])) {
    ++above;
  }
  return above - 1;
}

/* Between two places of an axis. */
static inline int32_t heatsoak_integer_between(const heatsoak_integer_axis *axis, int32_t below, int32_t x, int32_t low, int32_t high) {
  const int64_t part = (int64_t)x - axis->points[below];
  const int64_t whole = (int64_t)axis->points[below + 1] - axis->points[below];
  return low + (int32_t)heatsoak_floor_quotient(((int64_t)high - low) * part, whole);
}

/* Copper heat of the current per ohm at 25 degC, in unit_mA2. */
static inline int32_t heatsoak_integer_heat(const heatsoak_integer_table *table, int32_t speed_mrad_per_s, int32_t stator_mC,
                                            int32_t winding_mC) {
  const int32_t windings = table->winding_mC.count;
  const int32_t stators = table->stator_mC.count;
  int32_t speed = speed_mrad_per_s;
  int32_t stator = stator_mC;
  int32_t winding = winding_mC;
  const int32_t i = (table->speed_mrad_per_s.count > 1) ? heatsoak_integer_find(&table->speed_mrad_per_s, &speed) : 0;
  const int32_t j = (stators > 1) ? heatsoak_integer_find(&table->stator_mC, &stator) : 0;
  const int32_t k = heatsoak_integer_find(&table->winding_mC, &winding);
  int32_t at_speed[2] = {0, 0};
  int32_t a;
  for (a = 0; (a < 2) && ((i + a) < table->speed_mrad_per_s.count); ++a) {
    int32_t at_stator[2] = {0, 0};
    int32_t b;
    for (b = 0; (b < 2) && ((j + b) < stators); ++b) {
      const int32_t at = ((((i + a) * stators) + j + b) * windings) + k;
      at_stator[b] = heatsoak_integer_between(&table->winding_mC, k, winding, table->heat[at], table->heat[at + 1]);
    }
    at_speed[a] = (stators > 1) ? heatsoak_integer_between(&table->stator_mC, j, stator, at_stator[0], at_stator[1]) : at_stator[0];
  }
  return (table->speed_mrad_per_s.count > 1) ? heatsoak_integer_between(&table->speed_mrad_per_s, i, speed, at_speed[0], at_speed[1])
                                             : at_speed[0];
}

/* Rounded down, bit by bit. */
static inline uint32_t heatsoak_integer_root(uint64_t square) {
  uint64_t root = 0u;
  uint64_t bit = UINT64_C(2147483648);
  while (bit != 0u) {
    if (((root + bit) * (root + bit)) <= square) {
      root += bit;
    }
    bit >>= 1;
  }
  return (uint32_t)root;
}

/* From 0 to most_current_mA; magnitude of the speed. Temperatures up to 1000 degC. */
static inline int32_t heatsoak_integer_allowed_mA(const heatsoak_integer_table *table, int32_t speed_mrad_per_s, int32_t stator_mC,
                                                  int32_t winding_mC) {
  const int32_t last_stator_mC = table->stator_mC.points[table->stator_mC.count - 1];
  const int32_t first_winding_mC = table->winding_mC.points[0];
  const int64_t straight_mA = table->straight_below_mA;
  int64_t counted_mC = winding_mC;
  int64_t resistance;
  int64_t square_mA2;
  int64_t current_mA;
  int32_t heat;
  if (winding_mC < first_winding_mC) {
    counted_mC = first_winding_mC;
  }
  if (stator_mC > last_stator_mC) {
    counted_mC += (int64_t)table->winding_per_stator_K * ((int64_t)stator_mC - last_stator_mC);
  }
  if ((speed_mrad_per_s >= table->no_current_speed_mrad_per_s) || (counted_mC > table->winding_mC.points[table->winding_mC.count - 1])) {
    return 0;
  }
  heat = heatsoak_integer_heat(table, speed_mrad_per_s, stator_mC, (int32_t)counted_mC);
  if (heat <= 0) {
    return 0;
  }
  /* A ratio in 2^-20, rounded up. The product fits in 64 bits for heats up to 8e6 A^2. */
  resistance = table->resistance_at_first + (((counted_mC - first_winding_mC) * table->resistance_per_mK) / 1048576) + 1;
  square_mA2 = (((int64_t)heat * (int64_t)table->unit_mA2) * 1048576) / resistance;
  current_mA =
      (square_mA2 < (straight_mA * straight_mA)) ? (square_mA2 / straight_mA) : (int64_t)heatsoak_integer_root((uint64_t)square_mA2);
  current_mA = (current_mA < table->most_current_mA) ? current_mA : table->most_current_mA;
  if (speed_mrad_per_s > table->most_speed_mrad_per_s) {
    current_mA = (current_mA * ((int64_t)table->no_current_speed_mrad_per_s - speed_mrad_per_s)) /
                 ((int64_t)table->no_current_speed_mrad_per_s - table->most_speed_mrad_per_s);
  }
  return (int32_t)current_mA;
}

#elif HEATSOAK_INTEGER_TABLE_H != 0x07e6fe11u
#error "generated headers of different heatsoak versions in one program: generate all of them with the same one"
#endif
