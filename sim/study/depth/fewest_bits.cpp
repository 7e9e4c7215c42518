#include "sim/study/depth/fewest_bits.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace halfplane {
namespace {

constexpr int kLeastBits = 8, kMostBits = 32;

DepthVariant unorm_variant(const Config& config, DepthMapping mapping, int bits, const DepthPlanes& planes) {
  return make_variant(config, mapping, {DepthFormat::Kind::unorm, bits, 0, 0}, planes);
}

/// The bisection of one mapping: `fails` bits are too few, `holds` are enough.
struct Bisection {
  int fails = kLeastBits - 1, holds = kMostBits + 1;
  std::array<DepthOrder, kMostBits + 1> orders{};  ///< by bits, where measured

  [[nodiscard]] bool is_done() const { return holds - fails <= 1; }
  [[nodiscard]] int middle() const { return (fails + holds) / 2; }
};

}  // namespace

DepthVariant stored_plane(const Config& config, const DepthPlanes& planes) {
  return unorm_variant(config, std::isinf(planes[1]) ? DepthMapping::stdinf : DepthMapping::std, config.depth_bits,
                       planes);
}

std::vector<FewestBits> fewest_depth_bits(const Scene& scene, const Config& config,
                                          std::span<const DepthMapping> mappings, const DepthPlanes& planes,
                                          double rate, int threads,
                                          const std::function<void(double fraction)>& progress) {
  std::vector<Bisection> searches(mappings.size());
  const double rounds = std::ceil(std::log2(kMostBits - kLeastBits + 2));
  for (int round = 0; std::ranges::any_of(searches, [](const Bisection& s) { return !s.is_done(); }); ++round) {
    std::vector<DepthVariant> variants;
    std::vector<Bisection*> measured;
    for (std::size_t i = 0; i < mappings.size(); ++i) {
      if (searches[i].is_done()) continue;
      variants.push_back(unorm_variant(config, mappings[i], searches[i].middle(), planes));
      measured.push_back(&searches[i]);
    }
    MeasureOptions options;
    options.wants_errors = false;
    if (progress) options.progress = [&](double fraction) { progress(std::min(1.0, (round + fraction) / rounds)); };
    const auto results = measure_depths(scene, variants, options, threads);
    for (std::size_t i = 0; i < results.size(); ++i) {
      if (!results[i].is_whole) return {};
      const int bits = measured[i]->middle();
      const DepthOrder& order = measured[i]->orders[static_cast<std::size_t>(bits)] = results[i].order;
      (order.rate() < rate ? measured[i]->holds : measured[i]->fails) = bits;
    }
  }
  std::vector<FewestBits> list;
  for (std::size_t i = 0; i < mappings.size(); ++i) {
    const auto order = [&](int bits) -> const DepthOrder& {
      return searches[i].orders[static_cast<std::size_t>(bits)];
    };
    FewestBits fewest;
    fewest.mapping = mappings[i];
    const int enough = searches[i].holds;
    if (enough <= kMostBits) fewest.bits = enough;
    const DepthOrder& best = order(std::min(enough, kMostBits));
    fewest.pairs = best.pairs;
    fewest.rate = best.rate();
    if (fewest.bits && enough > kLeastBits) fewest.one_less = order(enough - 1).rate();
    const auto variant = unorm_variant(config, mappings[i], std::min(enough, kMostBits), planes);
    fewest.is_in_rtl = DepthEncode(variant.config, planes).is_identity();
    list.push_back(fewest);
  }
  return list;
}

}  // namespace halfplane
