#include "relay/members.h"

#include <algorithm>

#include "net/random.h"

namespace tandem::relay {
namespace {

/// A session's number has the place in its low half. The high half is drawn, so that a place's
/// earlier sessions are told from the present one.
constexpr std::uint32_t kPlaceMask = 0xffff;

}  // namespace

Members::Members(std::size_t rooms, std::size_t members_per_room)
    : per_room_(members_per_room), rooms_(rooms), members_(rooms * members_per_room) {
  for (std::size_t i = 0; i < rooms_.size(); ++i) rooms_[i].number = static_cast<std::uint16_t>(i);
  for (std::size_t i = 0; i < members_.size(); ++i)
    members_[i].place = static_cast<std::uint16_t>(i);
}

Member* Members::find(std::uint32_t session) noexcept {
  const std::size_t place = session & kPlaceMask;
  if (session == 0 || place >= members_.size()) return nullptr;
  Member& member = members_[place];
  return member.session == session ? &member : nullptr;
}

Member* Members::find(const Room& room, std::uint16_t id) noexcept {
  return room.present.has(PeerId{id}) ? &members_[room.place[id]] : nullptr;
}

Room* Members::find(const RoomName& name) noexcept {
  const auto found = std::find_if(rooms_.begin(), rooms_.end(), [&](const Room& room) {
    return room.count > 0 && room.name == name;
  });
  return found == rooms_.end() ? nullptr : &*found;
}

Room* Members::openRoom(const RoomName& name) noexcept {
  const auto found =
      std::find_if(rooms_.begin(), rooms_.end(), [](const Room& room) { return room.count == 0; });
  if (found == rooms_.end()) return nullptr;
  const std::uint16_t number = found->number;
  *found = Room{};
  found->number = number;
  found->name = name;
  return &*found;
}

Member* Members::add(Room& room, std::uint16_t id, bool is_watcher) noexcept {
  const auto first = members_.begin() + static_cast<std::ptrdiff_t>(room.number * per_room_);
  const auto last = first + static_cast<std::ptrdiff_t>(per_room_);
  const auto free =
      std::find_if(first, last, [](const Member& member) { return member.session == 0; });
  if (free == last) return nullptr;
  const std::uint16_t place = free->place;
  room.place[id] = place;
  room.present.add(PeerId{id});
  ++room.count;
  if (is_watcher) ++room.watchers;
  ++count_;
  *free = Member{};
  free->place = place;
  free->id = id;
  free->is_watcher = is_watcher;
  free->room = room.number;
  free->session = std::uint32_t{net::drawNumber<std::uint16_t>()} << 16U | place;
  return &*free;
}

void Members::remove(Member& member) noexcept {
  Room& room = roomOf(member);
  room.present.remove(PeerId{member.id});
  --room.count;
  if (member.is_watcher) --room.watchers;
  --count_;
  member.session = 0;
  sodium_memzero(member.key.data(), member.key.size());
}

}  // namespace tandem::relay
