#include "bench/stress/stress_case.h"

#include <algorithm>
#include <cmath>

#include "bench/program/draw.h"

namespace tandem::demos::bench {
namespace {

/// 0 in a tenth of all cases, otherwise uniform in the logarithm.
CouplerGains drawGains(Draw& draw) {
  return {draw.log(10.0, 1e6), draw.chance(0.1) ? 0.0 : draw.log(1e-3, 1e3)};
}

double drawMass(Draw& draw) { return draw.log(1e-3, 10.0); }

Shape drawShape(Draw& draw, double size) {
  const double part = draw.even(0.0, 1.0);
  const auto length = [&] { return size * draw.even(0.2, 1.0); };
  if (part < 0.6) return Box{0.5 * Vec3(length(), length(), length())};
  if (part < 0.8) return Sphere{0.5 * length()};
  return Capsule{0.25 * length(), 0.25 * length()};
}

/// Distance of a sphere of `radius` from a shape's bounding ball, along its path. It is the way of
/// a few hundredths of a second or, in a fifth of all cases, deep inside.
double drawGap(Draw& draw, double size, double radius, double speed) {
  if (draw.chance(0.2)) return -draw.even(0.0, 0.5 * size + radius);
  return std::min(draw.even(0.0, 0.3) * size, 0.03 * speed);
}

void drawNetwork(Draw& draw, StressCase& one) {
  Impairments& way = one.network;
  way.seed = one.index + 1;
  way.delay = draw.chance(0.15) ? 0.0 : draw.chance(0.5) ? draw.log(1e-3, 1.0) : draw.even(0, 0.1);
  if (draw.chance(0.5)) way.jitter = draw.even(0.0, 1.0) * std::max(way.delay, 0.01);
  if (draw.chance(0.5)) way.loss = draw.even(0.0, 0.3);
  if (draw.chance(0.3)) way.duplicate = draw.even(0.0, 0.3);
  if (draw.chance(0.3)) way.reorder = draw.even(0.0, 0.3);
}

void drawCommon(Draw& draw, StressCase& one, double size) {
  one.host_step = draw.log(1e-3, 1.0 / 30.0);
  one.packet_rate = draw.log(20.0, 1000.0);
  one.contact = drawGains(draw);
  one.coordination = drawGains(draw);
  if (draw.chance(0.3)) {
    const double arm = size * draw.even(0.1, 1.0);
    one.angular =
        CouplerGains{one.coordination.stiffness * arm * arm, one.coordination.damping * arm * arm};
  }
  one.proxy_mass = drawMass(draw);
  one.radius = size * draw.even(0.1, 0.5);
  if (draw.chance(0.3)) one.proxy_damping = draw.log(1e-3, 1e2);
  if (draw.chance(0.3)) one.object_damping = draw.log(1e-3, 1e2);
  if (draw.chance(0.5)) one.origin_W = draw.log(0.1, 1e3) * draw.direction();
  drawNetwork(draw, one);
}

double drawSpeed(Draw& draw) { return draw.log(0.03, 10.0); }

/// A user's script: it starts at `p_W` with `v_W`, and acts on arrival.
StressPath drawPath(Draw& draw, const Vec3& p_W, const Vec3& v_W, double size) {
  StressPath path;
  path.start_W = p_W;
  path.v_W = v_W;
  const double part = draw.even(0.0, 1.0);
  if (part < 0.5) {
    path.turn_time = draw.even(0.02, 0.2);
  } else if (part < 0.8) {
    path.form = StressPath::Form::kSine;
    path.turn_time = draw.even(0.02, 0.3) * size / v_W.norm() + 1e-3;
  } else {
    path.form = StressPath::Form::kLeaps;
    path.turn_time = draw.log(2e-3, 0.1);
    path.leap_W = size * draw.even(0.01, 1.0) * (v_W.normalized() + 0.3 * draw.direction());
  }
  return path;
}

/// A scripted user who approaches a body from a random place.
StressUser drawComer(Draw& draw, const StressBody& body, double radius, double size) {
  const Vec3 from = draw.direction();
  const double speed = drawSpeed(draw);
  const double reach = computeBoundingRadius(body.shape);
  const Vec3 aside = 0.5 * reach * draw.even(0.0, 1.0) * draw.direction();
  const double distance = std::max(0.0, reach + radius + drawGap(draw, size, radius, speed));
  StressUser user;
  user.path =
      drawPath(draw, body.start.p_W + distance * from + aside, body.start.v_W - speed * from, size);
  return user;
}

void drawDevice(Draw& draw, StressUser& user, double speed) {
  user.is_scripted = false;
  user.device_mass = drawMass(draw);
  user.device_damping = draw.chance(0.2) ? 0.0 : draw.log(1e-2, 1e2);
  user.max_force = draw.chance(0.5) ? draw.log(1.0, 50.0) : 0.0;
  // A push that reaches the speed in a tenth of a second.
  const double force = std::min(user.device_mass * speed / 0.1, 50.0);
  user.hand_W = force * user.path.v_W.normalized();
}

StressBody drawFreeBody(Draw& draw, const Vec3& p_W, double size) {
  StressBody body;
  body.shape = drawShape(draw, size);
  body.mass = drawMass(draw);
  body.is_shared = true;
  body.start.p_W = p_W;
  body.start.q_WB = draw.rotation();
  if (draw.chance(0.3)) body.start.v_W = draw.log(0.01, 3.0) * draw.direction();
  if (draw.chance(0.3)) body.start.w_W = draw.log(0.1, 50.0) * draw.direction();
  return body;
}

void drawTwoSites(Draw& draw, StressCase& one, double size) {
  if (draw.chance(0.3)) one.scheme = "virtual_coupling";
  one.bodies.push_back(drawFreeBody(draw, one.origin_W, size));
  for (int i = 0; i < 2; ++i) {
    one.users.push_back(drawComer(draw, one.bodies.front(), one.radius, size));
    drawDevice(draw, one.users.back(), one.users.back().path.v_W.norm());
  }
}

void drawGuided(Draw& draw, StressCase& one, double size) {
  const Quat frame = draw.rotation();
  one.guide = frame * Vec3::UnitX();
  if (draw.chance(0.3)) one.scheme = draw.chance(0.5) ? "virtual_coupling" : "kinematic_proxy";
  const double half = 0.5 * size;
  const bool has_cube = one.scheme == "virtual_coupling" || draw.chance(0.7);
  if (has_cube) {
    StressBody cube;
    cube.shape = Box{Vec3::Constant(half)};
    cube.mass = drawMass(draw);
    cube.is_shared = true;
    cube.start.p_W = one.origin_W;
    cube.start.q_WB = frame;
    one.bodies.push_back(cube);
  }
  for (int i = 0; i < 2; ++i) {
    const double side = i == 0 ? -1.0 : 1.0;
    const double speed = drawSpeed(draw);
    const double rest = one.radius + (has_cube ? half : 0.0);
    double gap = drawGap(draw, size, one.radius, speed);
    // The centres decide the order in the slot.
    gap = std::max(gap, -0.9 * rest);
    StressUser user;
    user.path.start_W = one.origin_W + side * (rest + gap) * *one.guide;
    user.path.v_W = -side * speed * *one.guide;
    drawDevice(draw, user, speed);
    one.users.push_back(user);
  }
}

/// The experiments of the paper, with other numbers.
void drawPaper(Draw& draw, StressCase& one) {
  one.guide = Vec3::UnitX();
  one.origin_W.setZero();
  one.angular.reset();
  one.object_damping = 0.0;
  one.network.jitter = one.network.loss = one.network.duplicate = one.network.reorder = 0.0;
  // The reference takes a packet in at once; the site not in the tick that sent it.
  one.network.delay = std::max(one.network.delay, 2.0 / one.haptic_rate);
  const bool has_cube = draw.chance(0.5);
  constexpr double kHalf = 0.02;
  one.radius = 0.01;
  if (has_cube) {
    StressBody cube;
    cube.shape = Box{Vec3::Constant(kHalf)};
    cube.mass = drawMass(draw);
    cube.is_shared = true;
    one.bodies.push_back(cube);
  }
  const double force = draw.log(0.1, 10.0), damping = draw.log(1e-2, 10.0);
  for (int i = 0; i < 2; ++i) {
    StressUser user;
    user.is_scripted = false;
    user.device_mass = one.proxy_mass;
    user.device_damping = damping;
    user.path.start_W =
        (i == 0 ? -1.0 : 1.0) * (one.radius + (has_cube ? kHalf : 0.0)) * Vec3::UnitX();
    if (i == 0) user.hand_W = force * Vec3::UnitX();
    one.users.push_back(user);
  }
}

void drawScripted(Draw& draw, StressCase& one, double size) {
  one.network = {};
  const bool is_static = draw.chance(0.35);
  StressBody body = drawFreeBody(draw, one.origin_W, size);
  if (is_static) {
    body.mass = 0.0;
    body.is_shared = false;
    body.start.v_W = body.start.w_W = Vec3::Zero();
  }
  one.bodies.push_back(body);
  // The local user approaches too, or is far from all bodies.
  StressUser local = drawComer(draw, body, one.radius, size);
  if (is_static || draw.chance(0.4)) {
    local.path = {};
    local.path.start_W = one.origin_W + 100.0 * size * Vec3(1, 1, 1);
  }
  one.users.push_back(local);
  const int remotes = draw.count(1, 2);
  for (int i = 0; i < remotes; ++i) one.users.push_back(drawComer(draw, body, one.radius, size));
}

StressBody makeCube(const Vec3& p_W, const Vec3& half, double mass) {
  StressBody body;
  body.shape = Box{half};
  body.mass = mass;
  body.start.p_W = p_W;
  return body;
}

void drawRigid(Draw& draw, StressCase& one, double size) {
  one.network = {};
  one.gravity_W = -9.81 * Vec3::UnitZ();
  one.friction = draw.chance(0.2) ? 0.0 : draw.even(0.0, 1.0);
  const double half = 0.5 * size;
  StressBody floor;
  floor.shape = Plane{Vec3::UnitZ(), 0.0};
  floor.start.p_W = one.origin_W;
  if (draw.chance(0.5))
    floor = makeCube(one.origin_W - 5.0 * size * Vec3::UnitZ(), Vec3::Constant(5.0 * size), 0.0);
  one.bodies.push_back(floor);
  // On the floor, above it, or in it.
  const double height = draw.chance(0.5)   ? 0.0
                        : draw.chance(0.6) ? draw.even(0.0, 1.0) * size
                                           : -draw.even(0.0, 0.3) * size;
  StressBody cube = makeCube(one.origin_W + (half + height) * Vec3::UnitZ(),
                             half * Vec3(1.0, draw.even(0.3, 1.0), 1.0), drawMass(draw));
  cube.is_shared = true;
  if (height > 0.0 && draw.chance(0.5)) cube.start.q_WB = draw.rotation();
  if (draw.chance(0.5)) cube.start.v_W = draw.log(0.05, 10.0) * draw.direction();
  one.bodies.push_back(cube);
  const int walls = draw.count(0, 2);
  for (int i = 0; i < walls; ++i) {
    const double distance = size * draw.even(1.0, 1.3);
    const Vec3 side = i == 0 ? Vec3::UnitX() : Vec3::UnitY();
    one.bodies.push_back(
        makeCube(one.origin_W + distance * side + half * Vec3::UnitZ(), Vec3::Constant(half), 0.0));
  }
  StressUser local;
  local.path.start_W = one.origin_W + 100.0 * size * Vec3(1, 1, 1);
  // Otherwise it stands in the way.
  if (draw.chance(0.5)) {
    local.path = drawComer(draw, cube, one.radius, size).path;
    local.path.v_W.setZero();
    local.path.turn_time = 0.0;
    local.path.form = StressPath::Form::kEven;
  }
  one.users.push_back(local);
  one.users.push_back(drawComer(draw, cube, one.radius, size));
}

void drawNeighbours(Draw& draw, StressCase& one, double size) {
  drawRigid(draw, one, size);
  const int boxes = draw.count(1, 4);
  const double mass = drawMass(draw);
  for (int i = 0; i < boxes; ++i) {
    const double half = 0.5 * size * draw.even(0.5, 1.0);
    // A row or a pile, of bodies of similar weight, as in real scenes.
    const Vec3 place = draw.chance(0.5) ? Vec3(0.0, -(1.01 * i + 1.1) * size, half)
                                        : Vec3(-(1.01 * i + 1.1) * size, 0.0, half);
    StressBody box =
        makeCube(one.origin_W + place, Vec3::Constant(half), mass * draw.log(0.2, 5.0));
    box.is_shared = i == 1 && draw.chance(0.3);
    one.bodies.push_back(box);
  }
}

/// A straight chain of one to six links hangs at rest or swings as one about its pin. Links have
/// similar weights. The hand and a remote user come to the shared one, or are far away.
void drawJoined(Draw& draw, StressCase& one) {
  one.network = {};
  one.angular.reset();
  if (!draw.chance(0.1)) one.gravity_W = -9.81 * Vec3::UnitZ();
  const auto links = static_cast<std::size_t>(draw.count(1, 6));
  const double length = draw.log(1e-2, 1.0), mass = drawMass(draw);
  one.radius = length * draw.even(0.05, 0.3);
  const Vec3 along = draw.direction(), axis = along.cross(draw.direction()).normalized();
  const bool is_hinged = draw.chance(0.5);
  const double speed = draw.chance(0.5) ? 0.0 : draw.even(-1.0, 1.0) * std::sqrt(9.81 / length);
  const auto shared = static_cast<std::size_t>(draw.count(0, static_cast<int>(links) - 1));
  for (std::size_t i = 0; i < links; ++i) {
    const double k = static_cast<double>(i);
    StressBody link;
    link.shape = Box{0.5 * length * Vec3(1.0, draw.even(0.05, 0.3), draw.even(0.05, 0.3))};
    link.mass = mass * draw.log(0.2, 5.0);
    link.is_shared = i == shared;
    link.start.p_W = one.origin_W + (k + 0.5) * length * along;
    link.start.q_WB = Quat::FromTwoVectors(Vec3::UnitX(), along);
    link.start.w_W = speed * axis;
    link.start.v_W = speed * axis.cross(link.start.p_W - one.origin_W);
    one.bodies.push_back(link);
    StressJoint joint;
    joint.a = i;
    if (i > 0) joint.b = i - 1;
    joint.pin_W = one.origin_W + k * length * along;
    if (is_hinged) joint.axis_W = axis;
    one.joints.push_back(joint);
  }
  for (int user = 0; user < 2; ++user) {
    one.users.push_back(drawComer(draw, one.bodies[shared], one.radius, length));
    if (draw.chance(0.5)) continue;
    one.users.back().path = {};
    one.users.back().path.start_W = one.origin_W + 100.0 * (1 + user) * length * Vec3(1, 1, 1);
  }
}

/// Draws numbers that analysis calls stable: see isAnalysedStable().
void calmDown(Draw& draw, StressCase& one) {
  one.network = {};
  one.network.seed = one.index + 1;
  one.network.delay = draw.log(1e-4, 0.02);
  one.packet_rate = draw.log(200.0, 1000.0);
  one.contact = {draw.log(10.0, 2e4), draw.log(1e-3, 5.0)};
  const double oldest = one.network.delay + 1.0 / one.packet_rate;
  one.coordination.stiffness = draw.log(10.0, 1e4);
  one.coordination.damping =
      std::min(1e3, one.coordination.stiffness * oldest * draw.log(2.5, 20.0));
  if (one.angular) one.angular.reset();
  const double late = 0.5 / one.haptic_rate +
                      2.0 * (oldest + std::sqrt(one.proxy_mass / one.coordination.stiffness));
  for (StressUser& user : one.users)
    user.device_damping =
        4.0 * (one.contact.stiffness * late + one.contact.damping) * draw.even(1.01, 3.0);
}

}  // namespace

std::string_view nameOf(StressKind kind) {
  constexpr std::string_view kNames[] = {"two_sites", "guided",     "paper", "scripted",
                                         "rigid",     "neighbours", "joined"};
  return kNames[static_cast<int>(kind)];
}

PointState StressPath::at(double time) const {
  if (form == Form::kLeaps) {
    const bool is_there = static_cast<std::int64_t>(std::floor(time / turn_time)) % 2 != 0;
    return {is_there ? Vec3(start_W + leap_W) : start_W, v_W};
  }
  if (form == Form::kSine)
    return {start_W + turn_time * std::sin(time / turn_time) * v_W,
            std::cos(time / turn_time) * v_W};
  const double back = time - turn_time;
  if (turn_time <= 0.0 || back <= 0.0) return {start_W + time * v_W, v_W};
  return {start_W + (turn_time - back) * v_W, -v_W};
}

StressCase drawStressCase(std::uint64_t seed, std::uint64_t index) {
  Draw draw(seed, index);
  StressCase one;
  one.seed = seed;
  one.index = index;
  const double size = draw.log(1e-3, 1.0);
  drawCommon(draw, one, size);
  if (index >= kFirstJoinedCase) {
    one.kind = StressKind::kJoined;
    drawJoined(draw, one);
    one.duration = 0.25;
    return one;
  }
  const double part = draw.even(0.0, 1.0);
  if (part < 0.25) {
    one.kind = StressKind::kTwoSites;
    drawTwoSites(draw, one, size);
  } else if (part < 0.4) {
    one.kind = StressKind::kGuided;
    drawGuided(draw, one, size);
  } else if (part < 0.45) {
    one.kind = StressKind::kPaper;
    drawPaper(draw, one);
  } else if (part < 0.75) {
    one.kind = StressKind::kScripted;
    drawScripted(draw, one, size);
  } else if (part < 0.9) {
    one.kind = StressKind::kRigid;
    drawRigid(draw, one, size);
  } else {
    one.kind = StressKind::kNeighbours;
    drawNeighbours(draw, one, size);
  }
  if ((one.kind == StressKind::kTwoSites || one.kind == StressKind::kGuided) && draw.chance(0.3))
    calmDown(draw, one);
  one.duration = 0.15;
  if (one.users.size() > 1 && !one.users[1].is_scripted)
    one.duration = 0.2 + std::min(2.2 * one.network.delay, 2.0);
  one.duration = std::ceil(one.duration * one.haptic_rate) / one.haptic_rate;
  return one;
}

}  // namespace tandem::demos::bench
