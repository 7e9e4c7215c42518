/* Lines and points: clip, setup, words. The model's model/host/line_setup.cpp and point_raster.hpp. */
#include "internal.h"

#if HALFPLANE_LINE_POSITION_BITS > 31
#error "positions along a line need more than 32 bits: make guard.band or subpixel.bits smaller"
#endif
#if HALFPLANE_LINES_UNIT != 0 && HALFPLANE_RECIPROCAL_BITS > 31
#error "one over a line's length needs more than 32 bits: make depth.bits or reciprocal.extra_bits smaller"
#endif

#define HP_S HALFPLANE_GRID_BITS
#define HP_PIXEL ((int32_t)1 << HP_S)

/* The line in its own octant: along the major axis from a0 to a1, along the minor one from b0 to b1, both growing.
   Reversing an axis
   maps v to -v, and so pixel i to -1 - i. */
typedef struct octant {
  int32_t a0, b0, a1, b1;
  uint8_t is_x_major, is_major_negative, is_minor_negative;
} octant;

static octant to_octant(const int32_t start[2], const int32_t end[2], uint8_t rule) {
  int32_t from[2], to[2], size[2];
  uint8_t is_negative[2];
  for (uint32_t i = 0; i < 2; ++i) {
    /* But for diamonds: the centre of the pixel. */
    from[i] = rule == HP_DIAMOND ? start[i] : (start[i] >> HP_S) * HP_PIXEL + HP_PIXEL / 2;
    to[i] = rule == HP_DIAMOND ? end[i] : (end[i] >> HP_S) * HP_PIXEL + HP_PIXEL / 2;
    is_negative[i] = to[i] < from[i];
    if (is_negative[i] != 0) {
      from[i] = -from[i];
      to[i] = -to[i];
    }
    size[i] = to[i] - from[i];
  }
  const uint8_t is_x_major = size[0] >= size[1];
  const uint32_t major = is_x_major != 0 ? 0 : 1, minor = 1 - major;
  const octant line = {from[major], from[minor],        to[major],         to[minor],
                       is_x_major,  is_negative[major], is_negative[minor]};
  return line;
}

/* Whether a line that crosses a column's centre exactly between two rows takes the later row. */
static uint8_t tie_moves(const octant* line, uint8_t rule) {
  if (line->is_x_major == 0) return line->is_minor_negative;
  if (rule != HP_DIAMOND) return line->is_major_negative;
  return line->is_major_negative == 0 && line->b1 != line->b0;
}

/* Diamond exit: the first column that a line from (a, b) on would cover, one past the last that a line to (a, b)
   does. */
static int32_t exit_column(const octant* line, int32_t a, int32_t b) {
  const int32_t half = HP_PIXEL / 2;
  const int32_t column = line->is_major_negative != 0 ? ((a - half) >> HP_S) + 1 : (a - half + HP_PIXEL - 1) >> HP_S;
  const int32_t u = a - (column - 1) * HP_PIXEL - half, v = (b & (HP_PIXEL - 1)) - half;
  const int32_t reach = u + (v < 0 ? -v : v);
  uint8_t is_inside = reach < half;
  if (reach == half) { /* on the border */
    if (line->is_x_major != 0)
      is_inside = line->is_major_negative == 0;
    else if (v == -half)
      is_inside = 1;
    else
      is_inside = v != 0 && (v > 0) != (line->is_minor_negative != 0);
  }
  return is_inside != 0 ? column - 1 : column;
}

static int32_t floor_divide(int32_t n, int32_t d) {
  const int32_t quotient = n / d;
  return n % d < 0 ? quotient - 1 : quotient;
}

/* The steps n whose row, floor((q + d n) / D), lies in low...high; none: first > last. */
static void clip_to_rows(int32_t* first, int32_t* last, int32_t low, int32_t high, int32_t q, int32_t d, int32_t D) {
  if (q + d * *first < low * D) {
    if (d == 0) {
      *last = *first - 1;
      return;
    }
    *first = (low * D - q + d - 1) / d;
  }
  if (q + d * *last >= (high + 1) * D) {
    const int32_t room = (high + 1) * D - 1 - q;
    *last = d == 0 || room < 0 ? *first - 1 : room / d;
  }
}

/* The value of a plane at the first pixel, and its step per pixel. */
static void put_attribute(uint32_t* words, uint32_t at, uint32_t bits, int32_t from, int32_t to, uint64_t reciprocal,
                          int32_t shift, int32_t offset) {
  const int64_t gradient = hp_round_shift((to - from) * (int64_t)reciprocal, shift - HP_S - HALFPLANE_LINE_GUARD_BITS);
  const int64_t value = (int64_t)from * ((int64_t)1 << HALFPLANE_LINE_GUARD_BITS) +
                        ((int64_t)1 << (HALFPLANE_LINE_GUARD_BITS - 1)) + hp_round_shift(gradient * offset, HP_S);
  hp_put_bits(words, HALFPLANE_LINE_SETUP_VALUE_AT + at, bits, (uint64_t)value);
  hp_put_bits(words, HALFPLANE_LINE_SETUP_STEP_AT + at, bits, (uint64_t)gradient);
}

static uint32_t code_of(const hp_vertex* v, uint32_t plane) {
  return plane == 0 ? v->depth : v->color >> (8 * (plane - 1)) & 255u;
}

static void put_attributes(uint32_t* words, const hp_vertex* a, const hp_vertex* b, int32_t length, int32_t offset) {
  static const uint8_t line_bits[] = HALFPLANE_LINE_BITS_OF, code_bits[] = HALFPLANE_AFFINE_CODE_BITS_OF;
  uint64_t reciprocal = 0;
  int32_t shift = 0;
  if (length > 0) { /* one pixel alone has no gradients */
    shift = (int32_t)hp_bits32((uint32_t)length) - 1 + HALFPLANE_RECIPROCAL_BITS - 1;
    reciprocal = (uint64_t)hp_round_shift(hp_divide((uint64_t)2 << shift, (uint32_t)length), 1);
  }
  uint32_t line_at = 0, code_at = 0;
  for (uint32_t p = 0; p < HALFPLANE_AFFINE_PLANES; ++p) {
    const uint32_t from = code_of(a, p);
    put_attribute(words, line_at, line_bits[p], (int32_t)from, (int32_t)code_of(b, p), reciprocal, shift, offset);
    hp_put_bits(words, HALFPLANE_LINE_SETUP_START_AT + code_at, code_bits[p], from);
    line_at += line_bits[p];
    code_at += code_bits[p];
  }
}

/* One strand of a line, its ends moved: sends what of it is in context->rect. */
static void send_strand(hp_context* context, const hp_vertex* a, const hp_vertex* b, const int32_t start[2],
                        const int32_t end[2]) {
  const uint8_t rule = context->state.line_rule;
  const octant line = to_octant(start, end, rule);
  const int32_t d = line.b1 - line.b0, D = line.a1 > line.a0 ? line.a1 - line.a0 : 1;
  int32_t first = line.a0 >> HP_S, end_column = (line.a1 >> HP_S) + (context->state.line_last != 0 ? 1 : 0);
  if (rule == HP_DIAMOND) {
    first = exit_column(&line, line.a0, line.b0);
    end_column = exit_column(&line, line.a1, line.b1);
  }
  const int32_t base = line.b0 >> HP_S, offset = first * HP_PIXEL + HP_PIXEL / 2 - line.a0;
  const int32_t numerator = (line.b0 & (HP_PIXEL - 1)) * D + d * offset;
  const int32_t q = (numerator - (tie_moves(&line, rule) != 0 ? 0 : 1)) >> HP_S;

  const uint32_t x = line.is_x_major != 0 ? 0 : 1; /* left and right, or top and bottom, along the major axis */
  int32_t low[2], high[2];                         /* of the rect along major and minor axis */
  for (uint32_t i = 0; i < 2; ++i) {
    const uint32_t axis = i == 0 ? x : 1 - x;
    const uint8_t is_negative = i == 0 ? line.is_major_negative : line.is_minor_negative;
    low[i] = is_negative != 0 ? ~context->rect[2 + axis] : context->rect[axis];
    high[i] = is_negative != 0 ? ~context->rect[axis] : context->rect[2 + axis];
  }
  int32_t step = hp_max(0, low[0] - first), last = hp_min(end_column - 1, high[0]) - first;
  if (step > last) return;
  clip_to_rows(&step, &last, low[1] - base, high[1] - base, q, d, D);
  if (step > last) return;

  const int32_t position = q + d * step, row = floor_divide(position, D), column = first + step;
  const int32_t along = line.is_major_negative != 0 ? ~column : column;
  const int32_t across = line.is_minor_negative != 0 ? ~(row + base) : row + base;
  uint32_t words[HP_LINE_WORDS + 1] = {0};
#define HP_FIELD(name, value) \
  hp_put_bits(words, HALFPLANE_LINE_SETUP_##name##_AT, HALFPLANE_LINE_SETUP_##name##_BITS, (uint64_t)(int64_t)(value))
  HP_FIELD(X, line.is_x_major != 0 ? along : across);
  HP_FIELD(Y, line.is_x_major != 0 ? across : along);
  HP_FIELD(IS_X_MAJOR, line.is_x_major);
  HP_FIELD(IS_X_NEGATIVE, line.is_x_major != 0 ? line.is_major_negative : line.is_minor_negative);
  HP_FIELD(IS_Y_NEGATIVE, line.is_x_major != 0 ? line.is_minor_negative : line.is_major_negative);
  HP_FIELD(IS_BEFORE_START, step == 0 && offset < 0);
  HP_FIELD(REMAINING, last - step);
  HP_FIELD(STEP_STAY, d);
  HP_FIELD(STEP_MOVE, d - D);
  HP_FIELD(ERROR, position - row * D + d - D);
#undef HP_FIELD
  put_attributes(words, a, b, line.a1 - line.a0, offset + step * HP_PIXEL);
  if (hp_reserve(context, 1 + HP_LINE_WORDS) == 0) return;
  hp_put(context, HP_HEADER(HP_LINE, 0));
  for (uint32_t i = 0; i < HP_LINE_WORDS; ++i) hp_put(context, words[i]);
  ++context->counts.sent;
}

/* Strands of one pixel, side by side across the major axis. */
static void send_line(hp_context* context, const hp_vertex* a, const hp_vertex* b) {
  const int32_t count = context->state.line_width;
  const uint8_t rule = context->state.line_rule;
  const int32_t from[2] = {a->x, a->y}, to[2] = {b->x, b->y};
  const uint32_t minor = to_octant(from, to, rule).is_x_major != 0 ? 1 : 0;
  for (int32_t i = 0; i < count; ++i) {
    const int32_t across =
        rule == HP_DIAMOND ? (2 * i - (count - 1)) * (HP_PIXEL / 2) : (i - (count - 1) / 2) * HP_PIXEL;
    int32_t start[2] = {a->x, a->y}, end[2] = {b->x, b->y};
    start[minor] += across;
    end[minor] += across;
    send_strand(context, a, b, start, end);
  }
}

void hp_draw_line(hp_context* context, const hp_vertex* a, const hp_vertex* b) {
  if ((a->outcode | b->outcode) == 0) {
    send_line(context, a, b);
    return;
  }
  hp_corner *from = &context->polygon[0][0], *to = &context->polygon[0][1];
  hp_corner_of(a, from);
  hp_corner_of(b, to);
  for (uint32_t p = 0; p < 6; ++p) {
    const int64_t d_a = hp_distance(&context->planes[p], from->part), d_b = hp_distance(&context->planes[p], to->part);
    if (d_a < 0 && d_b < 0) {
      ++context->counts.outside;
      return;
    }
    hp_corner *out = d_a < 0 ? from : to, *in = d_a < 0 ? to : from;
    const hp_corner before = *out;
    if (d_a < 0 || d_b < 0) hp_cut(out, in, &before, d_a < 0 ? d_b : d_a, d_a < 0 ? d_a : d_b);
  }
  ++context->counts.cut;
  for (uint32_t i = 0; i < 2; ++i) hp_project_corner(context, &context->polygon[0][i], &context->corner[i]);
  send_line(context, &context->corner[0], &context->corner[1]);
}

/* The first pixel whose centre is at or after a border, which is in halves of a subpixel. */
static int32_t first_centre(int32_t border) { return (border - HP_PIXEL + 2 * HP_PIXEL - 1) >> (HP_S + 1); }

void hp_draw_point(hp_context* context, const hp_vertex* v) {
  if (v->outcode != 0) {
    ++context->counts.outside;
    return;
  }
  const int32_t size = (context->state.point_size + (32768 >> HP_S)) >> (16 - HP_S); /* subpixels */
  const int32_t place[2] = {2 * (int32_t)v->x, 2 * (int32_t)v->y};
  int32_t box[4];
  for (uint32_t i = 0; i < 2; ++i) {
    box[i] = hp_max(context->rect[i], first_centre(place[i] - size));
    box[2 + i] = hp_min(context->rect[2 + i], first_centre(place[i] + size) - 1);
  }
  if (box[0] > box[2] || box[1] > box[3] || hp_reserve(context, 3 + 1 + HP_AFFINE_WORDS) == 0) return;
  hp_send_box(context, box[0], box[1], box[2], box[3]);
  hp_put(context, HP_HEADER(HP_POINT, 0));
  hp_put_codes(context, v->depth, v->color);
  ++context->counts.sent;
}
