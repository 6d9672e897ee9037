#include "shapes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include <Eigen/Geometry>

#include "refusal.h"

namespace tandem::pybullet {
namespace {

using Vector = Eigen::Vector3d;
using Turn = Eigen::Quaterniond;

Turn toTurn(const double q[4]) { return {q[3], q[0], q[1], q[2]}; }

void store(const Turn& turn, double q[4]) {
  q[0] = turn.x(), q[1] = turn.y(), q[2] = turn.z(), q[3] = turn.w();
}

void setSize(Piece& piece, TandemShapeKind kind, double a, double b, double c) {
  piece.settings.shape = kind;
  piece.settings.size[0] = a;
  piece.settings.size[1] = b;
  piece.settings.size[2] = c;
}

Piece makePiece(int body, const b3::CollisionShapeData& data) {
  Piece piece;
  piece.settings = tandem_default_body_settings();
  std::copy_n(data.frame, 3, piece.position);
  std::copy_n(data.frame + 3, 4, piece.orientation);
  const double* const d = data.dimensions;
  switch (data.geometry) {
    case b3::kBox:
      setSize(piece, TANDEM_BOX, d[0] / 2.0, d[1] / 2.0, d[2] / 2.0);
      return piece;
    case b3::kSphere:
      setSize(piece, TANDEM_SPHERE, d[0], 0.0, 0.0);
      return piece;
    case b3::kCapsule:
      setSize(piece, TANDEM_CAPSULE, d[1], d[0], 0.0);
      return piece;
    case b3::kCylinder:
      setSize(piece, TANDEM_CYLINDER, d[1], d[0], 0.0);
      return piece;
    case b3::kPlane: {
      setSize(piece, TANDEM_PLANE, 0.0, 0.0, 0.0);
      const Turn up = Turn::FromTwoVectors(Vector::UnitZ(), Vector(d[0], d[1], d[2]));
      store(toTurn(data.frame + 3) * up, piece.orientation);
      return piece;
    }
    default:
      throw Refusal(kPyBulletSays,
                    "body " + std::to_string(body) +
                        " has a mesh, hull or height field, of which PyBullet does not tell the "
                        "points: give shape=hull with its points");
  }
}

}  // namespace

bool Piece::isCentred() const {
  const double* const p = position;
  const bool is_straight = std::abs(std::abs(orientation[3]) - 1.0) < 1e-12;
  const bool is_round = settings.shape == TANDEM_SPHERE;
  return std::hypot(p[0], p[1], p[2]) < 1e-9 && (is_straight || is_round);
}

std::optional<Piece> readPieceFromWords(Words& words, const std::vector<double>& points) {
  if (!words.has("shape")) return std::nullopt;
  const std::string kind = words.text("shape");
  Piece piece;
  piece.settings = tandem_default_body_settings();
  double size[3]{};
  if (kind == "box") {
    words.numbers("size", size, 3);
    setSize(piece, TANDEM_BOX, size[0], size[1], size[2]);
  } else if (kind == "sphere") {
    words.numbers("size", size, 1);
    setSize(piece, TANDEM_SPHERE, size[0], 0.0, 0.0);
  } else if (kind == "capsule" || kind == "cylinder") {
    words.numbers("size", size, 2);
    setSize(piece, kind == "capsule" ? TANDEM_CAPSULE : TANDEM_CYLINDER, size[0], size[1], 0.0);
  } else if (kind == "plane") {
    setSize(piece, TANDEM_PLANE, 0.0, 0.0, 0.0);
  } else if (kind == "hull") {
    setSize(piece, TANDEM_HULL, 0.0, 0.0, 0.0);
    if (points.size() < 12 || points.size() % 3 != 0) {
      throw Refusal(kBadCommand, "shape=hull: " + std::to_string(points.size()) +
                                     " coordinates have come in; it needs x, y, z of four points "
                                     "or more, sent before by `data`");
    }
    piece.points = points;
  } else {
    throw Refusal(kBadCommand,
                  "shape=" + kind + ": there are box, sphere, capsule, cylinder, hull and plane");
  }
  return piece;
}

std::vector<Piece> readPieces(const Engine& engine, int body, const BodyFacts& facts) {
  const std::string name = "body " + std::to_string(body);
  if (!facts.is_multibody) {
    throw Refusal(kPyBulletSays, name +
                                     " has maximal coordinates, of which PyBullet does not tell "
                                     "the shape: give shape=... and size=...");
  }
  std::vector<Piece> pieces;
  for (const b3::CollisionShapeData& data : engine.readShape(body)) {
    pieces.push_back(makePiece(body, data));
  }
  if (pieces.empty()) {
    throw Refusal(kPyBulletSays, name +
                                     " has no collision shape that PyBullet could tell of: "
                                     "give shape=... and size=...");
  }
  return pieces;
}

TandemState computePieceState(const TandemState& pose, const Piece& piece) {
  TandemState state{};
  const Turn R_WB = toTurn(pose.orientation);
  const Vector p_BP(piece.position[0], piece.position[1], piece.position[2]);
  const Vector p_WP = Vector(pose.position[0], pose.position[1], pose.position[2]) + R_WB * p_BP;
  std::copy_n(p_WP.data(), 3, state.position);
  store((R_WB * toTurn(piece.orientation)).normalized(), state.orientation);
  return state;
}

}  // namespace tandem::pybullet
