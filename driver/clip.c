/* Triangles with a corner outside the guard band or beyond near and far plane: clip and fan, the model's
   --transform s15.16 (sim/scene/host_geometry.cpp). */
#include "internal.h"

void hp_corner_of(const hp_vertex* v, hp_corner* corner) {
  for (uint32_t i = 0; i < 4; ++i) {
    corner->part[i] = v->clip[i];
    corner->part[4 + i] = (hp_fixed)((v->color >> (8 * i) & 255u) << 16);
  }
  corner->part[8] = v->texcoord[0];
  corner->part[9] = v->texcoord[1];
#if HALFPLANE_NORMALS != 0
  for (uint32_t i = 0; i < 3; ++i) corner->part[10 + i] = v->normal[i];
#endif
}

void hp_cut(hp_corner* made, const hp_corner* in, const hp_corner* out, int64_t d_in, int64_t d_out) {
  /* t, 31 fraction bits, from the inside end. */
  const uint64_t whole = (uint64_t)d_in - (uint64_t)d_out;
  const uint32_t bits = hp_bits64(whole), shift = bits > 32 ? bits - 32 : 0, divisor = (uint32_t)(whole >> shift);
  const int64_t t = hp_divide((((uint64_t)d_in >> shift) << 31) + divisor / 2, divisor);
  for (uint32_t i = 0; i < HP_PARTS; ++i) {
    const int64_t step = (int64_t)out->part[i] - in->part[i];
    made->part[i] = (hp_fixed)(in->part[i] + ((step * t + ((int64_t)1 << 30)) >> 31));
  }
}

void hp_project_corner(const hp_context* context, const hp_corner* corner, hp_vertex* vertex) {
  hp_project(context, corner->part, vertex);
  vertex->color = 0;
  for (uint32_t i = 0; i < 4; ++i) /* between the ends, which are codes */
    vertex->color |= (uint32_t)((corner->part[4 + i] + 32768) >> 16) << (8 * i);
  vertex->texcoord[0] = corner->part[8];
  vertex->texcoord[1] = corner->part[9];
#if HALFPLANE_NORMALS != 0
  if (context->is_lit != 0) hp_normal_codes(&corner->part[10], vertex->normal_code);
#endif
}

/* Sutherland and Hodgman, plane by plane; returns the number of corners of polygon[0]. */
static uint32_t clip(hp_context* context) {
  uint32_t size = 3, side = 0;
  for (uint32_t p = 0; p < 6; ++p) {
    const hp_plane* plane = &context->planes[p];
    const hp_corner* given = context->polygon[side];
    hp_corner* made = context->polygon[1 - side];
    uint32_t count = 0;
    for (uint32_t i = 0; i < size; ++i) {
      const hp_corner *from = &given[i], *to = &given[i + 1 == size ? 0 : i + 1];
      const int64_t d_from = hp_distance(plane, from->part), d_to = hp_distance(plane, to->part);
      if (count + 2 > HP_CORNERS) return hp_refuse(context, HP_POLYGON);
      if (d_from >= 0) made[count++] = *from;
      if (d_from >= 0 && d_to < 0) hp_cut(&made[count++], from, to, d_from, d_to);
      if (d_from < 0 && d_to >= 0) hp_cut(&made[count++], to, from, d_to, d_from);
    }
    size = count;
    side = 1 - side;
  }
  return size; /* of polygon[0]: six planes */
}

/* Piece i of the fan from corner `start`. */
static void piece_of(const hp_context* context, uint32_t size, uint32_t start, uint32_t i, const hp_vertex* v[3]) {
  v[0] = &context->corner[start];
  v[1] = &context->corner[(start + i) % size];
  v[2] = &context->corner[(start + i + 1) % size];
}

/* Rounding can dent the polygon: then the fan begins at a corner from which no piece is reversed, the smallest by y
   and x; or at the
   smallest of all, without the pieces that are. */
static uint32_t fan_start(const hp_context* context, uint32_t size, int64_t whole) {
  uint32_t best = 0;
  uint8_t best_agrees = 0;
  for (uint32_t start = 0; start < size; ++start) {
    uint8_t agrees = 1;
    for (uint32_t i = 1; i + 1 < size; ++i) {
      const hp_vertex* v[3];
      piece_of(context, size, start, i, v);
      const int64_t area = hp_area(v[0], v[1], v[2]);
      if (area != 0 && (area > 0) != (whole > 0)) agrees = 0;
    }
    const hp_vertex *a = &context->corner[start], *b = &context->corner[best];
    const uint8_t is_before = a->y != b->y ? a->y < b->y : a->x < b->x;
    if (agrees == best_agrees ? (start == 0 || is_before != 0) : agrees != 0) {
      best = start;
      best_agrees = agrees;
    }
  }
  return best;
}

static void send_pieces(hp_context* context, uint32_t size) {
  for (uint32_t i = 0; i < size; ++i) {
    hp_vertex* corner = &context->corner[i];
    hp_project_corner(context, &context->polygon[0][i], corner);
    corner->tag = HP_CORNER_TAG + i;
  }
  for (uint32_t s = 0; s < 3; ++s) /* corners of an earlier polygon */
    if (context->slot[s] >= HP_CORNER_TAG) context->slot[s] = HP_NO_TAG;
  const hp_vertex* v[3];
  int64_t whole = 0;
  for (uint32_t i = 1; i + 1 < size; ++i) {
    piece_of(context, size, 0, i, v);
    whole += hp_area(v[0], v[1], v[2]);
  }
  if (whole == 0) return;
  const uint32_t start = fan_start(context, size, whole);
  for (uint32_t i = 1; i + 1 < size; ++i) {
    piece_of(context, size, start, i, v);
    const int64_t area = hp_area(v[0], v[1], v[2]);
    if (area != 0 && (area > 0) == (whole > 0)) hp_send_triangle(context, v[0], v[1], v[2]);
  }
}

void hp_clip_triangle(hp_context* context, const hp_vertex* a, const hp_vertex* b, const hp_vertex* c) {
  if ((a->outcode & b->outcode & c->outcode) != 0) {
    ++context->counts.outside;
    return;
  }
  hp_corner_of(a, &context->polygon[0][0]);
  hp_corner_of(b, &context->polygon[0][1]);
  hp_corner_of(c, &context->polygon[0][2]);
  const uint32_t size = clip(context);
  ++*(size < 3 ? &context->counts.outside : &context->counts.cut);
  if (size >= 3) send_pieces(context, size);
}
