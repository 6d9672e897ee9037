#pragma once

#include <atomic>
#include <mutex>
#include <thread>

#include "tandem/plugin/link_queue.h"
#include "tandem/plugin/udp_mesh.h"

#include "peer/start_link.h"

namespace tandem::demos {

/// The thread that has the socket while a haptic thread ticks: what the site sends waits in `queue`
/// for it at most kPause, and what comes in is there before its tick. From start to end the mesh
/// and the start link are its own, but for those who hold `mutex`.
class MeshThread {
 public:
  static constexpr double kPause = 0.25e-3;  ///< between two looks at the queue [s]

  /// `start` must be known. All must outlive this.
  MeshThread(UdpMesh& mesh, StartLink& start, LinkQueue& queue, std::mutex& mutex);
  ~MeshThread();
  MeshThread(const MeshThread&) = delete;
  MeshThread& operator=(const MeshThread&) = delete;

 private:
  void run() noexcept;

  UdpMesh& mesh_;
  StartLink& link_;
  LinkQueue& queue_;
  std::mutex& mutex_;
  std::atomic<bool> is_stopping_{false};
  std::thread thread_;
};

}  // namespace tandem::demos
