// Product of two numbers that are wider than a multiplier's input, in digits of 17 bits, added one after the other.
//
// Yosys splits a long product itself, but it adds three numbers by full adders in front of a carry chain, three places a bit
// where two chains take two. Where the right factor has no sign, the products of one of its digits with every other
// digit of the left factor do not overlap and are one number.
module long_product #(
    parameter int LEFT = 18,         // bits of the left factor, signed
    parameter int RIGHT = 18,        // bits of the right factor
    parameter bit RIGHT_SIGNED = 1,  // 0: unsigned, which saves adders
    parameter int OUT = 36           // bits of the product that count, from the lowest
) (
    input  logic [LEFT-1:0]  left_i,    // signed
    input  logic [RIGHT-1:0] right_i,
    output logic [OUT-1:0]   product_o  // modulo 2^OUT; may be shorter than the full product
);

  localparam int DIGIT = 17;
  // The last digit keeps the sign.
  localparam int LEFT_DIGITS = LEFT > DIGIT + 1 ? (LEFT - 2) / DIGIT + 1 : 1;
  localparam int RIGHT_DIGITS = RIGHT > (RIGHT_SIGNED ? DIGIT + 1 : DIGIT) ?
                                (RIGHT - (RIGHT_SIGNED ? 2 : 1)) / DIGIT + 1 : 1;
  localparam int PARTS = LEFT_DIGITS * RIGHT_DIGITS;

  // Both signed, extended to all digits.
  localparam int LEFT_LONG = LEFT_DIGITS * DIGIT + 1;
  localparam int RIGHT_LONG = RIGHT_DIGITS * DIGIT + 1;
  logic signed [LEFT_LONG-1:0]  left;
  logic signed [RIGHT_LONG-1:0] right;
  assign left  = LEFT_LONG'($signed(left_i));
  assign right = RIGHT_SIGNED ? RIGHT_LONG'($signed(right_i)) : RIGHT_LONG'(right_i);

  localparam int PART = 2 * DIGIT + 2;
  logic [PARTS*PART-1:0] parts;
  genvar i, j, b;
  generate
    for (j = 0; j < RIGHT_DIGITS; j++) begin : gen_right
      localparam bit HAS_SIGN = RIGHT_SIGNED && j == RIGHT_DIGITS - 1;
      logic signed [DIGIT:0] right_digit;
      assign right_digit = {HAS_SIGN && right[j*DIGIT+DIGIT], right[j*DIGIT+:DIGIT]};
      for (i = 0; i < LEFT_DIGITS; i++) begin : gen_left
        localparam int N = j * LEFT_DIGITS + i;
        localparam int AT = DIGIT * (i + j);
        logic signed [DIGIT:0]  left_digit;
        logic signed [PART-1:0] part;
        logic [OUT-1:0]         sum;     // including this term
        logic [OUT-1:0]         so_far;  // before this term
        assign left_digit = {i == LEFT_DIGITS - 1 && left[i*DIGIT+DIGIT], left[i*DIGIT+:DIGIT]};
        assign part       = left_digit * right_digit;
        assign parts[N*PART+:PART] = part;
        if (i > 0) begin : gen_behind
          assign so_far = gen_left[i-1].sum;
        end else if (j > 0) begin : gen_below
          assign so_far = gen_right[j-1].gen_left[LEFT_DIGITS-1].sum;
        end else begin : gen_zero
          assign so_far = '0;
        end
        if ((i > 1 && !HAS_SIGN) || AT >= OUT) begin : gen_no_term  // above another term, or above the whole product
          assign sum = so_far;
        end else begin : gen_term
          logic [OUT-AT-1:0] term;
          for (b = AT; b < OUT; b++) begin : gen_bit
            localparam int ABOVE = HAS_SIGN ? 0 : (b - AT) / (2 * DIGIT);
            localparam int LAST = (LEFT_DIGITS - 1 - i) / 2;
            localparam int WHICH = 2 * (ABOVE < LAST ? ABOVE : LAST);
            localparam int BIT = b - AT - DIGIT * WHICH;
            assign term[b-AT] = parts[(N+WHICH)*PART+(BIT<PART?BIT:PART-1)];
          end
          if (N == 0) begin : gen_first
            assign sum = term;
          end else begin : gen_sum
            if (AT > 0) begin : gen_low
              assign sum[AT-1:0] = so_far[AT-1:0];
            end
            add_or_subtract #(
                .WIDTH(OUT - AT)
            ) u_sum (
                .subtracts_i(1'b0),
                .a_i        (so_far[OUT-1:AT]),
                .b_i        (term),
                .sum_o      (sum[OUT-1:AT])
            );
          end
        end
      end
    end
  endgenerate
  assign product_o = gen_right[RIGHT_DIGITS-1].gen_left[LEFT_DIGITS-1].sum;

endmodule
