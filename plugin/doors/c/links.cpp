#include <cmath>
#include <stdexcept>

#include "tandem/coordination/simulated_link.h"

#include "c/link.h"
#include "c/values.h"

namespace tandem::c_door {
namespace {

static_assert(TANDEM_MAX_OBJECTS_PER_PACKET == kMaxObjectsPerPacket);

[[nodiscard]] TandemLink* wrap(std::unique_ptr<Link> link, ManualLink* manual = nullptr) {
  auto end = std::make_unique<LinkEnd>();
  end->link = link.get();
  end->own = std::move(link);
  end->manual = manual;
  end->is_simulated = !manual;
  return Shells<TandemLink>::all().wrap(std::move(end));
}

[[nodiscard]] ManualLink& openManual(const TandemLink* link) {
  ManualLink* manual = open(link).manual;
  if (!manual)
    throw std::invalid_argument(
        "packets are pushed and popped by hand on links of tandem_link_create_manual(); make one");
  return *manual;
}

/// Copies without checks: the site drops and counts invalid states.
[[nodiscard]] RigidState fromPacket(const TandemState& state) noexcept {
  RigidState read;
  const double *p = state.position, *q = state.orientation, *v = state.velocity,
               *w = state.angular_velocity;
  read.p_W = {p[0], p[1], p[2]};
  read.q_WB = Quat(q[3], q[0], q[1], q[2]);
  read.v_W = {v[0], v[1], v[2]};
  read.w_W = {w[0], w[1], w[2]};
  return read;
}

[[nodiscard]] StatePacket readPacket(const TandemPacket& packet) noexcept {
  StatePacket read;
  read.sender = PeerId{packet.sender};
  read.sequence = packet.sequence;
  read.time = packet.time;
  read.user = {{packet.position[0], packet.position[1], packet.position[2]},
               {packet.velocity[0], packet.velocity[1], packet.velocity[2]}};
  read.is_idle = packet.is_idle != 0;
  if (!std::isnan(packet.energy_granted))
    read.energy = {packet.energy_granted, packet.energy_holdings};
  read.object_count = static_cast<std::uint32_t>(packet.object_count);
  for (std::uint32_t i = 0; i < read.object_count; ++i)
    read.objects[i] = {packet.object_ids[i],
                       fromPacket(packet.objects[i]),
                       {packet.object_epochs[i], PeerId{packet.object_epoch_authors[i]}}};
  if (packet.has_grip) {
    GripState& grip = read.grip.emplace();
    const double *p = packet.grip_position, *q = packet.grip_orientation;
    grip.epoch = static_cast<std::uint16_t>(packet.grip_epoch);
    if (packet.grip_object != TANDEM_NO_OBJECT) grip.object = packet.grip_object;
    grip.p_BG = {p[0], p[1], p[2]};
    grip.q_BG = Quat(q[3], q[0], q[1], q[2]);
    grip.age = packet.grip_age;
  }
  if (packet.roll_heard != 0)
    read.roll = RollCall{SiteSet(packet.roll_heard), SiteSet(packet.roll_members), packet.roll_age};
  return read;
}

[[nodiscard]] TandemPacket writePacket(const StatePacket& packet) noexcept {
  TandemPacket written{};
  written.sender = static_cast<std::uint32_t>(packet.sender);
  written.sequence = packet.sequence;
  written.time = packet.time;
  writeVec3(packet.user.p_W, written.position);
  writeVec3(packet.user.v_W, written.velocity);
  written.is_idle = packet.is_idle;
  written.energy_granted = packet.energy ? packet.energy->granted : std::nan("");
  written.energy_holdings = packet.energy ? packet.energy->holdings : std::nan("");
  written.object_count = packet.object_count;
  for (std::uint32_t i = 0; i < packet.object_count; ++i) {
    written.object_ids[i] = packet.objects[i].id;
    written.objects[i] = c_door::toC(packet.objects[i].state);
    written.object_epochs[i] = packet.objects[i].epoch.count;
    written.object_epoch_authors[i] = static_cast<std::uint32_t>(packet.objects[i].epoch.author);
  }
  if (packet.roll) {
    written.roll_heard = packet.roll->heard.bits();
    written.roll_members = packet.roll->members.bits();
    written.roll_age = packet.roll->age;
  }
  if (!packet.grip) return written;
  written.has_grip = 1;
  written.grip_epoch = packet.grip->epoch;
  written.grip_object = packet.grip->object.value_or(TANDEM_NO_OBJECT);
  writeVec3(packet.grip->p_BG, written.grip_position);
  for (int i = 0; i < 4; ++i) written.grip_orientation[i] = packet.grip->q_BG.coeffs()[i];
  written.grip_age = packet.grip->age;
  return written;
}

}  // namespace

std::optional<Arrival> ManualLink::receive(double from, double) noexcept {
  const StatePacket* packet = arrivals_.peek();
  if (!packet) return std::nullopt;
  Arrival arrival{*packet, from};
  arrivals_.drop();
  return arrival;
}

}  // namespace tandem::c_door

using namespace tandem;          // NOLINT: the functions of the header are in no namespace
using namespace tandem::c_door;  // NOLINT

extern "C" {

TandemResult tandem_link_create_simulated(const TandemNetwork* network, TandemLink** first,
                                          TandemLink** second) {
  return guarded([&] {
    const TandemNetwork& n = checkPointer(network, "network");
    auto& first_out = checkPointer(first, "first");
    auto& second_out = checkPointer(second, "second");
    if (first == second)
      throw std::invalid_argument("first and second are one place; give each end its own");
    auto ends = makeSimulatedLinks({n.delay, n.jitter, n.loss, n.duplicate, n.reorder, n.seed});
    TandemLink* made = wrap(std::move(ends.first));
    try {
      second_out = wrap(std::move(ends.second));
    } catch (...) {
      Shells<TandemLink>::all().discard(*made);
      throw;
    }
    first_out = made;
  });
}

TandemResult tandem_link_create_manual(TandemLink** link) {
  return guarded([&] {
    auto& out = checkPointer(link, "link");
    auto manual = std::make_unique<ManualLink>();
    ManualLink* kept = manual.get();
    out = wrap(std::move(manual), kept);
  });
}

TandemResult tandem_link_push(TandemLink* link, const TandemPacket* packet) {
  return guarded([&] {
    ManualLink& manual = openManual(link);
    const TandemPacket& pushed = checkPointer(packet, "packet");
    if (pushed.object_count > TANDEM_MAX_OBJECTS_PER_PACKET)
      refuseValue("object_count", static_cast<double>(pushed.object_count),
                  "at most TANDEM_MAX_OBJECTS_PER_PACKET");
    (void)manual.push(readPacket(pushed));
  });
}

TandemResult tandem_link_pop(TandemLink* link, TandemPacket* packet, int* there) {
  return guarded([&] {
    ManualLink& manual = openManual(link);
    auto& out = checkPointer(packet, "packet");
    auto& is_there = checkPointer(there, "there");
    const StatePacket* next = manual.peek();
    is_there = next != nullptr;
    if (!next) return;
    out = writePacket(*next);
    manual.drop();
  });
}

TandemResult tandem_link_destroy(TandemLink* link) {
  return guarded([&] {
    if (link && !open(link).own)
      throw Refusal(TANDEM_IN_USE, "the link belongs to its mesh; destroy that");
    Shells<TandemLink>::all().destroy(link);
  });
}

}  // extern "C"
