// Contact that is kept from one search to the next agrees with a fresh search, and hides nothing.

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <iostream>
#include <random>
#include <string_view>

#include <gtest/gtest.h>

#include "bridge/bullet_rig.h"
#include "bullet_bridge/src/surroundings/obstacles.h"

namespace tandem {
namespace {

using test::BulletRig;
using test::byWidth;
using test::turn;

constexpr double kHalf = 0.02;  // of cubes [m]

/// Bodies of an island in a host's world, with standing objects, and contact at any poses.
class Finder {
 public:
  void addStanding(btCollisionShape& shape, const Vec3& p_W = Vec3::Zero()) {
    rig.addBody(shape, 0.0, p_W);
  }
  void addBody(btCollisionShape& shape, const Vec3& p_W, const Quat& q_WB = Quat::Identity()) {
    btRigidBody& body = rig.addBody(shape, 0.1, p_W, q_WB);
    obstacles.addBody(static_cast<BodyIndex>(states.size()), body);
    states.push_back({p_W, q_WB});
  }
  void search() { obstacles.update(states, 0.04); }

  const std::vector<RigidContact>& find() {
    const std::vector<double> reach(states.size(), 0.001);
    std::vector<char> awake(states.size(), 1), near(states.size(), 0);
    obstacles.lookAround(states, reach, awake, near);
    contacts.clear();
    contacts.reserve(64);
    obstacles.find(states, contacts);
    return contacts;
  }

  BulletRig rig;
  Obstacles obstacles{rig.world};
  std::vector<RigidState> states;
  std::vector<RigidContact> contacts;
};

btConvexHullShape& makeWedge(BulletRig& rig, double margin) {
  auto& hull = rig.makeShape<btConvexHullShape>();
  for (const double x : {-kHalf, kHalf})
    for (const double y : {-kHalf, kHalf}) {
      hull.addPoint(toBullet(Vec3(x, y, -kHalf)));
      hull.addPoint(toBullet(Vec3(0.5 * x, 0.0, kHalf)));
    }
  hull.setMargin(static_cast<btScalar>(margin));
  return hull;
}

/// A body 0 on something else: how it is made, and how it lies.
struct Pair {
  const char* name;
  std::function<void(Finder&)> build;
  bool freezes;
};

const Quat kTipped = turn(0.3, Vec3(1.0, 0.4, 0.0));
double lowestCorner(const Quat& q) {
  const Vec3 up = q.conjugate() * Vec3::UnitZ();
  return kHalf * up.cwiseAbs().sum();
}

const Pair kPairs[] = {
    {"face on face",
     [](Finder& f) {
       f.addStanding(f.rig.makeShape<btBoxShape>(btVector3(1, 1, 1)), Vec3(0, 0, -1));
       f.addBody(f.rig.makeShape<btBoxShape>(toBullet(Vec3::Constant(kHalf))), Vec3(0, 0, kHalf));
     },
     true},
    {"face across face",
     [](Finder& f) {
       f.addBody(f.rig.makeShape<btBoxShape>(toBullet(Vec3::Constant(kHalf))), Vec3(0, 0, kHalf));
       f.addBody(f.rig.makeShape<btBoxShape>(toBullet(Vec3::Constant(kHalf))),
                 Vec3(0.007, 0.011, 3 * kHalf), turn(0.4, Vec3::UnitZ()));
     },
     true},
    {"corner on face",
     [](Finder& f) {
       f.addStanding(f.rig.makeShape<btBoxShape>(btVector3(1, 1, 1)), Vec3(0, 0, -1));
       f.addBody(f.rig.makeShape<btBoxShape>(toBullet(Vec3::Constant(kHalf))),
                 Vec3(0, 0, lowestCorner(kTipped)), kTipped);
     },
     true},
    {"box on plane",
     [](Finder& f) {
       f.addStanding(f.rig.makeShape<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(0)));
       f.addBody(f.rig.makeShape<btBoxShape>(toBullet(Vec3::Constant(kHalf))), Vec3(0, 0, kHalf));
     },
     true},
    {"hull on plane",
     [](Finder& f) {
       f.addStanding(f.rig.makeShape<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(0)));
       f.addBody(makeWedge(f.rig, 0.001), Vec3(0, 0, kHalf + 0.001));
     },
     true},
    {"ball on plane",
     [](Finder& f) {
       f.addStanding(f.rig.makeShape<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(0)));
       f.addBody(f.rig.makeShape<btSphereShape>(btScalar(kHalf)), Vec3(0, 0, kHalf));
     },
     true},
    {"ball on box",
     [](Finder& f) {
       f.addStanding(f.rig.makeShape<btBoxShape>(btVector3(1, 1, 1)), Vec3(0, 0, -1));
       f.addBody(f.rig.makeShape<btSphereShape>(btScalar(kHalf)), Vec3(0, 0, kHalf));
     },
     true},
    {"compound on plane",
     [](Finder& f) {
       f.addStanding(f.rig.makeShape<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(0)));
       auto& both = f.rig.makeShape<btCompoundShape>();
       auto& box = f.rig.makeShape<btBoxShape>(toBullet(Vec3::Constant(0.5 * kHalf)));
       for (const double x : {-kHalf, kHalf})
         both.addChildShape(toBullet(Vec3(x, 0, 0), turn(0.3, Vec3::UnitZ())), &box);
       f.addBody(both, Vec3(0, 0, 0.5 * kHalf));
     },
     true},
    {"hull on hull",
     [](Finder& f) {
       f.addBody(makeWedge(f.rig, 0.001), Vec3(0, 0, kHalf));
       f.addBody(f.rig.makeShape<btBoxShape>(toBullet(Vec3::Constant(kHalf))),
                 Vec3(0.003, 0.001, -kHalf - 0.001));
     },
     false},
    {"cylinder on plane",
     [](Finder& f) {
       f.addStanding(f.rig.makeShape<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(0)));
       f.addBody(f.rig.makeShape<btCylinderShapeZ>(toBullet(Vec3::Constant(kHalf))),
                 Vec3(0, 0, kHalf));
     },
     false},
};

/// Moves all bodies by up to `way` [m] and `angle` [rad] from where they are.
void shake(std::vector<RigidState>& states, double way, double angle, std::mt19937_64& random) {
  const auto draw = [&] {
    return static_cast<double>(random() >> 11) * 0x1p-52 - 1.0;  // from -1 to 1
  };
  for (RigidState& state : states) {
    const Vec3 by(draw(), draw(), draw()), axis(draw(), draw(), draw());
    state.p_W += way * by;
    state.q_WB = (turn(angle * draw(), axis) * state.q_WB).normalized();
  }
}

// Both compute gaps in double from the same corners, so they differ by the rounding of double. A
// search may choose other points of the same faces: only points that are there in both count.
TEST(FrozenContact, AgreesWithAFreshSearch) {
  constexpr std::uint64_t kSeed = 20261125;
  constexpr double kTolerance = 1e-13;  // [m], [1]; places are below 1 m
  std::cout << "seed " << kSeed << '\n';
  for (const Pair& pair : kPairs) {
    SCOPED_TRACE(pair.name);
    std::mt19937_64 random(kSeed);
    std::uint64_t frozen = 0;
    int compared = 0, seen = 0;
    for (int scene = 0; scene < 20; ++scene) {
      Finder kept;
      pair.build(kept);
      kept.states[0].p_W.z() -= 1e-6;
      kept.search();
      kept.find();
      for (int i = 0; i < 10; ++i) {
        shake(kept.states, 1e-6, 1e-6, random);
        kept.find();
        Finder fresh;
        pair.build(fresh);
        fresh.states = kept.states;
        fresh.search();
        fresh.find();
        if (!pair.freezes) continue;
        for (const RigidContact& old : kept.contacts) {
          ++seen;
          for (const RigidContact& now : fresh.contacts) {
            if ((old.p_W - now.p_W).norm() > 1e-4) continue;
            ++compared;
            EXPECT_NEAR(old.distance, now.distance, kTolerance);
            EXPECT_LT((old.p_W - now.p_W).norm(), kTolerance);
            EXPECT_LT((old.n_W - now.n_W).norm(), kTolerance);
            break;
          }
        }
      }
      frozen += kept.obstacles.frozenSearches();
    }
    if (pair.freezes) {
      EXPECT_GT(frozen, 150u);
      EXPECT_GT(compared, 9 * seen / 10);
      EXPECT_GE(seen, 150);
    } else {
      EXPECT_EQ(frozen, 0u);
    }
  }
}

/// Corners of a cube, or of a wedge without its margin.
std::vector<Vec3> findCorners(const RigidState& state, double half, bool is_wedge) {
  std::vector<Vec3> corners;
  for (const double x : {-half, half})
    for (const double y : {-half, half}) {
      const Vec3 above = is_wedge ? Vec3(0.5 * x, 0.0, half) : Vec3(x, y, half);
      corners.push_back(state.p_W + state.q_WB * Vec3(x, y, -half));
      corners.push_back(state.p_W + state.q_WB * above);
    }
  return corners;
}

/// Puts body 0 down with its lowest corner `depth` [m] in the floor. Returns how many are in it;
/// all of them must be known.
int expectCornersSeen(Finder& finder, double half, double margin, double angle, double depth) {
  RigidState& state = finder.states[0];
  state.q_WB = turn(angle, Vec3(1.0, 0.3, 0.0));
  state.p_W.z() = 0.0;
  double lowest = HUGE_VAL;
  for (const Vec3& corner : findCorners(state, half, margin > 0.0))
    lowest = std::min(lowest, corner.z());
  state.p_W.z() = margin - lowest - depth;
  finder.find();
  int sunk = 0;
  for (const Vec3& corner : findCorners(state, half, margin > 0.0)) {
    const double gap = corner.z() - margin;
    if (gap > 0.0) continue;
    ++sunk;
    const auto is_it = [&](const RigidContact& contact) {
      // Bullet rounds its place of a floor that is 1 m thick.
      return std::abs(contact.distance - gap) < byWidth(1e-12, 1e-7) &&
             (contact.p_W - corner).head<2>().norm() < 1e-5;
    };
    EXPECT_TRUE(std::any_of(finder.contacts.begin(), finder.contacts.end(), is_it))
        << "corner " << corner.transpose() << " at " << angle << " rad, " << depth << " m";
  }
  return sunk;
}

/// Lays the body down from an edge.
void expectCornersSeen(Finder& finder, double half, double margin) {
  finder.search();
  int sunk = 0;
  for (double angle = 0.05; angle > -1e-4; angle -= std::max(1.3e-6, angle / 400.0))
    sunk += expectCornersSeen(finder, half, margin, angle, 1e-7);
  EXPECT_GT(sunk, 1000);
  EXPECT_GT(finder.obstacles.frozenSearches(), finder.obstacles.searches());
}

TEST(FrozenContact, NoCornerSinksInUnseen) {
  constexpr double kSmall = 0.002;
  for (const char* name : {"face on face", "box on plane", "hull on plane"}) {
    SCOPED_TRACE(name);
    Finder finder;
    std::find_if(std::begin(kPairs), std::end(kPairs), [&](const Pair& pair) {
      return std::string_view(pair.name) == name;
    })->build(finder);
    expectCornersSeen(finder, kHalf, std::string_view(name) == "hull on plane" ? 0.001 : 0.0);
  }
  // Bullet sees corners of a small box only when they are near.
  Finder finder;
  finder.addStanding(finder.rig.makeShape<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(0)));
  finder.addBody(finder.rig.makeShape<btBoxShape>(toBullet(Vec3::Constant(kSmall))),
                 Vec3(0, 0, kSmall));
  expectCornersSeen(finder, kSmall, 0.0);
  int sunk = 0;
  for (double depth = 0.0; depth < 2e-4; depth += 1e-5)
    sunk += expectCornersSeen(finder, kSmall, 0.0, 0.025, depth);
  EXPECT_GT(sunk, 25) << "a second corner must come down";
}

// A standing body may move, and be replaced.
TEST(FrozenContact, FollowsAStandingObjectThatMoves) {
  Finder finder;
  kPairs[0].build(finder);
  finder.search();
  for (const double rise : {0.0, 3e-6, -3e-6, 1e-5, 5e-4}) {
    btRigidBody& floor = *finder.rig.bodies.front();
    floor.setWorldTransform(toBullet(Vec3(0.0, 0.0, rise - 1.0), Quat::Identity()));
    finder.search();
    finder.find();
    ASSERT_EQ(finder.contacts.size(), 4u) << rise;
    for (const RigidContact& contact : finder.contacts)
      EXPECT_NEAR(contact.distance, -rise, byWidth(1e-12, 1e-7));
  }
}

// Whichever of two bodies comes first, a cube slides far over a plate by corners. Then all of them
// are found anew.
TEST(FrozenContact, KeepsAllCornersAfterALongSlide) {
  for (const int cube : {0, 1}) {
    Finder finder;
    for (const int body : {0, 1}) {
      const Vec3 half(body == cube ? kHalf : 0.1, body == cube ? kHalf : 0.1, kHalf);
      finder.addBody(finder.rig.makeShape<btBoxShape>(toBullet(half)),
                     Vec3(0, 0, body == cube ? kHalf : -kHalf));
    }
    finder.search();
    RigidState& state = finder.states[static_cast<std::size_t>(cube)];
    for (int i = 0; i < 100; ++i) {
      state.p_W.x() += 1e-4;
      ASSERT_EQ(finder.find().size(), 4u) << cube;
    }
    EXPECT_EQ(finder.obstacles.searches(), 1u) << cube;
    state.p_W.z() += 9e-6;
    ASSERT_EQ(finder.find().size(), 4u) << cube;
    EXPECT_EQ(finder.obstacles.searches(), 2u) << cube;
    for (const RigidContact& contact : finder.contacts)
      EXPECT_NEAR((contact.p_W - state.p_W).head<2>().cwiseAbs().maxCoeff(), kHalf, 1e-8);
  }
}

TEST(FrozenContact, IsForgottenWithItsShape) {
  Finder finder;
  kPairs[3].build(finder);
  finder.search();
  finder.find();
  finder.find();
  EXPECT_EQ(finder.obstacles.searches(), 1u);
  auto& taller = finder.rig.makeShape<btBoxShape>(toBullet(Vec3(kHalf, kHalf, kHalf + 2e-4)));
  finder.rig.bodies.back()->setCollisionShape(&taller);
  finder.search();
  for (const RigidContact& contact : finder.find())
    EXPECT_NEAR(contact.distance, -2e-4, byWidth(1e-9, 1e-7));
  EXPECT_EQ(finder.obstacles.searches(), 2u);
}

/// Pushes a row of four cubes over a floor at 0.1 m/s, with rounding of an island. Calls `each`.
template <typename Each>
void pushRow(Finder& finder, Each each) {
  finder.addStanding(finder.rig.makeShape<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(0)));
  for (int i = 0; i < 4; ++i)
    finder.addBody(finder.rig.makeShape<btBoxShape>(toBullet(Vec3::Constant(kHalf))),
                   Vec3(2.0 * kHalf * i, 0.0, kHalf));
  std::mt19937_64 random(7);
  for (int tick = 0; tick < 1000; ++tick) {
    if (tick % 16 == 0) finder.search();
    for (RigidState& state : finder.states) state.p_W.x() += 1e-4;
    shake(finder.states, 1e-9, 1e-9, random);
    finder.find();
    each();
  }
}

TEST(FrozenContact, SavesSearchesOfAPushedRow) {
  Finder finder;
  pushRow(finder, [&] { ASSERT_EQ(finder.contacts.size(), 4u * 4u + 3u * 4u); });
  EXPECT_LT(5 * finder.obstacles.searches(), finder.obstacles.frozenSearches());
  std::cout << finder.obstacles.searches() << " searches, " << finder.obstacles.frozenSearches()
            << " frozen\n";
}

TEST(FrozenContact, IsEqualToTheBitRunToRun) {
  std::vector<std::uint64_t> runs[2];
  for (auto& run : runs) {
    Finder finder;
    pushRow(finder, [&] {
      for (const RigidContact& contact : finder.contacts)
        for (const double number : {contact.distance, contact.p_W.x(), contact.p_W.y(),
                                    contact.p_W.z(), contact.n_W.x(), contact.n_W.z()})
          run.push_back(std::bit_cast<std::uint64_t>(number));
    });
  }
  EXPECT_EQ(runs[0], runs[1]);
}

}  // namespace
}  // namespace tandem
