#include "live/island_desk.h"

#include <atomic>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace tandem {
namespace {

TEST(IslandDesk, WithoutAThreadWorkIsDoneAtOnce) {
  IslandDesk desk;
  int done = 0;
  desk.run([&] { ++done; });
  EXPECT_EQ(done, 1);
}

TEST(IslandDesk, WorkIsDoneByTheThreadThatServes) {
  IslandDesk desk;
  desk.open();
  std::atomic<bool> stops{false};
  std::thread::id server_id;
  std::thread server([&] {
    server_id = std::this_thread::get_id();
    while (!stops) desk.serve();
  });
  std::thread::id worked_in;
  desk.run([&] { worked_in = std::this_thread::get_id(); });
  stops = true;
  server.join();
  EXPECT_EQ(worked_in, server_id);
}

TEST(IslandDesk, ManyAskersAreServedOneByOneWhileTheDeskOpensAndCloses) {
  constexpr int kAskers = 4, kOrders = 2000;
  IslandDesk desk;
  desk.open();      // before, the island belongs to one thread
  long island = 0;  // not atomic: one thread at a time has it
  std::atomic<bool> stops{false};
  std::thread server([&] {
    while (!stops) {
      for (int i = 0; i < 100; ++i) {
        desk.serve();
        std::this_thread::yield();
      }
      // While the desk is closed the askers do the work; the desk serialises these too.
      desk.close();
      desk.serve();
      std::this_thread::yield();
      desk.open();
    }
  });
  std::vector<std::thread> askers;
  for (int a = 0; a < kAskers; ++a)
    askers.emplace_back([&] {
      for (int i = 0; i < kOrders; ++i) desk.run([&] { ++island; });
    });
  for (std::thread& asker : askers) asker.join();
  stops = true;
  server.join();
  EXPECT_EQ(island, static_cast<long>(kAskers) * kOrders);
}

}  // namespace
}  // namespace tandem
