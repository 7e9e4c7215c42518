// Vectors of a stage: its input and output packets in the hardware model, over whole scenes.
#pragma once

#include <functional>

#include "packets.hpp"
#include "sim/cosim/session.hpp"

namespace halfplane::vectors {

/// Runs the scenes one after the other through one hardware model, from reset, and keeps the packets of the stage's
/// ports. Throws InputError for a scene that the hardware does not support. `progress` gets the primitives sent so far;
/// it may throw.
[[nodiscard]] StagePackets record_stage(const JudgedStage& stage, const Config& config, const SceneSource& next,
                                        const std::function<void(std::uint64_t primitives)>& progress = {});

/// One packet, in the stage's order of inputs and outputs.
using Visit =
    std::function<void(bool is_out, std::size_t port, std::size_t number, std::span<const std::uint32_t> words)>;

/// Runs the stage's specification on its inputs: calls visit for each input packet that it takes, and for each output.
/// For a stage without a specification: all inputs, then all outputs. Throws std::logic_error if specification and
/// hardware model differ.
void replay_stage(const JudgedStage& stage, const Config& config, const StagePackets& packets, const Visit& visit);

}  // namespace halfplane::vectors
