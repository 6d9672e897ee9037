#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tandem/plugin/site.h"

#include "host_time.h"
#include "object_choice.h"
#include "remote_site.h"
#include "step_log.h"

namespace tandem::preload {

/// Shares an object of one world of the process. Waits for the object, attaches a site when it
/// appears and lets go when it leaves. Events are reported on stderr. Nothing is thrown: after
/// trouble the host runs on without Tandem. For the thread that steps the world.
class SharedObject {
 public:
  /// Throws tandem::Error if the log cannot be written.
  explicit SharedObject(const PreloadConfig& config);
  ~SharedObject();
  SharedObject(const SharedObject&) = delete;
  SharedObject& operator=(const SharedObject&) = delete;

  /// Sets the world. It may be an incomplete derived one, so nothing is read from it here.
  void setWorld(btDiscreteDynamicsWorld& world) noexcept { world_ = &world; }

  void beforeStep() noexcept;
  void afterStep(double dt, int max_sub_steps, double fixed_step, int sub_steps) noexcept;
  void objectLeaves(const void* object) noexcept;
  /// Restores the world before it ends.
  void endWorld() noexcept;

  /// Null while the object is absent.
  [[nodiscard]] const Site* site() const noexcept { return site_.get(); }

 private:
  void lookForObject();
  void reportLeaving(bool is_back);
  void attach(const ObjectChoice& choice);
  void lookForTheSame(const ObjectChoice& choice);
  void attachAgainIfUnseated();
  void letGo() noexcept;
  void giveUp(const char* why) noexcept;
  void report();

  PreloadConfig config_;
  btDiscreteDynamicsWorld* world_ = nullptr;
  std::unique_ptr<StepLog> log_;
  std::unique_ptr<RemoteSite> remote_;
  std::unique_ptr<SimulatedDevice> device_;
  std::unique_ptr<Site> site_;
  ObjectChoice choice_;
  btRigidBody* body_ = nullptr;
  std::vector<const void*> leave_alone_;  ///< bodies that were present when the object left
  HostTime time_, site_time_;
  std::uint64_t steps_ = 0, seen_steps_ = 0;
  std::uint32_t reported_status_ = 0;
  std::uint64_t last_ticks_ = 0;  ///< of the stay that ended last
  bool is_in_step_ = false, has_left_ = false, is_waiting_told_ = false, has_given_up_ = false;
  bool is_leaving_told_ = true;  ///< false: the object left after the last step
};

}  // namespace tandem::preload
