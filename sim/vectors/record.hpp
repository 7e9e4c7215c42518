// Vectors of a stage: its input and output packets in the hardware model, over whole scenes.
#pragma once

#include <functional>

#include "packets.hpp"
#include "sim/cosim/session.hpp"

namespace halfplane::vectors {

/// Runs the scenes one after the other through one hardware model, from reset, and keeps the packets of the stage's ports.
/// Throws InputError for a scene that the hardware cannot take. `progress` gets the primitives sent so far; it may throw.
[[nodiscard]] StagePackets record_stage(const JudgedStage& stage, const Config& config, const SceneSource& next,
                                        const std::function<void(std::uint64_t primitives)>& progress = {});

/// One packet, in the order in which the stage takes and gives them.
using Visit =
    std::function<void(bool is_out, std::size_t port, std::size_t number, std::span<const std::uint32_t> words)>;

/// Runs the stage's specification on what goes in: calls visit for each packet that it takes, and for each that comes out.
/// Of a stage without one: all that go in, then all that come out. Throws std::logic_error if specification and hardware
/// model differ.
void replay_stage(const JudgedStage& stage, const Config& config, const StagePackets& packets, const Visit& visit);

}  // namespace halfplane::vectors
