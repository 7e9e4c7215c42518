/* Draws: vertices of triangles, lines and points. */
#include "internal.h"

typedef struct source {
  hp_context* context;
  const hp_vertices* vertices;
  const uint16_t* indices;
} source;

static uint32_t index_of(const source* from, uint32_t i) { return from->indices != NULL ? from->indices[i] : i; }

/* Vertex `index`, transformed; null: out of range. */
static const hp_vertex* vertex_of(const source* from, uint32_t index) {
  hp_vertex* vertex = &from->context->cache[index % HP_CACHE];
  return vertex->tag == index ? vertex : hp_transform(from->context, from->vertices, index, vertex);
}

/* Likewise, if it is there already. */
static const hp_vertex* cached(const source* from, uint32_t index) {
  const hp_vertex* vertex = &from->context->cache[index % HP_CACHE];
  return vertex->tag == index ? vertex : NULL;
}

/* Transformed vertices; false: one is out of range. An entry of the cache that another of them takes is copied
   first. */
static uint8_t fetch(const source* from, const uint32_t at[3], uint32_t count, const hp_vertex* v[3]) {
  hp_context* context = from->context;
  uint32_t index[3];
  for (uint32_t i = 0; i < count; ++i) {
    index[i] = index_of(from, at[i]);
    for (uint32_t j = 0; j < i; ++j)
      if (index[j] != index[i] && index[j] % HP_CACHE == index[i] % HP_CACHE) {
        hp_vertex* kept = &context->corner[HP_CORNERS - 3 + j];
        if (v[j] != kept) *kept = *v[j];
        v[j] = kept;
      }
    v[i] = vertex_of(from, index[i]);
    if (v[i] == NULL) {
      context->status |= HP_OUT_OF_RANGE;
      return 0;
    }
  }
  return 1;
}

static inline void send_triangle(hp_context* context, const hp_vertex* a, const hp_vertex* b, const hp_vertex* c) {
  if ((a->outcode | b->outcode | c->outcode) == 0)
    hp_send_triangle(context, a, b, c);
  else
    hp_clip_triangle(context, a, b, c);
}

/* Whether vertices have one entry of the cache. */
static inline uint8_t share(uint32_t i, uint32_t j) { return (i ^ j) % HP_CACHE == 0; }

static void triangle(const source* from, uint32_t a, uint32_t b, uint32_t c) {
  const uint32_t i = index_of(from, a), j = index_of(from, b), k = index_of(from, c);
  if (share(i, j) == 0 && share(j, k) == 0 && share(i, k) == 0) {
    const hp_vertex *first = vertex_of(from, i), *second = vertex_of(from, j), *third = vertex_of(from, k);
    if (first != NULL && second != NULL && third != NULL)
      send_triangle(from->context, first, second, third);
    else
      from->context->status |= HP_OUT_OF_RANGE;
  } else {
    const uint32_t at[3] = {a, b, c};
    const hp_vertex* v[3];
    if (fetch(from, at, 3, v) != 0) send_triangle(from->context, v[0], v[1], v[2]);
  }
}

/* A strip: the triangle of two vertices of the one before, where they lie in the cache, and a new one. Every second
   one is turned. */
static void strip(const source* from, uint32_t first, uint32_t count) {
  const hp_vertex *a = NULL, *b = NULL;
  uint32_t i = 0, j = 0;
  for (uint32_t n = first + 2; n < first + count; ++n) {
    const uint32_t turn = (n - first) & 1u, k = index_of(from, n);
    const hp_vertex* c = NULL;
    if (a != NULL && share(i, k) == 0 && share(j, k) == 0) {
      c = vertex_of(from, k);
      if (c == NULL)
        from->context->status |= HP_OUT_OF_RANGE;
      else if (turn != 0)
        send_triangle(from->context, a, c, b);
      else
        send_triangle(from->context, a, b, c);
    } else {
      triangle(from, n - 2, n - 1 + turn, n - turn);
      j = index_of(from, n - 1);
      b = cached(from, j);
      c = cached(from, k);
    }
    a = c != NULL ? b : NULL;
    i = j;
    b = c;
    j = k;
  }
}

static void line(const source* from, uint32_t a, uint32_t b) {
  const uint32_t at[3] = {a, b, 0};
  const hp_vertex* v[3];
  ++from->context->counts.lines;
  if (fetch(from, at, 2, v) != 0) hp_draw_line(from->context, v[0], v[1]);
}

static void point(const source* from, uint32_t a) {
  const uint32_t at[3] = {a, 0, 0};
  const hp_vertex* v[3];
  ++from->context->counts.points;
  if (fetch(from, at, 1, v) != 0) hp_draw_point(from->context, v[0]);
}

/* One run of indices between restarts, from `first` on. What is left over makes no primitive. */
static void draw_run(const source* from, enum hp_topology topology, uint32_t first, uint32_t count) {
  if (topology <= HP_TRIANGLE_FAN && count > 2)
    from->context->counts.triangles += topology == HP_TRIANGLES ? count / 3 : count - 2;
  switch (topology) {
    case HP_TRIANGLES:
      for (uint32_t i = 0; i + 2 < count; i += 3) triangle(from, first + i, first + i + 1, first + i + 2);
      break;
    case HP_TRIANGLE_STRIP: strip(from, first, count); break;
    case HP_TRIANGLE_FAN:
      for (uint32_t i = 0; i + 2 < count; ++i) triangle(from, first + i + 1, first + i + 2, first);
      break;
    case HP_LINES:
      for (uint32_t i = 0; i + 1 < count; i += 2) line(from, first + i, first + i + 1);
      break;
    case HP_LINE_STRIP:
    case HP_LINE_LOOP:
      for (uint32_t i = 0; i + 1 < count; ++i) line(from, first + i, first + i + 1);
      if (topology == HP_LINE_LOOP && count > 1) line(from, first + count - 1, first);
      break;
    default: /* points */
      for (uint32_t i = 0; i < count; ++i) point(from, first + i);
      break;
  }
}

void hp_draw(hp_context* context, enum hp_topology topology, const hp_vertices* vertices, const uint16_t* indices,
             uint32_t count) {
  if (vertices->position == NULL || (indices == NULL && count > HP_CORNER_TAG) || (uint32_t)topology > HP_POINTS) {
    context->status |= HP_BAD_VALUE;
    return;
  }
#if HALFPLANE_LINES_UNIT == 0
  if (topology >= HP_LINES && topology <= HP_LINE_LOOP) {
    context->status |= HP_UNSUPPORTED;
    return;
  }
#endif
  for (uint32_t i = 0; i < HP_CACHE; ++i) context->cache[i].tag = HP_NO_TAG; /* of other vertices */
  if (hp_prepare(context, topology <= HP_TRIANGLE_FAN) == 0) return;
  for (uint32_t i = 0; i < 3; ++i) context->slot[i] = HP_NO_TAG;
  const source from = {context, vertices, indices};
  uint32_t first = 0;
  for (uint32_t i = 0; indices != NULL && i < count; ++i)
    if (indices[i] == HP_RESTART) {
      draw_run(&from, topology, first, i - first);
      first = i + 1;
    }
  draw_run(&from, topology, first, count - first);
  hp_settle(context);
}
