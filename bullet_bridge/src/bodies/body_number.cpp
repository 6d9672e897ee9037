#include "bodies/body_number.h"

namespace tandem {
namespace {

/// Bullet keeps the number private, and has no getter. C++ checks no access to names in an explicit
/// instantiation.
template <int btRigidBody::*kNumber>
struct NumberAccess {
  friend const int& readNumber(const btRigidBody& body) noexcept { return body.*kNumber; }
};
const int& readNumber(const btRigidBody& body) noexcept;
template struct NumberAccess<&btRigidBody::m_debugBodyId>;

}  // namespace

const int& numberOf(const btRigidBody& body) noexcept { return readNumber(body); }

}  // namespace tandem
