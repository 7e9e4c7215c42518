// Batches of steps on their way from the bits of a frame to its times.
#include <gtest/gtest.h>

#include <system_error>
#include <thread>
#include <vector>

#include "model/engines/cycle/step_queue.hpp"

namespace halfplane::step_queue_test {
namespace {

constexpr std::uint32_t kBatches = 100;

/// Notes the number of each batch, the count of its only step, and the threads that ran them.
struct Notes final : StepRunner {
  void run(const Steps& steps) override {
    numbers.push_back(steps.order.items()[0].count);
    is_elsewhere = is_elsewhere || std::this_thread::get_id() != here;
    if (numbers.size() == fails_at) throw std::runtime_error("the memory refuses");
  }
  const std::thread::id here = std::this_thread::get_id();
  std::vector<std::uint32_t> numbers;
  bool is_elsewhere = false;
  std::size_t fails_at = 0;
};

void hand_over_batches(StepQueue& queue) {
  queue.begin(2);
  for (std::uint32_t n = 1; n <= kBatches; ++n) {
    queue.filling().add(StepKind::outside, n);
    if (n < kBatches) queue.hand_over();
  }
  queue.complete();
}

void expect_all_in_order(const Notes& notes) {
  ASSERT_EQ(notes.numbers.size(), kBatches);
  for (std::uint32_t n = 0; n < kBatches; ++n) EXPECT_EQ(notes.numbers[n], n + 1);
}

TEST(StepQueue, BatchesRunInOrderOnTheSecondThread) {
  Notes notes;
  StepQueue queue(notes);
  hand_over_batches(queue);
  expect_all_in_order(notes);
  EXPECT_TRUE(notes.is_elsewhere);
}

TEST(StepQueue, TheThreadStaysUntilOneIsEnough) {
  Notes notes;
  int launches = 0;
  StepQueue queue(notes, [&](std::function<void()> work) {
    ++launches;
    return std::thread(std::move(work));
  });
  for (int frame = 0; frame < 3; ++frame) {
    notes.numbers.clear();
    hand_over_batches(queue);
    expect_all_in_order(notes);
  }
  EXPECT_EQ(launches, 1);
  notes.is_elsewhere = false;
  queue.begin(1);
  queue.filling().add(StepKind::outside, 1);
  queue.complete();
  EXPECT_FALSE(notes.is_elsewhere);
  hand_over_batches(queue);
  EXPECT_EQ(launches, 2);
}

TEST(StepQueue, WhereNoThreadIsToBeHadBatchesRunOnTheFirst) {
  Notes notes;
  StepQueue queue(notes, [](const std::function<void()>&) -> std::thread {
    throw std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again));
  });
  hand_over_batches(queue);
  expect_all_in_order(notes);
  EXPECT_FALSE(notes.is_elsewhere);
}

TEST(StepQueue, WhatARunnerThrowsComesOutAndNothingRunsAfterIt) {
  Notes notes;
  notes.fails_at = 10;
  StepQueue queue(notes);
  EXPECT_THROW(hand_over_batches(queue), std::runtime_error);
  EXPECT_EQ(notes.numbers.size(), 10U);
}

}  // namespace
}  // namespace halfplane::step_queue_test
