/* Vertices: matrices, outcode, division, viewport, snap. Bit for bit the model's --transform s15.16
   (sim/scene/vertex_transform.hpp,
   host_geometry.hpp) and snap (model/host/viewport.hpp). */
#include "internal.h"

#define HP_LIMIT                 \
  (HALFPLANE_GUARD_BAND > 32767  \
       ? (int32_t)32767 * HP_ONE \
       : (int32_t)(HALFPLANE_GUARD_BAND * 65536 - (65536 >> HALFPLANE_SUBPIXEL_BITS))) /* guard band */

#define HP_HALF_SUBPIXEL (32768 >> HALFPLANE_SUBPIXEL_BITS)

/* Half a viewport and a w, for which numbers of the quick way fit: 4,096 pixels, and 4,096. */
#define HP_QUICK_BITS 28
#define HP_QUICK ((hp_fixed)1 << HP_QUICK_BITS)

/* A row's sum of products, rounded; `out_of_range` gets a bit where it does not fit. */
static inline hp_fixed rounded(int64_t sum, uint32_t* out_of_range) {
  const int32_t high = (int32_t)(sum >> 32);
  *out_of_range |= ((uint32_t)high + 32768u) >> 16;
  return (hp_fixed)(((uint32_t)high << 16) | ((uint32_t)sum >> 16));
}

/* Replaces a point by its product with a matrix; 0: out of range. Sums of four products do not leave 64 bits:
   hp_set_matrices(). */
static uint8_t multiply(const hp_fixed matrix[16], hp_fixed point[4]) {
  const hp_fixed x = point[0], y = point[1], z = point[2], w = point[3];
  uint32_t out_of_range = 0;
  for (const hp_fixed* m = matrix; m != matrix + 16; m += 4, ++point)
    *point =
        rounded((int64_t)m[0] * x + (int64_t)m[1] * y + (int64_t)m[2] * z + (int64_t)m[3] * w + 32768, &out_of_range);
  return out_of_range == 0;
}

/* The product of a row and a point whose w is 1. */
static inline hp_fixed affine_row(const hp_fixed m[4], int64_t offset, hp_fixed x, hp_fixed y, hp_fixed z,
                                  uint32_t* out_of_range) {
  return rounded((int64_t)m[0] * x + (int64_t)m[1] * y + (int64_t)m[2] * z + offset, out_of_range);
}

/* A vertex's point in clip space; 0: out of range. */
static uint8_t to_clip(const hp_context* context, const hp_fixed* in, uint8_t has_w, hp_fixed clip[4]) {
  hp_fixed x = in[0], y = in[1], z = in[2];
  const uint8_t is_affine = context->view_kind == HP_AFFINE && has_w == 0;
  uint32_t out_of_range = 0;
  if (is_affine != 0) {
    const hp_fixed* m = context->view;
    const int64_t* offset = context->view_offset;
    const hp_fixed a = affine_row(m, offset[0], x, y, z, &out_of_range);
    const hp_fixed b = affine_row(m + 4, offset[1], x, y, z, &out_of_range);
    z = affine_row(m + 8, offset[2], x, y, z, &out_of_range);
    x = a;
    y = b;
    if (out_of_range != 0) return 0;
    if (context->projection_kind == HP_PERSPECTIVE) {
      const hp_fixed* p = context->projection;
      clip[0] = rounded((int64_t)p[0] * x + 32768, &out_of_range);
      clip[1] = rounded((int64_t)p[5] * y + 32768, &out_of_range);
      clip[2] = rounded((int64_t)p[10] * z + (((int64_t)p[11] * 65536) | 32768), &out_of_range);
      clip[3] = (hp_fixed)(0u - (uint32_t)z);
      return out_of_range == 0 && z != INT32_MIN;
    }
  }
  clip[0] = x;
  clip[1] = y;
  clip[2] = z;
  clip[3] = has_w != 0 ? in[3] : HP_ONE;
  if (is_affine == 0 && context->view_kind != HP_IDENTITY && multiply(context->view, clip) == 0) return 0;
  return context->projection_kind == HP_IDENTITY || multiply(context->projection, clip) != 0;
}

int64_t hp_distance(const hp_plane* plane, const hp_fixed clip[4]) {
  return plane->x * clip[0] + plane->y * clip[1] + plane->z * clip[2] + plane->w * clip[3];
}

uint8_t hp_outcode(const hp_context* context, const hp_fixed clip[4]) {
  const hp_fixed w = clip[3];
  const int64_t low = context->viewport.zero_to_one != 0 ? 0 : -(int64_t)w;
  if (context->covers_view != 0 && clip[0] <= w && clip[0] >= -(int64_t)w && clip[1] <= w && clip[1] >= -(int64_t)w &&
      clip[2] <= w && clip[2] >= low)
    return 0;
  uint32_t code = 0;
  for (uint32_t i = 0; i < 6; ++i)
    if (hp_distance(&context->planes[i], clip) < 0) code |= 1u << i;
  return (uint8_t)code;
}

void hp_derive_view(hp_context* context) {
  const hp_viewport* view = &context->viewport;
  hp_plane* planes = context->planes;
  const hp_plane near_plane = {0, 0, HP_ONE, view->zero_to_one != 0 ? 0 : HP_ONE}, far_plane = {0, 0, -HP_ONE, HP_ONE};
  planes[0] = near_plane;
  planes[1] = far_plane;
  uint8_t covers = 1;
  for (uint32_t axis = 0; axis < 2; ++axis) {
    const int64_t first = axis == 0 ? view->x : view->y, size = axis == 0 ? view->width : view->height;
    const int64_t twice = 2 * first + size; /* the centre, 2^-17 */
    context->half[axis] = (hp_fixed)((size + 1) >> 1);
    context->center[axis] = (hp_fixed)(first + context->half[axis]);
    context->quick_center[axis] = context->center[axis] + HP_HALF_SUBPIXEL;
    hp_plane low = {0, 0, 0, 0}, high = {0, 0, 0, 0};
    /* y is down in the window. */
    const int64_t up = (size + 1) >> 1, down = (1 - size) >> 1;
    if (axis == 0) {
      low.x = up;
      high.x = down;
    } else {
      low.y = down;
      high.y = up;
    }
    low.w = (2 * (int64_t)HP_LIMIT + twice + 1) >> 1;
    high.w = (2 * (int64_t)HP_LIMIT - twice + 1) >> 1;
    if (low.w < up || high.w < up) covers = 0;
    planes[2 + 2 * axis] = low;
    planes[3 + 2 * axis] = high;
  }
  context->covers_view = covers;
  context->is_whole_range = view->near_depth == 0 && view->far_depth == HP_DEPTH_ONE;
  context->is_quick = covers != 0 && context->half[0] < HP_QUICK && context->half[1] < HP_QUICK &&
                      (int64_t)view->x + view->width < HP_LIMIT && (int64_t)view->y + view->height < HP_LIMIT;
}

/* A place in the window and half a subpixel, s15.16, snapped. */
static int16_t snapped(int32_t place) {
  const int32_t subpixel = place >> (16 - HALFPLANE_SUBPIXEL_BITS);
  return (int16_t)(subpixel * (1 << (HALFPLANE_GRID_BITS - HALFPLANE_SUBPIXEL_BITS)));
}
static int16_t clamped(int64_t place) {
  return snapped((int32_t)(place < -HP_LIMIT ? -HP_LIMIT : place > HP_LIMIT ? HP_LIMIT : place) + HP_HALF_SUBPIXEL);
}

/* The code of a depth in the view, 31 fraction bits. */
static inline uint32_t ranged(const hp_context* context, uint32_t depth) {
  if (context->is_whole_range == 0) {
    const hp_viewport* view = &context->viewport;
    const int64_t range = (int64_t)view->far_depth - (int64_t)view->near_depth;
    depth = (uint32_t)(view->near_depth + ((range * depth + ((int64_t)1 << 30)) >> 31));
  }
  return hp_depth_code(depth);
}

void hp_project(const hp_context* context, const hp_fixed clip[4], hp_vertex* vertex) {
  const uint32_t w = clip[3] > 0 ? (uint32_t)clip[3] : 1;
#if HP_HAS_TEXTURES
  vertex->w = (hp_fixed)w;
  vertex->shift = (uint8_t)hp_shift_of(w);
  vertex->reciprocal = hp_reciprocal(w, vertex->shift);
#endif
  vertex->x = clamped(context->center[0] + hp_divide_rounded((int64_t)clip[0] * context->half[0], w));
  vertex->y = clamped(context->center[1] + hp_divide_rounded(-(int64_t)clip[1] * context->half[1], w));
  /* 2 w times the depth */
  int64_t up = context->viewport.zero_to_one != 0 ? 2 * (int64_t)clip[2] : (int64_t)clip[2] + w;
  if (up < 0) up = 0;
  if (up > 2 * (int64_t)w) up = 2 * (int64_t)w;
  vertex->depth = ranged(context, (uint32_t)hp_divide_rounded(up << 30, w));
}

/* floor(x half / w + 1/2): a guess by the reciprocal, wrong by 3 at most, made exact. */
static inline int32_t over_w(int32_t x, int32_t half, uint32_t w, int32_t reciprocal, uint32_t shift) {
  const int32_t ratio = (int32_t)(((int64_t)(int32_t)((uint32_t)x << (shift - 1)) * reciprocal) >> 32); /* 2^29 x / w */
  const uint32_t guess = (uint32_t)(((int64_t)ratio * (half * 8)) >> 32);
  return (int32_t)hp_corrected(guess, (uint32_t)x * (uint32_t)half + w / 2, w);
}

/* hp_project() of a point inside the view, with one division of 32 bits in place of six; 0: it is not inside, or its
   numbers are too long. The results are the same bits. */
static uint8_t project_quickly(const hp_context* context, const hp_fixed clip[4], hp_vertex* vertex) {
  const uint32_t w = (uint32_t)clip[3], twice = 2 * w;
  const uint8_t zero_to_one = context->viewport.zero_to_one;
  const uint32_t above = zero_to_one != 0 ? (uint32_t)clip[2] : (uint32_t)clip[2] + w; /* the near plane */
  if (context->is_quick == 0 || (w - 1) >> HP_QUICK_BITS != 0 || (uint32_t)clip[0] + w > twice ||
      (uint32_t)clip[1] + w > twice || above > (zero_to_one != 0 ? w : twice))
    return 0;
  const uint32_t shift = hp_shift_of(w), reciprocal = hp_reciprocal(w, shift);
  const uint32_t up = zero_to_one != 0 ? 2 * above : above; /* 2 w times the depth */
  const uint32_t depth = hp_corrected(hp_high(up << (shift - 1), reciprocal) << 1, (up << 30) + w / 2, w);
#if HP_HAS_TEXTURES
  vertex->w = (hp_fixed)w;
  vertex->shift = (uint8_t)shift;
  vertex->reciprocal = reciprocal;
#endif
  vertex->x = snapped(context->quick_center[0] + over_w(clip[0], context->half[0], w, (int32_t)reciprocal, shift));
  vertex->y = snapped(context->quick_center[1] + over_w(-clip[1], context->half[1], w, (int32_t)reciprocal, shift));
  vertex->depth = ranged(context, depth);
  return 1;
}

static const void* element(const void* array, uint32_t index, uint32_t stride) {
  return (const unsigned char*)array + index * stride;
}

const hp_vertex* hp_transform(hp_context* context, const hp_vertices* vertices, uint32_t index, hp_vertex* vertex) {
  ++context->counts.transformed;
  const hp_fixed* in = element(vertices->position, index, vertices->position_stride);
  hp_fixed* clip = vertex->clip;
  if (to_clip(context, in, vertices->has_w, clip) == 0) {
    vertex->tag = HP_NO_TAG;
    return NULL;
  }
  vertex->tag = index;
  vertex->color = vertices->color != NULL ? *(const uint32_t*)element(vertices->color, index, vertices->color_stride)
                                          : HP_RGBA(255, 255, 255, 255);
#if HP_HAS_TEXTURES
  vertex->texcoord[0] = vertex->texcoord[1] = 0;
  if (vertices->texcoord != NULL) {
    const hp_fixed* texcoord = element(vertices->texcoord, index, vertices->texcoord_stride);
    vertex->texcoord[0] = texcoord[0];
    vertex->texcoord[1] = texcoord[1];
  }
#endif
#if HALFPLANE_NORMALS != 0
  if (context->is_lit != 0) {
    const hp_fixed* normal = vertices->normal;
    if (normal != NULL) normal = element(normal, index, vertices->normal_stride);
    for (uint32_t i = 0; i < 3; ++i) vertex->normal[i] = normal != NULL ? normal[i] : 0;
    hp_normal_codes(vertex->normal, vertex->normal_code);
  }
#endif
  vertex->outcode = 0;
  if (project_quickly(context, clip, vertex) != 0) return vertex;
  vertex->outcode = hp_outcode(context, clip);
  if (vertex->outcode == 0) hp_project(context, clip, vertex);
  return vertex;
}
