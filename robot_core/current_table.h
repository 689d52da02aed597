/* The derating table of a motor and how it is read: the same text in the drive core and in the exported C header, so plain C99.
   Method: squares of the allowed current, straight between the places (trilinear), because copper heats with the square. */
#ifndef HEATSOAK_CURRENT_TABLE_H
#define HEATSOAK_CURRENT_TABLE_H

#include <stdint.h>
#ifndef __GNUC__
#include <math.h>
#endif

/* Ascending places of an axis; one place: the axis does not matter. */
typedef struct {
  const float *points;
  int32_t count;
} heatsoak_axis;

typedef struct {
  heatsoak_axis speed_rad_per_s;
  heatsoak_axis stator_C;
  heatsoak_axis winding_C;
  const float *square_A2; /* [speed][stator][winding]; negative: no current is too much already */
  float most_current_A;
  float straight_below_A;           /* a smaller current is square/straight_below, so that it falls to 0 with a finite slope */
  float most_speed_rad_per_s;       /* from here on the current falls in a straight line */
  float no_current_speed_rad_per_s; /* to none here */
  float winding_per_stator_K;       /* a stator above its axis counts as a winding that is so many times hotter */
} heatsoak_current_table;

/* Where a speed and a stator temperature lie in the table: found once, used for several winding temperatures. */
typedef struct {
  int32_t first;       /* of the squares: corner of the cells of the row; negative: no current is allowed */
  int32_t next_stator; /* from a square to that of the next stator and speed; 0 without such an axis */
  int32_t next_speed;
  float stator_share; /* 0 to 1, place in the cell */
  float speed_share;
  float hotter_K;   /* that the winding counts hotter, for the stator */
  float fade_ratio; /* 0 to 1, current that a speed above the highest leaves */
} heatsoak_row;

/* Segment of an axis, from 0, and the place in it, 0 to 1; the ends for what lies outside. */
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

/* What is not a number allows no current. */
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

/* Between two places of the winding's axis. */
static inline float heatsoak_along_winding(const float *square_A2, int32_t at, float share) {
  return square_A2[at] + share * (square_A2[at + 1] - square_A2[at]);
}

static inline float heatsoak_along_stator(const float *square_A2, const heatsoak_row *row, int32_t at, float share) {
  const float low_A2 = heatsoak_along_winding(square_A2, at, share);
  return row->next_stator == 0 ? low_A2
                               : low_A2 + row->stator_share * (heatsoak_along_winding(square_A2, at + row->next_stator, share) - low_A2);
}

/* Square of the current; 0 above the axis of the winding and for what is not a number. */
static inline float heatsoak_allowed_A2(const heatsoak_current_table *table, const heatsoak_row *row, float winding_C) {
  const float first_C = table->winding_C.points[0];
  float counted_C = winding_C;
  float share = 0.0f;
  float low_A2;
  int32_t at;
  if (row->hotter_K > 0.0f) {
    counted_C = (winding_C < first_C ? first_C : winding_C) + row->hotter_K;
  }
  if (row->first < 0 || !(counted_C <= table->winding_C.points[table->winding_C.count - 1])) {
    return 0.0f;
  }
  at = row->first + heatsoak_find(&table->winding_C, counted_C, &share);
  low_A2 = heatsoak_along_stator(table->square_A2, row, at, share);
  return row->next_speed == 0
             ? low_A2
             : low_A2 + row->speed_share * (heatsoak_along_stator(table->square_A2, row, at + row->next_speed, share) - low_A2);
}

/* Of a positive number: one instruction where the controller has it, else the C library's; correctly rounded, so equal everywhere. */
static inline float heatsoak_square_root(float x) {
#ifdef __GNUC__
  return __builtin_sqrtf(x);
#else
  return sqrtf(x);
#endif
}

/* Current of a square of that row, from 0 to most_current_A. */
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

#endif
