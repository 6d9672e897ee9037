#include "import/mass_sum.h"

#include <Eigen/Eigenvalues>

namespace tandem::demos {
namespace {

/// Gives the inertia of a mass point at `p` about the origin.
Mat3 computePointInertia(double mass, const Vec3& p) {
  return mass * (p.squaredNorm() * Mat3::Identity() - p * p.transpose());
}

}  // namespace

void MassSum::add(double mass, const Vec3& p_W, const Mat3& I_W) {
  mass_ += mass;
  first_ += mass * p_W;
  about_origin_ += I_W + computePointInertia(mass, p_W);
}

Mat3 MassSum::inertia() const { return about_origin_ - computePointInertia(mass_, centre()); }

Mat3 findPrincipalAxes(const Mat3& I_W, const Mat3& wish) {
  Mat3 products = wish.transpose() * I_W * wish;
  products.diagonal().setZero();
  if (products.cwiseAbs().maxCoeff() <= 1e-6 * I_W.cwiseAbs().maxCoeff()) return wish;
  Mat3 axes = Eigen::SelfAdjointEigenSolver<Mat3>(I_W).eigenvectors();
  if (axes.determinant() < 0.0) axes.col(2) *= -1.0;
  return axes;
}

}  // namespace tandem::demos
