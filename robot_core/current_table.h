/* Derating table of a motor and its reader. Plain C99: the drive core and the exported C header share this text. Method: trilinear
   interpolation of the copper heat per ohm at 25 degC, which is linear in both temperatures for the network of a data sheet. */
#ifndef HEATSOAK_CURRENT_TABLE_H
#define HEATSOAK_CURRENT_TABLE_H 0x284c36ccu /* check sum of this text */

#include <stdint.h>
#ifndef __GNUC__
#include <math.h>
#endif

/* Axis points in ascending order. With one point the current does not depend on this axis. */
typedef struct {
  const float *points;
  int32_t count;
} heatsoak_axis;

typedef struct {
  heatsoak_axis speed_rad_per_s;
  heatsoak_axis stator_C;
  heatsoak_axis winding_C;
  const float *heat_per_ohm_A2; /* [speed][stator][winding], squared current times resistance ratio; negative: zero current is too much */
  float resistance_at_0C_ratio; /* resistance of the winding at 0 degC, as a ratio to that at 25 degC */
  float resistance_ratio_per_K; /* above 0 for a metal; the ratio must be above 0 at the first point of the winding axis */
  float most_current_A;
  float straight_below_A;           /* below this current the result is square/straight_below, so that it falls to 0 with a finite slope */
  float most_speed_rad_per_s;       /* above this speed the allowed current falls linearly */
  float no_current_speed_rad_per_s; /* the allowed current is 0 from this speed on */
  float winding_per_stator_K;       /* a stator 1 K above its axis counts as a winding that is this much hotter */
} heatsoak_current_table;

/* Position of a speed and a stator temperature in the table: found once, used for several winding temperatures. */
typedef struct {
  int32_t first;       /* index of the first heat of the row; negative: no current is allowed */
  int32_t next_stator; /* step to the heat of the next stator point; 0 if the axis has one point */
  int32_t next_speed;
  float stator_share; /* position between two stator points, 0 to 1 */
  float speed_share;
  float hotter_K;   /* added to the winding temperature for a stator above its axis */
  float fade_ratio; /* factor on the current above the highest speed of the axis, 0 to 1 */
} heatsoak_row;

/* Returns the axis segment of x, from 0, and sets `share` to the position in it, 0 to 1. Values outside the axis count as its ends. */
static inline int32_t heatsoak_find(const heatsoak_axis *axis, float x, float *share) {
  int32_t above = 1;
  float low;
  *share = 0.0f;
  if (axis->count < 2 || !(x > axis->points[0])) {
    return 0;
  }
  while (above + 1 < axis->count && x > axis->points[above]) {
    ++above;
  }
  low = axis->points[above - 1];
  *share = x < axis->points[above] ? (x - low) / (axis->points[above] - low) : 1.0f;
  return above - 1;
}

/* Finds the row of a speed and a stator temperature. NaN allows no current. */
static inline heatsoak_row heatsoak_find_row(const heatsoak_current_table *table, float speed_rad_per_s, float stator_C) {
  const int32_t windings = table->winding_C.count;
  const float last_stator_C = table->stator_C.points[table->stator_C.count - 1];
  heatsoak_row row = {-1, 0, 0, 0.0f, 0.0f, 0.0f, 1.0f};
  if (speed_rad_per_s < table->no_current_speed_rad_per_s && stator_C < 1.0e6f) {
    const int32_t speed = heatsoak_find(&table->speed_rad_per_s, speed_rad_per_s, &row.speed_share);
    const int32_t stator = heatsoak_find(&table->stator_C, stator_C, &row.stator_share);
    row.first = (speed * table->stator_C.count + stator) * windings;
    row.next_stator = table->stator_C.count > 1 ? windings : 0;
    row.next_speed = table->speed_rad_per_s.count > 1 ? windings * table->stator_C.count : 0;
    if (stator_C > last_stator_C) {
      row.hotter_K = table->winding_per_stator_K * (stator_C - last_stator_C);
    }
    if (speed_rad_per_s > table->most_speed_rad_per_s) {
      row.fade_ratio =
          (table->no_current_speed_rad_per_s - speed_rad_per_s) / (table->no_current_speed_rad_per_s - table->most_speed_rad_per_s);
    }
  }
  return row;
}

/* Linear interpolation between two points of the winding axis. */
static inline float heatsoak_along_winding(const float *heat_A2, int32_t at, float share) {
  return heat_A2[at] + share * (heat_A2[at + 1] - heat_A2[at]);
}

static inline float heatsoak_along_stator(const float *heat_A2, const heatsoak_row *row, int32_t at, float share) {
  const float low_A2 = heatsoak_along_winding(heat_A2, at, share);
  return row->next_stator == 0 ? low_A2
                               : low_A2 + row->stator_share * (heatsoak_along_winding(heat_A2, at + row->next_stator, share) - low_A2);
}

static inline float heatsoak_resistance_ratio(const heatsoak_current_table *table, float winding_C) {
  return table->resistance_at_0C_ratio + table->resistance_ratio_per_K * winding_C;
}

/* Square of the allowed current; 0 for a winding above its axis and for NaN. A winding below its axis counts as its first point. */
static inline float heatsoak_allowed_A2(const heatsoak_current_table *table, const heatsoak_row *row, float winding_C) {
  const float first_C = table->winding_C.points[0];
  const float counted_C = (winding_C < first_C ? first_C : winding_C) + row->hotter_K;
  float share = 0.0f;
  float heat_A2;
  int32_t at;
  if (row->first < 0 || !(counted_C <= table->winding_C.points[table->winding_C.count - 1])) {
    return 0.0f;
  }
  at = row->first + heatsoak_find(&table->winding_C, counted_C, &share);
  heat_A2 = heatsoak_along_stator(table->heat_per_ohm_A2, row, at, share);
  if (row->next_speed != 0) {
    heat_A2 += row->speed_share * (heatsoak_along_stator(table->heat_per_ohm_A2, row, at + row->next_speed, share) - heat_A2);
  }
  return heat_A2 / heatsoak_resistance_ratio(table, counted_C);
}

/* Square root of a positive number: one instruction if the controller has it, else the C library's. Both round correctly. */
static inline float heatsoak_square_root(float x) {
#ifdef __GNUC__
  return __builtin_sqrtf(x);
#else
  return sqrtf(x);
#endif
}

/* Allowed current for a square of that row, 0 to most_current_A. */
static inline float heatsoak_current_A(const heatsoak_current_table *table, const heatsoak_row *row, float square_A2) {
  const float straight_A = table->straight_below_A;
  float current_A;
  if (!(square_A2 > 0.0f)) {
    return 0.0f;
  }
  current_A = square_A2 < straight_A * straight_A ? square_A2 / straight_A : heatsoak_square_root(square_A2);
  current_A = current_A < table->most_current_A ? current_A : table->most_current_A;
  return row->fade_ratio < 1.0f ? current_A * row->fade_ratio : current_A;
}

static inline float heatsoak_allowed_A(const heatsoak_current_table *table, const heatsoak_row *row, float winding_C) {
  return heatsoak_current_A(table, row, heatsoak_allowed_A2(table, row, winding_C));
}

#elif HEATSOAK_CURRENT_TABLE_H != 0x284c36ccu
#error "generated headers of different heatsoak versions in one program: generate all of them with the same one"
#endif
