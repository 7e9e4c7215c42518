// The engines that `halfplane bench` times, behind one function.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string_view>

#include "model/config.hpp"
#include "model/scene.hpp"
#include "sim/study/bench/turns.hpp"

namespace halfplane {

/// Their names, as --engines takes them.
inline constexpr std::array<std::string_view, 6> kBenchEngines{"functional", "scalar", "golden",
                                                               "cycle",      "rtl",    "llvmpipe"};

/// Whether the engine can use more than one thread.
[[nodiscard]] bool has_threads(std::string_view engine);

/// Whether its images are the stages', bit for bit, so that one comparison with the golden is valid for all such
/// engines.
[[nodiscard]] bool is_bit_exact(std::string_view engine);

/// A function that renders a frame of `scene`, with everything else prepared and kept: buffers from frame to frame, a
/// Verilated design, llvmpipe's uploads. Throws InputError for unsupported features, here or in its first frame, and
/// std::runtime_error for features missing in this build or machine. `poll` is called from time to time inside a frame
/// of the slower engines, which it may leave by throwing; may be empty.
[[nodiscard]] Frame make_frame(std::string_view engine, std::shared_ptr<const Scene> scene, const Config& config,
                               int threads, const std::function<void()>& poll = {});

}  // namespace halfplane
