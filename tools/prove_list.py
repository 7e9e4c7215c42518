"""What tools/prove.py proves: which property of which module, with which widths, and which faults must break it."""
import dataclasses


@dataclasses.dataclass(frozen=True)
class Proof:
    """One file of properties about one module."""
    name: str         # also the file in tests/formal, unless `file` is another
    letter: str       # a stepping, b shared edge, c reject and accept, d HiZ, e ranges, f ready/valid
    module: str       # in rtl_ref, or in tests/formal one that joins some of those
    claim: str
    twins: tuple      # faults that must break it: numbers of mutants.cmake, or (text, text instead) in the module
    presets: tuple = ('tiny', 'embedded')
    no_answer: tuple = ()   # presets left out of `presets`, unless --only names it: no answer in time
    quick: tuple = ()       # presets of --quick: proof and twins in under 5 s
    k: int = 1        # induction over so many cycles
    depth: int = 3    # cycles from reset without induction
    twin_depth: int = 6     # a twin has to fail in the step, or in so many
    twin_traces: bool = False  # never mind the step: it has to fail in a trace from reset
    parameters: tuple = ()  # of the module: (name, number or constant of the package)
    package: tuple = ()     # constants of the package that this proof sets otherwise: (name, number), or with presets behind
    cover_depth: int = 0    # cycles in which every cover statement is reached: what is assumed can happen
    cuts: tuple = ()        # cells whose results may be anything, by Yosys's patterns of their types
    is_combinational: bool = False
    is_bounded: bool = False  # no induction: `depth` cycles, from where it starts
    has_reset: bool = True
    file: str = ''
    starts: tuple = ()      # what holds at the start of a bounded proof: (module, file that is put into it)
    wires: tuple = ()       # names in the properties for what is inside a module of it: (name, name behind flattening)
    joins: tuple = ()       # modules whose text takes the place of their instance, so that properties can name what is inside
    members: tuple = ()     # of structs that the package lacks: (struct, type, name)
    inputs: str = ''        # other files in front of it: what is assumed of the inputs, or of what is cut

    @property
    def properties(self):
        file = self.file or self.name
        reset = ['reset'] if self.has_reset and not self.is_combinational else []
        return [*reset, *self.inputs.split(), file]


TINY = ('tiny',)
CLOCKS_2 = (('SETUP_PLANE_CLOCKS', 2),)
MULTIPLIERS = ('$mul',)
SRAMS = ('*sram*',)
OFFSETS = ('*edge_offset*',)
HIZ_6 = (('HIZ_BITS', 6), ('HIZ_CODE_BITS', 6))
STAMPS_4 = (('STAMPS_PER_ROW', 2), ('STAMP_INDEX_BITS', 2))
LAG_4 = (('HIZ_LAG', 4),)
HIZ_TWINS = (15, 16, 17, 62, 63, 64, ("(HIZ + 1)'(depth_min[Z-1-:HIZ]) + ", "(HIZ + 1)'(depth_min[Z-1-:HIZ]) + (HIZ + 1)'(1) + "),
             ("seen_q + (N + 1)'(LAG);", "seen_q + (N + 1)'(LAG - 1);"))
TILES = tuple((name, number, 'embedded') for name, number in
              (('CACHE_KIND', 0), ('CACHE_LINES', 16), ('LINE_X_BITS', 2), ('LINE_Y_BITS', 2)))
# The smallest blocks in which everything happens: two lines, two victims, four blocks of four stamps, codes of a bit.
BLOCKS = (('CACHE_KIND', 1), ('CACHE_LINES', 2), ('LINE_X_BITS', 1), ('LINE_Y_BITS', 0), ('CACHE_QUEUE', 4), ('CACHE_VICTIMS', 2),
          ('BLOCK_SIDE', 2), ('BLOCKS_PER_ROW', 1), ('STAMPS_PER_ROW', 2), ('STAMP_INDEX_BITS', 2), ('FLAG_WORD', 2),
          ('TILES_X', 2), ('TILES_Y', 2), ('TILE_X_BITS', 1), ('TILE_Y_BITS', 1), ('PRIMITIVE_ID_BITS', 1), ('COLOR_FORMAT', 1),
          ('DEPTH_CODE_BITS', 1), ('STORED_DEPTH_BITS', 1), ('VERTEX_COLOR_BITS', 1), ('STORED_COLOR_BITS', 1), ('WRITTEN_COLOR_BITS', 1), ('SHADED_COLOR_BITS', 1),
          ('ALL_CODE_BITS', 2), ('ALL_FRAGMENT_BITS', 2), ('MEMORY_LANE_BITS', 2),
          ('FRAGMENT_PACKET_BITS', 18, 'tiny'), ('FRAGMENT_PACKET_BITS', 27, 'embedded'))
# The same with two by two of them in a tile, and flags that outlive a flush.
BLOCKS_IN_TILES = (*BLOCKS, ('BLOCKS_PER_ROW', 2), ('STAMPS_PER_ROW', 4), ('STAMP_INDEX_BITS', 4), ('FRAME_CLEARS', 1),
                   ('FRAGMENT_PACKET_BITS', 20, 'tiny'), ('FRAGMENT_PACKET_BITS', 29, 'embedded'))
# The same with two bins beside each other, each a column of two blocks.
BINS_IN_WORDS = (*BLOCKS, ('LINE_X_BITS', 0), ('LINE_Y_BITS', 1), ('FRAME_CLEARS', 1))
# Blocks with blending, a sample a clock; a word of operations fits a depth code.
BLENDING = (*BLOCKS, ('BLEND_LANES', 1), ('DEPTH_CODE_BITS', 29), ('STORED_DEPTH_BITS', 29), ('ALL_CODE_BITS', 30), ('ALL_FRAGMENT_BITS', 30),
            ('MEMORY_LANE_BITS', 29), ('FRAGMENT_PACKET_BITS', 46, 'tiny'), ('FRAGMENT_PACKET_BITS', 139, 'embedded'))
COLOR_SOURCES = (('tag_result_t', 'depth_source_t', 'color_source'), ('block_order_t', 'logic', 'reads_color'))
TESTED_STATES = (('tested_stamp_t', 'depth_source_t', 'color_source'), ('tested_stamp_t', 'logic', 'sets_state'),
                 ('tested_stamp_t', 'logic [DEPTH_FUNC_BITS-1:0]', 'state_register'), ('tested_stamp_t', 'logic [31:0]', 'state'))
# What the properties of texture caches call the registers of texture_answers.
TEXTURE_ANSWERS = tuple((name, f'u_answers.{name}') for name in
                        ('fills_ready', 'fills_valid', 'request_valid_q', 'recovers_q', 'request_address_q', 'request_size_q', 'beat_q', 'unanswered_q'))
# Blocks whose depths have a stencil above them, without the other units of that preset; a word of its registers fits a code.
STENCIL = (*BLOCKS, ('ALPHA_UNIT', 0), ('BLEND_LANES', 0), ('DITHER_UNIT', 0), ('FOG_UNIT', 0), ('TEXTURE_UNIT', 0), ('COORDINATES', 0),
           ('DEPTH_CODE_BITS', 21), ('STORED_DEPTH_BITS', 29), ('ALL_CODE_BITS', 22), ('ALL_FRAGMENT_BITS', 22), ('MEMORY_LANE_BITS', 29),
           ('FRAGMENT_PACKET_BITS', 185))
# The same where nobody looks at such a word: a bit of depth, and one for the stencil.
STENCIL_BIT = (*STENCIL, ('DEPTH_CODE_BITS', 1), ('STORED_DEPTH_BITS', 2), ('ALL_CODE_BITS', 2), ('ALL_FRAGMENT_BITS', 2), ('MEMORY_LANE_BITS', 2),
               ('FRAGMENT_PACKET_BITS', 105))
# What the properties of blocks call the registers of color_write.
COLOR_WRITE = tuple((name, f'u_write.{inside}') for name, inside in
                    (('w_first_q', 'first_q'), ('w_first_line_q', 'first_line_q'), ('w_first_slot_q', 'first_slot_q'),
                     ('w_first_fills_q', 'first_fills_q'), ('w_second_q', 'second_q'), ('w_second_line_q', 'second_line_q'),
                     ('w_second_slot_q', 'second_slot_q'), ('w_second_fills_q', 'second_fills_q'), ('w_two_q', 'second_begun_q'),
                     ('w_moves_up', 'moves_up'), ('w_delay_q', 'delay_q'), ('w_next', 'next'), ('w_read_address', 'read_address'),
                     ('w_starts', 'starts'), ('w_reads', 'reads'), ('c_fills_q', 'fills_q'), ('w_slot_q', 'next_slot_q'),
                     ('w_started_q', 'started_q'), ('w_write_address', 'write_address'), ('w_ram_dirty', 'dirty'),
                     ('w_ram_writes', 'writes'), ('w_ram_dirty_new', 'dirty_new'), ('w_ram_code', 'code'),
                     ('w_ram_code_new', 'code_new'), ('w_busy', 'is_busy'), ('w_writes_q', 'gen_replaces.writes_q'),
                     ('w_write_mask_q', 'gen_replaces.write_mask_q')))
QUEUES = ('*cache_tags*', '*fifo*', '*skid_buffer*')
JOINED = ('depth_cache', 'write_back', 'memory_answers')

PROOFS = [
    Proof('edge_offset_step', 'a', 'lib/edge_offset.sv', 'value + x step_x + y step_y', is_combinational=True,
          parameters=(('WIDTH', 'SAMPLE_EDGE_BITS'), ('OFFSET', 'TILE_PIXEL_BITS')),
          twins=(("(moved & WIDTH'((1 << b) - 1))", "(moved & WIDTH'((1 << b) - 2))"),)),
    Proof('plane_offset_step', 'a', 'lib/plane_offset.sv', 'value + offset step, offset in two\'s complement',
          is_combinational=True, parameters=(('WIDTH', 'MAX_LOCAL_BITS'), ('OFFSET', 'TILE_PIXEL_BITS')),
          quick=TINY, twins=(("{value_i, 1'b1} + {digit, is_negative}", "{value_i, 1'b0} + {digit, is_negative}"),)),
    Proof('add_or_subtract_sum', 'a', 'lib/add_or_subtract.sv', 'a + b, or a - b', is_combinational=True,
          parameters=(('WIDTH', 'SAMPLE_EDGE_BITS'),), quick=TINY, twins=(('{a_i, subtracts_i}', '{a_i, 1\'b0}'),)),
    Proof('edge_columns_search', 'a', 'lib/edge_columns.sv', 'a search for the change of sign finds the sign in every column',
          is_combinational=True, parameters=(('WIDTH', 'SAMPLE_EDGE_BITS'), ('OFFSET', 'TILE_PIXEL_BITS')), quick=TINY,
          twins=(23, 400, ('.subtracts_i(from[WIDTH-1])', '.subtracts_i(!from[WIDTH-1])'))),
    Proof('fine_raster_rows', 'a, e', 'stages/fine_raster.sv', 'edge values of each row of stamps; no sum overflows',
          twins=(('value_q + (step_y <<< STAMP_SHIFT)', 'value_q + step_x'),
                 ('localparam int W = raster_pkg::SAMPLE_EDGE_BITS;', 'localparam int W = raster_pkg::SAMPLE_EDGE_BITS - 1;'))),
    Proof('fine_raster_samples', 'a, e', 'stages/fine_raster.sv', 'every sample is covered as the closed form says; no sum '
          'overflows', is_combinational=True, twins=(24, ('.step_x_i (step_x)', '.step_x_i (step_y)'),
          ('value_q + place_q[k*W+:W]', 'value_q + place_q[k*W+:W] + W\'(1)'))),
    Proof('coarse_raster_step', 'a', 'stages/coarse_raster.sv', 'edges and planes at each tile of the walk',
          cuts=SRAMS, twins=(('returns ? row_q', '1\'b0 ? row_q'), ('returned_q ? row_q', '1\'b0 ? row_q'), ('exits && !starts && !is_start_q', 'exits && !starts'),
          ('moved_start_q ? tile_x_q : start_x_q', 'start_x_q'), ('if (starts || goes_on) edge_is_outside', 'if (goes_on) edge_is_outside'), ("to_best  = (TE'(best) <<< TS) - TE'(best) +", "to_best  = (TE'(best) <<< TS) +"))),
    Proof('interpolate_step', 'a, e', 'stages/interpolate.sv', 'every plane at every sample; codes within the vertices\'',
          is_combinational=True, twins=(27, 29)),
    Proof('line_raster_step', 'a, e', 'stages/line_raster.sv', 'the row of pixel n is the quotient, the error its remainder',
          quick=TINY, twins=(40, 41, 42), cover_depth=6),
    Proof('line_raster_planes', 'a', 'stages/line_raster.sv', 'every plane of pixel n is first + n step', quick=TINY,
          twins=(44, 45)),
    Proof('cross_product_sum', 'e', 'lib/cross_product.sv', 'a d - b c - bias', has_reset=False, cuts=MULTIPLIERS,
          parameters=(('A_BITS', 'DELTA_BITS'), ('D_BITS', 'DELTA_BITS'), ('OUT_BITS', 'AREA_BITS')), quick=TINY,
          twins=((', !bias_q}', ', bias_q}'),)),
    Proof('cull_fill_rule', 'b', 'stages/cull.sv', 'top-left rule by its definition; one of an edge\'s two sides covers a sample',
          quick=TINY, twins=(1, 5), cuts=MULTIPLIERS),
    Proof('coarse_raster_reject', 'c, e', 'stages/coarse_raster.sv', 'outside, inside and the saturated value, wherever in '
          'the tile', is_combinational=True,
          cuts=SRAMS, quick=TINY, twins=(14, ('largest[V]', "largest[V] || largest == '0"),
                                                 ('!smallest[V]', "!smallest[V] || smallest == '1"))),
    Proof('coarse_raster_corners', 'c, e', 'stages/coarse_raster.sv', 'every sample lies between the corners that are looked at',
          is_combinational=True, cuts=SRAMS, twins=(("assign best  = (dx[D-1] ? '0", "assign best  = (!dx[D-1] ? '0"),)),
    Proof('hiz_bound', 'd', 'stages/hiz.sv', 'a verdict knows the visits up to n - lag, exactly; what could pass is not '
          'rejected', presets=('embedded',), cuts=SRAMS, inputs='hiz_visits', twins=HIZ_TWINS, cover_depth=6),
    Proof('hiz_bound_lag_4', 'd', 'stages/hiz.sv', 'the same with hiz.lag=4', file='hiz_bound',
          presets=('embedded',), cuts=SRAMS, inputs='hiz_visits', twins=HIZ_TWINS, package=LAG_4, cover_depth=6),
    Proof('hiz_bound_6_bits', 'd', 'stages/hiz.sv', 'the same with hiz.bits=6', file='hiz_bound',
          presets=('embedded',), cuts=SRAMS, inputs='hiz_visits', twins=HIZ_TWINS, package=HIZ_6, cover_depth=6),
    Proof('coarse_raster_hiz', 'd', 'stages/coarse_raster.sv', 'a tile is rejected by its own verdict, made when all was settled',
          presets=('embedded',), cuts=SRAMS, cover_depth=8, twins=(('is_settled && !(left_valid_q && is_visit);', 'is_settled;'),
          ('reads_next ? next_x : tile_x_q', 'tile_x_q'), ('(is_visit ? is_settled : left_q.ends_primitive)', '(is_visit || left_q.ends_primitive)'))),
    Proof('order_test_passes', 'd', 'lib/order_test.sv', 'a value passes as the order of the two says', is_combinational=True,
          parameters=(('WIDTH', 'DEPTH_CODE_BITS'),), quick=TINY, twins=(("other_i, 1'b1}", "other_i, 1'b0}"),
          ('equal_i ? less_i && greater_i :', 'equal_i ? less_i :'))),
    Proof('depth_test_hiz', 'd', 'stages/depth_test.sv', 'the bound of a visit is not below any depth of the tile', quick=TINY,
          twins=(34, ('assign max    = corner > max_q ? corner : max_q;', 'assign max    = corner;'))),
    Proof('depth_test_hiz_stencil', 'd', 'stages/depth_test.sv', 'the same with a stencil', file='depth_test_hiz',
          presets=('stencilled',), twins=(34,)),
    Proof('depth_test_stencil', 'd', 'stages/depth_test.sv', 'a word of depth and stencil keeps what a fragment does not change',
          presets=('stencilled',), quick=('stencilled',), is_combinational=True, twins=(210, 214, 215)),
    Proof('sram_word', 'd', 'lib/sram.sv', 'a read gives what was written last', has_reset=False,
          parameters=(('WIDTH', 'HIZ_CODE_BITS'), ('DEPTH', 8)),
          quick=TINY, twins=(('if (read_i) data_q <= memory_q[read_address_i];', 'data_q <= memory_q[read_address_i];'),)),
    Proof('masked_sram_word', 'd', 'lib/masked_sram.sv', 'a read gives what was written last, bit by bit', has_reset=False,
          parameters=(('WIDTH', 'FLAG_WORD'), ('DEPTH', 8)),
          quick=TINY, twins=(('if (write[i]) memory_q', 'memory_q'),)),
    Proof('masked_sram_word_bits', 'd', 'lib/masked_sram.sv', 'the same with a RAM for each bit', has_reset=False,
          file='masked_sram_word', parameters=(('WIDTH', 4), ('DEPTH', 4), ('HAS_MASK', 0)), presets=TINY, is_bounded=True, depth=6,
          twins=(('.write_i        (write_i[b])', ".write_i        (write_i != '0)"),)),
    Proof('sram_word_parts', 'd', 'lib/sram.sv', 'the same where it is two RAMs', has_reset=False, file='sram_word',
          parameters=(('WIDTH', 4), ('DEPTH', 18), ('WHOLE', 4)), presets=('embedded',),
          twins=(('is_high_q   <= read_address_i[ADDRESS-1];', 'is_high_q   <= write_address_i[ADDRESS-1];'),
                 ('if (write_i && !write_address_i[ADDRESS-1])', 'if (write_i)'))),
    Proof('cull_ranges', 'e', 'stages/cull.sv', 'no sum on the way to the edge functions overflows', cuts=MULTIPLIERS,
          quick=TINY, twins=(('localparam int B = C + 1;', 'localparam int B = C;'), 3, ('localparam int N = S + 3;', 'localparam int N = S + 2;'))),
    Proof('skid_buffer_stream', 'f', 'lib/skid_buffer.sv', 'a queue of two', k=2, cover_depth=5,
          parameters=(('WIDTH', 'STAMP_PACKET_BITS'),),
          quick=TINY,
          twins=(('assign ready_o = !tail_valid_q;', 'assign ready_o = 1\'b1;'), ('tail_valid_q ? tail_q : data_i', 'data_i'))),
    Proof('fifo_stream', 'f', 'lib/fifo.sv', 'a queue of DEPTH', k=2, cover_depth=8, quick=TINY,
          presets=TINY, parameters=(('WIDTH', 8), ('DEPTH', 4)),
          twins=(('tail_q ^ {1\'b1, {INDEX{1\'b0}}}', 'tail_q'), ('memory_q[head_q[INDEX-1:0]]', 'memory_q[\'0]'),
                 ('if (leaves)', 'if (ready_i)'), ('if (ready_o && writes)', 'if (writes)'))),
    Proof('fifo_ahead_stream', 'f', 'lib/fifo.sv', 'the same where a part of the item on offer stands in a register, and of the next '
          'item a part is given', k=2, cover_depth=8,
          quick=TINY, presets=TINY, parameters=(('WIDTH', 8), ('DEPTH', 4), ('AHEAD', 5), ('NEXT', 4)), file='fifo_stream',
          twins=(('!valid_o || tail_q == next ?', '!valid_o ?'), ('({waiting, item})', '({item[AHEAD-1:0], item})'))),
    Proof('sram_fifo_stream', 'f', 'lib/sram_fifo.sv', 'the same, an item there from the cycle behind the one that took it on', k=2,
          cover_depth=9, quick=TINY, presets=TINY, parameters=(('WIDTH', 8), ('DEPTH', 4)), cuts=SRAMS,
          twins=(('tail_q ^ {1\'b1, {INDEX{1\'b0}}}', 'tail_q'), ('(INDEX + 1)\'(leaves)', '(INDEX + 1)\'(ready_i)'))),
    Proof('sram_fifo_ahead_stream', 'f', 'lib/sram_fifo.sv', 'the same where the item taken stands in a register', k=2, cover_depth=9,
          quick=TINY, presets=TINY, parameters=(('WIDTH', 8), ('DEPTH', 4), ('AHEAD', 1)), cuts=SRAMS, file='sram_fifo_stream',
          twins=(('passes_q <= !valid_o || is_last;', 'passes_q <= !valid_o;'), ('!valid_o || ready_i', 'ready_i'))),
    Proof('registered_fifo_stream', 'f', 'lib/registered_fifo.sv', 'the same, the item on offer in a register', k=2, cover_depth=9,
          quick=TINY, presets=TINY, parameters=(('WIDTH', 8), ('DEPTH', 4)), cuts=('*fifo*',),
          twins=(402, ("used_q != USED'(DEPTH)", "used_q != '1"), ('if (is_free) offered_q', 'if (ready_i) offered_q'))),
    Proof('texture_levels_place', 'e', 'stages/texture_levels.sv', 'a level begins where the larger ones end, and its blocks lie '
          'below that', presets=TINY, parameters=(('TAIL', 2),), cover_depth=6,
          twins=(463, ("(21'h1ffffe << blocks)", "(21'h1fffff << blocks)"),
                 ("level > first_of_one_q", "level >= first_of_one_q"))),
    Proof('texture_levels_stream', 'f', 'stages/texture_levels.sv', 'one pass a sample or two, the first and the second, in order',
          presets=TINY, parameters=(('TAIL', 2),), k=2, cover_depth=6,
          twins=(('has_second && !is_second_q : is_second_q', 'has_second : is_second_q'),
                 ('scales && (!has_second || is_second_q)', 'scales'), ('(!wrapped_valid_q || ready_i)', "1'b1"))),
    Proof('texture_rounds_stream', 'f', 'stages/texture_rounds.sv', 'one round a group or two, the second of those that waited, in order',
          presets=TINY, parameters=(('TAIL', 2),), k=2, cover_depth=8,
          twins=(("(live_i & has_upper) != '0 && !is_second_q", "(live_i & has_upper) != '0"),
                 ('scales && !turns', 'scales'), ('is_second_q ? live_i & has_upper : live_i', 'live_i'),
                 ('(!agreed_valid_q || ready_i)', "1'b1"))),
    Proof('texture_blend_stream', 'f', 'lib/texture_blend.sv', 'the first of two levels waits for the second, which leaves once',
          presets=TINY, parameters=(('TAIL', 2),), k=2, cover_depth=6, cuts=MULTIPLIERS,
          twins=(('if (!is_second_i) lower_q', 'lower_q'), ('!valid_q || is_first_q || ready_i', "1'b1"),
                 ('if (valid_i && ready_o && takes_i) begin', 'if (ready_o) begin'))),
    Proof('texture_cache_data', 'd, f', 'stages/texture_cache.sv', 'a texel is what memory holds there, in its turn; no deadlock',
          presets=TINY, parameters=(('LINES', 2), ('IN_FLIGHT', 4), ('TAIL', 5)), k=2, cuts=(*SRAMS, '*fifo*'), wires=TEXTURE_ANSWERS,
          cover_depth=16,
          twins=(256, ("{1'b1, t_address_q}", "{1'b1, tag[27:10], t_address_q[9:0]}"), ('(!is_miss || has_come)', "1'b1"),
                 ('{fill_line, fill_place}', '{fill_line, ~fill_place}'), ("drop_i || (sweeps_q && sweep_q != '1)", "sweeps_q && sweep_q != '1"),
                 ('may_ask && !is_occupied', 'may_ask'), ('t_goes && line_i == t_line_q', "1'b0"), ('same_line_q  <= address_i == t_address_q', "same_line_q  <= 1'b1"),
                 ('sweeps_q ? last_group : group}', "sweeps_q ? group - NUMBER'(64) : group}"),
                 ('same_line_q || may_take_any', 'same_line_q || may_take'), ('{!may_ask, tag_group}', "{1'b0, tag_group}"), ("{!may_ask, group}", "{1'b0, group}"))),
    Proof('colors_over_w_range', 'e', 'stages/colors_over_w.sv', 'the nearest code to the quotient, held to the range of the vertices',
          presets=TINY, parameters=(('CHANNELS', 1),), has_reset=False, quick=TINY, cover_depth=6, cuts=MULTIPLIERS,
          twins=(280, ("code_q < $signed(WHOLE'(least[n*8+:8]))", "1'b0"),
                 ("code_q > $signed(WHOLE'(greatest[n*8+:8]))", "1'b0"))),
    Proof('line_raster_stream', 'f', 'stages/line_raster.sv', 'remaining + 1 pixels a line, in order, stable', k=2, cover_depth=7,
          quick=TINY, twins=(43, 46)),
    Proof('primitive_join_stream', 'f', 'stages/primitive_join.sv', 'each pixel is one fragment, each other fragment as it was',
          quick=TINY, twins=(48, 50, ('{{TS{1\'b0}}, y} >> SS', '{{TS{1\'b0}}, x} >> SS')), is_combinational=True),
    Proof('fine_raster_stream', 'f', 'stages/fine_raster.sv', 'each covered stamp of a tile once, in order, and one end', k=2,
          cuts=OFFSETS, twins=(25, 26), cover_depth=6),
    Proof('interpolate_stream', 'f', 'stages/interpolate.sv', 'each stamp gets through, with its context, to a place of its own', k=2,
          cuts=(*OFFSETS, '*plane_offset*', '*fifo*'), twins=(28, ('x_valid_q       <= context_valid_q', 'x_valid_q       <= takes')), cover_depth=12),
    Proof('depth_test_stream', 'f', 'stages/depth_test.sv', 'an access, a write and a retirement for each that needs one', k=2,
          quick=TINY, package=TILES, twins=(31, ('valid_q <= takes_fragment', 'valid_q <= fragment_valid_i')), cover_depth=5),
    Proof('coarse_raster_stream', 'f', 'stages/coarse_raster.sv', 'each primitive ends once; no slot is given twice', k=2, cuts=SRAMS, twins=(22, ('left_is_free) left_valid_q <= enters;', 'enters || tile_taken) left_valid_q <= enters;'),
          ('is_outside ? ends_walk && left_is_free :', 'is_outside ? ends_walk :')), cover_depth=7),
    Proof('triangle_setup_stream', 'f', 'stages/triangle_setup.sv', 'each triangle leaves once, in its turn; an answer in time',
          k=2, cuts=(*MULTIPLIERS, '$sshr'), inputs='triangle_setup_parts', cover_depth=34,
          twins=(('at_q[i*STEPS+STEPS-1] && ready_q[i+1]', 'at_q[i*STEPS+STEPS-1]'),
                 ('assign setup_valid_o    = at_q[OFFER];', 'assign setup_valid_o    = at_q[OFFER] || at_q[OFFER-1];'))),
    Proof('triangle_setup_chains', 'f', 'stages/triangle_setup.sv', 'with it all that was found out about it', k=2,
          cuts=(*MULTIPLIERS, '$sshr'), inputs='triangle_setup_parts',
          twins=(('flows[i] = moves[i+:STEPS]', 'flows[i] = at_q[i+:STEPS]'),
                 ('if (moves[ROUND-1]) quotient_q', 'if (flows[ROUND]) quotient_q'))),
    Proof('triangle_setup_stream_2_clocks', 'f', 'stages/triangle_setup.sv', 'the same with two cycles a plane', k=2,
          cuts=(*MULTIPLIERS, '$sshr'), inputs='triangle_setup_parts', file='triangle_setup_stream', package=CLOCKS_2, cover_depth=60,
          twins=(('at_q[i*STEPS+STEPS-1] && ready_q[i+1]', 'at_q[i*STEPS+STEPS-1]'),)),
    Proof('triangle_setup_chains_2_clocks', 'f', 'stages/triangle_setup.sv', 'the same with two cycles a plane', k=2,
          cuts=(*MULTIPLIERS, '$sshr'), inputs='triangle_setup_parts', file='triangle_setup_chains', package=CLOCKS_2,
          twins=(473, ('if (moves[ROUND-1]) quotient_q', 'if (flows[ROUND]) quotient_q'),
                 ('if (moves[RANGED]) ranges_q', 'if (at_q[RANGED+1]) ranges_q'))),
    Proof('framebuffer_data', 'd, f', 'stages/framebuffer.sv', 'an access reads what was written last, or cleared; after a flush '
          'memory holds it', cuts=SRAMS, inputs='framebuffer_inputs', package=TILES, twins=(37, 38, 55, 121, 122, 123, 125)),
    Proof('framebuffer_data_4_stamps', 'd, f', 'stages/framebuffer.sv', 'the same with 4 stamps a tile: what is claimed happens',
          cuts=SRAMS, inputs='framebuffer_inputs', twins=(37, 38, 127), file='framebuffer_data', presets=('tiny',), package=STAMPS_4,
          cover_depth=40, twin_depth=30, twin_traces=True),
    Proof('framebuffer_stream', 'f', 'stages/framebuffer.sv', 'requests in order, stable; no deadlock when memory answers',
          cuts=SRAMS, inputs='framebuffer_inputs', package=TILES, k=2,
          quick=TINY,
          twins=(("runs && left != '0 && is_free", "runs && left != '0 && request_ready_i"),
                 ('offers_q <= steps || !is_free;', 'offers_q <= steps;'),
                 ('(state_q == EVICT && ends_plane && !plane_q)', '1\'b0'))),
    Proof('framebuffer_stream_4_stamps', 'f', 'stages/framebuffer.sv', 'the same with 4 stamps a tile: what is claimed happens',
          cuts=SRAMS, inputs='framebuffer_inputs', file='framebuffer_stream', presets=('tiny',), package=STAMPS_4, k=2,
          cover_depth=30, twins=(('(state_q == EVICT && ends_plane && !plane_q)', '1\'b0'),), twin_depth=30, twin_traces=True),
    Proof('clear_flags_data', 'd', 'stages/clear_flags.sv', 'of any block: its flags are what tokens have written, less what has '
          'fallen', cuts=SRAMS, package=BLOCKS, quick=TINY, cover_depth=8,
          twins=(71, ('is_busy_o = reads_q', 'is_busy_o = 1\'b0'), ('writes_q && write_address == read_address', '1\'b0'),
                 ('line_x_i == read_x_i && line_y_i == read_y_i', '1\'b0'), ('reads_q && reads_x_q == read_x_i && reads_y_q == read_y_i', '1\'b0'),
                 ('if (reads_q) read_address', 'if (1\'b0) read_address'))),
    Proof('cache_tags_data', 'd, f', 'stages/cache_tags.sv', 'of any block: where its depth is, what leaves, what is ordered and '
          'flagged is as specified', cuts=(*SRAMS, '*clear_flags*'), inputs='cache_tags_inputs', package=BLOCKS, cover_depth=32,
          twins=(70, 72, 73, 75, 91, 92, 93, 94, 95, 220, 221, 222, 223)),
    Proof('cache_tags_bins', 'd, f', 'stages/cache_tags.sv', 'the same where bins share words of flags: a clear of one leaves the others as '
          'they are', cuts=(*SRAMS, '*clear_flags*'), inputs='cache_tags_inputs cache_tags_data', package=BINS_IN_WORDS, cover_depth=32,
          presets=('embedded',), twins=(404, 405, 406)),
    Proof('cache_tags_data_in_tiles', 'd, f', 'stages/cache_tags.sv', 'the same with blocks in tiles, and frame.clears=flags',
          cuts=(*SRAMS, '*clear_flags*'), inputs='cache_tags_inputs', package=BLOCKS_IN_TILES, file='cache_tags_data', presets=('embedded',),
          quick=('embedded',), twins=(70, 74, 75)),
    Proof('cache_tags_color', 'd, f', 'stages/cache_tags.sv', 'with blending: colours are known only if they are on the chip, and '
          'are asked for where they are not', cuts=(*SRAMS, '*clear_flags*'), inputs='cache_tags_inputs cache_tags_data', package=BLENDING, members=COLOR_SOURCES,
          presets=TINY, quick=TINY, twins=(196, 197, ("color_known | (color_source != raster_pkg::DEPTH_SOURCE_NONE ? stamp_bit : '0)",
                                          'color_known | stamp_bit'))),
    Proof('cache_tags_stencil', 'd, f', 'stages/cache_tags.sv', 'with a stencil: a word of which a draw keeps a part is asked for, one that it '
          'replaces is not; a clear has the value of the front', cuts=(*SRAMS, '*clear_flags*'), inputs='cache_tags_inputs cache_tags_data',
          package=STENCIL, cover_depth=32, presets=('stencilled',), twins=(216, 217, 322, 323,
          ('replaces_q[fragment_q.state.is_back]', 'replaces_q[0]'))),
    Proof('color_write_data', 'd, f', 'stages/color_write.sv', 'with blending: a stamp reads what those before it have written; an '
          'eviction takes along what was there; no deadlock', cuts=(*SRAMS, '*blend_lane*', '*rop*'), package=BLENDING, members=TESTED_STATES,
          presets=('embedded',), quick=('embedded',), cover_depth=9,
          twins=(190, 191, 192, 262, 300, ('writes_all && is_first', 'writes_all'), ('is_newer[1] && !is_newer[0]', 'is_newer[1]'),
                 ('dirty_3_q[s], dirty_2_q[s]}', "dirty_3_q[s], 1'b0}"))),
    Proof('cache_tags_stream', 'f', 'stages/cache_tags.sv', 'each fragment leaves once, in its turn; no deadlock', k=2,
          cuts=(*SRAMS, '*clear_flags*'), inputs='cache_tags_inputs', package=BLOCKS, cover_depth=24,
          twins=(('is_settled && is_item && order_ready_i', 'is_settled && is_item'), ('if (moves) valid_q <= read_valid_q;', 'valid_q <= read_valid_q;'),
                 ('RESOLVE && (!bits_q[0] || ends_block)) bits_q', 'RESOLVE && ends_block) bits_q'))),
    Proof('block_cache_data', 'd, f', '../tests/formal/blocks.sv', 'the test sees what was written last, up to the clock before; an '
          'eviction takes it to memory, once', cuts=(*SRAMS, *QUEUES), joins=JOINED, inputs='block_cache_inputs block_cache_parts', package=BLOCKS,
          wires=COLOR_WRITE, cover_depth=22,
          twins=(76, ("x1_q.line == found.line && x1_writes_q;", "1'b0;"), ('on_chip && !is_forwarded', 'on_chip'), 77, 78, 79, 80, 261, 263, 264)),
    Proof('block_cache_stencil', 'd, f', '../tests/formal/blocks.sv', 'the same where a stencil is above the depth, and changes without it',
          cuts=(*SRAMS, *QUEUES), joins=JOINED, inputs='block_cache_inputs block_cache_parts', file='block_cache_data', package=STENCIL_BIT,
          wires=COLOR_WRITE, presets=('stencilled',), cover_depth=22,
          twins=(76, 78, 218, ('on_chip && !is_forwarded', 'on_chip'))),
    Proof('block_cache_stream', 'f', '../tests/formal/blocks.sv', 'requests stable; no read overtakes its eviction\'s write; no deadlock',
          k=2, cuts=(*SRAMS, *QUEUES), joins=JOINED, inputs='block_cache_inputs block_cache_parts', package=BLOCKS, wires=COLOR_WRITE, cover_depth=22,
          twins=(("'0 && color_ready_q != '0", "'0"), ('order_valid && written_q == order.writes;', 'order_valid && !sends && order.reads;'))),
    Proof('block_cache_whole', 'd, f', '../tests/formal/blocks.sv', 'tags and all: the test sees what was written last, or cleared',
          is_bounded=True, depth=10, starts=(('lib/sram.sv', 'block_cache_start'),), joins=JOINED, inputs='block_cache_inputs', package=BLOCKS,
          presets=TINY, cover_depth=9, twins=(70, 73, 76), twin_depth=10),
    Proof('block_cache_whole_flags', 'd, f', '../tests/formal/blocks.sv', 'the same where everything is flagged, frame.clears=flags',
          is_bounded=True, depth=10, starts=(('lib/sram.sv', 'block_cache_start'),), joins=JOINED, inputs='block_cache_inputs',
          file='block_cache_whole', package=(*BLOCKS, ('FRAME_CLEARS', 1)), presets=TINY, twins=(70, 73, 76), twin_depth=10),
    Proof('memory_port_stream', 'f', 'stages/memory_port.sv', 'bursts as long as they say; each answer counted; a reset leaves '
          'nothing stale; no deadlock', has_reset=False, inputs='memory_port_inputs', k=2, cover_depth=9,
          twins=(104, 105, 106, 107, ("recovers_q <= !rst_ni ||", "recovers_q <= rst_ni &&"), ("length_q   <= length_q - 1'b1;", ''))),
    Proof('memory_port_data', 'f', 'stages/memory_port.sv', 'each byte of a stamp goes out once, to its address; what is read is what '
          'memory answered', has_reset=False, inputs='memory_port_inputs memory_port_stream', k=2, cover_depth=9,
          twins=(102, ("color_offset = PLANE'(place) << COLOR_SHIFT;", "color_offset = PLANE'(place);"))),
    Proof('cull_stream', 'f', 'stages/cull.sv', 'each primitive is offered or dropped once, in its turn', cover_depth=14, k=2,
          cuts=MULTIPLIERS, twins=(('&& (triangle_ready_i || is_dropped)', ''),)),
]
