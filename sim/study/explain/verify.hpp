// Compares the figures of an explanation with each other, each time: wherever two sides must agree.
#pragma once

#include "hardware_record.hpp"
#include "history.hpp"

namespace halfplane::explain {

/// Adds the hardware model's results to their entries, and compares: verdicts, edge values, codes.
void join_hardware(const HardwareRecord& hardware, const Config& config, Explanation& result);

/// Compares coverage with the oracle, the stored values of specification, functional engine, hardware model and RTL, and the
/// RTL's packets and cycles with the model's.
void verify(const Config& config, Explanation& result);

/// Names of differing fields of a packet, as "field model rtl".
[[nodiscard]] std::vector<std::string> differing_fields(const PacketId& id, const RecordedPacket& packet,
                                                        const Widths& widths);

}  // namespace halfplane::explain
