#include "bench/guest/guest_shaken.h"

#include <algorithm>

#include "tandem/bullet_bridge/convert.h"

#include "bench/guest/guest_energy.h"
#include "bench/guest/guest_world.h"

namespace tandem::demos::bench {
namespace {

constexpr std::uint64_t kTwins = 16;
constexpr double kShake = 0.01;      // [m/s]
constexpr double kHalfFall = 4.905;  // half of gravity [m/s^2]

void doAll(const std::vector<GuestFrame::Deed>& deeds, GuestWorld& world) {
  for (const GuestFrame::Deed& deed : deeds) deed(world);
}

/// The island lets bodies fall as nature does. Bullet's are ahead by half of a step's gravity.
double shakeOf(const GuestCase& one) { return kShake + kHalfFall * one.step(); }

void shake(GuestWorld& world, double most, Draw& draw) {
  for (const auto& body : world.bodies()) {
    const auto one = [&] { return static_cast<btScalar>(draw.even(-most, most)); };
    const btScalar x = one(), y = one(), z = one();
    if (!isMoving(*body)) continue;
    btRigidBody& rigid = *body->rigid;
    rigid.setLinearVelocity(rigid.getLinearVelocity() +
                            btVector3(x, y, z) * rigid.getLinearFactor());
  }
}

}  // namespace

ShakenTwin::ShakenTwin(const GuestCase& one, std::uint64_t number) {
  Draw draw(one.seed ^ 0x7368616b656eU, one.index * kTwins + number);
  for (int i = 0; i < one.sites; ++i) {
    worlds_.push_back(std::make_unique<GuestWorld>(one));
    shake(*worlds_.back(), shakeOf(one), draw);
    energy_ += energyOf(*worlds_.back());
    has_fallen_.emplace_back(one.bodies.size(), char{0});
  }
}

ShakenTwin::~ShakenTwin() = default;

void ShakenTwin::advance(const std::vector<const GuestJournal*>& journals, std::size_t end) {
  for (; next_ < end; ++next_) {
    for (std::size_t i = 0; i < worlds_.size(); ++i)
      doAll((*journals[i])[next_].before, *worlds_[i]);
    look();
    for (std::size_t i = 0; i < worlds_.size(); ++i) {
      const GuestFrame& frame = (*journals[i])[next_];
      worlds_[i]->step(frame.time, [&] { doAll(frame.within, *worlds_[i]); });
      doAll(frame.after, *worlds_[i]);
    }
    look();
  }
}

void ShakenTwin::look() {
  double energy = 0.0;
  for (std::size_t i = 0; i < worlds_.size(); ++i) {
    const GuestWorld& world = *worlds_[i];
    energy += energyOf(world);
    for (std::size_t b = 0; b < world.bodies().size(); ++b)
      if (isBelowAll(world, *world.bodies()[b])) has_fallen_[i][b] = 1;
  }
  gained_ += std::max(0.0, energy - energy_);
  energy_ = energy;
}

void ShakenTwins::advance(const std::vector<const GuestJournal*>& journals) {
  if (twins_.empty())
    for (std::uint64_t number = 0; number < kTwins; ++number)
      twins_.push_back(std::make_unique<ShakenTwin>(case_, number));
  for (const auto& twin : twins_) twin->advance(journals, journals.front()->size());
}

double ShakenTwins::mostGained() const {
  double most = 0.0;
  for (const auto& twin : twins_) most = std::max(most, twin->gained());
  return most;
}

bool ShakenTwins::hasFallen(std::size_t site, std::size_t body) const {
  return std::any_of(twins_.begin(), twins_.end(),
                     [&](const auto& twin) { return twin->hasFallen(site, body); });
}

}  // namespace tandem::demos::bench
