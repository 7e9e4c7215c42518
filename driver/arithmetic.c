#include "internal.h"

#define HP_8(n) n, n, n, n, n, n, n, n
#define HP_32(n) HP_8(n), HP_8(n), HP_8(n), HP_8(n)
const uint8_t hp_bits_of_byte[256] = {0,        1,        2,        2,        3,        3,
                                      3,        3,        HP_8(4),  HP_8(5),  HP_8(5),  HP_32(6),
                                      HP_32(7), HP_32(7), HP_32(8), HP_32(8), HP_32(8), HP_32(8)};
#undef HP_32
#undef HP_8

uint32_t hp_divide(uint64_t n, uint32_t d) {
  if ((n >> 32) == 0) return (uint32_t)n / d;
  const uint32_t shift = 32 - hp_bits32(d); /* the divisor's highest bit to bit 31 */
  const uint32_t divisor = d << shift, high = divisor >> 16, low = divisor & 0xffffu;
  const uint64_t dividend = n << shift;
  uint32_t rest = (uint32_t)(dividend >> 32), quotient = 0;
  for (uint32_t digit = 2; digit-- != 0;) {
    const uint32_t next = (uint32_t)(dividend >> (16 * digit)) & 0xffffu;
    uint32_t q = rest / high, r = rest % high;
    /* At most two too large. Neither side leaves 32 bits: q and r are below 2^16 where they are compared. */
    while (q > 0xffffu || q * low > ((r << 16) | next)) {
      --q;
      r += high;
      if (r > 0xffffu) break;
    }
    rest = (rest << 16) + next - q * divisor; /* modulo 2^32: the rest is below the divisor */
    quotient = (quotient << 16) | q;
  }
  return quotient;
}

int64_t hp_divide_rounded(int64_t n, uint32_t d) {
  n += d / 2;
  const uint64_t size = n < 0 ? (uint64_t)-n + (d - 1) : (uint64_t)n;
  const int64_t quotient = (size >> 32) >= d ? (int64_t)1 << 33 : (int64_t)hp_divide(size, d);
  return n < 0 ? -quotient : quotient;
}
