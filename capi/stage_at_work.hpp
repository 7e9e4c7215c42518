// One stage of the specification that takes a packet at a time from whoever has one.
#pragma once

#include <deque>
#include <exception>
#include <semaphore>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "model/vectors/stages.hpp"

namespace halfplane::capi {

/// A stage pulls its packets (StageIo). Here they are pushed: the stage runs in a thread of its own and stands still where it
/// wants a packet that is not there yet. One of the two threads runs at a time.
class StageAtWork final : vectors::StageIo {
 public:
  /// From reset. Throws InputError for a stage that this configuration does not have, or that nobody can judge.
  StageAtWork(const Config& config, std::string_view name);
  ~StageAtWork() override;
  StageAtWork(const StageAtWork&) = delete;
  StageAtWork& operator=(const StageAtWork&) = delete;

  struct PortInfo {
    std::string name;
    int bits = 0;
    std::vector<vectors::FieldName> elements;  ///< in the order of values_of()
    std::vector<vectors::FieldName> fields;    ///< the same, highest bits first
  };
  [[nodiscard]] const std::vector<PortInfo>& ports(bool is_out) const { return is_out ? out_ports_ : in_ports_; }

  /// `words`: as many as the port's bits need. Throws InputError for a place outside the target; and for a packet that the
  /// stage cannot take, and then the stage is at its end and says so again whatever else is put.
  void put(std::size_t port, const std::uint32_t* words);
  /// False: there is none.
  [[nodiscard]] bool get(std::size_t port, std::uint32_t* words);

 private:
  using Packet = std::vector<std::uint32_t>;

  std::span<const std::uint32_t> take(std::size_t port) override;
  void send(std::size_t port, std::span<const std::uint32_t> words) override;
  void run();
  void go_on();
  void require_own_process() const;

  Config config_;
  Widths widths_;
  const vectors::JudgedStage& stage_;
  std::vector<PortInfo> in_ports_, out_ports_;
  std::vector<std::deque<Packet>> in_, out_;
  Packet taken_;
  std::size_t waits_for_ = 0;
  bool is_ending_ = false, has_ended_ = false;
  std::exception_ptr error_;
  std::binary_semaphore stage_turn_{0}, caller_turn_{0};
  std::thread thread_;
  const long process_;
};

}  // namespace halfplane::capi
