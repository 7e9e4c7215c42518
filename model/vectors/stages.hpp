// The stages as judges: the input and output packets of each, and the specification that maps one to the other.
//
// Ports are arrows of the pipeline graph, and two transfers inside a cycle that are no arrows: `interpolated`, from
// interpolate to primitive_join, and `tested`, from depth_test to rop. A stage reads each of its ports in order; the
// order between ports follows from the data alone, so that the packets of a port need no time.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "../config.hpp"
#include "../pipeline_graph.hpp"
#include "../widths.hpp"

namespace halfplane::vectors {

/// A port of a stage.
struct Port {
  std::string_view name;  ///< name of the arrow, or `interpolated`, or `tested`
  Arrow like;             ///< the arrow with the same packet type
};

/// The packets on a stage's ports, in the form of its specification: packed words (model/packets/packet_words.hpp).
class StageIo {
 public:
  virtual ~StageIo() = default;
  /// The next packet of input port `port`; empty at the end. Valid until the next call.
  [[nodiscard]] virtual std::span<const std::uint32_t> take(std::size_t port) = 0;
  /// The next packet of output port `port`.
  virtual void send(std::size_t port, std::span<const std::uint32_t> words) = 0;
};

struct JudgedStage {
  Stage stage;
  std::vector<Port> in, out;
  std::string_view why_not = {};  ///< reason why its packets cannot be judged from the input; empty: they can

  [[nodiscard]] bool can_run() const { return why_not.empty(); }
};

/// Runs the stage from reset until its first port ends. Throws InputError when another port ends before. Precondition:
/// stage.can_run().
void run_stage(const JudgedStage& stage, StageIo& io, const Config& config, const Widths& widths);

/// Every stage of the graph that sends packets.
[[nodiscard]] std::span<const JudgedStage> judged_stages();

/// The stage with that name. Throws InputError that lists the names, and for a stage that this configuration lacks.
[[nodiscard]] const JudgedStage& judged_stage(std::string_view name);
void require_stage(const JudgedStage& stage, const Config& config);

/// A field of a packet, as files name it.
struct FieldName {
  std::string name;
  int bits = 0;
  bool is_signed = false;
  int low = 0;  ///< its lowest bit in the packed struct
};
/// The fields of a packet type, as files list them: the highest field first, elements of an array by their number.
[[nodiscard]] std::vector<FieldName> fields_of(Arrow like, const Widths& widths);
/// The same by place, highest bits first: elements of an array in descending order, because element 0 is the lowest.
[[nodiscard]] std::vector<FieldName> highest_first(std::vector<FieldName> fields);
[[nodiscard]] std::size_t packet_words(Arrow like, const Widths& widths);
[[nodiscard]] int bits_of(Arrow like, const Widths& widths);
/// The bits of every field of a packet, and back. Precondition of the inverse: each value fits its field.
[[nodiscard]] std::vector<std::uint64_t> values_of(Arrow like, const Widths& widths,
                                                   std::span<const std::uint32_t> words);
[[nodiscard]] std::vector<std::uint32_t> words_from(std::span<const FieldName> fields,
                                                    std::span<const std::uint64_t> values);
/// The fault of an input packet: a tile or a pixel outside the largest target, for which no specification is defined.
/// Empty: none.
[[nodiscard]] std::string place_fault(std::span<const FieldName> fields, std::span<const std::uint64_t> values,
                                      const Config& config, const Widths& widths);

}  // namespace halfplane::vectors
