#pragma once

#include <algorithm>
#include <vector>

#include "bullet_bridge/src/bodies/momentum.h"
#include "site/moments.h"

namespace tandem {

/// Forces that a body of the island is expected to get from Bullet's contacts and joints.
///
/// Bullet solves them once per host step, with impulses that the island learns of at the end. If it
/// only got these, it would fall onto its support anew in each step. So what lasted for two steps
/// goes on as a force, and the next impulses of the solver correct it. Half of an impulse comes at
/// once: Bullet's come at the end of a step, when the fall of half a step has to be caught. For the
/// thread that ticks; real-time safe but makeRoom().
class Foresight {
 public:
  /// Allocates.
  void makeRoom() { parts_.reserve(kMostParts); }

  /// Takes the solver's impulses `reaction` over a host step of `dt` [s]: a new force from `now`
  /// [s] on. Returns what the body gets at once.
  [[nodiscard]] Momentum expect(double now, double dt, const Momentum& reaction) noexcept {
    const Momentum lasting{
        computeLastingShare(reaction.linear_W, last_.linear_W) * reaction.linear_W,
        computeLastingShare(reaction.angular_W, last_.angular_W) * reaction.angular_W};
    last_ = reaction;
    if (lasting.isZero() && isNone()) return {};
    const Momentum kick{0.5 * lasting.linear_W, 0.5 * lasting.angular_W};
    add({now, kick, lasting.linear_W / dt, lasting.angular_W / dt});
    return kick;
  }
  /// Expects nothing any more.
  void end(double now) noexcept {
    last_ = {};
    if (!isNone()) add({now, {}, Vec3::Zero(), Vec3::Zero()});
  }

  /// Expects nothing any more, and takes nothing back of what it gave: the host has set the body's
  /// motion anew.
  void forget() noexcept {
    last_ = {};
    parts_.clear();
  }

  [[nodiscard]] bool isNone() const noexcept {
    return force() == Vec3::Zero() && torque() == Vec3::Zero();
  }
  [[nodiscard]] Vec3 force() const noexcept {
    return parts_.empty() ? Vec3(Vec3::Zero()) : parts_.back().f_W;
  }
  [[nodiscard]] Vec3 torque() const noexcept {
    return parts_.empty() ? Vec3(Vec3::Zero()) : parts_.back().t_W;
  }

  /// Momentum given in a host step.
  struct Given {
    Momentum sum;   ///< at its end
    Momentum mean;  ///< over it: the body was led by this
  };
  /// Momentum given between two times [s]. Forgets what was given before the first.
  [[nodiscard]] Given take(double from, double to) noexcept {
    Given given;
    const auto give = [&](const Vec3& linear_W, const Vec3& angular_W, double at) {
      const double share = (to - at) / (to - from);
      given.sum.linear_W += linear_W;
      given.sum.angular_W += angular_W;
      given.mean.linear_W += share * linear_W;
      given.mean.angular_W += share * angular_W;
    };
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      Part& part = parts_[i];
      if (part.from < to - kSameTime) {
        give(part.kick.linear_W, part.kick.angular_W, std::max(part.from, from));
        part.kick = {};
      }
      const double end = i + 1 < parts_.size() ? std::min(parts_[i + 1].from, to) : to;
      const double start = std::max(part.from, from);
      const double duration = end - start;
      if (duration > 0.0) give(duration * part.f_W, duration * part.t_W, 0.5 * (start + end));
    }
    while (parts_.size() > 1 && parts_[1].from <= from) parts_.erase(parts_.begin());
    if (parts_.size() == 1 && isNone()) parts_.clear();
    return given;
  }

 private:
  static constexpr std::size_t kMostParts = 64;
  /// An impulse at a time, and a force from then on, up to the next part.
  struct Part {
    double from = 0.0;  ///< [s]
    Momentum kick;
    Vec3 f_W, t_W;  ///< [N, N m]
  };

  void add(const Part& part) noexcept {
    if (!parts_.empty() && parts_.size() == parts_.capacity()) parts_.erase(parts_.begin());
    if (parts_.size() < parts_.capacity()) parts_.push_back(part);
  }

  std::vector<Part> parts_;
  Momentum last_;
};

/// Force by which strangers press a body onto its supports. Bullet's view of the supports resists
/// with as much, so the body's motion does not show it. The island needs it for friction, and for
/// what the supports stand on.
struct PressForce {
  Vec3 f_W = Vec3::Zero(), t_W = Vec3::Zero();  ///< [N, N m]

  /// Takes what lasts of the supports' impulses over a host step of `dt` [s].
  void expect(double dt, const Momentum& lasting) noexcept {
    f_W = -lasting.linear_W / dt;
    t_W = -lasting.angular_W / dt;
  }
  [[nodiscard]] bool isNone() const noexcept { return f_W.isZero(0.0) && t_W.isZero(0.0); }
};

}  // namespace tandem
