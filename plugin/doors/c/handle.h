#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

#include "c/guard.h"

// A handle is a small shell around the object. Shells are reused and never freed, the longest
// unused first. A destroyed handle is thus recognised for a while, without reading freed memory.

namespace tandem::c_door {

/// First member of every handle; tells the kinds apart.
struct HandleHead {
  std::uint32_t kind = 0;  ///< 0: empty
  int users = 0;           ///< number of handles that need this one
};

/// `Thing` names itself: kKind, a number of its own; kName, "world"; kUser, "a site".
template <typename Thing>
struct Handle {
  HandleHead head;
  std::unique_ptr<Thing> thing;
  Handle* next = nullptr;  ///< shell that was discarded after this one
};

/// Throws std::invalid_argument unless `handle` is a live handle of this kind.
template <typename Thing>
[[nodiscard]] Thing& open(const Handle<Thing>* handle) {
  if (!handle)
    throw std::invalid_argument(std::string("the ") + Thing::kName + " is null; create one first");
  if (handle->head.kind != Thing::kKind)
    throw std::invalid_argument(std::string("the ") + Thing::kName +
                                " is none, or has been destroyed already");
  return *handle->thing;
}

/// All handles of one kind.
template <typename Shell>
class Shells {
 public:
  using Thing = typename decltype(Shell::thing)::element_type;

  /// Never destroyed, because handles may be open when the process ends.
  static Shells& all() {
    static Shells& shells = *new Shells;
    return shells;
  }

  [[nodiscard]] Shell* wrap(std::unique_ptr<Thing> thing) {
    const std::lock_guard lock(mutex_);
    Shell* shell = takeBack();
    if (!shell) shell = &shells_.emplace_back();
    shell->thing = std::move(thing);
    shell->head = {Thing::kKind, 0};
    return shell;
  }

  /// Ignores null. Throws as open(), and TANDEM_IN_USE.
  void destroy(Shell* shell) {
    if (!shell) return;
    (void)open(shell);
    if (shell->head.users > 0)
      throw Refusal(TANDEM_IN_USE, std::string("the ") + Thing::kName + " is used by " +
                                       Thing::kUser + "; destroy that first");
    discard(*shell);
  }

  /// Destroys the object even if it is in use.
  void discard(Shell& shell) noexcept {
    shell.head = {};
    shell.thing.reset();
    const std::lock_guard lock(mutex_);
    shell.next = nullptr;
    (last_ ? last_->next : first_) = &shell;
    last_ = &shell;
    ++free_;
  }

 private:
  static constexpr std::size_t kKnownAsGone = 256;

  /// Returns the oldest discarded shell, or null if too few are discarded.
  Shell* takeBack() noexcept {
    if (free_ <= kKnownAsGone) return nullptr;
    auto* shell = static_cast<Shell*>(first_);
    first_ = first_->next;
    --free_;
    return shell;
  }

  std::mutex mutex_;
  std::deque<Shell> shells_;
  Handle<Thing>*first_ = nullptr, *last_ = nullptr;  ///< list of discarded shells
  std::size_t free_ = 0;
};

/// Counts as a user of a handle during its lifetime.
class Use {
 public:
  Use() = default;
  explicit Use(HandleHead& head) noexcept : head_(&head) { ++head.users; }
  ~Use() {
    if (head_) --head_->users;
  }
  Use(Use&& other) noexcept : head_(std::exchange(other.head_, nullptr)) {}
  Use& operator=(Use&& other) noexcept {
    std::swap(head_, other.head_);
    return *this;
  }
  Use(const Use&) = delete;
  Use& operator=(const Use&) = delete;

 private:
  HandleHead* head_ = nullptr;
};

}  // namespace tandem::c_door
