#include "peer/mesh_thread.h"

#include "tandem/falcon/monotonic_clock.h"

namespace tandem::demos {
namespace {

/// Arrivals are fetched so far ahead of their moment, two ticks at 1 kHz [s].
constexpr double kAhead = 2e-3;

}  // namespace

MeshThread::MeshThread(UdpMesh& mesh, StartLink& start, LinkQueue& queue, std::mutex& mutex)
    : mesh_(mesh), link_(start), queue_(queue), mutex_(mutex), thread_([this] { run(); }) {}

MeshThread::~MeshThread() {
  is_stopping_ = true;
  thread_.join();
}

void MeshThread::run() noexcept {
  while (!is_stopping_) {
    {
      const std::lock_guard lock(mutex_);
      const double now = readMonotonicClock(), site_time = now - *link_.start();
      mesh_.poll(now);
      link_.setClock(now);
      queue_.exchange(link_, site_time, site_time + kAhead);
    }
    mesh_.wait(kPause);
  }
}

}  // namespace tandem::demos
