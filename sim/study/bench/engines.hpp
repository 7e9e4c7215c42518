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

/// Whether its images are the stages', bit for bit, so that one comparison with the golden holds for all such engines.
[[nodiscard]] bool is_bit_exact(std::string_view engine);

/// The frame that the engine renders of `scene`, whatever else it needs made and kept: buffers from one frame to the
/// next, a Verilated design, what llvmpipe uploads. Throws InputError for what the engine does not have, here or by its first
/// frame, and std::runtime_error for what this build or machine lacks. `poll` is called now and then inside a frame of
/// the slower engines, which it may leave by throwing; may be empty.
[[nodiscard]] Frame make_frame(std::string_view engine, std::shared_ptr<const Scene> scene, const Config& config,
                               int threads, const std::function<void()>& poll = {});

}  // namespace halfplane
