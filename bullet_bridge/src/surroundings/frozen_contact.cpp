#include "surroundings/frozen_contact.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tandem {
namespace {

/// Normals that differ less are one [rad]. A float Bullet rounds to 1e-6.
constexpr double kSameNormal = 1e-5, kBallNormal = 1e-3;
/// Coordinates and corners nearer than this are the same [m]: beyond the rounding of a float
/// Bullet.
constexpr double kSamePlace = 1e-6;

/// Bullet reports no point of two boxes beyond both skins: others may come as near as this part.
constexpr double kPartOfSkins = 0.8;
/// Corners left out may lose this part of their height.
constexpr double kPartOfHeight = 0.9;
/// A corner that Bullet may still add to fewer than four must be higher than this [m].
constexpr double kFree = 1e-5;
/// Corners that Bullet leaves out beside four others may sink this far below these [m].
constexpr double kRedundant = 1e-6;
/// Greatest way along the normal [m]: points beyond 1 mm are left out by ContactPair.
constexpr double kMostApproach = 5e-4;
/// Greatest tilt of a part [rad].
constexpr double kMostTilt = 1e-3;
/// Greatest way of a box along a box's face [m]: Bullet reports four points, and others may be left
/// out that take their place.
constexpr double kMostSlide = 1e-4;
/// A corner may leave the face by this [m].
constexpr double kMostOutside = 2e-6;
/// Sine of the angle between edges whose crossing is well defined.
constexpr double kLeastSine = 0.1;

/// Moves a coordinate near a side of a box, with skin or without, onto the side. True if it did.
bool snap(double& x, double half, double skin) noexcept {
  const bool is_on_side = std::abs(x) > half + skin - kSamePlace;
  x = is_on_side ? std::copysign(half, x) : std::clamp(x, -half, half);
  return is_on_side;
}

}  // namespace

bool FrozenContact::freeze(const ExactPart& first, const ExactPart& second,
                           const btPersistentManifold& manifold) noexcept {
  const Owner last = owner_;
  drop();
  const int count = manifold.getNumContacts();
  if (count == 0) return false;
  const auto normalOf = [&](int i) { return manifold.getContactPoint(i).m_normalWorldOnB; };
  for (int i = 1; i < count; ++i)
    if (static_cast<double>((normalOf(i) - normalOf(0)).length()) > kSameNormal) return false;
  count_ = count;
  if (!chooseOwner(last, first, second, manifold)) {
    drop();
    return false;
  }
  const bool is_of_first = owner_ == Owner::kFirst;
  const ExactPart& owner = is_of_first ? first : second;
  const ExactPart& other = is_of_first ? second : first;
  if (findBounds(owner, other) && place(owner, other)) return true;
  drop();
  return false;
}

/// Faces of two boxes may lie on each other. A normal that hops disturbs, so the owner of last time
/// stays. At first it is the one whose face holds all of the other's, as that may slide.
bool FrozenContact::chooseOwner(Owner last, const ExactPart& first, const ExactPart& second,
                                const btPersistentManifold& manifold) noexcept {
  const Owner favourite = last == Owner::kFirst ? Owner::kFirst : Owner::kSecond;
  const Owner another = last == Owner::kFirst ? Owner::kSecond : Owner::kFirst;
  const bool is_one = takeOwner(favourite, first, second, manifold);
  if (is_one && (last != Owner::kNone || hasWholeFace())) return true;
  if (takeOwner(another, first, second, manifold) && (!is_one || hasWholeFace())) return true;
  return is_one && takeOwner(favourite, first, second, manifold);
}

/// Describes the points as corners on a face of that part. False if they are none.
bool FrozenContact::takeOwner(Owner its, const ExactPart& first, const ExactPart& second,
                              const btPersistentManifold& manifold) noexcept {
  const bool is_of_first = its == Owner::kFirst;
  const ExactPart& owner = is_of_first ? first : second;
  const ExactPart& other = is_of_first ? second : first;
  const Vec3 normal = fromBullet(manifold.getContactPoint(0).m_normalWorldOnB).normalized();
  // Bullet's normal under a ball is off by 1e-4 in float. Over a face it is the face's.
  const double tolerance = other.is(SPHERE_SHAPE_PROXYTYPE) ? kBallNormal : kSameNormal;
  const Vec3 outward = owner.axes.transpose() * (is_of_first ? Vec3(-normal) : normal);
  if (!owner.findFace(outward, tolerance, face_)) return false;
  owner_ = its;
  rounding_ = other.rounding();
  up_at_search_ = other.axes.transpose() * (owner.axes * face_.normal);
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    const btManifoldPoint& point = manifold.getContactPoint(i);
    const btVector3& local = is_of_first ? point.m_localPointB : point.m_localPointA;
    const Vec3 p = fromBullet(other.in_object ? other.in_object->invXform(local) : local);
    if (!takeCorner(owner, other, p, corners_[static_cast<std::size_t>(i)])) return false;
  }
  return true;
}

/// Takes a point of the other part's surface as the corner or crossing that it is.
bool FrozenContact::takeCorner(const ExactPart& owner, const ExactPart& other, const Vec3& p,
                               Corner& corner) const noexcept {
  corner = {};
  corner.p = p;
  if (other.is(BOX_SHAPE_PROXYTYPE)) {
    std::array<int, 3> free{};
    std::size_t free_count = 0;
    for (int k = 0; k < 3; ++k)
      if (!snap(corner.p[k], other.half[k], other.skin)) free[free_count++] = k;
    if (free_count == 3) return false;
    corner.free = {free[0], free[1]};
    corner.free_count = static_cast<int>(free_count);
    corner.is_of_other = free_count == 0;
    if (free_count > 0) takeCrossing(owner, other, p, corner);
  } else {
    // Bullet looks for further corners in tilted directions, and so puts them too high.
    const Vec3 core = p + rounding_ * up_at_search_;
    double least = HUGE_VAL;
    const bool has_corners = other.visitCorners([&](const Vec3& one) {
      const double way = (one - core).squaredNorm();
      if (way < least) least = way, corner.p = one;
    });
    if (!has_corners) return false;
  }
  corner.at_search = owner.axes.transpose() * (other.axes * corner.p + other.p - owner.p);
  return true;
}

/// Finds the sides of the owner's face on which a point lies that is no corner of the other part.
/// If it is on none, or the crossing is unclear, the point goes with the other part.
void FrozenContact::takeCrossing(const ExactPart& owner, const ExactPart& other, const Vec3& p,
                                 Corner& corner) const noexcept {
  const Eigen::Matrix3d in_owner = owner.axes.transpose() * other.axes;
  const Vec3 p_in_owner = owner.axes.transpose() * (other.p - owner.p);
  Vec3 on_face = in_owner * p + p_in_owner;
  std::array<int, 2> sides{};
  std::size_t side_count = 0;
  for (int k = 0; k < 3 && owner.is(BOX_SHAPE_PROXYTYPE); ++k)
    if (face_.normal[k] == 0.0 && snap(on_face[k], owner.half[k], owner.skin))
      sides[side_count++] = k;
  const int free_count = std::exchange(corner.free_count, 0);
  corner.at_search = on_face;
  corner.held = sides;
  if (free_count == 1) {
    const auto sine = [&](int side) { return std::abs(in_owner(side, corner.free[0])); };
    if (side_count == 2 && sine(sides[1]) > sine(sides[0]))
      std::swap(corner.held[0], corner.held[1]);
    if (side_count == 0 || sine(corner.held[0]) < kLeastSine) return;
  } else {
    if (side_count < 2) return;
    // A face on a face; on an edge the other's free directions would not span the face.
    const double area = in_owner(sides[0], corner.free[0]) * in_owner(sides[1], corner.free[1]) -
                        in_owner(sides[0], corner.free[1]) * in_owner(sides[1], corner.free[0]);
    if (std::abs(area) < kLeastSine) return;
  }
  corner.free_count = free_count;
  corner.p = locate(corner, in_owner, p_in_owner);
}

/// The place of a corner in the other's frame.
Vec3 FrozenContact::locate(const Corner& corner, const Eigen::Matrix3d& in_owner,
                           const Vec3& p_in_owner) noexcept {
  Vec3 p = corner.p;
  if (corner.free_count == 0) return p;
  for (int i = 0; i < corner.free_count; ++i) p[corner.free[static_cast<std::size_t>(i)]] = 0.0;
  const Vec3 missing = corner.at_search - in_owner * p - p_in_owner;
  const auto [k, l] = corner.free;
  const auto [m, n] = corner.held;
  if (corner.free_count == 1) {
    p[k] = missing[m] / in_owner(m, k);
    return p;
  }
  const double area = in_owner(m, k) * in_owner(n, l) - in_owner(m, l) * in_owner(n, k);
  p[k] = (missing[m] * in_owner(n, l) - missing[n] * in_owner(m, l)) / area;
  p[l] = (missing[n] * in_owner(m, k) - missing[m] * in_owner(n, k)) / area;
  return p;
}

/// True if the points are the corners of a whole face of the other box: it lies on the owner's, and
/// nothing else can touch until it leaves that.
bool FrozenContact::hasWholeFace() const noexcept {
  if (count_ != 4) return false;
  Vec3 sum = Vec3::Zero(), reach = Vec3::Zero();
  for (const Corner& corner : corners_) {
    if (!corner.is_of_other) return false;
    sum += corner.p;
    reach = reach.cwiseMax(corner.p.cwiseAbs());
  }
  // Along the face they cancel out.
  return (sum.cwiseAbs().array() > reach.array()).count() == 1;
}

/// Finds how far the parts may move before anything that was left out can touch. False: not at all.
bool FrozenContact::findBounds(const ExactPart& owner, const ExactPart& other) noexcept {
  face_half_ = Vec3::Constant(HUGE_VAL);
  most_slide_ = HUGE_VAL;
  most_approach_ = kMostApproach;
  most_sinking_ = HUGE_VAL;
  reach_ = 0.0;
  if (owner.is(BOX_SHAPE_PROXYTYPE)) {
    face_half_ = owner.half.array() + (owner.skin + kMostOutside);
    if (other.is(SPHERE_SHAPE_PROXYTYPE)) return true;
    if (!other.is(BOX_SHAPE_PROXYTYPE)) return false;
    const bool is_whole_face = hasWholeFace();
    most_slide_ = is_whole_face ? HUGE_VAL : kMostSlide;
    if (count_ == MANIFOLD_CACHE_SIZE && !is_whole_face) most_sinking_ = kRedundant;
    most_approach_ = kPartOfSkins * (owner.skin + other.skin);
    reach_ = 2.0 * std::min(owner.half.norm(), other.half.norm());
    return most_approach_ > 0.0;
  }
  // A plane: all corners are known.
  const double above =
      face_.normal.dot(owner.axes.transpose() * (other.p - owner.p)) - face_.offset - rounding_;
  double lowest = HUGE_VAL, farthest = 0.0;
  other.visitCorners([&](const Vec3& p) {
    farthest = std::max(farthest, p.squaredNorm());
    const bool is_kept =
        std::any_of(corners_.begin(), corners_.begin() + count_, [&](const Corner& corner) {
          return (corner.p - p).squaredNorm() < kSamePlace * kSamePlace;
        });
    if (!is_kept) lowest = std::min(lowest, above + up_at_search_.dot(p));
  });
  reach_ = 2.0 * std::sqrt(farthest);
  const bool is_full = count_ == MANIFOLD_CACHE_SIZE;
  most_approach_ = std::clamp(kPartOfHeight * lowest, is_full ? kRedundant : 0.0, kMostApproach);
  return is_full || lowest > kFree;
}

bool FrozenContact::follow(const ExactPart& first, const ExactPart& second) noexcept {
  if (count_ == 0) return false;
  return owner_ == Owner::kFirst ? place(first, second) : place(second, first);
}

bool FrozenContact::place(const ExactPart& owner, const ExactPart& other) noexcept {
  const Eigen::Matrix3d in_owner = owner.axes.transpose() * other.axes;
  const Vec3 p_in_owner = owner.axes.transpose() * (other.p - owner.p);
  const double tilt = (in_owner.transpose() * face_.normal - up_at_search_).norm();
  if (tilt > kMostTilt || tilt * reach_ > most_sinking_) return false;
  slide_ = 0.0;
  for (int i = 0; i < count_; ++i) {
    const Corner& corner = corners_[static_cast<std::size_t>(i)];
    const Vec3 p = in_owner * locate(corner, in_owner, p_in_owner) + p_in_owner;
    const Vec3 way = p - corner.at_search;
    const double rise = face_.normal.dot(way);
    slide_ = std::max(slide_, (way - rise * face_.normal).norm());
    if (std::abs(rise) + tilt * reach_ > most_approach_) return false;
    if (slide_ > most_slide_) return false;
    const Vec3 along = p - face_.normal.dot(p) * face_.normal;
    if ((along.cwiseAbs().array() > face_half_.array()).any()) return false;
    Point& point = points_[static_cast<std::size_t>(i)];
    point.distance = face_.normal.dot(p) - face_.offset - rounding_;
    point.p = owner.p + owner.axes * (p - (rounding_ + 0.5 * point.distance) * face_.normal);
  }
  normal_ = owner.axes * (owner_ == Owner::kFirst ? Vec3(-face_.normal) : face_.normal);
  return true;
}

}  // namespace tandem
