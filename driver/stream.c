/* The stream: begin, words, tokens, and the commands that draw nothing. */
#include <string.h>

#include "internal.h"

#define HP_TOKEN_REST (HALFPLANE_ALL_AFFINE_CODE_BITS % 32) /* bits of a token's last affine word; 0: all */
#define HP_LONGEST_TOKEN (1 + HP_AFFINE_WORDS + (HALFPLANE_STATE_WORD_BITS - HALFPLANE_ALL_AFFINE_CODE_BITS + 31) / 32)

hp_state hp_default_state(void) {
  hp_state state;
  memset(&state, 0, sizeof state);
  state.depth_test = HP_LESS;
  state.depth_write = 1;
  state.color_mask = 15;
  state.src = state.src_alpha = HP_ONE_FACTOR;
  state.logic_op = HP_LOGIC_COPY;
  state.alpha_func = HP_ALWAYS;
  state.sample_mask = 255;
  state.largest_level = 12 * 256;
  for (uint32_t i = 0; i < 2; ++i) {
    state.stencil[i].func = HP_ALWAYS;
    state.stencil[i].read_mask = state.stencil[i].write_mask = 255;
  }
  state.line_rule = HP_DIAMOND;
  state.line_width = 1;
  state.point_size = HP_ONE;
  return state;
}

void hp_init(hp_context* context) {
  memset(context, 0, sizeof *context);
  context->state = hp_default_state();
}

uint64_t hp_config_id(void) { return ((uint64_t)HALFPLANE_CONFIG_ID_HIGH << 32) | HALFPLANE_CONFIG_ID_LOW; }

void hp_begin(hp_context* context, const hp_stream* stream) {
  if (stream->words == NULL || stream->size < HP_LONGEST) {
    context->status |= HP_BAD_VALUE;
    return;
  }
  context->stream = *stream;
  context->at = context->written = context->read = 0;
  context->wraps = 0;
  context->next = stream->words;
  context->end = stream->words + stream->size;
  context->known = 0;
  context->has_lines = 0;
  context->fog_lines = NULL;
#if HALFPLANE_NORMALS != 0
  context->light_lines = NULL;
#endif
  context->is_drawn = context->is_set = context->is_cleared = 0;
  memset(&context->counts, 0, sizeof context->counts);
}

uint32_t hp_written(const hp_context* context) { return context->written; }
uint32_t hp_status(const hp_context* context) { return context->status; }
const hp_counts* hp_count(const hp_context* context) { return &context->counts; }

/* ---- Words */

/* Counts the words up to context->next; those that wrap go to their places. */
void hp_settle(hp_context* context) {
  const hp_stream* stream = &context->stream;
  if (context->end == NULL) return; /* no stream */
  if (context->wraps != 0) {
    const uint32_t count = (uint32_t)(context->next - context->wrapped);
    for (uint32_t i = 0; i < count; ++i) {
      stream->words[context->at] = context->wrapped[i];
      if (++context->at == stream->size) context->at = 0;
    }
    context->written += count;
    context->wraps = 0;
  } else {
    const uint32_t at = (uint32_t)(context->next - stream->words);
    context->written += at - context->at;
    context->at = at == stream->size ? 0 : at;
  }
  /* The words that are free and in one piece. */
  const uint32_t room = stream->size - (context->written - context->read), whole = stream->size - context->at;
  context->next = stream->words + context->at;
  context->end = context->next + (room < whole ? room : whole);
}

uint8_t hp_make_room(hp_context* context, uint32_t words) {
  const hp_stream* stream = &context->stream;
  hp_settle(context);
  if ((uint32_t)(context->end - context->next) >= words) return 1;
  if (stream->size - (context->written - context->read) < words && stream->wait != NULL) {
    context->read = stream->wait(stream->user, context->written);
    hp_settle(context);
    if ((uint32_t)(context->end - context->next) >= words) return 1;
  }
  if (context->end == NULL || stream->size - (context->written - context->read) < words)
    return hp_refuse(context, HP_FULL);
  context->wraps = 1;
  context->next = context->wrapped;
  context->end = context->wrapped + words;
  return 1;
}

void hp_put_codes(hp_context* context, uint32_t depth, uint32_t color) {
  hp_write_codes(context->next, depth, color);
  context->next += HP_AFFINE_WORDS;
}

/* After hp_reserve(). */
void hp_send_state(hp_context* context, uint32_t word) {
  if ((context->known & HP_KNOWS_STATE) != 0 && context->state_word == word) return;
  context->known |= HP_KNOWS_STATE;
  context->state_word = word;
  hp_put(context, HP_SET_OF(HP_STATE, 1));
  hp_put(context, word);
}

/* Likewise. */
void hp_send_box(hp_context* context, int32_t left, int32_t top, int32_t right, int32_t bottom) {
  const uint32_t low = (uint32_t)left | ((uint32_t)top << 16), high = (uint32_t)right | ((uint32_t)bottom << 16);
  if ((context->known & HP_KNOWS_BOX) != 0 && context->box[0] == low && context->box[1] == high) return;
  context->known |= HP_KNOWS_BOX;
  context->box[0] = low;
  context->box[1] = high;
  hp_put(context, HP_SET_OF(HP_BOX_MIN, 2));
  hp_put(context, low);
  hp_put(context, high);
}

#if HP_HAS_TOKENS
void hp_send_token(hp_context* context, uint32_t which, const uint32_t value[4]) {
  if (hp_reserve(context, HP_LONGEST_TOKEN) == 0) return;
  hp_put(context, HP_HEADER(HP_TOKEN, which));
  /* The low bits in the words of the affine codes, then the rest. */
  for (uint32_t i = 0; i < HP_AFFINE_WORDS; ++i)
    hp_put(context,
           HP_TOKEN_REST != 0 && i + 1 == HP_AFFINE_WORDS ? value[i] & (((uint32_t)1 << HP_TOKEN_REST) - 1) : value[i]);
  for (uint32_t i = HALFPLANE_ALL_AFFINE_CODE_BITS / 32, n = 1 + HP_AFFINE_WORDS; n < HP_LONGEST_TOKEN; ++i, ++n) {
    const uint32_t low = i < 4 ? value[i] : 0, high = i < 3 ? value[i + 1] : 0;
    hp_put(context, HP_TOKEN_REST == 0 ? low : (low >> HP_TOKEN_REST) | (high << (32 - HP_TOKEN_REST) % 32));
  }
  context->slot[0] = context->slot[1] = context->slot[2] = HP_NO_TAG;
}

void hp_send_word(hp_context* context, uint32_t which, uint64_t value) {
  const uint32_t words[4] = {(uint32_t)value, (uint32_t)(value >> 32), 0, 0};
  hp_send_token(context, which, words);
}

#endif

/* ---- Commands */

uint8_t hp_put_command(hp_context* context, uint32_t header, uint32_t words, uint32_t first, uint32_t second) {
  if (hp_reserve(context, 1 + words) == 0) return 0;
  hp_put(context, header);
  if (words > 0) hp_put(context, first);
  if (words > 1) hp_put(context, second);
  hp_settle(context);
  return 1;
}

void hp_fence(hp_context* context, uint32_t tag) { (void)hp_put_command(context, HP_HEADER(HP_FENCE, 0), 1, tag, 0); }
void hp_wait_vblank(hp_context* context) { (void)hp_put_command(context, HP_HEADER(HP_WAIT_VBLANK, 0), 0, 0, 0); }
void hp_stop(hp_context* context) { (void)hp_put_command(context, HP_HEADER(HP_STOP, 0), 0, 0, 0); }
