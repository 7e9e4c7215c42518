/* Vertices: matrices, outcode, division, viewport, snap. Bit for bit the model's --transform s15.16
   (sim/scene/vertex_transform.hpp,
   host_geometry.hpp) and snap (model/host/viewport.hpp). */
#include "internal.h"

#define HP_LIMIT                 \
  (HALFPLANE_GUARD_BAND > 32767  \
       ? (int32_t)32767 * HP_ONE \
       : (int32_t)(HALFPLANE_GUARD_BAND * 65536 - (65536 >> HALFPLANE_SUBPIXEL_BITS))) /* guard band */

/* Replaces a point by its product with a matrix. Sums of four products do not leave 64 bits: hp_set_matrices().
   is_affine: w is 1 and
   stays 1. */
static uint8_t multiply(const hp_fixed matrix[16], hp_fixed point[4], uint8_t is_affine) {
  const hp_fixed x = point[0], y = point[1], z = point[2], w = point[3];
  uint8_t fits = 1;
  for (uint32_t row = 0; row < (is_affine != 0 ? 3u : 4u); ++row) {
    const hp_fixed* m = &matrix[4 * row];
    int64_t sum = (int64_t)m[0] * x + (int64_t)m[1] * y + (int64_t)m[2] * z + 32768;
    sum += is_affine != 0 ? (int64_t)m[3] * HP_ONE : (int64_t)m[3] * w;
    sum >>= 16;
    point[row] = (hp_fixed)sum;
    if (sum != point[row]) fits = 0;
  }
  return fits;
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
}

/* A place in the window, s15.16, snapped. */
static int16_t snapped(int64_t place) {
  if (place < -HP_LIMIT) place = -HP_LIMIT;
  if (place > HP_LIMIT) place = HP_LIMIT;
  const int32_t subpixel = ((int32_t)place + (32768 >> HALFPLANE_SUBPIXEL_BITS)) >> (16 - HALFPLANE_SUBPIXEL_BITS);
  return (int16_t)(subpixel * (1 << (HALFPLANE_GRID_BITS - HALFPLANE_SUBPIXEL_BITS)));
}

void hp_project(const hp_context* context, const hp_fixed clip[4], hp_vertex* vertex) {
  const hp_viewport* view = &context->viewport;
  const uint32_t w = clip[3] > 0 ? (uint32_t)clip[3] : 1;
  vertex->w = (hp_fixed)w;
  vertex->x = snapped(context->center[0] + hp_divide_rounded((int64_t)clip[0] * context->half[0], w));
  vertex->y = snapped(context->center[1] + hp_divide_rounded(-(int64_t)clip[1] * context->half[1], w));
  int64_t up = view->zero_to_one != 0 ? 2 * (int64_t)clip[2] : (int64_t)clip[2] + w; /* 2 w times the depth */
  if (up < 0) up = 0;
  if (up > 2 * (int64_t)w) up = 2 * (int64_t)w;
  const int64_t depth = hp_divide_rounded(up << 30, w);
  const int64_t range = (int64_t)view->far_depth - (int64_t)view->near_depth;
  vertex->depth = hp_depth_code((uint32_t)(view->near_depth + ((range * depth + ((int64_t)1 << 30)) >> 31)));
}

static const void* element(const void* array, uint32_t index, uint32_t stride) {
  return (const unsigned char*)array + (size_t)index * stride;
}

const hp_vertex* hp_fetch(hp_context* context, const hp_vertices* vertices, uint32_t index) {
  hp_vertex* vertex = &context->cache[index % HP_CACHE];
  if (vertex->tag == index) return vertex;
  ++context->counts.transformed;
  const hp_fixed* in = element(vertices->position, index, vertices->position_stride);
  hp_fixed* clip = vertex->clip;
  clip[0] = in[0];
  clip[1] = in[1];
  clip[2] = in[2];
  clip[3] = vertices->has_w != 0 ? in[3] : HP_ONE;
  vertex->tag = HP_NO_TAG;
  const uint8_t is_affine = vertices->has_w == 0 && context->is_affine != 0;
  if (context->has_view != 0 && multiply(context->view, clip, is_affine) == 0) return NULL;
  if (context->has_projection != 0 && multiply(context->projection, clip, 0) == 0) return NULL;
  vertex->tag = index;
  vertex->color = HP_RGBA(255, 255, 255, 255);
  if (vertices->color != NULL)
    vertex->color = *(const uint32_t*)element(vertices->color, index, vertices->color_stride);
  vertex->texcoord[0] = vertex->texcoord[1] = 0;
  if (vertices->texcoord != NULL) {
    const hp_fixed* texcoord = element(vertices->texcoord, index, vertices->texcoord_stride);
    vertex->texcoord[0] = texcoord[0];
    vertex->texcoord[1] = texcoord[1];
  }
  vertex->outcode = hp_outcode(context, clip);
  if (vertex->outcode == 0) hp_project(context, clip, vertex);
  return vertex;
}
