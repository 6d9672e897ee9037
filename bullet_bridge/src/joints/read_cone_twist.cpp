#include "joints/read_cone_twist.h"

#include <algorithm>

#include "joints/read_frame.h"

namespace tandem {
namespace {

constexpr double kLeastSpan = 1e-6;  // of a cone [rad]; its edge needs a direction

void readSwing(btConeTwistConstraint& host, JointSettings& joint) {
  SwingSettings& swing = joint.swing;
  swing.span1 = host.getSwingSpan1();
  swing.span2 = host.getSwingSpan2();
  const double fix_below = host.getFixThresh();
  const bool is_wide1 = swing.span1 >= fix_below, is_wide2 = swing.span2 >= fix_below;
  JointAxis &first = joint.axes[4], &second = joint.axes[5];
  if (is_wide1 && is_wide2) {
    swing.kind = SwingKind::kCone;
    for (double* span : {&swing.span1, &swing.span2})
      *span = std::max(*span * host.getLimitSoftness(), kLeastSpan);
    first.low = 0.0;
    first.high = HUGE_VAL;
    return;
  }
  first.lock();
  if (!is_wide1 && !is_wide2) {
    swing.kind = SwingKind::kFixed;
    second.lock();
    return;
  }
  swing.kind = is_wide1 ? SwingKind::kAboutZ : SwingKind::kAboutY;
  second.high = is_wide1 ? swing.span1 : swing.span2;
  second.low = -second.high;
}

}  // namespace

void readConeTwist(btConeTwistConstraint& host, const HostSolver& solver, JointSettings& joint) {
  joint.kind = JointKind::kConeTwist;
  joint.a = readFrame(host.getAFrame(), 0);
  joint.b = readFrame(host.getBFrame(), 0);
  const int flags = host.getFlags();
  for (std::size_t i = 0; i < 3; ++i) {
    JointAxis& axis = joint.axes[i];
    axis.lock();
    axis.erp = (flags & BT_CONETWIST_FLAGS_LIN_ERP)
                   ? static_cast<double>(host.getParam(BT_CONSTRAINT_ERP, static_cast<int>(i)))
                   : solver.erp;
    axis.cfm = (flags & BT_CONETWIST_FLAGS_LIN_CFM)
                   ? static_cast<double>(host.getParam(BT_CONSTRAINT_CFM, static_cast<int>(i)))
                   : 0.0;
  }
  // Bullet weakens angular rows by its bias, and scales them by the relaxation squared.
  const double bias = host.getBiasFactor();
  const double relaxation = host.getRelaxationFactor();
  const double scale = std::max(relaxation * relaxation, 1e-6);
  for (std::size_t i = 3; i < 6; ++i) {
    joint.axes[i].erp = bias / scale;
    joint.axes[i].cfm = (flags & BT_CONETWIST_FLAGS_ANG_CFM)
                            ? static_cast<double>(host.getParam(BT_CONSTRAINT_CFM, 3))
                            : 0.0;
  }
  // A motor ignores the limits.
  if (host.isMotorEnabled()) {
    joint.swing.kind = SwingKind::kMotor;
    joint.swing.target = fromBullet(host.getMotorTarget()).toRotationMatrix();
    joint.axes[4].motor = JointMotor::kTurn;
    joint.axes[4].gain = bias / (scale * solver.dt);
    const double impulse = host.getMaxMotorImpulse();
    joint.axes[4].force = impulse >= 0.0 ? impulse * scale / solver.dt : HUGE_VAL;
    return;
  }
  JointAxis& twist = joint.axes[3];
  twist.high = static_cast<double>(host.getTwistSpan()) * host.getLimitSoftness();
  twist.low = -twist.high;
  readSwing(host, joint);
}

}  // namespace tandem
