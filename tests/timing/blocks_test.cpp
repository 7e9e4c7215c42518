// The building blocks of the cycle model, each at the cycle before and the cycle at which something is possible.
#include <gtest/gtest.h>

#include "model/timing/queue.hpp"

namespace halfplane::blocks_test {
namespace {

TEST(Station, ARegisterWhoseReadyPassesThroughTakesTheNextItemInTheCycleInWhichOneLeaves) {
  Station station(1, 3, 0);
  EXPECT_EQ(station.room(), 0u);
  EXPECT_EQ(station.ready(5), 8u);
  station.leave(8);
  EXPECT_EQ(station.room(), 8u);
}

TEST(Station, ASkidBufferTakesItemNACycleAfterItemNMinus2Left) {
  Station skid(2, 1, 1);
  skid.leave(10);
  EXPECT_EQ(skid.room(), 0u);  // the second place was always free
  skid.leave(12);
  EXPECT_EQ(skid.room(), 11u);
  skid.leave(15);
  EXPECT_EQ(skid.room(), 13u);
}

TEST(Stream, AnItemMovesWhenItIsOfferedAndThereIsRoom) {
  Stream stream({}, 1);
  EXPECT_EQ(stream.transfer(4, 0), 4u);
  EXPECT_EQ(stream.transfer(5, 9), 9u);
  const StreamUse use = stream.use(20);
  EXPECT_EQ(use.busy, 2u);
  EXPECT_EQ(use.stalled, 4u);
  EXPECT_EQ(use.starved, 14u);
}

TEST(Stream, AStallMovesAnItemToTheFirstFreeCycle) {
  const Stalls stalls{7, stall_threshold(0.5)};
  Stream stream(stalls, 1U << 3);
  for (Cycle offered = 0; offered < 200; ++offered) {
    const Cycle moved = Stream(stalls, 1U << 3).transfer(offered, 0);
    EXPECT_FALSE(is_stalled(7, 3, moved, stalls.threshold));
    for (Cycle c = offered; c < moved; ++c) EXPECT_TRUE(is_stalled(7, 3, c, stalls.threshold));
  }
}

TEST(Stream, TwoStreamsThatMoveTogetherWaitForBoth) {
  const Stalls stalls{9, stall_threshold(0.4)};
  for (Cycle offered = 0; offered < 200; ++offered) {
    const Cycle moved = Stream(stalls, 1U << 0).transfer(offered, 0, 1U << 5);
    for (Cycle c = offered; c <= moved; ++c)
      EXPECT_EQ(c == moved, !is_stalled(9, 0, c, stalls.threshold) && !is_stalled(9, 5, c, stalls.threshold));
  }
}

TEST(Queue, NoQueueIsADirectHandOver) {
  Stream stream({}, 1);
  Queue none(0);
  const Passage passage = none.pass(stream, 3, 8);
  EXPECT_EQ(passage.left, 8u);
  EXPECT_EQ(passage.taken, 8u);
}

TEST(Queue, TheSenderIsFreeWhileAnItemWaitsInTheQueue) {
  Stream stream({}, 1);
  Queue queue(2);
  EXPECT_EQ(queue.pass(stream, 3, 10).left, 3u);
  EXPECT_EQ(queue.pass(stream, 4, 20).left, 4u);
  const Passage third = queue.pass(stream, 5, 30);  // full until the first has left at 10
  EXPECT_EQ(third.left, 11u);
  EXPECT_EQ(third.taken, 30u);
}

}  // namespace
}  // namespace halfplane::blocks_test
