#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "tandem/coordination/site_set.h"

#include "coordination/src/wire/replay_window.h"
#include "net/paths.h"
#include "net/retry.h"
#include "relay/relay_tags.h"

namespace tandem::relay {

/// One member of a room, and its session.
struct Member {
  std::uint32_t session = 0;  ///< 0: nobody has this place
  std::uint16_t place = 0;    ///< among all members
  std::uint16_t id = 0;
  std::uint16_t room = 0;
  bool is_watcher = false;
  std::uint64_t nonce = 0;  ///< of its JOIN
  SessionKey key{};
  ReplayWindow window;
  std::uint64_t newest = 0;        ///< highest sequence so far
  net::Paths paths{std::nullopt};  ///< where it is
  double heard_at = 0.0;           ///< last datagram that was authentic and new [s]
  net::RateLimit datagrams{0.0, 0.0}, bytes{0.0, 0.0};
};

/// One room. It is in use while it has members.
struct Room {
  std::uint16_t number = 0;
  RoomName name{};
  std::uint16_t count = 0, watchers = 0;
  SiteSet present;
  std::array<std::uint16_t, kMostMembers + 1> place{};  ///< of a member, by its id
  std::uint64_t forwarded = 0, forwarded_bytes = 0, too_many = 0;
};

/// All places of all rooms, made once.
class Members {
 public:
  Members(std::size_t rooms, std::size_t members_per_room);

  /// The member with this session; null for an unknown one.
  [[nodiscard]] Member* find(std::uint32_t session) noexcept;
  /// The member of a room with this id; null if it is not there.
  [[nodiscard]] Member* find(const Room& room, std::uint16_t id) noexcept;
  /// The room with this name; null if nobody is there.
  [[nodiscard]] Room* find(const RoomName& name) noexcept;
  [[nodiscard]] Room& roomOf(const Member& member) noexcept { return rooms_[member.room]; }

  /// A room that nobody uses, with this name; null if there is none.
  [[nodiscard]] Room* openRoom(const RoomName& name) noexcept;
  /// A free place in the room for this id, with a session of its own; null if the room is full.
  [[nodiscard]] Member* add(Room& room, std::uint16_t id, bool is_watcher) noexcept;
  void remove(Member& member) noexcept;

  [[nodiscard]] std::vector<Member>& all() noexcept { return members_; }
  [[nodiscard]] const std::vector<Room>& rooms() const noexcept { return rooms_; }
  [[nodiscard]] std::size_t count() const noexcept { return count_; }

 private:
  std::size_t per_room_;
  std::vector<Room> rooms_;
  std::vector<Member> members_;  ///< of room r from r * per_room_ on
  std::size_t count_ = 0;
};

}  // namespace tandem::relay
