# Copies of modules with faults that the tests of rtl_units must find. A script:
#
#   cmake -DSOURCE=rtl_ref "-DTEXTURE=stages/texture_unit.sv;..." -DFOLDER=DIR -P faults.cmake
#
# writes into FOLDER the modules TEXTURE with faults, lib/reciprocal_*.sv, and texture_faults.hpp: the number of the
# last fault of each kind. A file whose text stays is not written again.
cmake_policy(VERSION 3.25)
include("${CMAKE_CURRENT_LIST_DIR}/../../cmake/ReplaceOnce.cmake")

# reciprocal_fault(name number [[good]] [[bad]]): module NAME_fault_NUMBER, in which `good`, once, is `bad`
function(reciprocal_fault name number good bad)
  set(path "${SOURCE}/lib/${name}.sv")
  file(READ "${path}" text)
  replace_once(text "${path}" "${good}" "${bad}")
  string(REPLACE "module ${name} " "module ${name}_fault_${number} " text "${text}")
  file(CONFIGURE OUTPUT "${FOLDER}/${name}_fault_${number}.sv" CONTENT "${text}" @ONLY)
endfunction()
# The table's half, its slope, its correction; the division's comparison, its first remainder, its divisor.
reciprocal_fault(reciprocal_table 0 [=[+ 64'd1), DROP']=] [=[), DROP']=])
reciprocal_fault(reciprocal_table 1 [=[node(64'(n) + 64'd1)]=] [=[node(64'(n) + 64'd1) - 64'd1]=])
reciprocal_fault(reciprocal_table 2 [=[<= !product[CHECK-1]]=] [=[<= product[CHECK-2]]=])
reciprocal_fault(reciprocal_restoring 0 [=[quotient_q[BITS-2:0], !trial[BITS+1]]=] [=[quotient_q[BITS-2:0], !trial[BITS]]=])
reciprocal_fault(reciprocal_restoring 1 [=[{1'b0, ~mantissa_i, 1'b1}]=] [=[{1'b0, ~mantissa_i, 1'b0}]=])
reciprocal_fault(reciprocal_restoring 2 [=[{2'b01, mantissa_q, 1'b1}]=] [=[{2'b01, mantissa_q, 1'b0}]=])

# The row of subtractions: its comparison, its first remainder, a bit that the last clock leaves out.
reciprocal_fault(reciprocal_division 0 [=[bits_d[BITS-3:0], !trial[BITS+1]]=] [=[bits_d[BITS-3:0], !trial[BITS]]=])
reciprocal_fault(reciprocal_division 1 [=[{1'b0, ~mantissa_i, 1'b1}]=] [=[{1'b0, ~mantissa_i, 1'b0}]=])
reciprocal_fault(reciprocal_division 2 [=[{2'b01, mantissa, 1'b1}]=] [=[{2'b01, mantissa, 1'b0}]=])

# texture_fault(name number [[good]] [[bad]]): a copy of the module in which `good`, once, is `bad` while the bench's fault_i is
# NUMBER. All faults are in one unit, so that there is one more to compile and not one for each.
foreach(path IN LISTS TEXTURE)
  cmake_path(GET path STEM name)
  list(APPEND texture_names ${name})
  file(READ "${SOURCE}/${path}" texture_text_${name})
endforeach()
set(texture_faults 0)
function(texture_fault name number good bad)
  set(text "${texture_text_${name}}")
  replace_once(text "${name}.sv" "${good}" "((texture_unit_bench.fault_i == 7'd${number}) ? (${bad}) : (${good}))")
  set(texture_text_${name} "${text}" PARENT_SCOPE)
  set(texture_faults ${number} PARENT_SCOPE)
endfunction()
# Coordinate: rounding of P, rounding of the result, mirror, clamp.
texture_fault(over_w_narrow 1 [=[(NARROW + 1)'(shifted_q[0])]=] [=[(NARROW + 1)'(1'b0)]=])
texture_fault(texture_axis 2 [=[&placed[FRACTION:0]]=] [=[&placed[FRACTION:1]]=])
texture_fault(texture_wrap 3 [=[is_mirrored && turn != '0]=] [=[1'b0]=])
texture_fault(texture_wrap 4 [=[number_i[NUMBER_BITS-2:SIDE_BITS] != '0 || beyond != '0]=] [=[beyond != '0]=])
# Cache: tag, line's place, a sample ahead of its line, a word's place, invalidation, a stale answer, a place that is still
# read, two samples of one place, its last sample after an invalidation.
texture_fault(texture_cache 5 [=[{1'b1, t_address_q}]=] [=[{1'b1, tag[27:10], t_address_q[9:0]}]=])
texture_fault(texture_cache 6 [=[{line, offset[5:WORD]}]=] [=[{line[LINE-1:1], 1'b0, offset[5:WORD]}]=])
texture_fault(texture_cache 7 [=[(!is_miss || has_come)]=] [=[1'b1]=])
texture_fault(texture_cache 8 [=[{fill_line, fill_place}]=] [=[{fill_line, ~fill_place}]=])
texture_fault(texture_cache 9 [=[drop_i || (sweeps_q && sweep_q != '1)]=] [=[sweeps_q && sweep_q != '1]=])
texture_fault(texture_answers 10 [=[answer_valid_i && !discards]=] [=[answer_valid_i && rst_ni]=])
texture_fault(texture_cache 11 [=[may_ask && !is_occupied]=] [=[may_ask]=])
texture_fault(texture_cache 12 [=[t_goes && line_i == t_line_q]=] [=[1'b0]=])
texture_fault(texture_cache 13 [=[sweeps_q ? last_group : group]=] [=[sweeps_q ? group - NUMBER'(64) : group]=])
# Colour: saturation, a channel's bits.
texture_fault(texture_combine 14 [=[{8{sum[8]}}]=] [=[8'd0]=])
texture_fault(texture_decode 15 [=[{code_i[5:1], code_i[5:3]}]=] [=[{code_i[5:1], code_i[3:1]}]=])
# Unit: the triangle's frame, a stamp that lets samples pass, the row of blocks.
texture_fault(texture_unit 16 [=[INDEX'(splits && is_last)]=] [=[INDEX'(splits)]=])
texture_fault(texture_unit 17 [=[!stamp_is_textured && !stamp_divides && is_free]=] [=[!stamp_is_textured && !stamp_divides && is_free && !texel_valid]=])
texture_fault(texture_nearest 18 [=[(22'(block_y) << row_i)]=] [=[(22'(block_y) << (row_i - 4'(row_i >= 4'd10)))]=])
set(texture_nearest_faults ${texture_faults})
# Linear filter: half a texel, the part's rounding, the sum's, columns of the banks, lines that have come, a word's place, a
# place that is still read, two samples of one place, a line asked for twice.
texture_fault(texture_axis 19 [=[number - REFERENCE_BITS'(is_linear_i && !part[7])]=] [=[number]=])
texture_fault(texture_axis 20 [=[placed[FRACTION:1] + FRACTION'(placed[0])]=] [=[placed[FRACTION:1]]=])
texture_fault(texture_filter 21 [=[24'h008000]=] [=[24'h007000]=])
texture_fault(texture_cache_linear 22 [=[{x_i[1+:WAY_X], x_i[SIDE_BITS+1+:WAY_X]}]=] [=[{x_i[SIDE_BITS+1+:WAY_X], x_i[1+:WAY_X]}]=])
texture_fault(texture_tags 23 [=[come_q >= COME'(waits_for)]=] [=[come_q != '0 || waits_for == '0]=])
texture_fault(texture_cache_linear 24 [=[{fill_line, row, pair}]=] [=[{fill_line, row, 1'b0}]=])
texture_fault(texture_tags 25 [=[(asks & referenced) != '0]=] [=[1'b0]=])
texture_fault(texture_tags 26 [=[t_goes && t_used_q[b] && place == t_place_q[b*BANK+:BANK]]=] [=[1'b0]=])
texture_fault(texture_tags 27 [=[asked_q | (asks & {4{any_asks}})]=] [=[asked_q]=])
set(texture_linear_faults ${texture_faults})
# Levels: the bow and the ends of the logarithm, the octagon's half and its eighth, the other of two slopes, which filter a
# magnified sample has, the nearest level's rounding, the least level, rounding on a level, a size that is not halved any more,
# where a level begins, the level of one texel, the second pass, its weight, rounding of the blend, a level in the other's
# half, lines that come while samples wait.
texture_fault(log2_below 28 [=[below_i + 8'(bow_rom[from_end])]=] [=[below_i]=])
texture_fault(level_of_detail 29 [=[lines_q[128+32*(n%2)+:32]]=] [=[lines_q[128+:32]]=])
texture_fault(level_of_detail 30 [=[33'(high[31:3])]=] [=[33'd0]=])
texture_fault(level_of_detail 31 [=[!more[32]]=] [=[1'b1]=])
texture_fault(level_of_detail 32 [=[(value_q[AT+:32] ^ {32{sign}}) + 32'(sign)]=] [=[value_q[AT+:32]]=])
texture_fault(level_of_detail 33 [=[LOD'({exponent_i[5*k+:5], q_below, 1'b0})]=] [=[LOD'({exponent_i[5*k+:5], 9'd0})]=])
texture_fault(level_of_detail 34 [=[{1'b0, level_q} + 13'd127]=] [=[{1'b0, level_q} + 13'd128]=])
texture_fault(level_of_detail 35 [=[12'd128]=] [=[12'd0]=])
texture_fault(level_of_detail 36 [=[is_low ? least_q : is_high ? largest_q : lambda_q[11:0]]=] [=[is_high ? largest_q : lambda_q[11:0]]=])
texture_fault(level_of_detail 37 [=[LOD'($signed(offset_q))]=] [=[LOD'(offset_q)]=])
texture_fault(texture_on_level 38 [=[PLACE'(is_linear_q && scaled_q[0])]=] [=[PLACE'(1'b0)]=])
texture_fault(texture_on_level 39 [=[level_i < log2_size_i ? level_i : log2_size_i]=] [=[level_i]=])
texture_fault(texture_levels 40 [=[(ones_q & (21'h1ffffe << blocks))]=] [=[(ones_q & (21'h1fffff << blocks))]=])
texture_fault(texture_sides 41 [=[(21'h155555 << new_odds)]=] [=[21'h155555]=])
texture_fault(texture_levels 42 [=[level == first_of_one_q + 4'd2]=] [=[1'b0]=])
texture_fault(texture_levels 43 [=[level_i + 4'(is_second_q)]=] [=[level_i]=])
texture_fault(texture_levels 44 [=[part_i != '0]=] [=[part_i > 8'd1]=])
texture_fault(texture_levels 45 [=[less(wide_q, level)]=] [=[wide_q]=])
texture_fault(texture_blend 46 [=[sum_i[24*n+8+:16] + 16'(sum_i[24*n+7])]=] [=[sum_i[24*n+8+:16]]=])
texture_fault(texture_blend 47 [=[is_between_i ? {rounded, 8'd0} : sum_i[24*n+:24]]=] [=[sum_i[24*n+:24]]=])
texture_fault(texture_blend 48 [=[!valid_q || is_first_q || ready_i]=] [=[!valid_q || ready_i]=])
texture_fault(texture_tags 49 [=[(HALF_OF_BANK & {BANK_Y{shares_i && is_odd_i}})]=] [=[HALF_OF_BANK & {BANK_Y{shares_i}}]=])
texture_fault(texture_unit 50 [=[PIXEL'(group) >> ROW]=] [=[PIXEL'(group)]=])
texture_fault(texture_unit 51 [=[waits && waiting_token[2]]=] [=[waits && waiting_token[2] && tags_are_empty]=])
texture_fault(texture_blend 52 [=[product[23:0]]=] [=[{product[23:12], 12'd0}]=])
set(texture_levels_faults ${texture_faults})
# Colours over w: rounding, both ends of the range, the binary point and the reach of one channel, another triangle's range, the
# affine colour after a texel, a quotient that stays, P beyond its bits, beyond the largest shift.
texture_fault(colors_over_w 53 [=[WHOLE'(placed[POINT-1])]=] [=[WHOLE'(1'b0)]=])
texture_fault(colors_over_w 54 [=[code_q < $signed(WHOLE'(least[n*8+:8]))]=] [=[1'b0]=])
texture_fault(colors_over_w 55 [=[code_q > $signed(WHOLE'(greatest[n*8+:8]))]=] [=[1'b0]=])
texture_fault(colors_over_w 56 [=[shift[n*SHIFT_BITS+:SHIFT_BITS]]=] [=[shift[0+:SHIFT_BITS]]=])
texture_fault(colors_over_w 57 [=[reach[n*REACH_BITS+:REACH_BITS]]=] [=[reach[0+:REACH_BITS]]=])
texture_fault(colors_over_w 58 [=[range_ram_q[index_q[6*INDEX+:INDEX]]]=] [=[range_ram_q[index_q[5*INDEX+:INDEX]]]=])
texture_fault(texture_unit 59 [=[stamp_divides ? divided : own_color_q]=] [=[own_color_q]=])
texture_fault(texture_unit 60 [=[(e_moves && stamp_divides && e_ends_q)]=] [=[(e_moves && stamp_divides && e_ends_q && !e_last_q)]=])
texture_fault(over_w_narrow 61 [=[lost_16 || lost_4 || lost_1]=] [=[lost_4 || lost_1]=])
texture_fault(colors_over_w 62 [=[{6{!amount[7]}}]=] [=[{6{1'b1}}]=])
set(texture_colors_faults ${texture_faults})
# Lanes: two texels in one bank, two lines in one, who is compared with whom, who has been, a sample that has its lines beside
# one that has not, whose blocks count, where half a row of a line lies, a state while a pass is in front of the tags, a
# quotient or a stamp that goes with the first pass, whose colours a pass brings, a row of the other parity, samples that do
# not live.
texture_fault(texture_agree 63 [=[a[1:0] != b[1:0]]=] [=[1'b1]=])
texture_fault(texture_agree 64 [=[a[2] != b[2]]=] [=[1'b1]=])
texture_fault(texture_lanes 65 [=[!joins[first]]=] [=[!left[first]]=])
texture_fault(texture_lanes 66 [=[done_q | joins]=] [=[joins]=])
texture_fault(texture_lanes 67 [=[(t_uses[4*l+:4] & lacks) == '0]=] [=[lacks == '0]=])
texture_fault(texture_lanes 68 [=[joins[lane] && odd_texel[lane*ENDS*2+n] == 1'(bank)]=] [=[odd_texel[lane*ENDS*2+n] == 1'(bank)]=])
texture_fault(texture_lanes 69 [=[3'(2 * y + x / 2)]=] [=[3'(2 * y)]=])
texture_fault(texture_lanes 70 [=[tags_are_empty && !p_valid_q]=] [=[tags_are_empty]=])
texture_fault(texture_unit 71 [=[e_moves && e_last_q && e_ends_q]=] [=[e_moves && e_last_q]=])
texture_fault(texture_unit 72 [=[e_lanes_q[i%LANES]]=] [=[1'b1]=])
texture_fault(texture_lanes 73 [=[first[2] ? first[3] : second[3]]=] [=[first[3]]=])
texture_fault(texture_unit 74 [=[waiting_mask[i*LANES+:LANES] & {LANES{group == GROUP'(i)}}]=] [=[{LANES{group == GROUP'(i)}}]=])
# Two ways: the older way of a set one clock after its newer line, which way was newer, the newer line of each way, a line
# in both, a line that is still to be read in the other way, the way of a texel.
texture_fault(texture_tags 75 [=[same_place_q ? !recent_way_q : !newer]=] [=[!newer]=])
texture_fault(texture_tags 76 [=[way[b] && !sweeps_q]=] [=[1'b0]=])
texture_fault(texture_tags 77 [=[same_place_q && recent_way == 1'(w)]=] [=[same_place_q]=])
texture_fault(texture_tags 78 [=[way[b] == 1'(w)]=] [=[1'b1]=])
texture_fault(texture_tags 79 [=[groups[way[b]*NUMBER+:NUMBER]]=] [=[groups[0+:NUMBER]]=])
texture_fault(texture_lanes 80 [=[found_ways[{odd_at[4+y], odd_at[x]}]]=] [=[found_ways[0]]=])
set(texture_ways_faults ${texture_faults})
# Lanes with levels: the level of the second round, who takes part in it, samples of two levels in a pass, whose level has a
# part, a round of samples that do not live, where a level begins, whose level a pass has; whose weight the upper level has, a
# sum that waits and another's, a pass of which some leave, what waits and leaves, a stamp that goes with the first round, an
# odd level's half, samples lacked below; rows and columns of 2x2, squares of a stamp, a state while a round is under
# way.
texture_fault(texture_rounds 81 [=[level_i[4*l+:4] + 4'(is_second_q)]=] [=[level_i[4*l+:4]]=])
texture_fault(texture_rounds 82 [=[is_second_q ? live_i & has_upper : live_i]=] [=[live_i]=])
texture_fault(texture_rounds 83 [=[wrapped_level_q[4*l+:4] == wrapped_level_q[4*m+:4]]=] [=[1'b1]=])
texture_fault(texture_rounds 84 [=[part_i[8*l+:8] != '0]=] [=[part_i[7:0] != '0]=])
texture_fault(texture_rounds 85 [=[(live_i & has_upper) != '0 && !is_second_q]=] [=[has_upper != '0 && !is_second_q]=])
texture_fault(texture_rounds 86 [=[(ones & (21'h1ffffe << blocks))]=] [=[(ones & (21'h1fffff << blocks))]=])
texture_fault(texture_rounds 87 [=[(first_i[0] ? place_q[3*LEVEL+:LEVEL] : place_q[2*LEVEL+:LEVEL])]=] [=[place_q[0+:LEVEL]]=])
texture_fault(texture_lanes 88 [=[sum_level_part[8*l+:8]]=] [=[sum_level_part[7:0]]=])
texture_fault(texture_lanes 89 [=[sum_joins[l]]=] [=[1'b1]=])
texture_fault(texture_lanes 90 [=[sum_leaves == '0]=] [=[!sum_leaves[0]]=])
texture_fault(texture_lanes 91 [=[d_joins_q & ~d_waits_q]=] [=[d_joins_q]=])
texture_fault(texture_lanes 92 [=[ends && found_ends]=] [=[ends]=])
texture_fault(texture_lanes 93 [=[shares && p_is_odd_q]=] [=[shares]=])
texture_fault(texture_lanes 94 [=[(is_second_look && misses_first_q[lane])]=] [=[1'b0]=])
texture_fault(level_of_detail 95 [=[(k == 0 ? 32'd0 : step)]=] [=[32'd0]=])
texture_fault(level_of_detail 96 [=[length_q[32*(SIDE+k%2)+:32]]=] [=[length_q[32*SIDE+:32]]=])
texture_fault(texture_unit 97 [=[PIXEL'(group) & PIXEL'((1 << ROW) - 1)]=] [=[PIXEL'(0)]=])
texture_fault(texture_rounds 98 [=[!scaled_valid_q && !wrapped_valid_q && !agreed_valid_q]=] [=[!scaled_valid_q && !wrapped_valid_q]=])
set(texture_lanes_faults ${texture_faults})
# The constant: its target, its source, alpha, a token that brings nothing, one that sets it as it
# enters, which stamps blend.
texture_fault(texture_combine 99 [=[is_blended ? constant_i[8*n+:8] : texel]=] [=[texel]=])
texture_fault(texture_combine 100 [=[color & {8{is_decal || is_blended}}]=] [=[color & {8{is_decal}}]=])
texture_fault(texture_combine 101 [=[is_modulated || is_added || is_blended]=] [=[is_modulated || is_added]=])
texture_fault(texture_unit 102 [=[sets_constant_i ? (SAMPLES * COLOR)'(state_i[23:0]) : door_color]=] [=[door_color]=])
texture_fault(texture_unit 103 [=[passes && stamp_flags[FLAGS-1]]=] [=[stamp_valid_i && sets_constant_i]=])
texture_fault(texture_unit 104 [=[{state_i[46], state_i[6:5]}]=] [=[{1'b0, state_i[6:5]}]=])
set(texture_constant_faults ${texture_faults})
# The border: a coordinate that is not held, or only a texel later, on either side; who has a border, beyond the last texel as
# well, and far beyond; that of rows; a token that does not wait for samples, or counts passes for groups; half_border; another
# sample's.
texture_fault(texture_border 105 [=[is_held ? 8'h80 : part_i]=] [=[part_i]=])
texture_fault(texture_border 106 [=[(next_is_below || !part_i[7])]=] [=[next_is_below]=])
texture_fault(texture_border 107 [=[(first_is_above || part_i[7])]=] [=[first_is_above]=])
texture_fault(texture_border 108 [=[wrap_i[1:0] == 2'd3]=] [=[1'b0]=])
texture_fault(texture_border 109 [=[(holds && next_is_above)]=] [=[1'b0]=])
texture_fault(texture_border 110 [=[texel[NUMBER_BITS-2:SIDE_BITS] != '0]=] [=[1'b0]=])
texture_fault(texture_filter 111 [=[part_i[18+n/2]]=] [=[1'b0]=])
texture_fault(texture_unit 112 [=[inside_q == '0]=] [=[1'b1]=])
texture_fault(texture_unit 113 [=[texel_valid && texel_ready && texel_ends]=] [=[texel_valid && texel_ready]=])
texture_fault(texture_unit 114 [=[{waiting[48], waiting[10:9], waiting[47], waiting[8:7]}]=] [=[{1'b0, waiting[10:9], 1'b0, waiting[8:7]}]=])
texture_fault(texture_lanes 115 [=[PART'({border[4*l+:4], part[16*l+:16]})]=] [=[PART'({border[3:0], part[16*l+:16]})]=])
foreach(name IN LISTS texture_names)
  file(CONFIGURE OUTPUT "${FOLDER}/${name}.sv" CONTENT "${texture_text_${name}}" @ONLY)
endforeach()
file(CONFIGURE OUTPUT "${FOLDER}/texture_faults.hpp" CONTENT "#pragma once
// Written by tests/rtl_units/faults.cmake: the last fault of each kind.
inline constexpr int kNearestFaults = ${texture_nearest_faults}, kLinearFaults = ${texture_linear_faults},
                     kLevelsFaults = ${texture_levels_faults}, kColorsFaults = ${texture_colors_faults},
                     kWaysFaults = ${texture_ways_faults}, kLanesFaults = ${texture_lanes_faults},
                     kConstantFaults = ${texture_constant_faults}, kTextureFaults = ${texture_faults};
" @ONLY)
