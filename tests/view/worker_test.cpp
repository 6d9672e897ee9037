#include "session/worker.h"

#include <stdexcept>

#include <gtest/gtest.h>
#include <sys/resource.h>

namespace tandem::view {
namespace {

int niceOfThisThread() { return getpriority(PRIO_PROCESS, 0); }

TEST(Worker, KeepsItsPriorityWhenItsUserStepsBack) {
  int of_user = 0, of_worker = 0, of_its_threads = 0;
  // In a thread of its own: nobody gets a higher priority back.
  std::thread user([&] {
    const int before = niceOfThisThread();
    Worker worker;
    ASSERT_EQ(setpriority(PRIO_PROCESS, 0, before + 5), 0);
    of_user = niceOfThisThread() - before;
    worker.run([&] {
      of_worker = niceOfThisThread() - before;
      std::thread([&] { of_its_threads = niceOfThisThread() - before; }).join();
    });
  });
  user.join();
  EXPECT_EQ(of_user, 5);
  EXPECT_EQ(of_worker, 0);
  EXPECT_EQ(of_its_threads, 0);
}

TEST(Worker, ThrowsWhatItsWorkThrowsAndGoesOn) {
  Worker worker;
  EXPECT_THROW(worker.run([] { throw std::invalid_argument("no"); }), std::invalid_argument);
  bool is_done = false;
  worker.run([&] { is_done = true; });
  EXPECT_TRUE(is_done);
}

}  // namespace
}  // namespace tandem::view
