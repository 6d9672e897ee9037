#include <algorithm>
#include <cmath>

#include "c/site.h"
#include "c/values.h"

namespace tandem::c_door {
namespace {

static_assert(TANDEM_STATUS_DEVICE_INVALID == static_cast<int>(kDeviceInvalid));
static_assert(TANDEM_STATUS_BODY_MISSING == static_cast<int>(kBodyMissing));
static_assert(TANDEM_STATUS_PACKET_REFUSED == static_cast<int>(kPacketRefused));
static_assert(TANDEM_STATUS_HOST_STEP_WRONG == static_cast<int>(kHostStepWrong));
static_assert(TANDEM_STATUS_STATE_NOT_FINITE == static_cast<int>(kStateNotFinite));
static_assert(TANDEM_STATUS_WORLD_GONE == static_cast<int>(kWorldGone));
static_assert(TANDEM_STATUS_OUT_OF_RANGE == static_cast<int>(kOutOfRange));

static_assert(TANDEM_LINK_WAITING == static_cast<int>(LinkState::kWaiting));
static_assert(TANDEM_LINK_LIVE == static_cast<int>(LinkState::kLive));
static_assert(TANDEM_LINK_STALE == static_cast<int>(LinkState::kStale));
static_assert(TANDEM_LINK_FADING == static_cast<int>(LinkState::kFading));
static_assert(TANDEM_LINK_LOST == static_cast<int>(LinkState::kLost));
static_assert(TANDEM_LINK_REJOINING == static_cast<int>(LinkState::kRejoining));

[[nodiscard]] TandemReading readSite(const Site& site) noexcept {
  TandemReading reading{};
  writeVec3(site.force(), reading.force);
  writeVec3(site.torque(), reading.torque);
  writeVec3(site.hip().p_W, reading.hip);
  writeVec3(site.hip().v_W, reading.hip_velocity);
  reading.ticks = site.tickCount();
  reading.status = site.status();
  reading.state_hash = site.stateHash();
  reading.packets_sent = site.counters().packets_sent;
  reading.packets_taken = site.counters().packets_taken;
  reading.object_count = static_cast<std::size_t>(site.objectCount());
  reading.remote_count = static_cast<std::size_t>(site.remoteCount());
  return reading;
}

[[nodiscard]] TandemGrip readGrip(const Site& site) noexcept {
  TandemGrip read{};
  read.object = TANDEM_NO_OBJECT;
  const std::optional<Grip> grip = site.grip();
  if (!grip) return read;
  read.object = grip->object;
  read.is_fading = grip->is_fading;
  writeVec3(grip->p_BG, read.at);
  writeVec3(grip->force_W, read.force);
  writeVec3(grip->torque_W, read.torque);
  return read;
}

/// State of a remote without proxy: NAN.
[[nodiscard]] TandemState makeNoState() noexcept {
  TandemState state;
  for (double& value : state.position) value = std::nan("");
  for (double& value : state.orientation) value = std::nan("");
  for (double& value : state.velocity) value = std::nan("");
  for (double& value : state.angular_velocity) value = std::nan("");
  return state;
}

void readObjects(const Site& site, std::size_t room, TandemState* objects) noexcept {
  const std::size_t count = std::min(room, static_cast<std::size_t>(site.objectCount()));
  for (std::size_t i = 0; i < count; ++i)
    objects[i] = c_door::toC(site.object(static_cast<ObjectId>(i)));
}

void readRemotes(const Site& site, std::size_t room, TandemState* proxies,
                 TandemLinkState* links) noexcept {
  const int count = static_cast<int>(std::min(room, static_cast<std::size_t>(site.remoteCount())));
  for (int i = 0; i < count; ++i) {
    const RigidState* proxy = site.proxy(i);
    if (proxies) proxies[i] = proxy ? c_door::toC(*proxy) : makeNoState();
    if (links) links[i] = static_cast<TandemLinkState>(site.linkState(i));
  }
}

}  // namespace
}  // namespace tandem::c_door

using namespace tandem;          // NOLINT: the functions of the header are in no namespace
using namespace tandem::c_door;  // NOLINT

extern "C" {

TandemResult tandem_site_create(const TandemSiteSettings* settings, TandemWorld* world,
                                TandemDevice* device, TandemSite** site) {
  return guarded([&] {
    auto& out = checkPointer(site, "site");
    const SiteSettings read = c_door::fromC(checkPointer(settings, "settings"));
    (void)open(world);
    (void)open(device);
    if (device->head.users > 0)
      throw Refusal(TANDEM_IN_USE, "the device belongs to another site; make one for each");
    out = Shells<TandemSite>::all().wrap(std::make_unique<SiteEnd>(read, *world, *device));
  });
}

TandemResult tandem_site_destroy(TandemSite* site) {
  return guarded([&] { Shells<TandemSite>::all().destroy(site); });
}

TandemResult tandem_site_share(TandemSite* site, TandemBody body, double damping,
                               uint32_t* object) {
  return guarded([&] {
    SiteEnd& of = open(site);
    const ObjectId id = of.share(body, damping);
    if (object) *object = id;
  });
}

TandemResult tandem_site_share_tool(TandemSite* site, TandemBody body, uint32_t user,
                                    const double at[3], uint32_t* object) {
  return guarded([&] {
    SiteEnd& of = open(site);
    const ObjectId id = of.shareTool(body, user, readVec3OrZero("at", at));
    if (object) *object = id;
  });
}

TandemResult tandem_site_unshare(TandemSite* site, uint32_t object) {
  return guarded([&] { open(site).unshare(object); });
}

TandemResult tandem_site_share_again(TandemSite* site, uint32_t object, TandemBody body) {
  return guarded([&] { open(site).shareAgain(object, body); });
}

TandemResult tandem_site_shift_origin(TandemSite* site, const double offset[3]) {
  return guarded([&] { open(site).shiftOrigin(readVec3("offset", offset)); });
}

TandemResult tandem_site_grab(TandemSite* site, uint32_t object, const double at[3]) {
  return guarded([&] {
    SiteEnd& of = open(site);
    of.grab(object, at ? std::optional(readVec3("at", at)) : std::nullopt);
  });
}

TandemResult tandem_site_release(TandemSite* site) {
  return guarded([&] { open(site).release(); });
}

TandemResult tandem_site_read_grip(TandemSite* site, TandemGrip* grip) {
  return guarded([&] {
    Site& of = open(site).site();
    auto& out = checkPointer(grip, "grip");
    of.betweenTicks([&] { out = readGrip(of); });
  });
}

TandemResult tandem_site_object_state(const TandemSite* site, uint32_t object,
                                      TandemObjectState* state) {
  return guarded([&] {
    const SiteEnd& of = open(site);
    checkPointer(state, "state") = of.objectState(object);
  });
}

TandemResult tandem_site_connect(TandemSite* site, uint32_t peer, TandemLink* link,
                                 const double start[3], TandemBody* proxy) {
  return guarded([&] {
    SiteEnd& of = open(site);
    (void)open(link);
    const TandemBody made = of.connect(peer, *link, readVec3("start", start));
    if (proxy) *proxy = made;
  });
}

TandemResult tandem_site_tick(TandemSite* site, double now, uint32_t* status) {
  return guarded([&] {
    const std::uint32_t bits = open(site).tick(now);
    if (status) *status = bits;
  });
}

TandemResult tandem_site_start_loop(TandemSite* site, int priority) {
  return guarded([&] { open(site).startLoop(priority); });
}

TandemResult tandem_site_stop_loop(TandemSite* site) {
  return guarded([&] { open(site).stopLoop(); });
}

TandemResult tandem_site_read(TandemSite* site, TandemReading* reading, size_t object_room,
                              TandemState* objects, size_t remote_room, TandemState* proxies,
                              TandemLinkState* links) {
  return guarded([&] {
    Site& of = open(site).site();
    of.betweenTicks([&] {
      if (reading) *reading = readSite(of);
      if (objects) readObjects(of, object_room, objects);
      readRemotes(of, remote_room, proxies, links);
    });
  });
}

TandemResult tandem_site_warnings(const TandemSite* site, char* text, size_t room, size_t* length) {
  return guarded([&] { writeLines(open(site).warnings(), text, room, length); });
}

}  // extern "C"
