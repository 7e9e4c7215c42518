// Depth quantization, exactly: the code of an eye depth under a mapping and a format, in rationals of any size.
//
// Definitions (docs/depth.md): eye depth z in [near, far]; d(z) the mapping's depth in [0, 1]; a code's bin is every z
// that gets that code. Only the logarithm is irrational: it is computed to 64 bits, and its ties are decided exactly.
#pragma once

#include <gmpxx.h>

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "model/formats/depth_format.hpp"

namespace halfplane {

using Rational = mpq_class;

/// A decimal ("0.1", "1e-3", "5") as its exact value. Throws InputError naming `what`.
[[nodiscard]] Rational parse_decimal(std::string_view text, std::string_view what);

/// A mapping and a format at one eye depth. Lengths in eye-space units.
struct DepthFigures {
  std::uint32_t code = 0;
  double bin_width = 0;      ///< length of the code's bin, clipped to [near, far]
  double max_recon_err = 0;  ///< largest |z - reconstructed z| in that bin; infinite for the code of infinity
  double first_order = 0;    ///< |dz/dd| at z times the bin's width in d: a label, not a bound
};

class ExactDepth {
 public:
  /// 0 < near < far; `format` is not `plane`, `mapping` not `projection`. Throws InputError.
  ExactDepth(DepthMapping mapping, const DepthFormat& format, const Rational& near, const Rational& far);

  [[nodiscard]] std::uint32_t code(const Rational& z) const;
  [[nodiscard]] DepthFigures at(const Rational& z) const;

  /// The clipped bin of a code, near end first; none if no z in [near, far] has the code.
  struct Bin {
    double nearest = 0, farthest = 0, width = 0;
  };
  [[nodiscard]] std::optional<Bin> bin(std::uint32_t code) const;

  /// The code's width in d, for first_order.
  [[nodiscard]] double d_width(std::uint32_t code) const;

  /// The eye depth of a code; infinite for the code of infinity.
  [[nodiscard]] double reconstructed(std::uint32_t code) const;

  /// The least eye depth in [low, high] whose bin is longer than `length`; none if no bin there is.
  [[nodiscard]] std::optional<double> first_exceeding(double length, const Rational& low, const Rational& high) const;

  /// The longest bin that intersects [low, high].
  [[nodiscard]] double longest_bin(const Rational& low, const Rational& high) const;

  [[nodiscard]] DepthMapping mapping() const { return mapping_; }
  [[nodiscard]] const DepthFormat& format() const { return format_; }
  [[nodiscard]] const Rational& near() const { return near_; }
  [[nodiscard]] const Rational& far() const { return far_; }

 private:
  struct Boundaries {
    Rational low, high;  ///< in d, inside [0, 1]
  };
  [[nodiscard]] Boundaries boundaries(std::uint32_t code) const;
  [[nodiscard]] Rational value(std::uint32_t code) const;
  [[nodiscard]] int compare_d(const Rational& z, const Rational& d) const;
  [[nodiscard]] long double d_estimate(const Rational& z) const;
  [[nodiscard]] Rational d_of(const Rational& z) const;
  [[nodiscard]] std::optional<Rational> z_of(const Rational& d) const;
  [[nodiscard]] double to_double(const Rational& d) const;  ///< z(d)
  [[nodiscard]] double distance(const Rational& d0, const Rational& d1) const;
  [[nodiscard]] std::vector<std::uint32_t> run_ends(std::uint32_t first, std::uint32_t last) const;

  DepthMapping mapping_;
  DepthFormat format_;
  Rational near_, far_, d_near_, d_far_;
  long double log_ratio_ = 0;  ///< ln(far / near)
};

}  // namespace halfplane
