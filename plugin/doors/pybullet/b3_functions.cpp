#include "b3_functions.h"

#include <dlfcn.h>

namespace tandem::pybullet {
namespace {

/// Finds functions in one module, and keeps the name of the first missing one.
class Finder {
 public:
  explicit Finder(void* module) : module_(module) {}

  template <typename Function>
  void find(Function*& function, const char* name) {
    function = reinterpret_cast<Function*>(dlsym(module_, name));
    if (!function && missing_.empty()) missing_ = name;
  }
  const std::string& missing() const { return missing_; }

 private:
  void* module_;
  std::string missing_;
};

/// Opens the module that contains `code`, or the whole program if there is none.
void* openModuleOf(const void* code) {
  Dl_info info{};
  if (dladdr(code, &info) != 0 && info.dli_fname) {
    if (void* module = dlopen(info.dli_fname, RTLD_LAZY | RTLD_NOLOAD)) return module;
  }
  return dlopen(nullptr, RTLD_LAZY);
}

}  // namespace

std::string findB3Functions(const void* caller, B3Functions& functions) {
  void* const module = openModuleOf(caller);
  Finder in(module);
  in.find(functions.submit, "b3SubmitClientCommandAndWaitStatus");
  in.find(functions.make_state_request, "b3RequestActualStateCommandInit");
  in.find(functions.get_state, "b3GetStatusActualState");
  in.find(functions.get_state_and_links, "b3GetStatusActualState2");
  in.find(functions.make_pose, "b3CreatePoseCommandInit");
  in.find(functions.set_position, "b3CreatePoseCommandSetBasePosition");
  in.find(functions.set_orientation, "b3CreatePoseCommandSetBaseOrientation");
  in.find(functions.set_velocity, "b3CreatePoseCommandSetBaseLinearVelocity");
  in.find(functions.set_angular_velocity, "b3CreatePoseCommandSetBaseAngularVelocity");
  in.find(functions.make_dynamics_request, "b3GetDynamicsInfoCommandInit");
  in.find(functions.get_dynamics, "b3GetDynamicsInfo");
  in.find(functions.make_dynamics_change, "b3InitChangeDynamicsInfo");
  in.find(functions.change_mass, "b3ChangeDynamicsInfoSetMass");
  in.find(functions.change_inertia, "b3ChangeDynamicsInfoSetLocalInertiaDiagonal");
  in.find(functions.change_linear_damping, "b3ChangeDynamicsInfoSetLinearDamping");
  in.find(functions.change_angular_damping, "b3ChangeDynamicsInfoSetAngularDamping");
  in.find(functions.change_friction, "b3ChangeDynamicsInfoSetLateralFriction");
  in.find(functions.change_restitution, "b3ChangeDynamicsInfoSetRestitution");
  in.find(functions.change_contact_threshold, "b3ChangeDynamicsInfoSetContactProcessingThreshold");
  in.find(functions.change_activation, "b3ChangeDynamicsInfoSetActivationState");
  in.find(functions.make_parameter_request, "b3InitRequestPhysicsParamCommand");
  in.find(functions.get_parameters, "b3GetStatusPhysicsSimulationParameters");
  in.find(functions.make_shape_request, "b3InitRequestCollisionShapeInformation");
  in.find(functions.get_shape, "b3GetCollisionShapeInformation");
  in.find(functions.make_filter, "b3CollisionFilterCommandInit");
  in.find(functions.set_pair, "b3SetCollisionFilterPair");
  // The module contains the caller, so it stays loaded.
  if (module) dlclose(module);
  return in.missing();
}

}  // namespace tandem::pybullet
